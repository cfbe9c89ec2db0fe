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
}
