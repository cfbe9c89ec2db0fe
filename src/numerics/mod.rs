//! Linear algebra on dense and sparse matrices, and the checks of hand-written derivatives.

pub mod dense;
pub mod derivatives;

/// The dense matrix that modules hand to each other.
pub type DenseMatrix = nalgebra::DMatrix<f64>;
