//! The ways to go on from how a relaxation ended: a list, in the order in which they are tried.
//!
//! A relaxation begins with Newton's method in positions, or in fold angles where that is faster. Each route then sees
//! how the relaxation ended so far, says whether it is wanted, and returns how it ends with it. Routes that look for
//! something better return the ending before where they find nothing.

mod bent_screw;
pub(super) mod fold_angles;
mod other_tensions;
mod rest_path;
mod saddle;
pub(super) mod soft_bars;
mod stiffer_bars;
pub(super) mod straight_screw;

use super::run::{Ending, Run};
use crate::solver::Failure;

/// A way to go on from how a relaxation ended.
pub(super) struct Route {
    /// Its name, for those who read what a relaxation did.
    pub(super) name: &'static str,
    /// Whether it is to be tried after this ending.
    pub(super) wanted: fn(&Run<'_>, &Ending) -> bool,
    /// Returns how the relaxation ends with it.
    pub(super) go: fn(&mut Run<'_>, Ending) -> Ending,
}

/// All routes, in order: first those for relaxations that failed, then those that look for a lower energy, then the one
/// that settles the tensions.
pub(super) const ROUTES: [Route; 9] = [
    Route { name: "soft bars", wanted: soft_bars::is_singular, go: soft_bars::leave },
    Route { name: "fold angles", wanted: fold_angles::may_help, go: fold_angles::from_the_start },
    Route { name: "straight screw", wanted: straight_screw::is_nearly_straight, go: straight_screw::relaxed },
    Route { name: "rest path", wanted: has_failed, go: rest_path::follow },
    Route { name: "stiffer bars", wanted: has_failed, go: stiffer_bars::relaxed },
    Route { name: "soft bars", wanted: soft_bars::is_in_doubt, go: soft_bars::leave_if_better },
    Route { name: "saddle", wanted: saddle::is_reached, go: saddle::leave },
    Route { name: "bent screw", wanted: bent_screw::is_at_apex, go: bent_screw::lowest },
    Route { name: "other tensions", wanted: other_tensions::are_needed, go: other_tensions::relaxed },
];

/// Whether a relaxation failed for a reason that another way may mend.
fn has_failed(_: &Run<'_>, ending: &Ending) -> bool {
    let final_ones =
        |failure| matches!(failure, Failure::Interrupted | Failure::SingularStart | Failure::Unbounded { .. });
    ending.as_ref().is_err_and(|error| !final_ones(error.failure))
}
