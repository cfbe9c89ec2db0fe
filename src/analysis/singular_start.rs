//! Starts from which a sheet can leave on several branches: flat sheets, above all.
//!
//! Several branches of rigid folding meet in a flat state. With rigid bars no motion relieves the torques of the creases
//! to first order there, and Newton's method cannot choose a branch, since it sees the first order only. Bars that
//! stretch a little can: the torques push the sheet out of its plane, and it comes to rest on the branch that its rest
//! angles favour. From there it is followed while the bars are made stiffer, until they are rigid.

use super::recorder::Recorder;
use crate::model::Model;
use crate::solver::{Equilibrium, Failure, NewtonError, Options, Step};

/// Stiffnesses of the bars, one after the other, over that of the softest hinge. From 1e2 on or with three of them, some
/// flat-foldable patterns of 20 to 120 edges end in states of higher energy; from 1e4 on, some end in none.
const RATIOS: [f64; 2] = [1e3, 1e5];
/// Tolerance of the states in between.
const INTERMEDIATE_TOLERANCE: f64 = 1e-6;
/// Largest magnitude of a fold angle, in radians, at which a hinge counts as flat.
const FLAT_RAD: f64 = 1e-9;

/// The branch on which a flat or singular start was left.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BranchChoice {
    /// Number of soft hinges whose rest angle is not zero.
    pub hinges: usize,
    /// Number of those that fold to the side of their rest angle.
    pub on_rest_side: usize,
    /// Whether rigid bars stretched on the way, because the start was singular.
    pub soft_bars: bool,
}

impl BranchChoice {
    /// Returns the branch of the state `x` of a model that was started with these angles; `None` if the start was
    /// neither flat nor singular, or all rest angles are zero.
    pub(super) fn of(model: &Model, x: &[f64], start: &[f64], soft_bars: bool) -> Option<Self> {
        let flat = start.iter().all(|angle| angle.abs() <= FLAT_RAD);
        let [hinges, on_rest_side] = if flat || soft_bars { model.hinges_on_rest_side(x) } else { [0, 0] };
        (hinges > 0).then_some(Self { hinges, on_rest_side, soft_bars })
    }
}

/// Relaxes a model from coordinates that are a singular start of its rigid bars. `history` receives the steps with bars
/// that stretch.
///
/// # Errors
/// [`NewtonError`] of the model with rigid bars, or [`Failure::Interrupted`].
pub(super) fn leave(
    model: &mut Model,
    mut place: Vec<f64>,
    options: Options,
    recorder: &mut Recorder<'_>,
    history: &mut Vec<Step>,
) -> Result<Equilibrium, NewtonError> {
    let (hinge, loose) = (model.softest_hinge(), Options { tolerance: INTERMEDIATE_TOLERANCE, ..options });
    for ratio in RATIOS {
        model.soften_rigid_bars(ratio * hinge);
        let x = model.start_from(place.clone());
        let reached = recorder.minimize(model, x, loose);
        model.soften_rigid_bars(f64::INFINITY);
        match reached {
            Ok(found) => {
                place = model.coordinates(&found.x);
                history.extend(found.history);
            }
            Err(error) if error.failure == Failure::Interrupted => return Err(error),
            // the last state that was accepted is nearer than the one before
            Err(error) => {
                place = model.coordinates(&error.x);
                history.extend(error.history);
            }
        }
    }
    let x = model.start_from(place);
    recorder.minimize(model, x, options)
}
