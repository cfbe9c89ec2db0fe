//! The extension module of the Python package `foldwell`: its classes hold the values of the library and pass arrays to
//! NumPy. The package wraps them in functions with keyword arguments; nothing here is computed twice.

mod answer;
mod arrays;
mod assembly;
mod errors;
mod forms;
mod run;
mod sheet;
mod state;
mod sweep;
mod term;
mod values;
mod watch;

/// The compiled part of foldwell. Import `foldwell` instead.
#[pyo3::pymodule]
mod _foldwell {
    #[pymodule_export]
    use crate::answer::Answer;
    #[pymodule_export]
    use crate::assembly::Assembly;
    #[pymodule_export]
    use crate::forms::{Forms, closure};
    #[pymodule_export]
    use crate::run::{convert, pattern_help, patterns, run_scene, schema};
    #[pymodule_export]
    use crate::sheet::Sheet;
    #[pymodule_export]
    use crate::state::State;
    #[pymodule_export]
    use crate::sweep::Sweep;
    #[pymodule_export]
    use crate::watch::stop_all;

    #[pymodule_export]
    #[allow(non_upper_case_globals)]
    const __version__: &str = env!("CARGO_PKG_VERSION");
}
