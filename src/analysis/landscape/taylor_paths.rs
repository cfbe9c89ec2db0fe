//! Where a sheet goes along any of its modes, from what it does along a few.
//!
//! What goes with the power `d` of the amplitude is a form of degree `d` in the amplitudes of the modes. Forms of
//! degree three are known from their values at `(i, j, k, ...)`, whole numbers of sum three (a unisolvent set), and
//! those of lower degree too.

use super::expansion::drawn;
use super::taylor_path::ORDERS;
use super::{Expansion, HeldSheet, LandscapeError, TaylorPath};
use crate::numerics::DenseMatrix;
use crate::numerics::dense::least_squares;
use nalgebra::DVector;

/// Taylor paths along all modes of a sheet.
#[derive(Clone, Debug)]
pub struct TaylorPaths {
    /// Taylor paths along some modes.
    known: Vec<TaylorPath>,
    /// For every power, the weights of these courses by monomial, a column for each.
    weights: [DenseMatrix; ORDERS],
}

impl TaylorPaths {
    /// Of a sheet from the drawn state, by `n (n + 1) (n + 2) / 6` courses for `n` modes.
    ///
    /// # Errors
    /// [`LandscapeError`] where the modes of the sheet are not known, or its linear algebra fails.
    pub fn new(held: &HeldSheet) -> Result<Self, LandscapeError> {
        let places: Vec<DVector<f64>> = exponents(held.basis.ncols(), ORDERS)
            .into_iter()
            .map(|place| DVector::from_iterator(place.len(), place.into_iter().map(|i| i as f64 / ORDERS as f64)))
            .collect();
        let mut settling = drawn(held)?;
        let course = |place: &DVector<f64>| Ok(Expansion::at(held, &mut settling, (&held.basis * place).as_slice())?.1);
        let known = places.iter().map(course).collect::<Result<_, LandscapeError>>()?;
        let of_degree = |degree: usize| -> Result<DenseMatrix, LandscapeError> {
            let values: Vec<DVector<f64>> = places.iter().map(|place| monomials(place, degree)).collect();
            let values = DenseMatrix::from_columns(&values);
            Ok(least_squares(&values, &DenseMatrix::identity(values.nrows(), values.nrows()))?.solution)
        };
        Ok(Self { known, weights: [of_degree(1)?, of_degree(2)?, of_degree(3)?] })
    }

    /// Where the sheet goes along the mode with these rates.
    pub fn along(&self, held: &HeldSheet, rates: &[f64]) -> TaylorPath {
        let amplitudes = held.amplitudes(rates);
        let order = |number: usize| {
            let mut sum = held.still();
            let weights = &self.weights[number] * monomials(&amplitudes, number + 1);
            weights.iter().zip(&self.known).for_each(|(weight, course)| sum.add(*weight, &course.orders[number]));
            sum
        };
        TaylorPath { rates: rates.to_vec(), orders: [order(0), order(1), order(2)] }
    }
}

/// Exponents of the monomials of a degree in `count` variables.
fn exponents(count: usize, degree: usize) -> Vec<Vec<usize>> {
    match count {
        0 => Vec::new(),
        1 => vec![vec![degree]],
        _ => (0..=degree)
            .flat_map(|first| {
                exponents(count - 1, degree - first).into_iter().map(move |rest| [vec![first], rest].concat())
            })
            .collect(),
    }
}

/// All monomials of a degree.
fn monomials(at: &DVector<f64>, degree: usize) -> DVector<f64> {
    let of = |powers: Vec<usize>| at.iter().zip(powers).map(|(value, power)| value.powi(power as i32)).product();
    let all: Vec<f64> = exponents(at.len(), degree).into_iter().map(of).collect();
    DVector::from_vec(all)
}
