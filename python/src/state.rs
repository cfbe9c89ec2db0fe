//! States of a sheet as arrays.

use crate::arrays::{Array1, Array2, indices, rows, view, view_of_points};
use crate::errors::{bug, raise};
use foldwell::Picture;
use foldwell::output::figure::{Annotations, Caption, sheet};
use foldwell::output::vtk;
use foldwell::run;
use pyo3::prelude::*;
use pyo3::types::{IntoPyDict, PyBytes, PyDict};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// A state of a sheet; see `foldwell.State`.
#[pyclass(frozen, module = "foldwell._foldwell", subclass)]
pub(crate) struct State {
    pub picture: Picture,
}

#[pymethods]
impl State {
    #[getter]
    fn positions<'py>(slf: &Bound<'py, Self>) -> Array2<'py, f64> {
        view_of_points(slf, &slf.get().picture.points)
    }

    #[getter]
    fn displacements<'py>(slf: &Bound<'py, Self>) -> Array2<'py, f64> {
        view_of_points(slf, &slf.get().picture.displacement)
    }

    #[getter]
    fn places<'py>(&self, py: Python<'py>) -> PyResult<Array2<'py, i64>> {
        let place = |(vertex, [a, b]): &(usize, [i32; 2])| [*vertex as i64, i64::from(*a), i64::from(*b)];
        rows(py, self.picture.places.iter().flat_map(place).collect(), 3)
    }

    #[getter]
    fn faces<'py>(&self, py: Python<'py>) -> PyResult<Array2<'py, i64>> {
        indices(py, &self.picture.triangles)
    }

    #[getter]
    fn self_intersecting<'py>(slf: &Bound<'py, Self>) -> Array1<'py, u8> {
        view(slf, &slf.get().picture.self_intersecting)
    }

    #[getter]
    fn edges<'py>(&self, py: Python<'py>) -> PyResult<Array2<'py, i64>> {
        indices(py, &self.picture.lines)
    }

    #[getter]
    fn kinds(&self) -> Vec<&'static str> {
        self.picture.line_kinds.iter().map(|kind| kind.word()).collect()
    }

    #[getter]
    fn letters(&self) -> Vec<&'static str> {
        self.picture.letters.iter().map(|letter| letter.letter()).collect()
    }

    #[getter]
    fn cell_edges<'py>(slf: &Bound<'py, Self>) -> Array1<'py, i32> {
        view(slf, &slf.get().picture.line_edges)
    }

    #[getter]
    fn on_edges<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyDict>> {
        let picture = &slf.get().picture;
        Picture::FIELDS.iter().map(|(name, get)| (*name, view(slf, get(picture)))).into_py_dict(slf.py())
    }

    #[getter]
    fn memory<'py>(slf: &Bound<'py, Self>) -> BTreeMap<&'static str, Array1<'py, f64>> {
        slf.get().picture.memory.iter().map(|(name, values)| (*name, view(slf, values))).collect()
    }

    /// Returns the addresses of the positions and the fold angles in the memory of the library.
    fn addresses(&self) -> [usize; 2] {
        [self.picture.points.as_ptr().addr(), self.picture.fold_angle.as_ptr().addr()]
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, (Bound<'py, PyBytes>,))> {
        let bytes = vtk::vtu(Path::new("state"), &slf.get().picture).map_err(|error| raise(slf.py(), &error.into()))?;
        Ok((slf.get_type().getattr("restore")?, (PyBytes::new(slf.py(), &bytes),)))
    }

    /// Makes the state of what a pickle has kept: the bytes of its VTU file.
    #[staticmethod]
    fn restore(py: Python<'_>, bytes: &[u8]) -> PyResult<Self> {
        vtk::parse_picture(bytes).map(|picture| Self { picture }).map_err(|fault| bug(py, fault.to_string()))
    }

    /// Returns the drawing of the state, without words.
    fn svg(&self, py: Python<'_>) -> PyResult<String> {
        let drawn = sheet::svg(&self.picture, &Annotations::default(), &Caption::default());
        drawn.map_err(|fault| bug(py, fault.to_string()))
    }

    /// Writes the state; returns what the file does not keep.
    fn save(&self, py: Python<'_>, path: PathBuf, thickness: Option<f64>) -> PyResult<Vec<String>> {
        run::write_state(&self.picture, &path, thickness).map_err(|error| raise(py, &error))
    }
}
