//! Answers of studies.

use crate::arrays::{Array1, vector, view};
use crate::assembly::Assembly;
use crate::errors::raise;
use crate::state::State;
use foldwell::Picture;
use foldwell::analysis::restored;
use foldwell::model::{Configuration, Memory};
use foldwell::output::{Artifact, Column, OutputError, files};
use foldwell::run::{Computed, RunError};
use numpy::PyArrayMethods;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};
use std::borrow::Cow;
use std::path::{Path, PathBuf};

/// The answer of a study; see `foldwell.Result`.
#[pyclass(frozen, module = "foldwell._foldwell")]
pub(crate) struct Answer {
    summary: String,
    pub assembly: Py<Assembly>,
    states: Vec<(String, Py<State>)>,
    files: Vec<(String, File)>,
    pub saved: Option<Configuration>,
}

/// A file of an answer that is no state: as it was computed, or as a pickle has kept it.
enum File {
    Computed(Box<Artifact>),
    Kept { bytes: Vec<u8>, columns: Option<Vec<(String, Column)>> },
}

/// The values of a column, as Python has them.
#[derive(FromPyObject, IntoPyObject)]
enum Values<'py> {
    Whole(Array1<'py, i64>),
    Numbers(Array1<'py, f64>),
    Words(Vec<String>),
}

/// Content of a pickled file: name, bytes, and the columns of a table.
type KeptFile<'py> = (String, Bound<'py, PyBytes>, Option<Vec<(String, Values<'py>)>>);
/// Content of a pickled configuration: coordinates, angles and tensions.
type KeptState<'py> = (Array1<'py, f64>, Array1<'py, f64>, Option<Array1<'py, f64>>, Vec<[f64; 2]>);
/// Content of a pickled answer: summary as JSON, assembly, states by file, other files, and final configuration.
type Kept<'py> = (String, Py<Assembly>, Vec<(String, Py<State>)>, Vec<KeptFile<'py>>, Option<KeptState<'py>>);

impl File {
    /// Returns the columns; `None` if the file is no table.
    fn columns(&self) -> Option<Vec<(String, Column)>> {
        match self {
            Self::Computed(artifact) => {
                let Artifact::Table(table) = &**artifact else { return None };
                Some(table.columns().map(|(name, column)| (name.to_owned(), column)).collect())
            }
            Self::Kept { columns, .. } => columns.clone(),
        }
    }

    fn bytes(&self, path: &Path) -> Result<Cow<'_, [u8]>, OutputError> {
        match self {
            Self::Computed(artifact) => artifact.bytes(path).map(Cow::Owned),
            Self::Kept { bytes, .. } => Ok(bytes.into()),
        }
    }
}

impl<'py> Values<'py> {
    fn new(py: Python<'py>, column: Column) -> Self {
        match column {
            Column::Whole(numbers) => Self::Whole(vector(py, numbers)),
            Column::Numbers(numbers) => Self::Numbers(vector(py, numbers)),
            Column::Words(words) => Self::Words(words),
        }
    }

    fn column(self) -> PyResult<Column> {
        Ok(match self {
            Self::Whole(numbers) => Column::Whole(numbers.to_vec()?),
            Self::Numbers(numbers) => Column::Numbers(numbers.to_vec()?),
            Self::Words(words) => Column::Words(words),
        })
    }
}

impl Answer {
    fn new(py: Python<'_>, assembly: &Py<Assembly>, answer: foldwell::study::Answer) -> PyResult<Self> {
        let (mut states, mut files) = (Vec::new(), Vec::new());
        for (name, artifact) in answer.files {
            match artifact {
                Artifact::State(picture) => states.push((name, Py::new(py, State { picture })?)),
                other => files.push((name, File::Computed(other.into()))),
            }
        }
        let summary = serde_json::to_string(&answer.summary).unwrap_or_default();
        Ok(Self { summary, assembly: assembly.clone_ref(py), states, files, saved: answer.state })
    }
}

/// Returns the summary of a run as JSON, the answers of its studies, and whether it was interrupted.
pub(crate) fn answers(
    py: Python<'_>,
    assembly: &Py<Assembly>,
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

    /// The tables by the names of their files: the columns as arrays; columns of words are lists.
    fn tables<'py>(&self, py: Python<'py>) -> PyResult<Vec<(&str, Bound<'py, PyDict>)>> {
        let mut tables = Vec::new();
        for (file, content) in &self.files {
            let Some(columns) = content.columns() else { continue };
            let table = PyDict::new(py);
            columns.into_iter().try_for_each(|(name, column)| table.set_item(name, Values::new(py, column)))?;
            tables.push((file.as_str(), table));
        }
        Ok(tables)
    }

    /// The states that were kept, in the order of their files.
    #[getter]
    fn states(&self, py: Python<'_>) -> Vec<Py<State>> {
        self.states.iter().map(|(_, state)| state.clone_ref(py)).collect()
    }

    /// Returns the final state; `None` if the study has none.
    fn state(&self, py: Python<'_>) -> PyResult<Option<State>> {
        let (this, saved) = (self.assembly.get(), self.saved.as_ref());
        let found = py.detach(|| {
            let state = restored::state(saved?, &this.assembly)?;
            Some(State { picture: Picture::new(&this.assembly, &state) })
        });
        this.raise_failures().map(|()| found)
    }

    /// The coordinates of the final state.
    #[getter]
    fn coordinates<'py>(slf: &Bound<'py, Self>) -> Option<Array1<'py, f64>> {
        slf.get().saved.as_ref().map(|saved| view(slf, &saved.coordinates))
    }

    /// The drawings as SVG, by their names.
    #[getter]
    fn drawings(&self) -> Vec<(&str, String)> {
        let mut drawings = Vec::new();
        for (name, file) in self.files.iter().filter(|(name, _)| name.ends_with(".svg")) {
            if let Ok(text) = file.bytes(Path::new(name)) {
                drawings.push((name.as_str(), String::from_utf8_lossy(&text).into_owned()));
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
            let mut others = self.files.iter().map(|(name, file)| (folder.join(name), file));
            others.try_for_each(|(path, file)| files::write(&path, file.bytes(&path)?))
        };
        py.detach(write).map_err(|error: OutputError| raise(py, &error.into()))?;
        let states = self.states.iter().map(|(name, _)| name.clone());
        Ok(states.chain(self.files.iter().map(|(name, _)| name.clone())).collect())
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, Kept<'py>)> {
        let (py, answer) = (slf.py(), slf.get());
        let mut kept: Vec<KeptFile<'py>> = Vec::new();
        for (name, file) in &answer.files {
            let bytes = file.bytes(Path::new(name)).map_err(|error| raise(py, &error.into()))?;
            let columns = file
                .columns()
                .map(|columns| columns.into_iter().map(|(name, column)| (name, Values::new(py, column))).collect());
            kept.push((name.clone(), PyBytes::new(py, &bytes), columns));
        }
        let array = |values: &Vec<f64>| vector(py, values.clone());
        let saved = answer.saved.as_ref().map(|Configuration { coordinates, angles, tension, memory }| {
            let memory = memory.iter().map(|memory| [memory.kept, memory.gone]).collect();
            (array(coordinates), array(angles), tension.as_ref().map(array), memory)
        });
        let states = answer.states.iter().map(|(name, state)| (name.clone(), state.clone_ref(py))).collect();
        let state = (answer.summary.clone(), answer.assembly.clone_ref(py), states, kept, saved);
        Ok((slf.get_type().getattr("restore")?, state))
    }

    /// Makes the answer of what a pickle has kept.
    #[staticmethod]
    fn restore(
        summary: String,
        assembly: Py<Assembly>,
        states: Vec<(String, Py<State>)>,
        files: Vec<KeptFile<'_>>,
        saved: Option<KeptState<'_>>,
    ) -> PyResult<Self> {
        let mut kept = Vec::new();
        for (name, bytes, columns) in files {
            let column = |(name, values): (String, Values<'_>)| Ok((name, values.column()?));
            let columns = columns.map(|all| all.into_iter().map(column).collect::<PyResult<_>>()).transpose()?;
            kept.push((name, File::Kept { bytes: bytes.as_bytes().to_vec(), columns }));
        }
        let configuration = |(coordinates, angles, tension, memory): KeptState<'_>| {
            let tension = tension.map(|tension| tension.to_vec()).transpose()?;
            let memory = memory.into_iter().map(|[kept, gone]| Memory { kept, gone }).collect();
            let state = Configuration::new(coordinates.to_vec()?, angles.to_vec()?, tension);
            PyResult::Ok(Configuration { memory, ..state })
        };
        Ok(Self { summary, assembly, states, files: kept, saved: saved.map(configuration).transpose()? })
    }
}
