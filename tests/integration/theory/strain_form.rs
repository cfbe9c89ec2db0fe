//! The directions in which zero lines leave `q = 0`, from the three linear folding modes only.
//!
//! A long wave bends the sheet by curvature tensors along `k k^T`, where `k` is its wave vector in the plane. A uniform
//! mode of curvature `K` has the lattice strain `eps(K)`. Strains that vary only along `k` are those of an in-plane
//! displacement if they do not stretch the direction perpendicular to `k`: the wave has no energy if `k' . eps(k k^T) .
//! k' = 0`, where `k'` is `k` rotated by a right angle. This quartic is the leading form of the determinant at `q = 0`
//! up to a constant. It is symmetric: `cof(K') : eps(K) = cof(K) : eps(K')` for any two modes.

use super::Predicted;
use foldwell::kinematics::metric::LatticeFrame;
use foldwell::kinematics::{Displacement, Embedding, folding_modes};
use foldwell::math::Vec3;
use foldwell::sheet::{Corner, Sheet};
use nalgebra::Matrix3;

/// Strains of the linear folding modes of a spatially periodic sheet.
#[derive(Clone, Debug)]
pub struct StrainForm {
    /// Strains `[strain11, strain22, strain12]` of the modes whose curvatures `[k11, k22, k12]` are the unit vectors,
    /// as columns; their unit is 1/curvature.
    pub strains: Matrix3<f64>,
    /// The frame of the drawn lattice.
    pub frame: LatticeFrame,
}

impl StrainForm {
    /// Computes the form from the modes of the drawn state. Fails if there are not three modes, or if they are not
    /// determined by their curvatures.
    pub fn new(sheet: &Sheet) -> Predicted<Self> {
        let lattice = sheet.lattice.ok_or("no lattice")?;
        let (modes, embedding, frame) = (folding_modes(sheet)?, Embedding::new(sheet)?, LatticeFrame::new(&lattice));
        let strain = |mode: usize| -> Predicted<Vec3> {
            let mut curvature = [0.0; 3];
            curvature[mode] = 1.0;
            let moving = Displacement::new(&embedding, embedding.drawn_angles(), &modes.named(curvature)?);
            let velocity = |shift: [i32; 2]| moving.corner(Corner { vertex: 0, shift }).1;
            let rates = [[1, 0], [0, 1]].map(|shift| velocity(shift) - velocity([0, 0]));
            Ok(Vec3::from(frame.strain_rate(&lattice, &rates)))
        };
        Ok(Self { strains: Matrix3::from_columns(&[strain(0)?, strain(1)?, strain(2)?]), frame })
    }

    /// Returns `cof(other) : eps(curvature)`, both tensors as `[k11, k22, k12]`.
    pub fn pairing(&self, curvature: [f64; 3], other: [f64; 3]) -> f64 {
        let strain = self.strains * Vec3::from(curvature);
        other[1] * strain[0] + other[0] * strain[1] - 2.0 * other[2] * strain[2]
    }

    /// Returns the quartic: the coefficients of `q1^(4 - k) q2^k`, with wavenumbers in radians per cell.
    pub fn quartic(&self) -> [f64; 5] {
        // the components of the wave vector a^-T q, as polynomials of degree 1 in q
        let inverse = self.frame.inverse;
        let [x, y] = [0, 1].map(|i| [inverse[(0, i)], inverse[(1, i)]]);
        let tensor = [product(&x, &x), product(&y, &y), product(&x, &y)];
        let mut quartic = [0.0; 5];
        for (row, (cofactor, weight)) in [(1, 1.0), (0, 1.0), (2, -2.0)].into_iter().enumerate() {
            for column in 0..3 {
                let part = product(&tensor[cofactor], &tensor[column]);
                let factor = weight * self.strains[(row, column)];
                quartic.iter_mut().zip(part).for_each(|(sum, c)| *sum += factor * c);
            }
        }
        quartic
    }
}

/// Returns the product of two polynomials.
fn product(a: &[f64], b: &[f64]) -> Vec<f64> {
    let mut found = vec![0.0; a.len() + b.len() - 1];
    for (i, x) in a.iter().enumerate() {
        b.iter().enumerate().for_each(|(j, y)| found[i + j] += x * y);
    }
    found
}
