//! The closure conditions as equations of a solver, with the fold angles of the folding edges as unknowns.

use super::Closure;
use crate::numerics::DenseMatrix;
use crate::solver::Implicit;
use crate::solver::continuation::Curve;

/// The equations `residual(angles) = 0`. The unknowns are the angles of the folding edges; all other angles are fixed.
pub struct Closing<'a> {
    closure: &'a Closure,
    angles: Vec<f64>,
}

impl<'a> Closing<'a> {
    /// Makes the equations; `angles` holds the fold angle of every edge in radians, also those that stay fixed.
    pub fn new(closure: &'a Closure, angles: Vec<f64>) -> Self {
        Self { closure, angles }
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
        3 * self.closure.vertices().len()
    }

    fn linearize(&mut self, x: &[f64], residual: &mut [f64], jacobian: &mut DenseMatrix) {
        self.closure.folding_edges().iter().zip(x).for_each(|(&edge, &angle)| self.angles[edge] = angle);
        self.closure.linearize_into(&self.angles, residual, jacobian);
    }
}

/// A one-parameter family of solutions, followed without indicators, if folding has one degree of freedom.
impl Curve for Closing<'_> {}
