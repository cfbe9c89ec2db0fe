//! Screws whose relaxation ends without curvature.
//!
//! The motions of a screw that bend it are a curvature times the square of the axis's direction: a cone, whose apex is
//! zero curvature. At the apex Newton's method sees only the direction in which the axis happens to lie, so that a
//! state in balance along it, with no negative eigenvalue, may still lose energy by bending about another axis. A
//! relaxation that ends at the apex is therefore repeated from states that are bent a little about several axes, both
//! ways; the lowest equilibrium is the answer.

use crate::analysis::relax::certainty::off_rest;
use crate::analysis::relax::run::{Ending, Run, is_better};
use crate::solver::Problem;
use std::f64::consts::PI;

/// Curvature times the unit of length, over the largest angle by which a hinge is off its rest: below this a state has
/// none,
const APEX_CURVATURE: f64 = 1e-6;
/// and from this relaxations are repeated.
const BENT_CURVATURE: f64 = 0.03;
/// Directions of the axis about which the sheet is bent, evenly over half a turn, beginning off the directions of
/// symmetric cells.
const AXES: usize = 4;
const FIRST_AXIS_RAD: f64 = 0.3;

/// Whether the equilibrium is that of a screw without curvature, some of whose hinges are off their rest.
pub(super) fn is_at_apex(run: &Run<'_>, ending: &Ending) -> bool {
    let Ok(found) = ending else { return false };
    let Some(turns) = run.model.domain().turns(&run.model.coordinates(&found.x)) else { return false };
    let off = if run.has_moved() { off_rest(&run.model, &found.x) } else { 0.0 };
    off > 0.0 && turns.kappa.abs() * run.model.unit_of_length() <= APEX_CURVATURE * off
}

/// The lowest equilibrium that relaxations from slightly bent states reach, or the one before where none is lower.
pub(super) fn lowest(run: &mut Run<'_>, ending: Ending) -> Ending {
    let mut found = ending?;
    let (start, flat) = (run.model.clone(), run.model.coordinates(&found.x));
    let bend = BENT_CURVATURE * off_rest(&run.model, &found.x) / run.model.unit_of_length();
    for axis in 0..AXES {
        for kappa in [bend, -bend] {
            let bent = |run: &mut Run<'_>| {
                let mut coordinates = flat.clone();
                run.model.domain().bend(&mut coordinates, FIRST_AXIS_RAD + PI * axis as f64 / AXES as f64, kappa);
                run.model.clone_from(&start);
                let x = run.model.start_from(coordinates);
                Some(run.minimize(x))
            };
            found = run.prefer(Ok(found), bent, is_better)?;
        }
    }
    Ok(found)
}
