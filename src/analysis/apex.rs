//! Screws whose relaxation ends without curvature.
//!
//! The motions of a screw that bend it are a curvature times the square of the axis's direction: a cone, whose apex is zero
//! curvature. At the apex Newton's method sees only the direction in which the axis happens to lie, so that a state in
//! balance along it, with no negative eigenvalue, may still lose energy by bending about another axis. A relaxation that ends at
//! the apex is therefore repeated from states that are bent a little about several axes, both ways; the lowest equilibrium is the
//! answer.

use super::recorder::Recorder;
use crate::model::Model;
use crate::solver::{Equilibrium, Failure, NewtonError, Options, Problem, Step};
use std::f64::consts::PI;

/// Curvature times the unit of length, over the largest angle by which a hinge is off its rest: below this a state has none,
const APEX_CURVATURE: f64 = 1e-6;
/// and from this relaxations are repeated.
const BENT_CURVATURE: f64 = 0.03;
/// Directions of the axis about which the sheet is bent, evenly over half a turn, beginning off the directions of symmetric cells.
const AXES: usize = 4;
const FIRST_AXIS: f64 = 0.3;
/// Relative fall of the energy that rounding errors do not explain.
const LOWER: f64 = 1e-10;

/// Whether a state with this largest angle between a hinge and its rest is that of a screw without curvature.
pub(super) fn at_apex(model: &Model, x: &[f64], off: f64) -> bool {
    let turns = model.domain().turns(&model.coordinates(x));
    turns.is_some_and(|turns| turns.kappa.abs() * model.unit_of_length() <= APEX_CURVATURE * off)
}

/// The lowest equilibrium that relaxations from slightly bent states reach, or `found` where none is lower. `off` is the largest angle
/// between a hinge and its rest, in radians.
///
/// # Errors
/// [`Failure::Interrupted`] where the observer asks to stop. A relaxation that fails otherwise is passed over.
pub(super) fn bent(
    model: &mut Model,
    mut found: Equilibrium,
    off: f64,
    options: Options,
    recorder: &mut Recorder<'_>,
    history: &mut Vec<Step>,
) -> Result<Equilibrium, NewtonError> {
    let (start, mut place) = (model.place(), model.place());
    let flat = model.coordinates(&found.x);
    let bend = BENT_CURVATURE * off / model.unit_of_length();
    for axis in 0..AXES {
        for kappa in [bend, -bend] {
            let mut coordinates = flat.clone();
            model.domain().bend(&mut coordinates, FIRST_AXIS + PI * axis as f64 / AXES as f64, kappa);
            model.go_to(&start);
            let x = model.start_from(coordinates);
            let steps = recorder.steps();
            match recorder.minimize(model, x, options) {
                Ok(other) if found.energy - other.energy > LOWER * found.energy.abs() => {
                    history.append(&mut found.history);
                    (found, place) = (other, model.place());
                }
                Err(error) if error.failure == Failure::Interrupted => {
                    history.append(&mut found.history);
                    return Err(error);
                }
                _ => recorder.forget_after(steps),
            }
        }
    }
    model.go_to(&place);
    Ok(found)
}
