//! Sweeps: the points of a scene, each computed here or in another process, and the table of their results.

use crate::errors::raise;
use crate::run::Given;
use crate::watch::watched;
use foldwell::run::{self, Observer, RunOptions};
use pyo3::prelude::*;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The points of a scene.
#[pyclass(frozen, module = "foldwell._foldwell")]
pub(crate) struct Sweep {
    sweep: Arc<foldwell::scene::Sweep>,
}

#[pymethods]
impl Sweep {
    /// Reads the points of a scene with some keys set.
    #[new]
    fn new(py: Python<'_>, scene: Given<'_>, base: PathBuf, settings: Vec<String>) -> PyResult<Self> {
        let file = scene.read(py, &base, &settings)?;
        run::points(&file).map(|sweep| Self { sweep: sweep.into() }).map_err(|error| raise(py, &error))
    }

    fn __len__(&self) -> usize {
        self.sweep.len()
    }

    /// The text of the scene, from which another process reads the same points.
    #[getter]
    fn text(&self) -> &str {
        self.sweep.file().text()
    }

    /// The path of the scene, to which paths in it are relative.
    #[getter]
    fn path(&self) -> &Path {
        self.sweep.file().path()
    }

    /// Reads the points from the text of a scene.
    #[staticmethod]
    fn parse(py: Python<'_>, text: &str, path: PathBuf) -> PyResult<Self> {
        let found =
            foldwell::scene::parse(text, &path).map_err(run::RunError::from).and_then(|file| run::points(&file));
        found.map(|sweep| Self { sweep: sweep.into() }).map_err(|error| raise(py, &error))
    }

    /// The number of values along each axis; empty if the points are no product.
    #[getter]
    fn shape(&self) -> Vec<usize> {
        self.sweep.shape().unwrap_or_default()
    }

    /// The paths of the keys that the points set.
    #[getter]
    fn keys(&self) -> Vec<&str> {
        self.sweep.keys().collect()
    }

    /// Checks the scene and every point as `sweep` would; writes nothing.
    fn check(&self, py: Python<'_>, out: PathBuf) -> PyResult<()> {
        let options = RunOptions { out: Some(out), ..RunOptions::default() };
        let sweep = self.sweep.clone();
        watched(py, None, move |_| run::check(sweep.file(), &options))?.map_err(|error| raise(py, &error))
    }

    /// Computes a point in its folder, unless it is kept; returns the word for what became of it.
    fn run_point(
        &self,
        py: Python<'_>,
        index: usize,
        out: PathBuf,
        threads: Option<usize>,
        resume: bool,
    ) -> PyResult<Option<&'static str>> {
        let (sweep, options) = (self.sweep.clone(), RunOptions { out: Some(out), threads, resume });
        let work = move |observer: Observer<'_>| run::run_point(&sweep, index, &options, observer);
        let status = watched(py, None, work)?.map_err(|error| raise(py, &error))?;
        Ok(status.map(|status| status.word()))
    }

    /// Writes the table of the finished points; returns the summary as JSON.
    fn assemble(&self, py: Python<'_>, out: PathBuf) -> PyResult<String> {
        let sweep = self.sweep.clone();
        let summary = watched(py, None, move |_| run::assemble(&sweep, &out))?.map_err(|error| raise(py, &error))?;
        Ok(serde_json::to_string(&summary).unwrap_or_default())
    }

    /// Computes all points on the threads of this process.
    fn run(
        &self,
        py: Python<'_>,
        out: PathBuf,
        threads: Option<usize>,
        resume: bool,
        progress: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<String> {
        let (sweep, options) = (self.sweep.clone(), RunOptions { out: Some(out), threads, resume });
        let work = move |observer: Observer<'_>| run::sweep(sweep.file(), &options, None, observer);
        let report = watched(py, progress, work)?.map_err(|error| raise(py, &error))?;
        Ok(serde_json::to_string(&report.summary).unwrap_or_default())
    }
}
