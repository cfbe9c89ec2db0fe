//! Error of a converged state: the change of its fold angles in one more Newton step.

use crate::model::{Domain, Element, Model};
use crate::solver::{Equilibrium, HessianKind, Linearization, Problem, Tangent};

/// Largest angle, in radians, by which a converged state may still be off.
pub(super) const CERTAIN: f64 = 1e-7;
/// Relative residual of the linear system that tells this angle.
const ROUGH: f64 = 0.1;
/// Scaled force above which the state of a sheet under torques is not balanced.
const UNBALANCED: f64 = 1e-9;

/// The largest change of a soft hinge's angle that one more Newton step would make, in radians: what the residual means
/// for the state. Asked where it may mean much: where rounding errors kept it above the tolerance, and on screws, whose
/// axis has next to no direction near zero curvature. `None` elsewhere, and where it cannot be told; infinite where a
/// state under torques has a residual that is no rounding error of theirs.
pub(super) fn uncertainty(model: &Model, found: &Equilibrium, tolerance: f64) -> Option<f64> {
    let last = found.history.last()?;
    if last.residual_force <= tolerance && !matches!(model.domain(), Domain::Screw) {
        return None;
    }
    let strained = || off_rest(model, &found.x) > CERTAIN;
    let of_others = || last.residual_force * rigid_over_others(model, found).max(1.0);
    if matches!(model.domain(), Domain::Screw) && of_others() > UNBALANCED && strained() {
        return Some(f64::INFINITY);
    }
    let mut tangent = Tangent::at_state(model, &found.x, &found.tension, HessianKind::Full).ok()?;
    model.hold(&found.tension, &mut tangent.at);
    let unknown = || (last.residual_force > UNBALANCED && strained()).then_some(f64::INFINITY);
    if tangent.factor(0.0).is_err() {
        return unknown();
    }
    next_change(&mut tangent, &found.tension).or_else(unknown)
}

/// The largest change of a soft hinge's angle in the Newton step from a factored state, in radians; `None` where the
/// linear system tells none.
pub(super) fn next_change(tangent: &mut Tangent, tension: &[f64]) -> Option<f64> {
    let step = tangent.newton_step(tension, ROUGH);
    (step.residual <= ROUGH).then(|| tangent.at.largest_measure_change(&step.dx))
}

/// The largest angle between a soft hinge and its rest, in radians.
pub(super) fn off_rest(model: &Model, x: &[f64]) -> f64 {
    let coordinates = model.coordinates(x);
    let off = model.soft().filter(Element::is_hinge).map(|hinge| hinge.value(&coordinates) - hinge.spring.rest);
    off.fold(0.0, |largest, off| largest.max(off.abs()))
}

/// The largest force of a rigid measure over the largest one of all others.
pub(super) fn rigid_over_others(model: &Model, found: &Equilibrium) -> f64 {
    let mut at = Linearization::new(model.layout());
    let mut largest = |tension: &[f64]| {
        model.linearize(&found.x, tension, HessianKind::GaussNewton, &mut at);
        at.largest_force
    };
    let of_others: Vec<f64> =
        found.tension.iter().zip(model.compliance()).map(|(t, c)| if *c == 0.0 { 0.0 } else { *t }).collect();
    largest(&found.tension) / largest(&of_others)
}
