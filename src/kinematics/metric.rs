//! The frame of the drawn lattice: x along the first lattice vector, y in the plane of the lattice towards the second.
//!
//! In this frame the lattice vectors are the columns of `a`, which is upper triangular with `a^T a = g`,
//! `g_ij = l_i . l_j`.

use crate::math::Vec3;
use nalgebra::Matrix2;

/// The frame of a drawn lattice.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LatticeFrame {
    /// The lattice vectors as columns, `a`.
    pub vectors: Matrix2<f64>,
    /// `a^-1`.
    pub inverse: Matrix2<f64>,
}

impl LatticeFrame {
    /// Returns the frame of two lattice vectors that are not parallel.
    pub fn new([l1, l2]: &[Vec3; 2]) -> Self {
        let along = l1.normalize();
        let vectors = Matrix2::new(l1.norm(), along.dot(l2), 0.0, along.cross(l2).norm());
        let [width, height] = [vectors.m11, vectors.m22];
        let inverse = Matrix2::new(1.0 / width, -vectors.m12 / (width * height), 0.0, 1.0 / height);
        Self { vectors, inverse }
    }

    /// Returns `[t11, t22, t12]` of the symmetric part of the tensor `a^-T m a^-1`; `m` has one entry for each pair of
    /// lattice vectors.
    pub fn tensor(&self, m: &Matrix2<f64>) -> [f64; 3] {
        let tensor = self.inverse.transpose() * m * self.inverse;
        [tensor.m11, tensor.m22, 0.5 * (tensor.m12 + tensor.m21)]
    }

    /// Returns the strain `[strain11, strain22, strain12]` of the `chords` relative to the drawn lattice,
    /// `a^-T g a^-1 - I` with the metric `g` of the chords, without the factor 1/2.
    pub(crate) fn strain(&self, chords: &[Vec3; 2]) -> [f64; 3] {
        let metric = Matrix2::from_fn(|i, j| chords[i].dot(&chords[j]));
        let [e11, e22, e12] = self.tensor(&metric);
        [e11 - 1.0, e22 - 1.0, e12]
    }

    /// Returns the rate of the strain for given rates of the chords.
    pub fn strain_rate(&self, chords: &[Vec3; 2], rates: &[Vec3; 2]) -> [f64; 3] {
        self.tensor(&Matrix2::from_fn(|i, j| rates[i].dot(&chords[j]) + chords[i].dot(&rates[j])))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LATTICE: [[f64; 3]; 2] = [[2.0, 0.0, 0.0], [0.6, 2.0, 0.0]];

    /// Claim: the drawn lattice has no strain. Stretched along the first lattice vector by 10 per cent, it has a strain
    /// of 21 per cent in `strain11` only; sheared along that vector by an angle of tangent 0.1, it has `strain12 = 0.1`
    /// and `strain22 = 0.01`. This holds for every orientation in space. Tolerance: rounding.
    #[test]
    fn strains_of_simple_changes() {
        let turn = crate::math::rotation::exp(&Vec3::new(0.3, -1.0, 0.2));
        let lattice = LATTICE.map(|l| turn * Vec3::from(l));
        let frame = LatticeFrame::new(&lattice);
        let [x, y] = [Vec3::x(), Vec3::y()].map(|unit| turn * unit);
        let strained = |change: &dyn Fn(Vec3) -> Vec3| frame.strain(&lattice.map(change));
        let close = |found: [f64; 3], expected: [f64; 3]| {
            assert!((Vec3::from(found) - Vec3::from(expected)).amax() <= 1e-15, "{found:?}");
        };
        close(strained(&|l| l), [0.0; 3]);
        close(strained(&|l| l + 0.1 * x * x.dot(&l)), [0.21, 0.0, 0.0]);
        close(strained(&|l| l + 0.1 * x * y.dot(&l)), [0.0, 0.01, 0.1]);
    }
}
