//! Starts from which a sheet can leave on several branches: flat sheets, above all.
//!
//! Several branches of rigid folding meet in a flat state. With rigid bars no motion relieves the torques of the
//! creases to first order there, and Newton's method cannot choose a branch, since it sees the first order only. Bars
//! that stretch a little can: the torques push the sheet out of its plane, and it comes to rest on the branch that its
//! rest angles favour. From there it is followed while the bars are made stiffer, until they are rigid.
//!
//! A pattern may have no rigid fold that relieves all its torques: that of three creases that meet at angles of 120
//! degrees has none at all. Let an angle `a` stretch the bars by `a^2`, as near a flat vertex that does not fold
//! rigidly. Then the minimum of `k a^4 - torque a` has an angle that falls as `k^(-1/3)` and bars whose tension `k a^2`
//! grows as `k^(1/3)`: the state tends to a rigid one, in which no tensions balance the torques. That is said, since no
//! iteration can converge to it.

use crate::analysis::relax::certainty::rigid_over_others;
use crate::analysis::relax::run::{Ending, Run, is_better, is_interruption};
use crate::math::fold_angle::FLAT_RAD;
use crate::model::{Model, TermKind};
use crate::numerics::vector::max_abs;
use crate::solver::{Equilibrium, Failure, NewtonError, Options, Start};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::ops::RangeInclusive;

/// Stiffnesses of the bars, one after the other, over that of the softest hinge. From 1e2 on or with three of them,
/// some flat-foldable patterns of 20 to 120 edges end in states of higher energy; from 1e4 on, some end in none.
pub(super) const RATIOS: [f64; 2] = [1e3, 1e5];
/// Tolerance of the states in between.
const INTERMEDIATE_TOLERANCE: f64 = 1e-6;
/// Further such ratios, tried where the state of the last of [`RATIOS`] does not lead to one of rigid bars, and the
/// tolerance of their states: the tensions of stiff bars are sensitive.
const FURTHER_RATIOS: [f64; 5] = [1e6, 1e7, 1e8, 1e9, 1e10];
const FURTHER_TOLERANCE: f64 = 1e-9;
/// Growth of the largest tension from one of the further ratios to the next that shows that it has no bound: 10^(1/3) =
/// 2.15 in theory. Where rigid bars have a balance it is 1, and 10 where the lengths of rigid bars cannot be met.
const UNBOUNDED_GROWTH: RangeInclusive<f64> = 1.5..=5.0;
/// Largest force of a rigid measure over those of the others above which a state next to the start is no equilibrium:
/// next to a state without balance it grows without bound, until rounding errors of the lengths hide the angles on
/// which it acts.
const DOUBTFUL_FORCE: f64 = 1e3;
/// Part of the energy of a flat start that a state must keep to be in doubt: most patterns lose more than a third of
/// it.
const DOUBTFUL_PART: f64 = 0.9;

/// A branch of rigid folding, by the creases and soft facets that have a rest angle other than 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[schemars(rename = "BranchChoiceSummary")]
pub struct FoldingBranch {
    /// Number of these creases and facets.
    pub hinges: usize,
    /// Number of those that are folded to the side of their rest angle.
    pub on_rest_side: usize,
    /// Whether rigid bars stretched on the way, since no motion relieves the torques at the start.
    pub soft_bars: bool,
}

impl FoldingBranch {
    /// Returns the branch of the state `x` of a model that was started with these angles; `None` if the start was
    /// neither flat nor singular, is flat still, or all rest angles are zero.
    pub(crate) fn of(model: &Model, x: &[f64], start: &[f64], soft_bars: bool) -> Option<Self> {
        let left = is_flat(start) && !is_flat(&model.configuration(x, None).angles);
        let (hinges, on_rest_side, _) = if left || soft_bars { model.hinges_on_rest_side(x) } else { (0, 0, 0.0) };
        (hinges > 0).then_some(Self { hinges, on_rest_side, soft_bars })
    }
}

fn is_flat(angles: &[f64]) -> bool {
    angles.iter().all(|angle| angle.abs() <= FLAT_RAD)
}

/// Whether nothing relieves the forces of the start to first order, as in a flat sheet with rigid bars.
pub(super) fn is_singular(run: &Run<'_>, ending: &Ending) -> bool {
    ending.as_ref().is_err_and(|error| error.failure == Failure::SingularStart) && run.model.has_rigid_bars()
}

/// Whether the way with rigid bars ended in doubt: from a flat start it failed, or relieved next to nothing, since
/// Newton's method chose a branch there that it saw to first order only; or rigid measures could not be met, which next
/// to a flat state may be so at second order, to which bars that stretch find their way.
pub(super) fn is_in_doubt(run: &Run<'_>, ending: &Ending) -> bool {
    if run.is_restarted() || !run.soft_steps.is_empty() || !run.model.has_rigid_bars() {
        return false;
    }
    match ending {
        Ok(found) => is_flat(&run.start.angles) && hardly_relieved(run, found),
        Err(error) => match error.failure {
            Failure::Interrupted | Failure::SingularStart => false,
            Failure::Infeasible { .. } => is_flat(&run.start.angles) || !has_locks(run),
            _ => is_flat(&run.start.angles),
        },
    }
}

/// Whether forces of rigid measures hide whether the others are balanced.
pub(super) fn hides_others(run: &Run<'_>, found: &Equilibrium) -> bool {
    rigid_over_others(&run.model, found) > DOUBTFUL_FORCE
}

/// Whether creases are locked: bars that stretch might find their way to another branch than the one that a lock
/// drives.
pub(super) fn has_locks(run: &Run<'_>) -> bool {
    run.model.stiff().any(|element| element.kind() == TermKind::Locks)
}

/// Whether an equilibrium keeps nearly all of the energy of the start, which has some.
fn hardly_relieved(run: &Run<'_>, found: &Equilibrium) -> bool {
    run.start_energy > 0.0 && found.energy > DOUBTFUL_PART * run.start_energy
}

/// Leaves the start by soft bars, where that is better than the way with rigid ones.
pub(super) fn leave_if_better(run: &mut Run<'_>, ending: Ending) -> Ending {
    let forced = ending.as_ref().is_ok_and(|found| hides_others(run, found));
    run.prefer(
        ending,
        |run| Some(from_the_start(run, &RATIOS)),
        |left, before| match (left, before) {
            (Err(NewtonError { failure: Failure::Unbounded { .. }, .. }), before) => before.is_err() || forced,
            _ => is_better(left, before),
        },
    )
}

/// Leaves a singular start by soft bars.
pub(super) fn leave(run: &mut Run<'_>, _: Ending) -> Ending {
    run.soft_steps = 0..run.recorder.steps();
    from_the_start(run, &RATIOS)
}

/// Relaxes from the start with bars that stretch, then with rigid ones.
pub(super) fn from_the_start(run: &mut Run<'_>, ratios: &[f64]) -> Ending {
    let start = run.begin_anew();
    from(run, &start, ratios)
}

/// Relaxes from these unknowns with bars that stretch, then with those of the sheet, which are rigid or very stiff.
pub(super) fn from(run: &mut Run<'_>, x: &[f64], ratios: &[f64]) -> Ending {
    let mut coordinates = run.model.coordinates(x);
    let loose = Options { tolerance: INTERMEDIATE_TOLERANCE, ..run.options };
    for &ratio in ratios {
        coordinates = match with_soft_bars(run, ratio, (&coordinates, None), loose) {
            Ok(found) => run.model.coordinates(&found.x),
            Err(error) if is_interruption(&error) => return Err(error),
            // the last state that was accepted is nearer than the one before
            Err(error) => run.model.coordinates(&error.x),
        };
    }
    let (x, steps) = (run.model.start_from(coordinates.clone()), run.recorder.steps());
    let found = run.minimize(x);
    if is_certain(run, &found) {
        return found;
    }
    let (soft_steps, from) = (run.soft_steps.clone(), coordinates.clone());
    run.recorder.forget_after(steps);
    if let Some(verdict) = stiffen(run, coordinates) {
        return verdict;
    }
    run.recorder.forget_after(steps);
    run.soft_steps = soft_steps;
    let x = run.model.start_from(from);
    run.minimize(x)
}

/// Whether a way was interrupted, or ended in an equilibrium that is no start without balance.
fn is_certain(run: &Run<'_>, ending: &Ending) -> bool {
    match ending {
        Ok(found) => !(hardly_relieved(run, found) && hides_others(run, found)),
        Err(error) => is_interruption(error),
    }
}

/// Minimises from these coordinates, and tensions if they are known, while the rigid bars have this stiffness over that
/// of the softest hinge.
fn with_soft_bars(
    run: &mut Run<'_>,
    ratio: f64,
    (coordinates, tension): (&[f64], Option<&Vec<f64>>),
    options: Options,
) -> Ending {
    run.with_soft_bars(ratio, false, |run| {
        let x = run.model.start_from(coordinates.to_vec());
        run.recorder.minimize(&mut run.model, Start { x, tension: tension.cloned() }, options)
    })
}

/// Follows a state of soft bars, from which that of rigid ones was not reached, or not without doubt, while the bars
/// are made much stiffer. `None` where that tells nothing more.
fn stiffen(run: &mut Run<'_>, mut coordinates: Vec<f64>) -> Option<Ending> {
    let (mut tension, mut largest) = (None, vec![]);
    let exact = Options { tolerance: FURTHER_TOLERANCE, ..run.options };
    for ratio in FURTHER_RATIOS {
        let (steps, soft_steps) = (run.recorder.steps(), run.soft_steps.clone());
        let mut reached = with_soft_bars(run, ratio, (&coordinates, tension.as_ref()), exact);
        // where known tensions lead nowhere, others may
        if reached.as_ref().is_err_and(|error| !is_interruption(error)) && tension.is_some() {
            run.recorder.forget_after(steps);
            reached = with_soft_bars(run, ratio, (&coordinates, None), exact);
        }
        let found = match reached {
            Ok(found) if found.negative_eigenvalues == Some(0) => found,
            Err(error) if is_interruption(&error) => return Some(Err(error)),
            _ => {
                run.recorder.forget_after(steps);
                run.soft_steps = soft_steps;
                break;
            }
        };
        (coordinates, tension) = (run.model.coordinates(&found.x), Some(found.tension));
        largest.push(tension.as_deref().map_or(0.0, max_abs));
        let (x, steps) = (run.model.start_from(coordinates.clone()), run.recorder.steps());
        let rigid = run.minimize(Start { x, tension: tension.clone() });
        if is_certain(run, &rigid) {
            return Some(rigid);
        }
        run.recorder.forget_after(steps);
    }
    let growth = unbounded_growth(&largest)?;
    let x = run.model.start_from(coordinates);
    Some(Err(NewtonError { failure: Failure::Unbounded { growth }, x, tension: tension?, history: vec![] }))
}

/// Returns the last growth of these largest tensions, if the last two are those of tensions without bound.
fn unbounded_growth(largest: &[f64]) -> Option<f64> {
    let [a, b, c] = *largest.last_chunk()?;
    [b / a, c / b].iter().all(|growth| UNBOUNDED_GROWTH.contains(growth)).then_some(c / b)
}
