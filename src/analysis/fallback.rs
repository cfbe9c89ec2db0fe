//! Relaxation after Newton's method failed from the start: by way of straight states, for a screw that it left with hardly any
//! curvature, and by continuation, with rest values that move to their targets in steps.

use super::recorder::Recorder;
use super::singular_start::Origin;
use super::straight;
use crate::model::Model;
use crate::solver::{Equilibrium, Failure, NewtonError, Options, Step};

/// Smallest step of the continuation that is tried before giving up.
const LEAST_STEP: f64 = 1.0 / 64.0;
/// Tolerance of the states in between.
const INTERMEDIATE_TOLERANCE: f64 = 1e-6;
/// Largest number of Newton steps to one of them; 100 lead no further in the scenes of `meshes/` at other fractions and stiffnesses.
const INTERMEDIATE_STEPS: usize = 50;

/// Returns the equilibrium that is reached after this failure, by way of straight states if it left a screw nearly straight, and
/// by continuation from the start if it did not or if that fails.
///
/// # Errors
/// [`NewtonError`] of the relaxation that failed last.
pub(super) fn relaxed(
    model: &mut Model,
    error: NewtonError,
    origin: &Origin,
    options: Options,
    recorder: &mut Recorder<'_>,
    history: &mut Vec<Step>,
) -> Result<Equilibrium, NewtonError> {
    let by_straight_states = from_nearly_straight(model, error, options, recorder, history);
    by_straight_states.or_else(|error| {
        if error.failure == Failure::Interrupted {
            return Err(error);
        }
        history.extend(error.history);
        model.set_angles(&origin.angles);
        let by_continuation = follow(model, origin.place.clone(), options, recorder, history);
        by_continuation.or_else(|error| from_nearly_straight(model, error, options, recorder, history))
    })
}

/// Returns the equilibrium that is reached by way of straight states from the last state of a failed relaxation; the failure itself if
/// that state is not nearly straight.
fn from_nearly_straight(
    model: &mut Model,
    error: NewtonError,
    options: Options,
    recorder: &mut Recorder<'_>,
    history: &mut Vec<Step>,
) -> Result<Equilibrium, NewtonError> {
    let last = model.coordinates(&error.x);
    if hopeless(error.failure) || !straight::is_nearly(model, &last) {
        return Err(error);
    }
    history.extend(error.history);
    straight::relaxed(model, last, options, recorder, history)
}

/// Failures that smaller steps cannot mend.
pub(super) fn hopeless(failure: Failure) -> bool {
    matches!(failure, Failure::Interrupted | Failure::SingularStart)
}

/// Continuation in the rest values, from a state with these coordinates: those who accept states may change what the unknowns mean.
fn follow(
    model: &mut Model,
    mut place: Vec<f64>,
    options: Options,
    recorder: &mut Recorder<'_>,
    history: &mut Vec<Step>,
) -> Result<Equilibrium, NewtonError> {
    let start = model.start_from(place.clone());
    let (targets, origin) = (model.rests(), model.values(&start));
    let (mut done, mut step) = (0.0, 0.25);
    let loose = Options {
        tolerance: options.tolerance.max(INTERMEDIATE_TOLERANCE),
        iterations: options.iterations.min(INTERMEDIATE_STEPS),
    };
    loop {
        let next = f64::min(done + step, 1.0);
        let angles = model.angles();
        model.set_rests(&origin, &targets, next);
        let x = model.start_from(place.clone());
        match recorder.minimize(model, x, if next < 1.0 { loose } else { options }) {
            Ok(found) if next == 1.0 => return Ok(found),
            Ok(found) => {
                history.extend(found.history);
                (place, done, step) = (model.coordinates(&found.x), next, 2.0 * step);
            }
            Err(error) if error.failure == Failure::Interrupted || step <= LEAST_STEP => {
                model.set_rests(&origin, &targets, 1.0);
                return Err(error);
            }
            Err(error) => {
                history.extend(error.history);
                model.set_angles(&angles);
                step /= 2.0;
            }
        }
    }
}
