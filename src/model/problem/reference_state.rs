//! The reference state of a model: all that accepted steps and choices of unknowns change in it, to be saved and restored.

use super::Model;
use crate::solver::Layout;
use std::sync::Arc;

/// The saved reference state of a model.
#[derive(Clone, Debug)]
pub struct ReferenceState {
    base: Vec<f64>,
    units: Vec<f64>,
    angles: Vec<f64>,
    pinned: Vec<usize>,
    free: Vec<u32>,
    turning: Vec<u32>,
    layout: Arc<Layout>,
}

impl Model {
    /// Saves the reference state: unknowns computed now have the same meaning after [`Model::go_to`].
    pub(crate) fn place(&self) -> ReferenceState {
        ReferenceState {
            base: self.base.clone(),
            units: self.units.clone(),
            angles: self.angles(),
            pinned: self.pinned.clone(),
            free: self.free.clone(),
            turning: self.turning.clone(),
            layout: self.layout.clone(),
        }
    }

    /// Restores a saved reference state, with the coordinates that were held in it.
    pub(crate) fn go_to(&mut self, place: &ReferenceState) {
        self.base.clone_from(&place.base);
        self.units.clone_from(&place.units);
        self.set_angles(&place.angles);
        self.pinned.clone_from(&place.pinned);
        self.free.clone_from(&place.free);
        self.turning.clone_from(&place.turning);
        self.layout = place.layout.clone();
    }

    /// Makes these coordinates the reference state of a screw, and holds as many coordinates of its axis as `held` says: the
    /// direction, then the curvature. Returns the unknowns.
    pub(crate) fn hold_axis(&mut self, held: usize, coordinates: Vec<f64>) -> Vec<f64> {
        let axis = self.points() - self.domain.shared();
        self.pinned.retain(|k| !(axis..axis + 2).contains(k));
        self.pinned.extend(axis..axis + held);
        self.rebase_gauge(coordinates)
    }
}
