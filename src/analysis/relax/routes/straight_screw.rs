//! Screws that a relaxation leaves next to zero curvature: those without an equilibrium, and the stability of straight
//! ones.
//!
//! The motions of a screw that bend it are a curvature times the square of the axis's direction: a cone, whose apex is
//! zero curvature. Next to it a moment that bends the sheet makes Newton's system indefinite, by the moment over the
//! curvature, and steps become short in all unknowns. A sheet that stiff bars keep nearly straight, as a Miura-ori, is
//! therefore held straight first, where it has the equilibrium of a torus. From there it bends about an axis that keeps
//! its direction, and at last with all its unknowns, in balance or nearly so.

use super::has_failed;
use crate::analysis::relax::certainty::{CERTAIN, next_change};
use crate::analysis::relax::run::{Ending, Run, is_interruption};
use crate::model::Model;
use crate::solver::{Equilibrium, HessianKind, Problem, Start, Tangent};
use std::f64::consts::PI;

/// Curvature times the unit of length up to which the last state of a relaxation is nearly straight, and up to which it
/// is rounding.
const NEARLY: f64 = 1e-2;
const ROUNDING: f64 = 1e-13;
/// Curvature times the unit of length up to which a state is asked whether its axis has a direction.
const STRAIGHT: f64 = 1e-9;
/// Direction of the axis in radians, off those of symmetric cells; the first of those asked, which are even over half a
/// turn.
const AXIS: f64 = 0.3;
const AXES: usize = 4;

/// Whether a screw has at most this curvature times the mean length of an edge.
fn is_straight(model: &Model, coordinates: &[f64], most: f64) -> bool {
    let turns = model.domain().turns(coordinates);
    turns.is_some_and(|turns| turns.kappa.abs() * model.unit_of_length() <= most)
}

/// Whether a relaxation of a screw failed with hardly any curvature.
pub(super) fn is_nearly_straight(run: &Run<'_>, ending: &Ending) -> bool {
    let Err(error) = ending else { return false };
    has_failed(run, ending) && is_straight(&run.model, &run.model.coordinates(&error.x), NEARLY)
}

/// The equilibrium that a nearly straight screw reaches by way of straight ones.
pub(super) fn relaxed(run: &mut Run<'_>, ending: Ending) -> Ending {
    let last = ending.as_ref().map_or_else(|error| &error.x, |found| &found.x);
    let mut coordinates = run.model.coordinates(last);
    run.model.domain().bend(&mut coordinates, AXIS, 0.0);
    let start = Start::from(run.model.hold_axis(2, coordinates));
    with_axis_held(run, start, &[1, 0])
}

/// Whether a relaxation starts next to an equilibrium without curvature.
pub(crate) fn begins_straight(run: &Run<'_>) -> bool {
    run.is_restarted() && is_straight(&run.model, &run.start.coordinates, ROUNDING)
}

/// The equilibrium next to a straight start, about an axis that keeps its direction unless the sheet bends.
pub(crate) fn begin(run: &mut Run<'_>, start: Start) -> Ending {
    let start = Start { x: run.model.hold_axis(1, run.start.coordinates.clone()), ..start };
    with_axis_held(run, start, &[0])
}

/// Relaxes from a start, each time with fewer coordinates of the axis held: as many as `left` says, one after the
/// other.
fn with_axis_held(run: &mut Run<'_>, mut start: Start, left: &[usize]) -> Ending {
    for &left in left {
        let reached = run.minimize(start);
        let last = reached.as_ref().map_or_else(|error| &error.x, |found| &found.x);
        let mut place = run.model.coordinates(last);
        let straight = is_straight(&run.model, &place, ROUNDING);
        if straight {
            run.model.domain().bend(&mut place, AXIS, 0.0);
        }
        let x = run.model.hold_axis(if reached.is_ok() { left } else { 0 }, place);
        let found = reached?;
        if left == 0 && straight {
            // the direction of the axis has no effect, and whether its eigenvalue is negative no meaning
            return Ok(Equilibrium { x, ..found });
        }
        start = Start { x, tension: Some(found.tension) };
    }
    run.minimize(start)
}

/// The equilibrium of a straight screw with residuals within the tolerance about an axis that keeps its direction, which
/// is how it starts again. Others, and those that do not meet it so, are returned as they are.
pub(super) fn about_one_axis(run: &mut Run<'_>, found: Equilibrium) -> Ending {
    let place = run.model.coordinates(&found.x);
    if !is_straight(&run.model, &place, ROUNDING) {
        return Ok(found);
    }
    let (tension, steps) = (Some(found.tension.clone()), run.recorder.steps());
    let about_one = |run: &mut Run<'_>| {
        let x = run.model.hold_axis(1, place);
        let reached = run.minimize(Start { x, tension });
        if run.recorder.steps() == steps + 1 {
            // it was within the tolerance already
            run.recorder.forget_after(steps);
        }
        Some(reached)
    };
    run.prefer(Ok(found), about_one, |about_one, _| about_one.as_ref().map_or_else(is_interruption, |_| true))
}

/// The equilibrium of a screw about an axis that may turn, with its negative eigenvalues counted about axes that keep
/// their direction, the most of several, if it is straight and would bend about none of them. Then the direction has no
/// effect, and the sign of its eigenvalue is one of rounding. Other equilibria are returned as they are.
pub(crate) fn counted(model: &mut Model, found: Equilibrium) -> Equilibrium {
    let place = model.coordinates(&found.x);
    if !is_straight(model, &place, STRAIGHT) {
        return found;
    }
    if found.negative_eigenvalues == Some(0) {
        return Equilibrium { x: model.hold_axis(0, place), ..found };
    }
    let directions = (0..AXES).map(|axis| AXIS + PI * axis as f64 / AXES as f64);
    let counts: Option<Vec<usize>> =
        directions.map(|axis| negative_about(model, place.clone(), axis, &found.tension)).collect();
    let most = counts.and_then(|counts| counts.into_iter().max());
    let negative_eigenvalues = most.or(found.negative_eigenvalues);
    Equilibrium { x: model.hold_axis(0, place), negative_eigenvalues, ..found }
}

/// Negative eigenvalues of a straight state about an axis of this direction, in radians; `None` if it would bend about
/// that axis.
fn negative_about(model: &mut Model, mut coordinates: Vec<f64>, axis: f64, tension: &[f64]) -> Option<usize> {
    model.domain().bend(&mut coordinates, axis, 0.0);
    let x = model.hold_axis(1, coordinates);
    let mut tangent = Tangent::at_state(model, &x, tension, HessianKind::Full).ok()?;
    let negative = tangent.negative_eigenvalues().ok()??;
    next_change(&mut tangent, tension).filter(|change| *change <= CERTAIN).map(|_| negative)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analysis::relax::relax;
    use crate::model::{Assembly, Gauge, Rest};
    use crate::sheet::generate::{Pattern, generate};
    use crate::solver::{Options, minimize};

    /// An eggbox on a screw with these rest angles of mountains and valleys, in radians.
    fn eggbox(rest: [f64; 2]) -> Assembly {
        let [mountains, valleys] = rest;
        let sheet = generate(&Pattern::named("eggbox").unwrap()).unwrap();
        let drawn = sheet.edges.iter().map(|edge| sheet.drawn_angle(edge).unwrap());
        let rest = drawn.map(|angle| if angle > 0.0 { valleys } else { mountains }).collect();
        let builder = Assembly::screw(sheet, [1, 1]).bars(100.0).facets(0.1);
        builder.creases(1.0).rest(Rest::PerEdge(rest)).build().unwrap()
    }

    /// Claim: of an eggbox that is held straight, and that relaxations leave straight, no negative eigenvalue counts,
    /// whatever number comes in; where a moment bends it to a lower energy the number is kept. Tolerance: the energy
    /// falls by 6e-5.
    #[test]
    fn counts_what_bends() {
        for (rest, bends) in [([-1.0, 1.0], false), ([-3.1, 0.1], true)] {
            let assembly = eggbox(rest);
            let mut model = assembly.model(Gauge::Held);
            let mut coordinates = model.coordinates(&model.start());
            model.domain().bend(&mut coordinates, AXIS, 0.0);
            let start = Start::from(model.hold_axis(2, coordinates));
            let held = minimize(&mut model, start, Options::default(), &mut |_| true).unwrap();
            let place = model.coordinates(&held.x);
            let found = Equilibrium { x: model.hold_axis(0, place), negative_eigenvalues: Some(7), ..held };
            let straight_energy = found.energy;
            let counted = counted(&mut model, found);
            let relaxed = relax(&assembly).unwrap();
            assert_eq!(relaxed.state.total() < straight_energy - 1e-6, bends, "{straight_energy}");
            assert_eq!(counted.negative_eigenvalues, Some(if bends { 7 } else { 0 }));
        }
    }
}
