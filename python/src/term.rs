//! Terms whose energy is a function in Python.

use crate::errors::refused;
use foldwell::math::Vec3;
use foldwell::model::{Domain, Measure, OwnTerm, Site};
use foldwell::numerics::derivatives::{DerivativeError, check_gradient};
use nalgebra::{SMatrix, SVector};
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
    pub(crate) fn raise(&self) -> PyResult<()> {
        self.failure.lock().unwrap_or_else(PoisonError::into_inner).take().map_or(Ok(()), Err)
    }

    /// Returns the assembly with this term.
    pub(crate) fn added_to(&self, py: Python<'_>, assembly: &foldwell::Assembly) -> PyResult<foldwell::Assembly> {
        let Self { name, elements, .. } = self;
        let is_taken = assembly.terms().own_names().contains(name.as_str());
        if is_taken || ["bars", "creases", "facets", "total"].contains(&name.as_str()) {
            return Err(refused(py, format!("there is a term `{name}` already"), "give another name"));
        }
        if *assembly.domain() != Domain::Patch {
            return Err(refused(py, "terms of one's own are on patches".to_owned(), "use `Assembly.patch`"));
        }
        let points = assembly.tiling().positions.len();
        if let Some(vertex) = elements.iter().flatten().find(|vertex| **vertex >= points) {
            let message = format!("`{name}` names vertex {vertex}, and the model has {points}");
            return Err(refused(py, message, "vertices are numbered cell by cell, as `state.positions`"));
        }
        Ok(assembly.with_own_term(match elements.first().map_or(0, Vec::len) {
            1 => self.term::<1, 3>(py, assembly)?,
            2 => self.term::<2, 6>(py, assembly)?,
            3 => self.term::<3, 9>(py, assembly)?,
            4 => self.term::<4, 12>(py, assembly)?,
            5 => self.term::<5, 15>(py, assembly)?,
            6 => self.term::<6, 18>(py, assembly)?,
            count => {
                let message = format!("the elements of `{name}` have {count} vertices");
                return Err(refused(py, message, "an element has 1 to 6 vertices"));
            }
        }))
    }

    fn term<const N: usize, const D: usize>(&self, py: Python<'_>, assembly: &foldwell::Assembly) -> PyResult<OwnTerm> {
        let measure = Called { function: self.function.clone_ref(py), failure: self.failure.clone() };
        let sites = |vertices: &Vec<usize>| array::from_fn::<_, N, _>(|k| Site { vertex: vertices[k], shift: [0, 0] });
        let elements = self.elements.iter().map(|vertices| (sites(vertices), 1.0));
        let coordinates = &assembly.drawn().coordinates;
        let all: Vec<Vec3> = coordinates.chunks_exact(3).map(Vec3::from_column_slice).collect();
        let drawn = |vertices: &Vec<usize>| array::from_fn::<_, N, _>(|k| all[vertices[k]]);
        if let Some(element) = self.elements.iter().find(|each| Measure::<N, D>::value(&measure, &drawn(each)).is_nan())
        {
            self.raise()?;
            let message = format!("the energy of `{}` at the vertices {element:?} is not a number as drawn", self.name);
            return Err(refused(py, message, "a term has a finite energy, gradient and Hessian in the drawn state"));
        }
        let checked = measure.checked::<N, D>(&all, &self.elements[0]);
        self.raise()?;
        checked.map_err(|(what, error)| {
            let message = format!("the {what} of `{}` is wrong: along a random direction it has {error}", self.name);
            let help = "it should be that of the energy by the positions, vertex by vertex: x, y and z of the first, then of the second";
            refused(py, message, help)
        })?;
        Ok(OwnTerm::energy::<_, N, D>(&self.name, measure, elements))
    }
}

/// Tolerance of derivatives along a direction, relative. A wrong factor, sign or order is far above it; a function that
/// rounds to single precision, or whose differences are too rough to judge it, is not refused.
const TOLERANCE: f64 = 1e-3;

/// Numbers between -1/2 and 1/2 without a pattern, the same every time: multiples of the golden section.
fn scattered(first: usize) -> impl Iterator<Item = f64> {
    (first..).map(|k| (k as f64 * 0.618_033_988_749_895).fract() - 0.5)
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

impl Called {
    /// Compares gradient and Hessian of one element with central differences, each along one direction, near the drawn
    /// state: a symmetric state may hide what is wrong. A Hessian is compared along two directions, times the second.
    fn checked<const N: usize, const D: usize>(
        &self,
        all: &[Vec3],
        vertices: &[usize],
    ) -> Result<(), (&'static str, DerivativeError)> {
        let drawn: [Vec3; N] = array::from_fn(|k| all[vertices[k]]);
        let others = if N > 1 { &drawn[..] } else { all };
        let size = others.iter().map(|point| (point - drawn[0]).norm()).fold(0.0, f64::max);
        let [off, along, across] = [1, 101, 211].map(|first| {
            let mut numbers = scattered(first);
            SVector::<f64, D>::from_fn(|_, _| size * numbers.next().unwrap_or_default())
        });
        let at = |part: &[f64]| -> [Vec3; N] {
            array::from_fn(|k| drawn[k] + (0.1 * off + part[0] * along).fixed_rows::<3>(3 * k).into_owned())
        };
        let gradient = |part: &[f64]| Measure::<N, D>::gradient(self, &at(part)).1;
        let mut lower = Vec::new();
        let found = Measure::<N, D>::hessian(self, &at(&[0.0]), &mut lower).1;
        let hessian = SMatrix::<f64, D, D>::from_fn(|row, column| {
            let (row, column) = (row.max(column), row.min(column));
            lower[row * (row + 1) / 2 + column]
        });
        let energy = |part: &[f64]| Measure::<N, D>::value(self, &at(part));
        let slope = |part: &[f64]| gradient(part).dot(&across);
        for (what, judged) in [
            ("gradient", check_gradient(energy, &[0.0], &[found.dot(&along)], TOLERANCE)),
            ("Hessian", check_gradient(slope, &[0.0], &[across.dot(&(hessian * along))], TOLERANCE)),
        ] {
            if let Err(error @ DerivativeError::Entry { found, .. }) = judged
                && found.is_finite()
            {
                return Err((what, error));
            }
        }
        Ok(())
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
