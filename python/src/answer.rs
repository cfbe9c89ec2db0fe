//! Answers of studies.

use crate::arrays::{Array1, vector, view};
use crate::errors::raise;
use crate::state::State;
use foldwell::Picture;
use foldwell::analysis::restored;
use foldwell::model::Configuration;
use foldwell::output::{Artifact, Column, OutputError, Table};
use foldwell::run::{Computed, RunError};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::path::PathBuf;

/// The answer of a study; see `foldwell.Result`.
#[pyclass(frozen, module = "foldwell._foldwell")]
pub(crate) struct Answer {
    summary: String,
    pub assembly: foldwell::Assembly,
    states: Vec<(String, Py<State>)>,
    files: Vec<(String, Artifact)>,
    pub saved: Option<Configuration>,
}

impl Answer {
    fn new(py: Python<'_>, assembly: &foldwell::Assembly, answer: foldwell::study::Answer) -> PyResult<Self> {
        let (mut states, mut files) = (Vec::new(), Vec::new());
        for (name, artifact) in answer.files {
            match artifact {
                Artifact::State(picture) => states.push((name, Py::new(py, State { picture })?)),
                other => files.push((name, other)),
            }
        }
        let summary = serde_json::to_string(&answer.summary).unwrap_or_default();
        Ok(Self { summary, assembly: assembly.clone(), states, files, saved: answer.state })
    }

    fn tables(&self) -> impl Iterator<Item = (&str, &Table)> {
        self.files.iter().filter_map(|(name, artifact)| match artifact {
            Artifact::Table(table) => Some((name.as_str(), table)),
            _ => None,
        })
    }
}

/// Returns the summary of a run as JSON, the answers of its studies, and whether it was interrupted.
pub(crate) fn answers(
    py: Python<'_>,
    assembly: &foldwell::Assembly,
    computed: Result<Computed, RunError>,
) -> PyResult<(String, Vec<Answer>, bool)> {
    let Computed { summary, answers, interrupted } = computed.map_err(|error| raise(py, &error))?;
    let answers = answers.into_iter().map(|answer| Answer::new(py, assembly, answer)).collect::<PyResult<_>>()?;
    Ok((serde_json::to_string(&summary).unwrap_or_default(), answers, interrupted))
}

#[pymethods]
impl Answer {
    /// The study's part of `summary.json`.
    #[getter]
    fn summary(&self) -> &str {
        &self.summary
    }

    /// The names of the tables.
    #[getter]
    fn table_names(&self) -> Vec<&str> {
        self.tables().map(|(name, _)| name).collect()
    }

    /// Returns the columns of a table as arrays; columns of words are lists.
    fn table<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Option<Bound<'py, PyDict>>> {
        let Some((_, table)) = self.tables().find(|(known, _)| *known == name) else { return Ok(None) };
        let columns = PyDict::new(py);
        for (name, column) in table.columns() {
            match column {
                Column::Whole(numbers) => columns.set_item(name, vector(py, numbers))?,
                Column::Numbers(numbers) => columns.set_item(name, vector(py, numbers))?,
                Column::Words(words) => columns.set_item(name, words)?,
            }
        }
        Ok(Some(columns))
    }

    /// The states that were kept, in the order of their files.
    #[getter]
    fn states(&self, py: Python<'_>) -> Vec<Py<State>> {
        self.states.iter().map(|(_, state)| state.clone_ref(py)).collect()
    }

    /// Returns the final state; `None` if the study has none.
    fn state(&self) -> Option<State> {
        let state = restored::state(self.saved.as_ref()?, &self.assembly)?;
        Some(State { picture: Picture::new(&self.assembly, &state) })
    }

    /// The coordinates of the final state.
    #[getter]
    fn coordinates<'py>(slf: &Bound<'py, Self>) -> Option<Array1<'py, f64>> {
        slf.get().saved.as_ref().map(|saved| view(slf, &saved.coordinates))
    }

    /// The drawings as SVG, by their names.
    #[getter]
    fn drawings(&self) -> Vec<(&str, &str)> {
        let mut drawings = Vec::new();
        for (name, artifact) in &self.files {
            if let Artifact::Svg(Ok(text)) = artifact {
                drawings.push((name.as_str(), text.as_str()));
            }
        }
        drawings
    }

    /// Writes the files of the study into a folder; returns their names.
    fn save(&self, py: Python<'_>, folder: PathBuf) -> PyResult<Vec<String>> {
        let write = || {
            for (name, state) in &self.states {
                foldwell::write_vtu(&folder.join(name), &state.get().picture)?;
            }
            self.files.iter().try_for_each(|(name, artifact)| artifact.write(&folder.join(name)))
        };
        py.detach(write).map_err(|error: OutputError| raise(py, &error.into()))?;
        let states = self.states.iter().map(|(name, _)| name.clone());
        Ok(states.chain(self.files.iter().map(|(name, _)| name.clone())).collect())
    }
}
