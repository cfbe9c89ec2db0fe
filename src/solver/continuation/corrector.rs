//! From a predicted point onto the curve, and the tangent there.
//!
//! Newton's method in the plane through the predicted point `p` across the predicted tangent `tau`: every correction is the
//! least-squares solution of `J d = -F`, `tau . d = 0`, from the normal equations `(J^T J + tau tau^T) d = -J^T F`. They lose
//! digits of `d`, not of the point, since `F` is evaluated anew; and redundant rows of `J` do no harm. The tangent solves
//! `(J^T J + tau tau^T) t = tau`, once refined.

use super::Curve;
use crate::numerics::DenseMatrix;
use nalgebra::{Cholesky, DVector, Dyn};

/// Corrections allowed.
const CORRECTIONS: usize = 6;

/// Workspace of the corrector.
pub struct Corrector {
    residual: DVector<f64>,
    jacobian: DenseMatrix,
}

/// What a correction found.
#[derive(Clone, Copy, Debug)]
pub struct Corrected {
    /// Largest component of `F`.
    pub residual: f64,
    /// Corrections made.
    pub corrections: usize,
    /// How far the point is from where it was predicted.
    pub distance: f64,
}

impl Corrector {
    /// For curves of this size.
    pub fn new(curve: &impl Curve) -> Self {
        let (equations, unknowns) = (curve.equations(), curve.unknowns());
        Self { residual: DVector::zeros(equations), jacobian: DenseMatrix::zeros(equations, unknowns) }
    }

    /// Moves `x` onto the curve and makes `tangent` the unit tangent there; `None` where that does not converge.
    pub fn correct(
        &mut self,
        curve: &mut impl Curve,
        x: &mut [f64],
        tangent: &mut [f64],
        tolerance: f64,
    ) -> Option<Corrected> {
        let direction = DVector::from_column_slice(tangent);
        let predicted = x.to_vec();
        let mut last = f64::INFINITY;
        for corrections in 0..=CORRECTIONS {
            curve.linearize(x, self.residual.as_mut_slice(), &mut self.jacobian);
            let residual = self.residual.amax();
            if residual <= tolerance {
                self.tangent(&direction)?.iter().zip(tangent).for_each(|(new, t)| *t = *new);
                let distance = x.iter().zip(&predicted).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt();
                return Some(Corrected { residual, corrections, distance });
            }
            if !(residual < last) {
                return None;
            }
            last = residual;
            let mut step = self.jacobian.tr_mul(&self.residual);
            self.normal(&direction)?.solve_mut(&mut step);
            x.iter_mut().zip(step.iter()).for_each(|(x, d)| *x -= d);
        }
        None
    }

    fn normal(&self, direction: &DVector<f64>) -> Option<Cholesky<f64, Dyn>> {
        let mut normal = self.jacobian.tr_mul(&self.jacobian);
        normal.ger(1.0, direction, direction, 1.0);
        Cholesky::new(normal)
    }

    /// The unit null vector of the Jacobian along `direction`.
    fn tangent(&self, direction: &DVector<f64>) -> Option<DVector<f64>> {
        let normal = self.normal(direction)?;
        let mut tangent = normal.solve(direction);
        let mut left = self.jacobian.tr_mul(&(&self.jacobian * &tangent));
        normal.solve_mut(&mut left);
        tangent -= left;
        let length = tangent.norm();
        (length.is_finite() && length > 0.0).then(|| tangent / length)
    }
}
