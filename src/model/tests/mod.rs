//! Tests of every derivative of the model, entry by entry, against extrapolated central differences.

mod domains;
mod measures;
mod parts;
mod terms;
mod whole;

use super::measure::Measure;
use crate::math::Vec3;
use crate::numerics::DenseMatrix;
use crate::numerics::derivatives::{TOLERANCE, check_gradient, check_jacobian};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// Random numbers that are the same on every machine.
struct RandomNumbers(ChaCha8Rng);

impl RandomNumbers {
    fn new(seed: u64) -> Self {
        Self(ChaCha8Rng::seed_from_u64(seed))
    }

    /// Returns a random number between `-size` and `size`.
    fn within(&mut self, size: f64) -> f64 {
        size * (2.0 * self.0.random::<f64>() - 1.0)
    }

    fn many(&mut self, count: usize, size: f64) -> Vec<f64> {
        (0..count).map(|_| self.within(size)).collect()
    }
}

/// Checks gradient and Hessian of a measure at some points against extrapolated differences.
pub(super) fn check_derivatives<M: Measure<N, D>, const N: usize, const D: usize>(measure: &M, points: &[Vec3; N]) {
    let at = |x: &[f64]| std::array::from_fn(|k| Vec3::from_column_slice(&x[3 * k..3 * k + 3]));
    let mut lower = vec![f64::NAN; 3];
    let x: Vec<f64> = points.iter().flat_map(|point| point.iter().copied()).collect();
    let (value, gradient) = measure.hessian(points, &mut lower);
    assert_eq!((value, gradient), measure.gradient(points));
    assert_eq!(value, measure.value(points));
    check_gradient(|x| measure.value(&at(x)), &x, gradient.as_slice(), TOLERANCE).unwrap();
    check_jacobian(|x| measure.gradient(&at(x)).1.as_slice().to_vec(), &x, &symmetric(D, &lower), TOLERANCE).unwrap();
}

/// Returns the full symmetric matrix of a lower triangle that is stored row by row.
fn symmetric(size: usize, lower: &[f64]) -> DenseMatrix {
    let entry = |i: usize, j: usize| lower[i.max(j) * (i.max(j) + 1) / 2 + i.min(j)];
    DenseMatrix::from_fn(size, size, entry)
}
