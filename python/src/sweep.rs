//! Sweeps: the points of a scene, each computed here or in another process, and the table of their results.

use crate::arrays::{KeptArrays, kept, unkept};
use crate::errors::raise;
use crate::run::Given;
use crate::watch::watched;
use foldwell::run::{self, Observer, RunError, RunOptions, SweepRow};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::path::PathBuf;
use std::sync::Arc;

/// The points of a scene.
#[pyclass(frozen, module = "foldwell._foldwell")]
pub(crate) struct Sweep {
    sweep: Arc<foldwell::scene::Sweep>,
}

/// Content of a pickled sweep: text of the scene, its path, and the arrays in it.
type Kept<'py> = (String, PathBuf, KeptArrays<'py>);

#[pymethods]
impl Sweep {
    /// Reads the points of a scene with some keys set.
    #[new]
    fn new(py: Python<'_>, scene: Given<'_>, base: PathBuf, settings: &Bound<'_, PyDict>) -> PyResult<Self> {
        let file = scene.read(py, &base, settings)?;
        run::points(&file).map(|sweep| Self { sweep: sweep.into() }).map_err(|error| raise(py, &error))
    }

    fn __len__(&self) -> usize {
        self.sweep.len()
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, Kept<'py>)> {
        let file = slf.get().sweep.file();
        let state = (file.text().to_owned(), file.path().to_owned(), kept(slf.py(), file.arrays()));
        Ok((slf.get_type().getattr("parse")?, state))
    }

    /// Reads the points from the text of a scene.
    #[staticmethod]
    fn parse(py: Python<'_>, text: &str, path: PathBuf, arrays: KeptArrays<'_>) -> PyResult<Self> {
        let arrays = unkept(arrays)?;
        let file = foldwell::scene::parse(text, &path).map_err(RunError::from);
        let found = file.and_then(|file| run::points(&file.with_arrays(arrays)));
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

    /// Checks the scene and those of all points as `run` would.
    fn check_scenes(&self, py: Python<'_>) -> PyResult<()> {
        let sweep = self.sweep.clone();
        watched(py, None, move |_| run::check_scenes(&sweep))?.map_err(|error| raise(py, &error))
    }

    /// Computes some points and writes nothing; returns the row of each as JSON, `None` where the callback stopped it.
    fn rows(
        &self,
        py: Python<'_>,
        points: Vec<usize>,
        threads: Option<usize>,
        progress: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Vec<Option<String>>> {
        let sweep = self.sweep.clone();
        let work = move |observer: Observer<'_>| run::rows(&sweep, &points, threads, observer);
        let rows = watched(py, progress, work)?.map_err(|error: RunError| raise(py, &error))?;
        Ok(rows.iter().map(|row| serde_json::to_string(row.as_ref()?).ok()).collect())
    }

    /// Returns the table of these rows as CSV, and the summary as JSON.
    fn table(&self, py: Python<'_>, rows: Vec<Option<String>>) -> PyResult<(String, String)> {
        let rows = rows.iter().map(|row| serde_json::from_str::<SweepRow>(row.as_ref()?).ok()).collect();
        let (table, summary) = run::table_of(&self.sweep, rows).map_err(|error| raise(py, &error))?;
        Ok((table, serde_json::to_string(&summary).unwrap_or_default()))
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
