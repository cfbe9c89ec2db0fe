//! Turns of a whole sheet under loads: they cost nothing but what the loads resist them with.
//!
//! Between the steps of a minimisation the sheet is turned to where its loads do the most work; in a step turns have a small stiffness of
//! their own, so that those which no load resists leave the Hessian regular.

use super::{Gauge, Model};
use crate::math::Vec3;
use crate::model::domain::Domain;
use crate::model::gauge;
use crate::numerics::sparse::FIXED;
use crate::numerics::vector::max_abs;
use crate::solver::Linearization;

/// What turning the whole sheet costs in a Newton step: so many times the unbalanced force, which may favour a turn, and at least this
/// part of the largest stiffness.
const TURNING: f64 = 10.0;
const LEAST_TURNING: f64 = 1e-6;

impl Model {
    /// Unknowns, numbered like this, that would hold the rotations that pins leave; none where no loads pull: then they are held.
    pub(super) fn turning_unknowns(&self, number: &[u32]) -> Vec<u32> {
        if self.gauge == Gauge::Free || self.loads.is_empty() {
            return vec![];
        }
        let held: Vec<bool> = number.iter().map(|k| *k == FIXED).collect();
        let motions = gauge::rigid_motions(&self.domain, &self.base, true);
        gauge::choose(&motions, &held).into_iter().map(|k| number[k]).collect()
    }

    /// Makes turning the sheet cost something in the Hessian, and nothing in the force: turns that no load resists have no other stiffness
    /// in balance, and a stiffness that means nothing out of it. Those that loads resist are made by [`Problem::relieve`] too.
    pub(super) fn hold_rotations(&self, tension: &[f64], out: &mut Linearization) {
        if self.turning.is_empty() {
            return;
        }
        let unit = out.pattern().largest_diagonal(&out.hessian);
        let unbalanced = max_abs(&out.force(tension));
        let amount = f64::max(TURNING * unbalanced / self.mean_edge, LEAST_TURNING * unit);
        self.turning.iter().for_each(|&k| out.add_to_diagonal(k as usize, amount));
    }

    /// The point about which the whole sheet can turn: its only pinned vertex, the centre where none is. `None` where more are pinned.
    fn pivot(&self, all: &[f64]) -> Option<Vec3> {
        let vertices = (all.len() - self.domain.shared()) / 3;
        let point = |k: usize| Vec3::from_column_slice(&all[3 * k..3 * k + 3]);
        match self.pinned.first().map(|k| k / 3) {
            None => Some((0..vertices).map(point).sum::<Vec3>() / vertices as f64),
            Some(pinned) => self.pinned.iter().all(|k| k / 3 == pinned).then(|| point(pinned)),
        }
    }

    /// Turns the whole sheet to where its loads do the most work, by the shortest way; returns by how much the energy falls.
    pub(super) fn turn_along_loads(&mut self, x: &mut [f64]) -> f64 {
        if self.turning.is_empty() || !matches!(self.domain, Domain::Patch) {
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
