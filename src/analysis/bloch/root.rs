//! Roots of the determinant in one Bloch factor.

use nalgebra::Complex;

/// Roots nearer to the circle than this are on it, and those nearer than so many times their rounding error.
const ON_CIRCLE: f64 = 1e-9;

const ROUNDINGS: f64 = 100.0;

/// A root of the determinant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Root {
    /// Factor from a cell to the next.
    pub z: Complex<f64>,
    /// Change of `log z` per change of the determinant's coefficients by so much of the largest; of a root corrected on
    /// the matrix, per relative change of its entries.
    pub condition: f64,
    /// How many roots coincide here: more than one where the matrix has as many null vectors, or fewer while the
    /// derivatives of the determinant vanish up to rounding; each is listed.
    pub multiplicity: usize,
}

impl Root {
    /// `log|z|`, per cell.
    pub fn kappa(&self) -> f64 {
        self.z.norm().ln()
    }

    /// Real part of the wavenumber, in `(-pi, pi]`.
    pub(crate) fn wavenumber(&self) -> f64 {
        self.z.arg()
    }

    /// How well `log z` is known.
    pub(super) fn rounding(&self) -> f64 {
        ROUNDINGS * f64::EPSILON * self.condition
    }

    /// Whether the mode neither grows nor decays, as far as its condition tells.
    pub fn on_circle(&self) -> bool {
        self.kappa().abs() <= ON_CIRCLE.max(self.rounding())
    }
}
