//! Vectors of the library as arrays of NumPy.

use foldwell::math::Vec3;
use foldwell::scene::Arrays;
use numpy::ndarray::{ArrayView1, ArrayView2};
use numpy::{Element, IntoPyArray, PyArray1, PyArray2, PyArrayMethods};
use pyo3::PyClass;
use pyo3::prelude::*;
use std::collections::BTreeMap;
use std::path::PathBuf;

/// Array of one dimension.
pub(crate) type Array1<'py, T> = Bound<'py, PyArray1<T>>;
/// Array of two dimensions.
pub(crate) type Array2<'py, T> = Bound<'py, PyArray2<T>>;

/// Arrays of a scene as a pickle keeps them.
pub(crate) type KeptArrays<'py> = BTreeMap<PathBuf, Array1<'py, f64>>;

/// Returns the arrays of a scene for a pickle.
pub(crate) fn kept<'py>(py: Python<'py>, arrays: &Arrays) -> KeptArrays<'py> {
    arrays.iter().map(|(name, array)| (name.clone(), vector(py, array.clone()))).collect()
}

/// Returns the arrays that a pickle has kept.
pub(crate) fn unkept(arrays: KeptArrays<'_>) -> PyResult<Arrays> {
    let found: PyResult<BTreeMap<_, _>> = arrays.into_iter().map(|(name, array)| Ok((name, array.to_vec()?))).collect();
    Ok(found?.into())
}

/// Returns numbers that `owner` contains as an array that cannot be written, without copying them. The array keeps the
/// owner alive.
pub(crate) fn view<'py, T: PyClass, E: Element>(owner: &Bound<'py, T>, values: &[E]) -> Array1<'py, E> {
    let values = ArrayView1::from(values);
    // SAFETY: the values are in the memory of a frozen object, which neither moves nor changes while the array keeps it
    // alive.
    let array = unsafe { PyArray1::borrow_from_array(&values, owner.clone().into_any()) };
    array.readwrite().make_nonwriteable();
    array
}

/// Does the same with points, as an array of three columns.
pub(crate) fn view_of_points<'py, T: PyClass>(owner: &Bound<'py, T>, points: &[Vec3]) -> Array2<'py, f64> {
    // SAFETY: `Vec3` has the layout of `[f64; 3]`: nalgebra stores it as one column of an array.
    let rows = unsafe { std::slice::from_raw_parts(points.as_ptr().cast::<[f64; 3]>(), points.len()) };
    let rows = ArrayView2::from(rows);
    // SAFETY: as in `view`.
    let array = unsafe { PyArray2::borrow_from_array(&rows, owner.clone().into_any()) };
    array.readwrite().make_nonwriteable();
    array
}

/// Returns a vector as an array, which takes over its memory.
pub(crate) fn vector<T: Element>(py: Python<'_>, values: Vec<T>) -> Array1<'_, T> {
    values.into_pyarray(py)
}

/// Returns rows of equal length, one after the other, as an array.
pub(crate) fn rows<T: Element>(py: Python<'_>, values: Vec<T>, width: usize) -> PyResult<Array2<'_, T>> {
    let height = values.len() / width.max(1);
    values.into_pyarray(py).reshape([height, width])
}

/// Returns points as an array of three columns.
pub(crate) fn points<'py>(py: Python<'py>, points: &[Vec3]) -> PyResult<Array2<'py, f64>> {
    rows(py, points.iter().flatten().copied().collect(), 3)
}

/// Returns lists of numbers of equal length as an array.
pub(crate) fn indices<'py, const N: usize>(py: Python<'py>, lists: &[[usize; N]]) -> PyResult<Array2<'py, i64>> {
    rows(py, lists.iter().flatten().map(|number| *number as i64).collect(), N)
}
