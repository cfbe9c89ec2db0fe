//! The closure conditions as equations of a solver, with the fold angles of the folding edges as unknowns.

use super::Closure;
use crate::numerics::DenseMatrix;
use crate::solver::Implicit;
use crate::solver::continuation::Curve;

/// A further equation on fold angles, such as one of the conditions on a [tube](super::tube).
pub trait AngleCondition {
    /// Returns the value that vanishes where the condition holds, at the fold angles of all edges in radians, and writes
    /// its derivatives with respect to all of them.
    fn linearize(&self, angles: &[f64], rates: &mut [f64]) -> f64;
}

/// The equations `residual(angles) = 0`. The unknowns are the angles of the folding edges; all other angles are fixed.
pub struct Closing<'a> {
    closure: &'a Closure,
    angles: Vec<f64>,
    kept: Option<Kept<'a>>,
}

/// The condition that is kept beside closure, and storage for the two Jacobians.
struct Kept<'a> {
    condition: &'a dyn AngleCondition,
    closure: DenseMatrix,
    rates: Vec<f64>,
}

impl<'a> Closing<'a> {
    /// Makes the equations; `angles` holds the fold angle of every edge in radians, also those that stay fixed.
    pub fn new(closure: &'a Closure, angles: Vec<f64>) -> Self {
        Self { closure, angles, kept: None }
    }

    /// Returns the equations followed by that of a condition.
    pub fn keeping(self, condition: &'a dyn AngleCondition) -> Self {
        let closure = DenseMatrix::zeros(3 * self.closure.vertices().len(), self.closure.folding_edges().len());
        let kept = Some(Kept { condition, closure, rates: vec![0.0; self.angles.len()] });
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
}

impl Implicit for Closing<'_> {
    fn unknowns(&self) -> usize {
        self.closure.folding_edges().len()
    }

    fn equations(&self) -> usize {
        3 * self.closure.vertices().len() + usize::from(self.kept.is_some())
    }

    fn linearize(&mut self, x: &[f64], residual: &mut [f64], jacobian: &mut DenseMatrix) {
        let folding = self.closure.folding_edges();
        folding.iter().zip(x).for_each(|(&edge, &angle)| self.angles[edge] = angle);
        let Some(kept) = &mut self.kept else { return self.closure.linearize_into(&self.angles, residual, jacobian) };
        let row = kept.closure.nrows();
        self.closure.linearize_into(&self.angles, &mut residual[..row], &mut kept.closure);
        jacobian.rows_mut(0, row).copy_from(&kept.closure);
        residual[row] = kept.condition.linearize(&self.angles, &mut kept.rates);
        folding.iter().enumerate().for_each(|(column, &edge)| jacobian[(row, column)] = kept.rates[edge]);
    }
}

/// A one-parameter family of solutions, followed without indicators, if folding has one degree of freedom.
impl Curve for Closing<'_> {}
