//! An equilibrium that is no minimum is left along a motion on which its energy falls, both ways, to the lower side.

use crate::analysis::relax::run::{Ending, Run, is_better};
use crate::model::Model;
use crate::numerics::vector::{larger, max_abs, moved};
use crate::solver::{Equilibrium, HessianKind, Problem, Start, Tangent};

/// Length of the step that leaves a saddle: the largest change of a soft measure (an angle, in radians), and the
/// largest change of an unknown in units of length.
const LEAVING_STEP: f64 = 0.1;
/// Largest number of saddles that are left one after the other.
const MOST_SADDLES: usize = 20;

/// Whether the equilibrium has negative eigenvalues. A start that knows its tensions asks for the equilibrium next to
/// it, whatever its stability.
pub(super) fn is_reached(run: &Run<'_>, ending: &Ending) -> bool {
    !run.is_restarted() && ending.as_ref().is_ok_and(is_saddle)
}

fn is_saddle(found: &Equilibrium) -> bool {
    found.negative_eigenvalues.is_some_and(|count| count > 0)
}

/// The minimum below a saddle, or the last saddle from which nothing lower is reached.
pub(super) fn leave(run: &mut Run<'_>, ending: Ending) -> Ending {
    let mut found = ending?;
    for _ in 0..MOST_SADDLES {
        let energy = found.energy;
        if is_saddle(&found) {
            found = lower_side(run, found)?;
        }
        if found.energy == energy {
            break;
        }
    }
    Ok(found)
}

/// The lower one of the equilibria on both sides of a saddle; the saddle itself where none is lower.
fn lower_side(run: &mut Run<'_>, saddle: Equilibrium) -> Ending {
    let Some(step) = leaving_step(&run.model, &saddle) else { return Ok(saddle) };
    let (place, x, tension) = (run.model.clone(), saddle.x.clone(), saddle.tension.clone());
    let mut found = Ok(saddle);
    for side in [1.0, -1.0] {
        let beside = |run: &mut Run<'_>| {
            run.model.clone_from(&place);
            Some(run.minimize(Start { x: moved(&x, side, &step), tension: Some(tension.clone()) }))
        };
        found = run.prefer(found, beside, is_better);
    }
    found
}

/// A step along a motion on which the energy of a saddle falls.
fn leaving_step(model: &Model, saddle: &Equilibrium) -> Option<Vec<f64>> {
    let mut tangent = Tangent::at_state(model, &saddle.x, &saddle.tension, HessianKind::Full).ok()?;
    model.hold(&saddle.tension, &mut tangent.at);
    let motion = tangent.falling_motion().ok()??;
    let length = max_abs(&motion) / model.unit_of_length();
    let size = larger(tangent.at.largest_measure_change(&motion), length);
    Some(motion.iter().map(|rate| LEAVING_STEP / size * rate).collect())
}
