//! What accepted steps change in a model, to come back to a state.

use super::Model;

/// What a model knows of the state at which it is.
#[derive(Clone, Debug)]
pub struct ReferenceState {
    base: Vec<f64>,
    units: Vec<f64>,
    angles: Vec<f64>,
}

impl Model {
    /// Where the model is: unknowns found from here mean the same after [`Model::go_to`].
    pub(crate) fn place(&self) -> ReferenceState {
        ReferenceState { base: self.base.clone(), units: self.units.clone(), angles: self.angles() }
    }

    /// Goes back to a place. What is held against rigid motions must not have been chosen anew since.
    pub(crate) fn go_to(&mut self, place: &ReferenceState) {
        self.base.clone_from(&place.base);
        self.units.clone_from(&place.units);
        self.set_angles(&place.angles);
    }
}
