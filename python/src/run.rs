//! Whole scenes, and files.

use crate::answer::{Answer, answers};
use crate::assembly::Assembly;
use crate::errors::raise;
use crate::values::{table, text};
use crate::watch::watched;
use foldwell::Pattern;
use foldwell::run::{self, Ledger, Progress, RunError, RunOptions};
use foldwell::scene::{Arrays, SceneFile, Setting, parse_set};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::path::{Path, PathBuf};

/// A scene as a dict, or the path of its file.
#[derive(FromPyObject)]
pub(crate) enum Given<'py> {
    Dict(Bound<'py, PyDict>),
    File(PathBuf),
}

impl Given<'_> {
    /// Reads the scene with some keys set; paths in a dict are relative to `base`.
    pub(crate) fn read(&self, py: Python<'_>, base: &Path, settings: &[String]) -> PyResult<SceneFile> {
        let settings: Vec<Setting> = settings
            .iter()
            .map(|setting| setting.parse().map_err(|error| PyValueError::new_err(format!("{error}"))))
            .collect::<PyResult<_>>()?;
        let found = match self {
            Self::Dict(dict) => parse_set(&text(&table(dict)?)?, scene_in(base), &settings).map_err(RunError::from),
            Self::File(path) => run::read_scene(path, &settings),
        };
        found.map_err(|error| raise(py, &error))
    }
}

/// Returns the path that stands for a scene in a folder.
fn scene_in(base: &Path) -> PathBuf {
    if base == Path::new(".") { "scene".into() } else { base.join("scene") }
}

/// Computes the studies of a scene: in memory, or, with `out`, into a folder. Returns the summary as JSON, the answers
/// (none for a folder) and whether the run was interrupted.
#[pyfunction]
pub(crate) fn run_scene(
    py: Python<'_>,
    scene: Given<'_>,
    place: (PathBuf, Vec<String>),
    options: (Option<PathBuf>, Option<usize>, bool),
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<(String, Vec<Answer>, bool)> {
    let ((base, settings), (out, threads, resume)) = (place, options);
    let file = scene.read(py, &base, &settings)?;
    if file.scene.sweep.is_some() {
        let help = "foldwell.sweep computes its points";
        return Err(raise(py, &file.error_at(0..0, "the scene has a [sweep]", help).into()));
    }
    if let Some(out) = out {
        let options = RunOptions { out: Some(out), threads, resume };
        let ledger = Ledger::default();
        let record = ledger.clone();
        let work = move |observer: run::Observer<'_>| run::run(&file, &options, observer, &record);
        let ended = watched(py, progress, work);
        if ended.is_err() {
            ledger.close(false).map_err(|error| raise(py, &error))?; // at Ctrl-C: what is finished is recorded
        }
        let report = ended?.map_err(|error| raise(py, &error))?;
        return Ok((serde_json::to_string(&report.summary).unwrap_or_default(), vec![], report.interrupted));
    }
    let assembly = Py::new(py, Assembly::of(py, file.clone(), Arrays::default(), None)?)?;
    let built = assembly.get().assembly.clone();
    let work = move |observer: run::Observer<'_>| run::compute(&file, &built, Default::default(), threads, observer);
    answers(py, &assembly, watched(py, progress, work)?)
}

/// Converts a mesh; returns what the new file does not keep. After Ctrl-C no file is begun.
#[pyfunction]
pub(crate) fn convert(py: Python<'_>, from: PathBuf, to: PathBuf, frame: Option<usize>) -> PyResult<Vec<String>> {
    let reading = Progress { study: "convert".to_owned(), step: 0, of: None, residual: f64::NAN };
    let work = move |observer: run::Observer<'_>| {
        let sheet = run::read_sheet(&from, frame, None)?;
        if observer(&reading).is_break() { Ok(Vec::new()) } else { run::write_sheet(&sheet, &to) }
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

/// Returns the JSON schema of scenes or summaries.
#[pyfunction]
pub(crate) fn schema(of: &str) -> PyResult<String> {
    match of {
        "scene" => Ok(foldwell::scene::schema().to_string()),
        "summary" => Ok(run::schema::schema().to_string()),
        _ => Err(PyValueError::new_err("schemas are those of `scene` and `summary`")),
    }
}
