//! Constraints on the position of a sheet: the coordinates that pins and parts hold, and those along the directions of
//! guides.

use super::Model;
use crate::model::gauge::Motion;

/// A coordinate, or a linear function of coordinates, that keeps its value. Angles count as lengths at the distance of
/// one mean edge.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Kept {
    /// Its rates under the rigid motions of a state; see [`gauge::rigid_motions`].
    pub rates: Motion,
    /// Its value in that state, which need not be the one that is kept.
    pub value: f64,
}

impl Model {
    /// Returns everything that is kept, with rates and values in the state with these coordinates of all points.
    pub(crate) fn kept(&self, coordinates: &[f64]) -> Vec<Kept> {
        let mut generalised = coordinates.to_vec();
        generalised.resize(self.base.len(), 0.0);
        self.equations.bodies.find_all_poses(&mut generalised, &self.base);
        let motions = self.rigid_motions(&generalised, true);
        let held = self.held_by_conditions(motions.len());
        let value = |k: usize| match k.checked_sub(self.base.len()) {
            Some(support) => self.supports[support].value(&generalised),
            None => generalised[k] / self.unit(k),
        };
        (0..motions.len()).filter(|&k| held[k]).map(|k| Kept { rates: motions[k], value: value(k) }).collect()
    }

    /// Returns the number of rigid motions of the drawn state, and how many of them nothing prevents.
    pub(crate) fn rigid_motion_counts(&self) -> [usize; 2] {
        let motions = self.rigid_motions(&self.base, true);
        let nothing = vec![false; motions.len()];
        [nothing, self.held_by_conditions(motions.len())].map(|held| self.chosen_by_pieces(&motions, &held).len())
    }

    /// Whether vertices move as rigid parts.
    pub(crate) fn has_parts(&self) -> bool {
        !self.equations.bodies.is_empty()
    }

    /// Returns which generalised coordinates pins and parts hold, then that the values of supports are kept.
    pub(super) fn held_by_conditions(&self, count: usize) -> Vec<bool> {
        let mut held = vec![false; count];
        self.pinned.iter().for_each(|&k| held[k] = true);
        let poses = self.points()..self.base.len();
        poses.zip(self.equations.bodies.free()).for_each(|(k, free)| held[k] = !free);
        held[self.base.len()..].fill(true);
        held
    }
}
