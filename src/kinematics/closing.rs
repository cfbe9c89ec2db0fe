//! The closure conditions as equations of a solver, with the fold angles of the folding edges as unknowns.

use super::{Closure, Displacement, Embedding};
use crate::math::rotation;
use crate::numerics::DenseMatrix;
use crate::solver::Implicit;
use nalgebra::DVector;

/// Further equations on fold angles, such as one of the conditions on a [tube](super::tube).
pub trait AngleConditions {
    /// Number of the equations.
    fn count(&self) -> usize;
    /// Writes the values that vanish where the conditions hold, at the fold angles of all edges in radians, and their
    /// derivatives with respect to all of them: a row for each condition.
    fn linearize(&self, angles: &[f64], values: &mut [f64], rates: &mut DenseMatrix);
}

/// The conditions that the rotations of both lattice motions vanish: what closes is then spatially periodic. Where
/// these states are a curve, closure alone has three null vectors on it, and these conditions leave the one along the
/// curve.
pub(crate) struct SpatiallyPeriodic<'a>(pub &'a Embedding);

impl AngleConditions for SpatiallyPeriodic<'_> {
    fn count(&self) -> usize {
        6
    }

    /// The derivatives are right to first order in the rotation vectors.
    fn linearize(&self, angles: &[f64], values: &mut [f64], rates: &mut DenseMatrix) {
        Displacement::for_each_edge(self.0, angles, |edge, lattice| {
            for (k, one) in lattice.iter().flatten().enumerate() {
                values[3 * k..3 * k + 3].copy_from_slice(rotation::log(&one.motion.rotation).as_slice());
                rates.view_mut((3 * k, edge), (3, 1)).copy_from(&one.twist.angular);
            }
        });
    }
}

/// The equations `residual(angles) = 0`. The unknowns are the angles of the folding edges; all other angles are fixed.
pub struct Closing<'a> {
    closure: &'a Closure,
    angles: Vec<f64>,
    /// Conditions that are kept beside closure.
    kept: Option<&'a dyn AngleConditions>,
}

impl<'a> Closing<'a> {
    /// Makes the equations; `angles` holds the fold angle of every edge in radians, also those that stay fixed.
    pub fn new(closure: &'a Closure, angles: Vec<f64>) -> Self {
        Self { closure, angles, kept: None }
    }

    /// Returns the equations followed by those of conditions, if there are any.
    pub fn keeping(self, conditions: Option<&'a impl AngleConditions>) -> Self {
        let kept = conditions.map(|conditions| conditions as &dyn AngleConditions).or(self.kept);
        Self { kept, ..self }
    }

    /// Extracts the entries of the folding edges from a list with one number for every edge.
    pub fn folding(&self, all: &[f64]) -> Vec<f64> {
        self.closure.folding_edges().iter().map(|&edge| all[edge]).collect()
    }

    /// Returns the fold angles of all edges for given unknowns.
    pub(crate) fn angles(&self, x: &[f64]) -> Vec<f64> {
        self.spread(x, &self.angles)
    }

    /// Returns the rates of all edges for given rates of the folding ones; the others are zero.
    pub(crate) fn rates(&self, x: &[f64]) -> Vec<f64> {
        self.spread(x, &vec![0.0; self.angles.len()])
    }

    fn spread(&self, x: &[f64], others: &[f64]) -> Vec<f64> {
        let mut all = others.to_vec();
        self.closure.folding_edges().iter().zip(x).for_each(|(&edge, &number)| all[edge] = number);
        all
    }

    /// Returns the equations at the angles of the folding edges, and their Jacobian.
    pub(crate) fn linearized(&mut self, x: &[f64]) -> (DVector<f64>, DenseMatrix) {
        let mut residual = DVector::zeros(self.equations());
        let mut jacobian = DenseMatrix::zeros(residual.len(), x.len());
        self.linearize(x, residual.as_mut_slice(), &mut jacobian);
        (residual, jacobian)
    }
}

impl Implicit for Closing<'_> {
    fn unknowns(&self) -> usize {
        self.closure.folding_edges().len()
    }

    fn equations(&self) -> usize {
        self.closure.rows() + self.kept.map_or(0, AngleConditions::count)
    }

    fn linearize(&mut self, x: &[f64], residual: &mut [f64], jacobian: &mut DenseMatrix) {
        let folding = self.closure.folding_edges();
        folding.iter().zip(x).for_each(|(&edge, &angle)| self.angles[edge] = angle);
        let Some(kept) = self.kept else { return self.closure.linearize_into(&self.angles, residual, jacobian) };
        let (row, count) = (self.closure.rows(), kept.count());
        let mut closure = DenseMatrix::zeros(row, folding.len());
        self.closure.linearize_into(&self.angles, &mut residual[..row], &mut closure);
        jacobian.rows_mut(0, row).copy_from(&closure);
        let mut of_kept = DenseMatrix::zeros(count, self.angles.len());
        kept.linearize(&self.angles, &mut residual[row..], &mut of_kept);
        let mut rates = jacobian.rows_mut(row, count);
        folding.iter().enumerate().for_each(|(column, &edge)| rates.set_column(column, &of_kept.column(edge)));
    }
}
