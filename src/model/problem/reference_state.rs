//! The reference state of a model: all that accepted steps change in it, to be saved and restored.

use super::Model;

/// The saved reference state of a model.
#[derive(Clone, Debug)]
pub struct ReferenceState {
    base: Vec<f64>,
    units: Vec<f64>,
    angles: Vec<f64>,
}

impl Model {
    /// Saves the reference state: unknowns computed now have the same meaning after [`Model::go_to`].
    pub(crate) fn place(&self) -> ReferenceState {
        ReferenceState { base: self.base.clone(), units: self.units.clone(), angles: self.angles() }
    }

    /// Restores a saved reference state. The held coordinates must not have been chosen anew since it was saved.
    pub(crate) fn go_to(&mut self, place: &ReferenceState) {
        self.base.clone_from(&place.base);
        self.units.clone_from(&place.units);
        self.set_angles(&place.angles);
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
