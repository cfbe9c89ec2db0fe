//! Curves and surfaces given by equations `F(x) = 0`: from a predicted point onto them, and the tangents there.
//!
//! Newton's method across a frame `T` of orthonormal columns, roughly the tangents at the predicted point `p`: every
//! correction is the least-squares solution of `J d = -F`, `T^T d = 0`, from the normal equations `(J^T J + T T^T) d =
//! -J^T F`. They lose digits of `d`, not of the point, since `F` is evaluated anew; and redundant rows of `J` do no
//! harm. The tangents solve `(J^T J + T T^T) U = T`, once refined, and are then made orthonormal. On a curve that is a
//! multiple one as a whole `J` has more null vectors: there a small multiple of the unit matrix is added, and nothing
//! moves along them.

use foldwell_numerics::dense::small::{CholeskyFactor, cholesky};
use foldwell_numerics::{DenseMatrix, vector};
use nalgebra::DVector;

/// Largest number of corrections.
const MOST_CORRECTIONS: usize = 6;
/// Pivot of the normal equations, over their largest diagonal entry, up to which it is rounding errors of zero.
const ZERO_PIVOT: f64 = 1e-13;
/// The multiple of the unit matrix, over that entry: rounding errors divided by it turn no tangent.
const UNMOVED: f64 = 1e-6;

/// Equations `F(x) = 0`, some of which may be redundant.
pub trait Implicit {
    /// Number of unknowns.
    fn unknowns(&self) -> usize;
    /// Number of equations, redundant ones included.
    fn equations(&self) -> usize;
    /// Fills in `F(x)` and its Jacobian, equations by unknowns.
    fn linearize(&mut self, x: &[f64], residual: &mut [f64], jacobian: &mut DenseMatrix);
}

/// Workspace of the corrections.
pub(super) struct Corrector {
    residual: DVector<f64>,
    jacobian: DenseMatrix,
}

/// The result of correcting a predicted point.
#[derive(Clone, Copy, Debug)]
pub(super) struct CorrectedPoint {
    /// Largest component of `F` at the corrected point.
    pub residual: f64,
    /// Number of corrections made.
    pub corrections: usize,
    /// Distance of the corrected point from the predicted one.
    pub distance: f64,
}

impl Corrector {
    /// Makes room for equations of this size.
    pub(crate) fn new(equations: &impl Implicit) -> Self {
        let (rows, unknowns) = (equations.equations(), equations.unknowns());
        Self { residual: DVector::zeros(rows), jacobian: DenseMatrix::zeros(rows, unknowns) }
    }

    /// Moves `x` across `frame` (tangents one behind the other) onto the solutions, until the largest residual is at
    /// most `tolerance`, and makes the frame the tangents there, on the same side; `None` where that does not converge.
    pub(crate) fn correct(
        &mut self,
        equations: &mut impl Implicit,
        x: &mut [f64],
        frame: &mut [f64],
        tolerance: f64,
    ) -> Option<CorrectedPoint> {
        let across = columns(frame, x.len());
        let predicted = x.to_vec();
        let mut last = f64::INFINITY;
        for corrections in 0..=MOST_CORRECTIONS {
            equations.linearize(x, self.residual.as_mut_slice(), &mut self.jacobian);
            let residual = self.residual.amax();
            if residual <= tolerance {
                frame.copy_from_slice(self.tangents(&across)?.as_slice());
                let distance = vector::distance(x, &predicted);
                return Some(CorrectedPoint { residual, corrections, distance });
            }
            if !(residual < last) {
                return None;
            }
            last = residual;
            let mut step = self.jacobian.tr_mul(&self.residual);
            self.normal(&across)?.solve_mut(&mut step);
            x.iter_mut().zip(step.iter()).for_each(|(x, d)| *x -= d);
        }
        None
    }

    /// The largest component of `F` at `x`.
    pub(crate) fn residual(&mut self, equations: &mut impl Implicit, x: &[f64]) -> f64 {
        equations.linearize(x, self.residual.as_mut_slice(), &mut self.jacobian);
        self.residual.amax()
    }

    /// Turns a frame into the tangents at `x`, which is near the solutions but need not be one; `None` where that
    /// fails.
    pub fn turn(&mut self, equations: &mut impl Implicit, x: &[f64], frame: &mut [f64]) -> Option<()> {
        equations.linearize(x, self.residual.as_mut_slice(), &mut self.jacobian);
        let tangents = self.tangents(&columns(frame, x.len()))?;
        frame.copy_from_slice(tangents.as_slice());
        Some(())
    }

    fn normal(&self, across: &DenseMatrix) -> Option<CholeskyFactor> {
        let mut normal = self.jacobian.tr_mul(&self.jacobian);
        across.column_iter().for_each(|tangent| normal.ger(1.0, &tangent, &tangent, 1.0));
        let largest = normal.diagonal().amax();
        let is_regular =
            |found: &CholeskyFactor| found.l_dirty().diagonal().iter().all(|root| root * root > ZERO_PIVOT * largest);
        cholesky(normal.clone()).filter(is_regular).or_else(|| {
            (0..normal.nrows()).for_each(|k| normal[(k, k)] += UNMOVED * largest);
            cholesky(normal)
        })
    }

    /// Orthonormal null vectors of the Jacobian along the frame.
    fn tangents(&self, across: &DenseMatrix) -> Option<DenseMatrix> {
        let normal = self.normal(across)?;
        let mut tangents = normal.solve(across);
        let mut left = self.jacobian.tr_mul(&(&self.jacobian * &tangents));
        normal.solve_mut(&mut left);
        tangents -= left;
        for k in 0..tangents.ncols() {
            for before in 0..k {
                let part = tangents.column(before).dot(&tangents.column(k));
                let other = tangents.column(before).into_owned();
                tangents.column_mut(k).axpy(-part, &other, 1.0);
            }
            let length = tangents.column(k).norm();
            if !(length.is_finite() && length > 0.0) {
                return None;
            }
            tangents.column_mut(k).unscale_mut(length);
        }
        Some(tangents)
    }
}

fn columns(frame: &[f64], unknowns: usize) -> DenseMatrix {
    DenseMatrix::from_column_slice(unknowns, frame.len() / unknowns, frame)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The unit sphere in four dimensions cut by a hyperplane: a sphere, with a redundant equation.
    struct CutSphere;

    impl Implicit for CutSphere {
        fn unknowns(&self) -> usize {
            4
        }

        fn equations(&self) -> usize {
            3
        }

        fn linearize(&mut self, x: &[f64], residual: &mut [f64], jacobian: &mut DenseMatrix) {
            residual[0] = x.iter().map(|x| x * x).sum::<f64>() - 1.0;
            residual[1] = x[0] + x[1] - x[2] - x[3];
            residual[2] = residual[0] * 0.5 + residual[1];
            for (column, (x, sign)) in x.iter().zip([1.0, 1.0, -1.0, -1.0]).enumerate() {
                jacobian[(0, column)] = 2.0 * x;
                jacobian[(1, column)] = sign;
                jacobian[(2, column)] = x + sign;
            }
        }
    }

    /// Claim: a point near a sphere is moved onto it across the frame, quadratically, and the tangents there are
    /// orthonormal, in the surface and near the old ones. Tolerances: rounding.
    #[test]
    fn a_point_is_corrected_across_its_frame() {
        let guess = [0.52, 0.49, 0.51, 0.5];
        let frame = [[0.5, -0.5, 0.5, -0.5], [-0.5, 0.5, 0.5, -0.5]].concat();
        let (mut x, mut tangents) = (guess, frame.clone());
        let done = Corrector::new(&CutSphere).correct(&mut CutSphere, &mut x, &mut tangents, 1e-15).unwrap();
        assert!(done.corrections <= 4 && done.residual <= 1e-15, "{done:?}");
        let (before, after) = (columns(&frame, 4), columns(&tangents, 4));
        let moved = DVector::from_fn(4, |k, _| x[k] - guess[k]);
        assert!((moved.norm() - done.distance).abs() <= 1e-15 && before.tr_mul(&moved).amax() <= 1e-15);
        assert!((after.tr_mul(&after) - DenseMatrix::identity(2, 2)).amax() <= 1e-15);
        let normals = DenseMatrix::from_columns(&[x.to_vec().into(), vec![1.0, 1.0, -1.0, -1.0].into()]);
        assert!(normals.tr_mul(&after).amax() <= 1e-15);
        assert!((before.tr_mul(&after) - DenseMatrix::identity(2, 2)).amax() <= 1e-3);
    }

    /// Claim: where the equations have no solution near by, and where they are not numbers, there is none.
    #[test]
    fn what_has_no_solution_is_refused() {
        let mut frame = [[0.5, -0.5, 0.5, -0.5], [-0.5, 0.5, 0.5, -0.5]].concat();
        let mut corrector = Corrector::new(&CutSphere);
        for mut x in [[2.0, -2.0, 2.0, -2.0], [f64::NAN; 4]] {
            assert!(corrector.correct(&mut CutSphere, &mut x, &mut frame, 1e-15).is_none());
        }
    }
}
