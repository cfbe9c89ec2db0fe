//! Whole scenes, and files.

use crate::answer::{Answer, answers};
use crate::assembly::Assembly;
use crate::errors::{DICT, raise};
use crate::values::{scene_of, settings_of, text};
use crate::watch::watched;
use foldwell::Pattern;
use foldwell::run::{self, Computed, Ledger, Progress, RunError, RunOptions};
use foldwell::scene::{SceneFile, Setting, parse_set};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A scene as a dict, or the path of its file.
#[derive(FromPyObject)]
pub(crate) enum Given<'py> {
    Dict(Bound<'py, PyDict>),
    File(PathBuf),
}

impl Given<'_> {
    /// Reads the scene with some keys set; paths in a dict are relative to `base`.
    pub(crate) fn read(&self, py: Python<'_>, base: &Path, settings: &Bound<'_, PyDict>) -> PyResult<SceneFile> {
        let (settings, mut arrays) = settings_of(settings)?;
        let settings: Vec<Setting> = settings
            .iter()
            .map(|setting| setting.parse().map_err(|error| PyValueError::new_err(format!("{error}"))))
            .collect::<PyResult<_>>()?;
        let found = match self {
            Self::Dict(dict) => {
                let (table, in_scene) = scene_of(dict, ToOwned::to_owned)?;
                let place = if base == Path::new(".") { DICT.into() } else { base.join(DICT) };
                let set = Arc::make_mut(&mut arrays);
                in_scene.iter().for_each(|(name, array)| _ = set.entry(name.clone()).or_insert_with(|| array.clone()));
                parse_set(&text(&table)?, place, &settings).map_err(RunError::from)
            }
            Self::File(path) => run::read_scene(path, &settings),
        };
        found.map(|file| file.with_arrays(arrays)).map_err(|error| raise(py, &error))
    }
}

/// Computes the studies of a scene, and with `out` writes their files into a folder. Returns the summary as JSON, the
/// answers and whether the run was interrupted.
#[pyfunction]
pub(crate) fn run_scene(
    py: Python<'_>,
    scene: Given<'_>,
    place: (PathBuf, Bound<'_, PyDict>),
    options: (Option<PathBuf>, Option<usize>, bool),
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<(String, Vec<Answer>, bool)> {
    let ((base, settings), (out, threads, resume)) = (place, options);
    let file = scene.read(py, &base, &settings)?;
    if file.scene.sweep.is_some() {
        let help = "foldwell.sweep computes its points";
        return Err(raise(py, &file.error_at(0..0, "the scene has a [sweep]", help).into()));
    }
    let assembly = Py::new(py, Assembly::of(py, file.clone(), None)?)?;
    let built = assembly.get().assembly.clone();
    let ledger = Ledger::default();
    let record = ledger.clone();
    let work = move |observer: run::Observer<'_>| match out {
        None => run::compute(&file, &built, Default::default(), threads, observer),
        Some(out) => {
            let options = RunOptions { out: Some(out), threads, resume };
            let (report, answers) = run::run_and_keep(&file, &built, &options, observer, &record)?;
            Ok(Computed { summary: report.summary, answers, interrupted: report.interrupted })
        }
    };
    let ended = watched(py, progress, work);
    if ended.is_err() {
        ledger.close(false).map_err(|error| raise(py, &error))?; // at Ctrl-C: what is finished is recorded
    }
    answers(py, &assembly, ended?)
}

/// Converts a mesh; returns what the new file does not keep. After Ctrl-C no file is begun.
#[pyfunction]
pub(crate) fn convert(py: Python<'_>, from: PathBuf, to: PathBuf, frame: Option<usize>) -> PyResult<Vec<String>> {
    let reading = Progress { study: "convert".to_owned(), step: 0, of: None, residual: f64::NAN, part: f64::NAN };
    let work = move |observer: run::Observer<'_>| {
        let sheet = run::read_sheet(&from, frame, None)?;
        if observer(&reading).is_break() { Ok(Vec::new()) } else { run::write_sheet(&sheet, &to, None) }
    };
    watched(py, None, work)?.map_err(|error: RunError| raise(py, &error))
}

/// Returns the names of the patterns.
#[pyfunction]
pub(crate) fn patterns() -> Vec<&'static str> {
    Pattern::names().collect()
}

/// Returns a page about a pattern and its parameters.
#[pyfunction]
pub(crate) fn pattern_help(name: &str) -> PyResult<&'static str> {
    Pattern::help(name).map_err(|error| PyValueError::new_err(error.to_string()))
}

/// Returns the JSON schema of scenes, or of summaries of runs or sweeps.
#[pyfunction]
pub(crate) fn schema(of: &str) -> PyResult<String> {
    match of {
        "scene" => Ok(foldwell::scene::schema().to_string()),
        "summary" => Ok(run::schema::schema().to_string()),
        "sweep" => Ok(run::schema::of_sweep().to_string()),
        _ => Err(PyValueError::new_err("schemas are those of `scene`, `summary` and `sweep`")),
    }
}
