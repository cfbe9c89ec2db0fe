//! The second derivative of the closure at closed states.
//!
//! With `e_k` the direction of edge `k` in the frame of the first, changes `rho_k` of the fold angles of a closed state
//! change the product around a vertex to `exp(rho_1 e_1) exp(rho_2 e_2) ...`, whose rotation vector is to second order
//!
//! `sum_k rho_k e_k + 1/2 sum_{j<k} rho_j rho_k e_j x e_k`
//!
//! (formula of Baker, Campbell and Hausdorff).

use super::Closure;
use super::opening::{self, add_products};
use crate::math::Vec3;
use crate::numerics::DenseMatrix;

impl Closure {
    /// Returns the second-order part of [`residual`](Self::residual) along linear motions: for every row a symmetric
    /// matrix `B` such that a change of the angles by `modes * x` changes the row by `J modes x + x^T B x` up to third
    /// order.
    ///
    /// `angles` is a closed state. `modes` has a row for every edge, which should be zero for locked edges, and a
    /// column for every motion.
    /// # Panics
    /// If the number of rows of `angles` or `modes` is not the number of edges.
    pub(crate) fn second_order(&self, angles: &[f64], modes: &DenseMatrix) -> Vec<DenseMatrix> {
        assert_eq!([angles.len(), modes.nrows()], [self.edges; 2], "a row for every edge");
        let count = modes.ncols();
        let mut parts = vec![DenseMatrix::zeros(count, count); self.rows()];
        let (rounds, loops) = parts.split_at_mut(3 * self.rounds.len());
        for (round, parts) in self.rounds.iter().zip(rounds.chunks_exact_mut(3)) {
            let mut directions = Vec::with_capacity(round.spokes.len());
            round.walk(angles, |_, direction| directions.push(*direction));
            let mut before = vec![Vec3::zeros(); count];
            for (spoke, direction) in round.spokes.iter().zip(directions) {
                let turns: Vec<Vec3> = (0..count).map(|mode| modes[(spoke.edge, mode)] * direction).collect();
                add_products(parts, (&before, &turns), 0.25);
                before.iter_mut().zip(&turns).for_each(|(sum, turn)| *sum += turn);
            }
        }
        for (opening, parts) in self.openings.iter().zip(loops.chunks_exact_mut(opening::ROWS)) {
            opening.add_second_order(angles, modes, parts);
        }
        parts
    }
}
