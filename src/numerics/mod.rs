//! Sparse and dense linear algebra, all solutions of quadrics, and the check of derivatives. The only module that names `faer`.

pub mod complex;
pub mod dense;
pub mod derivatives;
pub mod eigen;
pub mod factor;
pub mod fourier;
pub mod homotopy;
pub mod order;
pub mod parallel;
pub mod polynomial;
pub mod random;
pub mod rank;
pub mod sparse;
pub mod tearing;

#[cfg(test)]
mod tests;

/// The dense matrix that modules hand to each other.
pub type DenseMatrix = nalgebra::DMatrix<f64>;

/// Largest magnitude of these numbers, 0 of none; a NaN is passed over.
pub fn largest(values: &[f64]) -> f64 {
    values.iter().map(|value| value.abs()).fold(0.0, |most, size| if size > most { size } else { most })
}
