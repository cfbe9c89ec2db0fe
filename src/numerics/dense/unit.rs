//! The unit in which matrices are handed to faer's eigensolvers.

/// Returns the largest power of two that is at most this magnitude, by which a matrix is divided without rounding; 1 for zero.
///
/// faer's divide and conquer of symmetric matrices compares with numbers that do not belong to the matrix: where entries
/// are near 1 its eigenvalues are good to rounding, where they are near 1e11 only to 1e-9 of the largest.
pub(in crate::numerics) fn binary_unit(magnitudes: impl Iterator<Item = f64>) -> f64 {
    let largest = magnitudes.fold(0.0, f64::max);
    // powers of two between these, and their inverses, are normal numbers
    if largest > 0.0 { largest.log2().floor().clamp(-1000.0, 1000.0).exp2() } else { 1.0 }
}
