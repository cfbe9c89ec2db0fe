//! Tests of every derivative of the model, entry by entry, against extrapolated central differences.

mod domains;
mod measures;
mod parts;
mod terms;
mod whole;

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// Random numbers that are the same on every machine.
struct Numbers(ChaCha8Rng);

impl Numbers {
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

/// Returns the full symmetric matrix of a lower triangle that is stored row by row.
fn symmetric(size: usize, lower: &[f64]) -> crate::numerics::DenseMatrix {
    let entry = |i: usize, j: usize| lower[i.max(j) * (i.max(j) + 1) / 2 + i.min(j)];
    crate::numerics::DenseMatrix::from_fn(size, size, entry)
}
