//! Numbers of zero modes and self stresses at a real wavenumber.
//!
//! Zero modes at `q` are null vectors of `R(z)`, self stresses at `q` those of the equilibrium matrix `R(1/z)^T`. So at
//! every `q` there are as many zero modes as self stresses at `-q` where bars and coordinates balance (C. L. Kane, T.
//! C. Lubensky, Nature Physics 10, 39 (2014); McInerney and others, PNAS 117, 30252 (2020), equation 16).

use super::rigidity::TERM;
use super::{BlochError, Rigidity};
use crate::numerics::complex::ComplexMatrix;
use crate::numerics::dense::full_svd;
use nalgebra::Complex;

/// Singular values below this part of the largest, or of the terms of the matrix, are zero.
const ZERO: f64 = 1e-11;

/// The numbers at one wavenumber.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ZeroModeCounts {
    /// The wavenumbers, radians per cell.
    pub q: [f64; 2],
    /// Zero modes.
    pub zero_modes: usize,
    /// Self stresses.
    pub self_stresses: usize,
    /// Self stresses at the opposite wavenumber.
    pub self_stresses_opposite: usize,
    /// Smallest singular value that is not zero over the largest that is, of the two matrices at `q` the less clear;
    /// the latter never taken below rounding.
    pub gap: f64,
}

impl ZeroModeCounts {
    /// The numbers at a wavenumber.
    ///
    /// ```
    /// use foldwell::analysis::bloch::{Rigidity, ZeroModeCounts};
    /// use foldwell::sheet::generate::{Pattern, Random, generate};
    ///
    /// let sheet = generate(&Pattern::Random(Random::default()))?;
    /// let found = ZeroModeCounts::at(&Rigidity::of_sheet(&sheet, false)?, [0.0, 0.0])?;
    /// assert_eq!((found.zero_modes, found.self_stresses), (3, 3));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`BlochError`] where the matrix is not square or a decomposition fails.
    pub fn at(rigidity: &Rigidity, q: [f64; 2]) -> Result<Self, BlochError> {
        rigidity.require_square()?;
        let z = q.map(|q| Complex::from_polar(1.0, q));
        let (zero_modes, one) = nullity(&rigidity.at(z))?;
        let (self_stresses, two) = nullity(&rigidity.equilibrium(z))?;
        let (self_stresses_opposite, _) = nullity(&rigidity.equilibrium(z.map(|z| z.inv())))?;
        Ok(Self { q, zero_modes, self_stresses, self_stresses_opposite, gap: one.min(two) })
    }
}

/// The number of null vectors of a square matrix, and how clearly they stand out.
fn nullity(matrix: &ComplexMatrix) -> Result<(usize, f64), BlochError> {
    let values = full_svd(matrix)?.singular_values;
    let (rank, gap) = rank_and_gap(&values);
    Ok((values.len() - rank, gap))
}

/// The number of singular values that are not zero, and the last of them over the next one.
pub(super) fn rank_and_gap(values: &[f64]) -> (usize, f64) {
    let largest = values.first().copied().unwrap_or(0.0).max(TERM);
    let rank = values.iter().filter(|value| **value > ZERO * largest).count();
    let kept = rank.checked_sub(1).map_or(TERM, |last| values[last]);
    let dropped = values.get(rank).copied().unwrap_or(0.0).max(f64::EPSILON * largest);
    (rank, kept / dropped)
}
