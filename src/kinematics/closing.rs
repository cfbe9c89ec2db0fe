//! The closure conditions as equations of a solver, in the fold angles of the folding edges.

use super::Closure;
use crate::numerics::DenseMatrix;
use crate::solver::Implicit;
use crate::solver::continuation::Curve;

/// `residual(angles) = 0`; the unknowns are the angles of the folding edges, the others stay as they are given.
pub struct Closing<'a> {
    closure: &'a Closure,
    angles: Vec<f64>,
}

impl<'a> Closing<'a> {
    /// `angles` holds the fold angle of every edge; edges that do not fold keep theirs.
    pub fn new(closure: &'a Closure, angles: Vec<f64>) -> Self {
        Self { closure, angles }
    }

    /// The entries of the folding edges.
    pub fn folding(&self, all: &[f64]) -> Vec<f64> {
        self.closure.folding_edges().iter().map(|&edge| all[edge]).collect()
    }

    /// The fold angles of all edges.
    pub(crate) fn angles(&self, x: &[f64]) -> Vec<f64> {
        self.spread(x, &self.angles)
    }

    /// Rates of all edges from those of the folding ones.
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

/// Where folding has one degree of freedom, a trajectory on which nothing is watched.
impl Curve for Closing<'_> {}
