//! What a relaxation tries where the direct way from its start failed: to go straight, or step by step.

use super::recorder::Recorder;
use super::singular_start::Origin;
use super::straight;
use crate::model::Model;
use crate::solver::{Equilibrium, Failure, NewtonError, Options, Step};

/// Smallest step of the continuation that is tried before giving up.
const LEAST_STEP: f64 = 1.0 / 64.0;
/// Tolerance of the states in between.
const INTERMEDIATE_TOLERANCE: f64 = 1e-6;

/// The equilibrium that is reached after this failure: of a screw that it left nearly straight by way of straight states, and else from
/// the start, with rest values that move to their targets in steps.
///
/// # Errors
/// [`NewtonError`] of the relaxation that failed last.
pub(super) fn reached(
    model: &mut Model,
    error: NewtonError,
    origin: &Origin,
    options: Options,
    recorder: &mut Recorder<'_>,
    history: &mut Vec<Step>,
) -> Result<Equilibrium, NewtonError> {
    let straight = from_nearly_straight(model, error, options, recorder, history);
    straight.or_else(|error| {
        if error.failure == Failure::Interrupted {
            return Err(error);
        }
        history.extend(error.history);
        model.set_angles(&origin.angles);
        let by_steps = follow(model, origin.place.clone(), options, recorder, history);
        by_steps.or_else(|error| from_nearly_straight(model, error, options, recorder, history))
    })
}

/// The equilibrium that a failed relaxation which ended nearly straight reaches by way of straight states.
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
    let loose =
        Options { tolerance: options.tolerance.max(INTERMEDIATE_TOLERANCE), iterations: options.iterations.min(50) };
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
