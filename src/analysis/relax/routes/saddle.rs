//! An equilibrium that is no minimum is left along a motion on which its energy falls, both ways, to the lower side.
//!
//! In a flat sheet of rigid or very stiff bars a motion that meets the bars to first order may meet them on no way to
//! second: from there the sheet is followed with bars that stretch.

use super::soft_bars;
use crate::analysis::relax::run::{Ending, Run, is_better};
use crate::model::Model;
use crate::numerics::vector::{larger, max_abs, moved};
use crate::solver::{Equilibrium, HessianKind, Problem, Start, Tangent};

/// Length of the step that leaves a saddle: the largest change of a soft measure (an angle, in radians), and the largest
/// change of an unknown in units of length.
const LEAVING_STEP: f64 = 0.1;
/// The ways out of a saddle, tried one after the other until one leads lower: lengths of the step, and whether rigid and
/// very stiff bars stretch after it. A long step may pass over the well beside a saddle.
pub(super) const WAYS: [(f64, bool); 3] = [(LEAVING_STEP, false), (0.1 * LEAVING_STEP, false), (LEAVING_STEP, true)];
/// Largest number of saddles that are left one after the other.
const MOST_SADDLES: usize = 20;
/// Stiffness of bars over that of the softest hinge above which they are very stiff: of 40 random plates in compression
/// none stayed at a saddle with bars of 1e8, and 11 with bars of 1e10.
const VERY_STIFF: f64 = 1e9;

/// Whether the equilibrium has negative eigenvalues, or may have some. A start that knows its tensions asks for the
/// equilibrium next to it, whatever its stability.
pub(super) fn is_reached(run: &Run<'_>, ending: &Ending) -> bool {
    !run.is_restarted() && ending.as_ref().is_ok_and(is_saddle)
}

fn is_saddle(found: &Equilibrium) -> bool {
    found.negative_eigenvalues != Some(0)
}

/// The minimum below a saddle, or the last saddle from which nothing lower is reached.
pub(super) fn leave(run: &mut Run<'_>, ending: Ending) -> Ending {
    left(run, ending, &WAYS)
}

/// The same by some of the ways; along a path, which goes on where a step as it is leads no lower, by the first.
pub(super) fn left(run: &mut Run<'_>, ending: Ending, ways: &[(f64, bool)]) -> Ending {
    let mut found = ending?;
    for _ in 0..MOST_SADDLES {
        let energy = found.energy;
        if is_saddle(&found) {
            found = lower_side(run, found, ways)?;
        }
        if found.energy == energy {
            break;
        }
    }
    Ok(found)
}

/// The lower one of the equilibria on both sides of a saddle; the saddle itself where none is lower.
fn lower_side(run: &mut Run<'_>, saddle: Equilibrium, ways: &[(f64, bool)]) -> Ending {
    let Some(motion) = falling_motion(&run.model, &saddle) else { return Ok(saddle) };
    let (place, x, tension, energy) = (run.model.clone(), saddle.x.clone(), saddle.tension.clone(), saddle.energy);
    let mut found = Ok(saddle);
    let very_stiff = place.has_bars_above(VERY_STIFF * place.softest_hinge());
    for &(length, soft) in ways.iter().filter(|(_, soft)| !soft || very_stiff) {
        for step in [length, -length] {
            let beside = |run: &mut Run<'_>| {
                run.model.clone_from(&place);
                let x = moved(&x, step, &motion);
                Some(if soft {
                    soft_bars::from(run, &x, &soft_bars::RATIOS)
                } else {
                    run.minimize(Start { x, tension: Some(tension.clone()) })
                })
            };
            found = run.prefer(found, beside, is_better);
        }
        if found.as_ref().map_or(true, |found| found.energy < energy) {
            break;
        }
    }
    found
}

/// A motion on which the energy of a saddle falls, of length 1.
fn falling_motion(model: &Model, saddle: &Equilibrium) -> Option<Vec<f64>> {
    let mut tangent = Tangent::at_state(model, &saddle.x, &saddle.tension, HessianKind::Full).ok()?;
    model.hold(&saddle.tension, &mut tangent.at);
    let motion = tangent.falling_motion().ok()??;
    let length = max_abs(&motion) / model.unit_of_length();
    let size = larger(tangent.at.largest_measure_change(&motion), length);
    Some(motion.iter().map(|rate| rate / size).collect())
}
