//! Sheets: read, generated, written and looked at.

use crate::arrays::{Array1, Array2, points, rows, vector};
use crate::errors::{raise, refused};
use crate::values::table;
use crate::watch::watched;
use foldwell::kinematics::drawn_fold_angles;
use foldwell::math::Vec3;
use foldwell::run::{self, RunError};
use foldwell::sheet::build::Drawing;
use foldwell::sheet::{Assignment, EdgeKey, Info, fold, listed, obj};
use numpy::PyReadonlyArray2;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::path::PathBuf;

/// A sheet; see `foldwell.Sheet`.
#[pyclass(frozen, module = "foldwell._foldwell", subclass)]
pub(crate) struct Sheet {
    pub sheet: foldwell::Sheet,
}

/// Given rows of numbers.
type Rows<'py> = PyReadonlyArray2<'py, f64>;

/// Returns the exception for a letter that FOLD does not have.
fn no_letter(py: Python<'_>, letter: &str) -> PyErr {
    let help = "letters are the capitals \"B\", \"M\", \"V\", \"F\", \"U\", \"C\" and \"J\"";
    refused(py, format!("`{letter}` is no letter of an edge"), help)
}

/// Content of a pickled sheet, the arguments of `parse`: FOLD text, name for messages, and the first frame (`None`).
type Kept = (String, &'static str, Option<usize>);

#[pymethods]
impl Sheet {
    /// Reads a mesh file in the format of its ending.
    #[staticmethod]
    fn read(py: Python<'_>, path: PathBuf, frame: Option<usize>, merge: Option<f64>) -> PyResult<Self> {
        let read = watched(py, None, move |_| run::read_sheet(&path, frame, merge))?;
        read.map(|sheet| Self { sheet }).map_err(|error| raise(py, &error))
    }

    /// Reads the text of a FOLD file, or of an OBJ file if `name` ends in `.obj`.
    #[staticmethod]
    fn parse(py: Python<'_>, text: String, name: String, frame: Option<usize>) -> PyResult<Self> {
        let parsed = watched(py, None, move |_| match (name.to_lowercase().ends_with(".obj"), frame) {
            (true, _) => obj::parse(&text, &name),
            (false, frame) => fold::parse_frame(&text, &name, frame, None),
        })?;
        parsed.map(|sheet| Self { sheet }).map_err(|error| raise(py, &error.into()))
    }

    /// Makes a sheet from arrays: vertices in two or three columns, faces, lattice vectors, and edges with letters and
    /// fold angles, NaN where there is none.
    #[staticmethod]
    fn of_arrays(
        py: Python<'_>,
        title: String,
        shape: (Rows<'_>, Vec<Vec<usize>>, Option<Rows<'_>>),
        listed: (Vec<[usize; 2]>, Vec<String>, Vec<f64>),
    ) -> PyResult<Self> {
        let ((vertices, faces, lattice), (edges, letters, fold_angles)) = (shape, listed);
        let points = |array: &Rows<'_>| -> Vec<Vec3> {
            let rows = array.as_array();
            rows.rows().into_iter().map(|row| Vec3::from_fn(|axis, _| row.get(axis).copied().unwrap_or(0.0))).collect()
        };
        let letter = |letter: &String| Assignment::from_letter(letter).ok_or_else(|| no_letter(py, letter));
        let letters = letters.iter().map(letter).collect::<PyResult<Vec<_>>>()?;
        let angles = fold_angles.iter().map(|angle| Some(*angle).filter(|angle| !angle.is_nan()));
        let drawn = Drawing {
            title,
            planar: vertices.as_array().ncols() == 2,
            coords: points(&vertices),
            faces,
            lattice: lattice.and_then(|lattice| <[Vec3; 2]>::try_from(points(&lattice)).ok()),
            assignments: edges.iter().copied().zip(letters).collect(),
            fold_angles: edges.iter().copied().zip(angles).collect(),
            ..Drawing::default()
        };
        let built = watched(py, None, move |_| listed::build_arrays(&drawn, &edges))?;
        let refused = |defect| raise(py, &RunError::NoSheet { path: "arrays".into(), defect });
        built.map(|sheet| Self { sheet }).map_err(refused)
    }

    /// Generates a pattern from its table.
    #[staticmethod]
    fn generate(py: Python<'_>, pattern: &Bound<'_, PyDict>) -> PyResult<Self> {
        let pattern = table(pattern)?;
        let made = watched(py, None, move |_| run::new_sheet(&pattern))?;
        made.map(|sheet| Self { sheet }).map_err(|error| raise(py, &error))
    }

    /// Writes the sheet; returns what the file does not keep.
    fn write(&self, py: Python<'_>, path: PathBuf, thickness: Option<f64>) -> PyResult<Vec<String>> {
        let sheet = self.sheet.clone();
        watched(py, None, move |_| run::write_sheet(&sheet, &path, thickness))?.map_err(|error| raise(py, &error))
    }

    /// Returns the text of a FOLD file of the sheet.
    fn to_fold(&self, py: Python<'_>) -> String {
        py.detach(|| fold::write(&self.sheet))
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, Kept)> {
        Ok((slf.get_type().getattr("parse")?, (slf.get().to_fold(slf.py()), "sheet", None)))
    }

    /// Returns counts and measures of the sheet as JSON.
    fn info(&self, py: Python<'_>) -> String {
        py.detach(|| serde_json::to_string(&Info::new(&self.sheet)).unwrap_or_default())
    }

    #[getter]
    fn title(&self) -> &str {
        &self.sheet.title
    }

    #[getter]
    fn vertices<'py>(&self, py: Python<'py>) -> PyResult<Array2<'py, f64>> {
        points(py, &self.sheet.vertices)
    }

    #[getter]
    fn lattice<'py>(&self, py: Python<'py>) -> PyResult<Option<Array2<'py, f64>>> {
        self.sheet.lattice.as_ref().map(|lattice| points(py, lattice)).transpose()
    }

    #[getter]
    fn screws<'py>(&self, py: Python<'py>) -> PyResult<Option<Array2<'py, f64>>> {
        let both = |screws: &foldwell::sheet::ScrewLattice| [0, 1].map(|a| [screws.turn[a], screws.rise[a]]).concat();
        self.sheet.screws.as_ref().map(|screws| rows(py, both(screws), 2)).transpose()
    }

    #[getter]
    fn edges<'py>(&self, py: Python<'py>) -> PyResult<Array2<'py, i64>> {
        rows(py, self.sheet.edges.iter().flat_map(|edge| name(edge.key)).collect(), 4)
    }

    #[getter]
    fn kinds(&self) -> Vec<&'static str> {
        self.sheet.edges.iter().map(|edge| edge.kind.word()).collect()
    }

    #[getter]
    fn letters(&self) -> Vec<&'static str> {
        self.sheet.edges.iter().map(|edge| self.sheet.assignment(edge).letter()).collect()
    }

    #[getter]
    fn fold_angles<'py>(&self, py: Python<'py>) -> Array1<'py, f64> {
        vector(py, drawn_fold_angles(&self.sheet))
    }

    /// The corners of the polygons, each as vertex and cell.
    #[getter]
    fn polygons(&self) -> Vec<Vec<(usize, i32, i32)>> {
        let polygons = self.sheet.polygons.iter();
        polygons.map(|corners| corners.iter().map(|c| (c.vertex, c.shift[0], c.shift[1])).collect()).collect()
    }
}

/// Returns the name of an edge as numbers.
pub(crate) fn name(key: EdgeKey) -> [i64; 4] {
    [key.i as i64, key.j as i64, i64::from(key.shift[0]), i64::from(key.shift[1])]
}
