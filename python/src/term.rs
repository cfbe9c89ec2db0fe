//! Terms whose energy is a function in Python.

use crate::errors::refused;
use foldwell::math::Vec3;
use foldwell::model::{Boundary, Law, Measure, OwnTerm, Site, Spring};
use nalgebra::SVector;
use numpy::PyReadonlyArray1;
use pyo3::prelude::*;
use std::array;
use std::sync::{Arc, Mutex, PoisonError};

/// The exception that ended a function of Python, until it is raised.
type Failure = Arc<Mutex<Option<PyErr>>>;

/// A term: its name, the vertices of each element, the function of their positions, and the exception
/// that ended it.
pub(crate) struct CalledTerm {
    pub name: String,
    pub elements: Vec<Vec<usize>>,
    pub function: Py<PyAny>,
    failure: Failure,
}

impl CalledTerm {
    pub(crate) fn new(name: String, elements: Vec<Vec<usize>>, function: Py<PyAny>) -> Self {
        Self { name, elements, function, failure: Failure::default() }
    }

    /// Returns the same term, whose failures are those of this one.
    pub(crate) fn clone_ref(&self, py: Python<'_>) -> Self {
        let Self { name, elements, function, failure } = self;
        let (name, elements, failure) = (name.clone(), elements.clone(), failure.clone());
        Self { name, elements, function: function.clone_ref(py), failure }
    }

    /// Returns the exception that has ended the function since this was asked last.
    ///
    /// # Errors
    /// That exception.
    pub(crate) fn raise(&self) -> PyResult<()> {
        self.failure.lock().unwrap_or_else(PoisonError::into_inner).take().map_or(Ok(()), Err)
    }

    /// Returns the assembly with this term.
    ///
    /// # Errors
    /// `SceneError` for names, vertices and boundary conditions that it cannot have.
    pub(crate) fn added_to(&self, py: Python<'_>, assembly: &foldwell::Assembly) -> PyResult<foldwell::Assembly> {
        let Self { name, elements, .. } = self;
        let is_taken = assembly.terms().own_names().contains(name.as_str());
        if is_taken || ["bars", "creases", "facets", "total"].contains(&name.as_str()) {
            return Err(refused(py, format!("there is a term `{name}` already"), "give another name"));
        }
        if assembly.boundary() != Boundary::Patch {
            return Err(refused(py, "terms of one's own are on patches".to_owned(), "use `Assembly.patch`"));
        }
        let points = assembly.tiling().positions.len();
        if let Some(vertex) = elements.iter().flatten().find(|vertex| **vertex >= points) {
            let message = format!("`{name}` names vertex {vertex}, and the model has {points}");
            return Err(refused(py, message, "vertices are numbered cell by cell, as `state.positions`"));
        }
        Ok(assembly.with_own_term(match elements.first().map_or(0, Vec::len) {
            1 => self.term::<1, 3>(py),
            2 => self.term::<2, 6>(py),
            3 => self.term::<3, 9>(py),
            4 => self.term::<4, 12>(py),
            5 => self.term::<5, 15>(py),
            6 => self.term::<6, 18>(py),
            count => {
                let message = format!("the elements of `{name}` have {count} vertices");
                return Err(refused(py, message, "an element has 1 to 6 vertices"));
            }
        }))
    }

    fn term<const N: usize, const D: usize>(&self, py: Python<'_>) -> OwnTerm {
        let measure = Called { function: self.function.clone_ref(py), failure: self.failure.clone() };
        let sites = |vertices: &Vec<usize>| array::from_fn::<_, N, _>(|k| Site { vertex: vertices[k], shift: [0, 0] });
        let elements = self.elements.iter().map(|vertices| (sites(vertices), Spring { stiffness: 1.0, rest: 0.0 }));
        OwnTerm::with_law::<_, N, D>(&self.name, measure, elements, Itself)
    }
}

/// The value of a function in Python as a measure.
struct Called {
    function: Py<PyAny>,
    failure: Failure,
}

/// Value, gradient and Hessian, row by row.
type Expansion<'py> = (f64, PyReadonlyArray1<'py, f64>, PyReadonlyArray1<'py, f64>);

impl Called {
    /// Calls the function with `[x, y, z]` of each point, and reads what it returns. `None` after an exception, which
    /// is kept to be raised, and when the interpreter ends.
    fn call<R>(&self, points: &[Vec3], read: impl FnOnce(Expansion<'_>) -> PyResult<R>) -> Option<R> {
        Python::try_attach(|py| {
            if self.failure.lock().unwrap_or_else(PoisonError::into_inner).is_some() {
                return None;
            }
            let rows: Vec<[f64; 3]> = points.iter().map(|point| (*point).into()).collect();
            let called = self.function.bind(py).call1((rows,)).and_then(|found| read(found.extract()?));
            called.map_err(|error| *self.failure.lock().unwrap_or_else(PoisonError::into_inner) = Some(error)).ok()
        })?
    }
}

impl<const N: usize, const D: usize> Measure<N, D> for Called {
    fn value(&self, points: &[Vec3; N]) -> f64 {
        self.call(points, |(value, ..)| Ok(value)).unwrap_or(f64::NAN)
    }

    fn gradient(&self, points: &[Vec3; N]) -> (f64, SVector<f64, D>) {
        self.hessian(points, &mut Vec::new())
    }

    fn hessian(&self, points: &[Vec3; N], lower: &mut Vec<f64>) -> (f64, SVector<f64, D>) {
        lower.clear();
        let read = |(value, gradient, hessian): Expansion<'_>| {
            let (gradient, hessian) = (gradient.as_slice()?, hessian.as_slice()?);
            (0..D).for_each(|row| lower.extend_from_slice(&hessian[row * D..=row * (D + 1)]));
            Ok((value, SVector::from_column_slice(gradient)))
        };
        let found = self.call(points, read);
        found.unwrap_or_else(|| {
            lower.resize(D * (D + 1) / 2, f64::NAN);
            (f64::NAN, SVector::repeat(f64::NAN))
        })
    }
}

/// The law whose energy is the measure itself.
#[derive(Debug)]
struct Itself;

impl Law for Itself {
    fn at(&self, value: f64, _: f64) -> [f64; 3] {
        [value, 1.0, 0.0]
    }

    fn by_rest(&self, _: f64, _: f64) -> [f64; 3] {
        [0.0; 3]
    }
}
