//! The displacement of a mode: the null vector of the rigidity matrix at a root of its determinant.

use super::rigidity::power;
use super::{BlochError, Rigidity};
use crate::math::Vec3;
use crate::numerics::dense::{Svd, full_svd};
use nalgebra::Complex;

/// A mode at Bloch factors.
#[derive(Clone, Debug, PartialEq)]
pub struct ModeShape {
    /// Factors from a cell to the next.
    pub z: [Complex<f64>; 2],
    /// Displacements of the vertices of cell (0, 0), `(u_0x, u_0y, u_0z, u_1x, ..)`, of norm 1; the largest is real.
    pub displacement: Vec<Complex<f64>>,
    /// Stretch of the bars over the largest stretch of any displacement of this norm.
    pub residual: f64,
}

impl ModeShape {
    /// The displacement that stretches the bars least at these factors.
    ///
    /// # Errors
    /// [`BlochError`] where the matrix is not square.
    pub fn new(rigidity: &Rigidity, z: [Complex<f64>; 2]) -> Result<Self, BlochError> {
        rigidity.require_square()?;
        let Svd { singular_values, v, .. } = full_svd(&rigidity.at(z))?;
        let last = singular_values.len() - 1;
        let null = v.column(last);
        let largest = null.iter().max_by(|a, b| a.norm().total_cmp(&b.norm())).copied().unwrap_or(Complex::ONE);
        let turned = largest.conj() / largest.norm();
        let displacement = null.iter().map(|u| u * turned).collect();
        Ok(Self { z, displacement, residual: singular_values[last] / singular_values[0] })
    }

    /// Real displacements of vertices of cells, the largest of them of length 1.
    pub(crate) fn at(&self, places: &[(usize, [i32; 2])]) -> Vec<Vec3> {
        let moved = places.iter().map(|&(vertex, cell)| {
            let factor = power(self.z, cell);
            Vec3::from_fn(|k, _| (self.displacement[3 * vertex + k] * factor).re)
        });
        let moved: Vec<Vec3> = moved.collect();
        let largest = moved.iter().map(Vec3::norm).fold(f64::MIN_POSITIVE, f64::max);
        moved.into_iter().map(|u| u / largest).collect()
    }
}
