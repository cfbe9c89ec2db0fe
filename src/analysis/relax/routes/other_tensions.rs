//! Tensions under which the residual says what it should: small beside the forces of soft terms, and without self
//! stress.

use super::straight_screw;
use crate::analysis::relax::certainty::rigid_over_others;
use crate::analysis::relax::run::{Ending, Run, is_interruption};
use crate::model::Domain;
use crate::solver::{Equilibrium, Options, Start, tension};

/// Largest force of a rigid measure over those of the others from which on it hides them.
const HIDING_FORCE_RATIO: f64 = 100.0;

/// Whether an equilibrium was reached by steps; a restarted one stays as it is.
pub(super) fn are_needed(run: &Run<'_>, ending: &Ending) -> bool {
    ending.is_ok() && run.has_moved()
}

/// The equilibrium with smaller residuals where tensions hide them. That of a straight screw is sought about an axis
/// that keeps its direction: with one that may turn Newton's method takes hundreds of steps and comes no nearer.
pub(super) fn relaxed(run: &mut Run<'_>, ending: Ending) -> Ending {
    let found = straight_screw::about_one_axis(run, ending?)?;
    let hidden =
        matches!(run.model.domain(), Domain::Screw) && rigid_over_others(&run.model, &found) > HIDING_FORCE_RATIO;
    let found = if hidden { refined(run, found)? } else { found };
    without_self_stress(run, found)
}

/// The equilibrium of a screw whose rigid measures are under so much tension that they hide what is left of the others'
/// forces, with these as small as residuals usually are; itself where that cannot be reached.
///
/// Next to zero curvature the rows of rigid measures are nearly dependent and their tensions grow without bound, and
/// residuals are measured against the largest force.
fn refined(run: &mut Run<'_>, found: Equilibrium) -> Ending {
    let start = Start { x: found.x.clone(), tension: Some(found.tension.clone()) };
    let options = Options { tolerance: run.options.tolerance / HIDING_FORCE_RATIO, ..run.options };
    let refine = |run: &mut Run<'_>| Some(run.recorder.minimize(&mut run.model, start, options));
    run.prefer(Ok(found), refine, |refined, _| refined.as_ref().map_or_else(is_interruption, |_| true))
}

/// The equilibrium without self stress. Where a self stress was large beside them, what was balanced to the
/// tolerance with it need not be so without: the iteration then goes on from there.
fn without_self_stress(run: &mut Run<'_>, found: Equilibrium) -> Ending {
    let settled = tension::settle(&run.model, &found);
    let met = found.history.last().is_some_and(|step| step.residual_force <= run.options.tolerance);
    if !met || settled.residuals.force <= run.options.tolerance {
        return Ok(found);
    }
    run.minimize(Start { x: found.x, tension: Some(settled.tension) })
}
