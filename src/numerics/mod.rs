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

/// The largest of some residuals or errors: `None` where there is none of them, since nothing was then measured, and not a number
/// where one of them is none.
pub fn worst(values: impl IntoIterator<Item = f64>) -> Option<f64> {
    values.into_iter().reduce(larger)
}

/// The larger of two numbers, or not a number where one of them is none.
pub fn larger(a: f64, b: f64) -> f64 {
    if a.is_nan() || a > b { a } else { b }
}

/// Largest magnitude of these numbers, 0 of none; a NaN is passed over.
pub fn largest(values: &[f64]) -> f64 {
    values.iter().map(|value| value.abs()).fold(0.0, |most, size| if size > most { size } else { most })
}
