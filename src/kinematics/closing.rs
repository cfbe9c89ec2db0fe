//! The closure conditions as equations of a solver, with the fold angles of the folding edges as unknowns.

use super::{Closure, Displacement, Embedding};
use crate::math::rotation;
use crate::numerics::DenseMatrix;
use crate::solver::Implicit;
use crate::solver::continuation::Curve;
use nalgebra::DMatrixViewMut;

/// The equations `residual(angles) = 0`. The unknowns are the angles of the folding edges; all other angles are fixed.
pub struct Closing<'a> {
    closure: &'a Closure,
    angles: Vec<f64>,
    /// Where lattice rotations have to vanish, what places the cell.
    periodic: Option<&'a Embedding>,
}

/// Components of the rotation vectors of both lattice motions.
const LATTICE_ROTATIONS: usize = 6;

impl<'a> Closing<'a> {
    /// Makes the equations; `angles` holds the fold angle of every edge in radians, also those that stay fixed.
    pub fn new(closure: &'a Closure, angles: Vec<f64>) -> Self {
        Self { closure, angles, periodic: None }
    }

    /// Adds the conditions that the rotations of both lattice motions vanish: what is left are spatially periodic states. Where these are
    /// a curve, closure alone has three null vectors on it, and these conditions leave the one along the curve.
    pub(crate) fn spatially_periodic(self, embedding: &'a Embedding) -> Self {
        Self { periodic: Some(embedding), ..self }
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
        3 * self.closure.vertices().len() + self.periodic.map_or(0, |_| LATTICE_ROTATIONS)
    }

    fn linearize(&mut self, x: &[f64], residual: &mut [f64], jacobian: &mut DenseMatrix) {
        self.closure.folding_edges().iter().zip(x).for_each(|(&edge, &angle)| self.angles[edge] = angle);
        let Some(embedding) = self.periodic else {
            return self.closure.linearize_into(&self.angles, residual, jacobian);
        };
        let rows = residual.len() - LATTICE_ROTATIONS;
        let mut of_closure = DenseMatrix::zeros(rows, x.len());
        self.closure.linearize_into(&self.angles, &mut residual[..rows], &mut of_closure);
        jacobian.rows_mut(0, rows).copy_from(&of_closure);
        self.lattice_rotations(embedding, &mut residual[rows..], &mut jacobian.rows_mut(rows, LATTICE_ROTATIONS));
    }
}

impl Closing<'_> {
    /// The rotation vectors of both lattice motions and their rates, right to first order in those vectors.
    fn lattice_rotations(&self, embedding: &Embedding, vectors: &mut [f64], rates: &mut DMatrixViewMut<'_, f64>) {
        let mut moving = vec![0.0; self.angles.len()];
        for (column, &edge) in self.closure.folding_edges().iter().enumerate() {
            moving[edge] = 1.0;
            let lattice = Displacement::new(embedding, &self.angles, &moving).lattice;
            moving[edge] = 0.0;
            for (k, one) in lattice.iter().flatten().enumerate() {
                vectors[3 * k..3 * k + 3].copy_from_slice(rotation::log(&one.motion.rotation).as_slice());
                rates.view_mut((3 * k, column), (3, 1)).copy_from(&one.twist.angular);
            }
        }
    }
}

/// A one-parameter family of solutions, followed without indicators, if folding has one degree of freedom.
impl Curve for Closing<'_> {}
