//! The unit in which matrices are handed to faer's eigensolvers, and the rounding errors of eigenvalues.

/// Bound on the error of an eigenvalue, in units of the machine epsilon times the square root of the number of unknowns
/// times the largest diagonal entry of the matrix. Zeros are found with at most a tenth of it
/// (`tests/integration/analysis/vibrations.rs`).
const ROUNDING_ERRORS: f64 = 4.0;

/// Returns the largest power of two that is at most this magnitude, by which a matrix is divided without rounding; 1
/// for zero.
///
/// faer's divide and conquer of symmetric matrices compares with numbers that do not belong to the matrix: where
/// entries are near 1 its eigenvalues are good to rounding, where they are near 1e11 only to 1e-9 of the largest.
pub(crate) fn binary_unit(magnitudes: impl Iterator<Item = f64>) -> f64 {
    let largest = magnitudes.fold(0.0, f64::max);
    // powers of two between these, and their inverses, are normal numbers
    if largest > 0.0 { largest.log2().floor().clamp(-1000.0, 1000.0).exp2() } else { 1.0 }
}

/// Returns the bound below which an eigenvalue of a symmetric or Hermitian matrix of this size and largest diagonal
/// entry is zero up to rounding.
pub fn eigenvalue_rounding(size: usize, diagonal: f64) -> f64 {
    ROUNDING_ERRORS * (size as f64).sqrt() * f64::EPSILON * diagonal
}
