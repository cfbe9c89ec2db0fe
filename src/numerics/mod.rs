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
pub mod vector;

#[cfg(test)]
mod tests;

pub use vector::{larger, worst};

/// The dense matrix that modules hand to each other.
pub type DenseMatrix = nalgebra::DMatrix<f64>;
