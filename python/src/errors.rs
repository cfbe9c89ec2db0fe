//! Errors of the library as Python exceptions.

use foldwell::run::RunError;
use foldwell::scene::SceneError;
use foldwell::sheet::SheetError;
use miette::Diagnostic;
use pyo3::prelude::*;

/// Returns the exception of a class of `foldwell.errors` with these arguments.
fn exception(py: Python<'_>, class: &str, arguments: (String, Option<String>, Option<String>, Option<usize>)) -> PyErr {
    let make = || py.import("foldwell.errors")?.getattr(class)?.call1(arguments);
    make().map_or_else(|error| error, PyErr::from_value)
}

/// Returns the exception for an error of the library: `SceneError` if something that was given is wrong, `SheetError`
/// if that is a mesh, `OutputError` if a file cannot be read or written.
pub(crate) fn raise(py: Python<'_>, error: &RunError) -> PyErr {
    let class = match error {
        RunError::Mesh(_) | RunError::NoSheet { .. } | RunError::Scene(SceneError::Mesh(_)) => "SheetError",
        _ if error.exit_status() == 3 => "OutputError",
        _ => "SceneError",
    };
    let help = error.help().map(|help| help.to_string());
    let (file, line) = match error {
        RunError::Scene(SceneError::At { file, line, .. }) => (Some(file.clone()), Some(*line)),
        _ => (None, None),
    };
    exception(py, class, (error.to_string(), help, file, line))
}

/// Returns the `SceneError` about something that was given, with a hint.
pub(crate) fn refused(py: Python<'_>, message: String, help: &str) -> PyErr {
    exception(py, "SceneError", (message, Some(help.to_owned()), None, None))
}

/// Returns the exception for a wrong mesh.
pub(crate) fn raise_sheet(py: Python<'_>, error: SheetError) -> PyErr {
    raise(py, &error.into())
}

/// Returns the exception for a failure of the program itself.
pub(crate) fn bug(py: Python<'_>, message: String) -> PyErr {
    exception(py, "FoldwellError", (message, None, None, None))
}
