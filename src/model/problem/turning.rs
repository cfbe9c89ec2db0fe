//! Rotations of a whole sheet under loads, against which only the loads have a stiffness.
//!
//! Between the steps of a minimisation the sheet is rotated to where its loads do the most work. In a Newton step
//! rotations have a small artificial stiffness, so that those which no load resists leave the Hessian regular.

use super::{Gauge, Model};
use crate::math::{Vec3, point};
use crate::model::domain::Domain;
use crate::model::gauge;
use crate::numerics::sparse::FIXED;
use crate::numerics::vector::max_abs;
use crate::solver::Linearization;

/// Artificial stiffness of rotations in a Newton step: `TURNING` times the unbalanced force per mean edge length,
/// which may favour a rotation, and at least the fraction `LEAST_TURNING` of the largest diagonal entry of the
/// Hessian.
const TURNING: f64 = 10.0;
const LEAST_TURNING: f64 = 1e-6;

impl Model {
    /// Returns the unknowns, numbered as in `number`, that would have to be held to prevent the rotations that pins
    /// leave free. Empty without loads, since the gauge holds rotations then.
    pub(super) fn turning_unknowns(&self, number: &[u32]) -> Vec<u32> {
        if self.equations.gauge == Gauge::Free || self.loads.is_empty() {
            return vec![];
        }
        let motions = self.rigid_motions(&self.base, true);
        let mut held: Vec<bool> = number.iter().map(|k| *k == FIXED).collect();
        held.resize(motions.len(), true);
        self.chosen_by_pieces(&motions, &held).into_iter().map(|k| number[k]).collect()
    }

    /// Adds the artificial stiffness of rotations to the Hessian, and no force: a rotation that no load resists has
    /// no other stiffness in balance, and a meaningless one out of balance. Rotations that loads resist are also made
    /// by [`Problem::relieve`].
    pub(super) fn hold_rotations(&self, tension: &[f64], out: &mut Linearization) {
        if self.turning.is_empty() {
            return;
        }
        let unit = out.pattern().largest_diagonal(&out.hessian);
        let unbalanced = max_abs(&out.force(tension));
        let amount = f64::max(TURNING * unbalanced / self.equations.mean_edge, LEAST_TURNING * unit);
        self.turning.iter().for_each(|&k| out.add_to_diagonal(k as usize, amount));
    }

    /// Returns the point about which the whole sheet can rotate: its only pinned vertex, or the centroid without
    /// pins. `None` if more than one vertex is pinned.
    fn pivot(&self, all: &[f64]) -> Option<Vec3> {
        match self.pinned.first().map(|k| k / 3) {
            None => Some(gauge::centre_and_size(&self.equations.domain, all).0),
            Some(pinned) => self.pinned.iter().all(|k| k / 3 == pinned).then(|| point(all, pinned)),
        }
    }

    /// Rotates the whole sheet by the shortest way to where its loads do the most work. Returns the decrease of the
    /// energy.
    pub(super) fn turn_along_loads(&mut self, x: &mut [f64]) -> f64 {
        let supported = !self.equations.bodies.is_empty() || !self.supports.is_empty();
        if self.turning.is_empty() || supported || !matches!(self.equations.domain, Domain::Patch) {
            return 0.0;
        }
        let all = self.coordinates(x);
        let Some(pivot) = self.pivot(&all) else { return 0.0 };
        let points = || all.chunks_exact(3).map(Vec3::from_column_slice);
        let forces = self.loads.chunks_exact(3).map(Vec3::from_column_slice);
        let arms = points().zip(forces).filter(|(_, force)| force.amax() > 0.0).map(|(p, f)| (p - pivot, f)).collect();
        let Some(turn) = gauge::turn_along(arms) else { return 0.0 };
        let turned: Vec<f64> = points().flat_map(|p| <[f64; 3]>::from(pivot + turn * (p - pivot))).collect();
        let work: f64 = self.loads.iter().zip(turned.iter().zip(&all)).map(|(f, (new, old))| f * (new - old)).sum();
        if !(work > 0.0) {
            return 0.0;
        }
        self.base = turned;
        x.copy_from_slice(&self.unknowns(&self.base));
        work
    }
}
