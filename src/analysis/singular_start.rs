//! Starts from which a sheet can leave on several branches: flat sheets, above all.
//!
//! Several branches of rigid folding meet in a flat state. With rigid bars no motion relieves the torques of the creases
//! to first order there, and Newton's method cannot choose a branch, since it sees the first order only. Bars that
//! stretch a little can: the torques push the sheet out of its plane, and it comes to rest on the branch that its rest
//! angles favour. From there it is followed while the bars are made stiffer, until they are rigid.
//!
//! A pattern may have no rigid fold that relieves all its torques: that of three creases that meet at angles of 120
//! degrees has none at all. Let an angle `a` stretch the bars by `a^2`, as near a flat vertex that does not fold rigidly. Then
//! the minimum of `k a^4 - torque a` has an angle that falls as `k^(-1/3)` and bars whose tension `k a^2` grows as `k^(1/3)`:
//! the state tends to a rigid one, in which no tensions balance the torques. That is said, since no iteration can
//! converge to it.

use super::recorder::Recorder;
use super::rigid_forces::rigid_over_others;
use crate::model::{Model, TermKind};
use crate::numerics::vector::max_abs;
use crate::solver::{Equilibrium, Failure, NewtonError, Options, Start, Step};
use std::ops::{Range, RangeInclusive};

/// Stiffnesses of the bars, one after the other, over that of the softest hinge. From 1e2 on or with three of them, some
/// flat-foldable patterns of 20 to 120 edges end in states of higher energy; from 1e4 on, some end in none.
const RATIOS: [f64; 2] = [1e3, 1e5];
/// Tolerance of the states in between.
const INTERMEDIATE_TOLERANCE: f64 = 1e-6;
/// Further such ratios, tried where the state of the last of [`RATIOS`] does not lead to one of rigid bars, and the tolerance of
/// their states: the tensions of stiff bars are sensitive.
const FURTHER_RATIOS: [f64; 5] = [1e6, 1e7, 1e8, 1e9, 1e10];
const FURTHER_TOLERANCE: f64 = 1e-9;
/// Growth of the largest tension from one of the further ratios to the next that shows that it has no bound: 10^(1/3) = 2.15 in
/// theory. Where rigid bars have a balance it is 1, and 10 where the lengths of rigid bars cannot be met.
const UNBOUNDED_GROWTH: RangeInclusive<f64> = 1.5..=5.0;
/// Largest force of a rigid measure over those of the others above which a state next to the start is no equilibrium: next to a
/// state without balance it grows without bound, until rounding errors of the lengths hide the angles on which it acts.
const DOUBTFUL_FORCE: f64 = 1e3;
/// Part of the energy of a flat start that a state must keep to be in doubt: most patterns lose more than a third of it.
const DOUBTFUL_PART: f64 = 0.9;
/// Relative fall of the energy that rounding errors do not explain.
const LOWER: f64 = 1e-10;
/// Largest magnitude of a fold angle, in radians, at which a hinge counts as flat.
const FLAT_RAD: f64 = 1e-9;

/// The branch on which a flat or singular start was left.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BranchChoice {
    /// Number of soft hinges whose rest angle is not zero.
    pub hinges: usize,
    /// Number of those that fold to the side of their rest angle.
    pub on_rest_side: usize,
    /// Whether rigid bars stretched on the way, because the start was singular.
    pub soft_bars: bool,
}

impl BranchChoice {
    /// Returns the branch of the state `x` of a model that was started with these angles; `None` if the start was
    /// neither flat nor singular, or all rest angles are zero.
    pub(super) fn of(model: &Model, x: &[f64], start: &[f64], soft_bars: bool) -> Option<Self> {
        let flat = is_flat(start);
        let [hinges, on_rest_side] = if flat || soft_bars { model.hinges_on_rest_side(x) } else { [0, 0] };
        (hinges > 0).then_some(Self { hinges, on_rest_side, soft_bars })
    }
}

fn is_flat(angles: &[f64]) -> bool {
    angles.iter().all(|angle| angle.abs() <= FLAT_RAD)
}

/// The coordinates, the hinges' angles and the energy of a start.
pub(super) struct Origin {
    pub(super) place: Vec<f64>,
    pub(super) angles: Vec<f64>,
    pub(super) energy: f64,
}

impl Origin {
    /// Whether a state keeps nearly all of the energy of this start, which has some.
    fn hardly_relieved(&self, found: &Equilibrium) -> bool {
        self.energy > 0.0 && found.energy > DOUBTFUL_PART * self.energy
    }
}

/// Leaves a flat start, or one from which rigid measures cannot be met, by soft bars where the way with rigid ones ended in doubt: it failed, or it relieved next to nothing,
/// since Newton's method chose a branch there that it saw to first order only. Returns what is better, and which steps of the
/// history were made with bars that stretch.
pub(super) fn leave_if_in_doubt(
    model: &mut Model,
    mut found: Result<Equilibrium, NewtonError>,
    origin: &Origin,
    options: Options,
    recorder: &mut Recorder<'_>,
    history: &mut Vec<Step>,
) -> (Result<Equilibrium, NewtonError>, Range<usize>) {
    let in_doubt = match &found {
        Ok(found) => origin.hardly_relieved(found),
        Err(error) => !matches!(error.failure, Failure::Interrupted | Failure::SingularStart),
    };
    // next to a flat state rigid measures may be met only at second order, which bars that stretch find their way to; from a lock they
    // might find their way to another branch than the one that it drives
    let infeasible = matches!(&found, Err(NewtonError { failure: Failure::Infeasible { .. }, .. }))
        && model.stiff().iter().all(|term| term.kind() != TermKind::Locks);
    if !(in_doubt && (infeasible || is_flat(&origin.angles)) && model.has_rigid_bars()) {
        return (found, 0..0);
    }
    let (here, seen, mut soft) = (model.place(), recorder.steps(), vec![]);
    let forced = found.as_ref().is_ok_and(|found| rigid_over_others(model, found) > DOUBTFUL_FORCE);
    model.set_angles(&origin.angles);
    let left = leave(model, origin, options, recorder, &mut soft);
    let better = match (&left, &found) {
        (Ok(left), Ok(found)) => found.energy - left.energy > LOWER * found.energy.abs(),
        (Ok(_), Err(_)) => true,
        (Err(error), Err(_)) => matches!(error.failure, Failure::Interrupted | Failure::Unbounded { .. }),
        (Err(error), Ok(_)) => {
            let unbounded = matches!(error.failure, Failure::Unbounded { .. });
            error.failure == Failure::Interrupted || unbounded && forced
        }
    };
    if !better {
        recorder.forget_after(seen);
        model.go_to(&here);
        return (found, 0..0);
    }
    history.append(match &mut found {
        Ok(found) => &mut found.history,
        Err(error) => &mut error.history,
    });
    let first = history.len();
    history.append(&mut soft);
    (left, first..history.len())
}

/// Relaxes a model from a singular start of its rigid bars. `history` receives the steps with bars
/// that stretch.
///
/// # Errors
/// [`NewtonError`] of the model with rigid bars, [`Failure::Unbounded`] where its forces cannot balance, or
/// [`Failure::Interrupted`].
pub(super) fn leave(
    model: &mut Model,
    origin: &Origin,
    options: Options,
    recorder: &mut Recorder<'_>,
    history: &mut Vec<Step>,
) -> Result<Equilibrium, NewtonError> {
    let mut place = origin.place.clone();
    let loose = Options { tolerance: INTERMEDIATE_TOLERANCE, ..options };
    for ratio in RATIOS {
        match with_soft_bars(model, ratio, (&place, None), loose, recorder) {
            Ok(found) => {
                place = model.coordinates(&found.x);
                history.extend(found.history);
            }
            Err(error) if error.failure == Failure::Interrupted => return Err(error),
            // the last state that was accepted is nearer than the one before
            Err(error) => {
                place = model.coordinates(&error.x);
                history.extend(error.history);
            }
        }
    }
    let (x, seen) = (model.start_from(place.clone()), recorder.steps());
    let found = recorder.minimize(model, x, options);
    if is_certain(model, origin, &found) {
        return found;
    }
    let steps = history.len();
    recorder.forget_after(seen);
    if let Some(verdict) = stiffen(model, (origin, place.clone()), options, recorder, history) {
        return verdict;
    }
    history.truncate(steps);
    recorder.forget_after(seen);
    let x = model.start_from(place);
    recorder.minimize(model, x, options)
}

/// Whether a way was interrupted, or ended in an equilibrium that is no start without balance.
fn is_certain(model: &Model, origin: &Origin, found: &Result<Equilibrium, NewtonError>) -> bool {
    match found {
        Ok(found) => !(origin.hardly_relieved(found) && rigid_over_others(model, found) > DOUBTFUL_FORCE),
        Err(error) => error.failure == Failure::Interrupted,
    }
}

/// Minimises from these coordinates, and tensions if they are known, while the rigid bars have this stiffness over that
/// of the softest hinge.
fn with_soft_bars(
    model: &mut Model,
    ratio: f64,
    (place, tension): (&[f64], Option<&Vec<f64>>),
    options: Options,
    recorder: &mut Recorder<'_>,
) -> Result<Equilibrium, NewtonError> {
    model.soften_rigid_bars(ratio * model.softest_hinge());
    let x = model.start_from(place.to_vec());
    let reached = recorder.minimize(model, Start { x, tension: tension.cloned() }, options);
    model.soften_rigid_bars(f64::INFINITY);
    reached
}

/// Follows a state of soft bars, from which that of rigid ones was not reached, or not without doubt, while the bars are made
/// much stiffer. `None` where that tells nothing more.
fn stiffen(
    model: &mut Model,
    (origin, mut place): (&Origin, Vec<f64>),
    options: Options,
    recorder: &mut Recorder<'_>,
    history: &mut Vec<Step>,
) -> Option<Result<Equilibrium, NewtonError>> {
    let (mut tension, mut largest) = (None, vec![]);
    let exact = Options { tolerance: FURTHER_TOLERANCE, ..options };
    for ratio in FURTHER_RATIOS {
        let seen = recorder.steps();
        let mut reached = with_soft_bars(model, ratio, (&place, tension.as_ref()), exact, recorder);
        // where known tensions lead nowhere, others may
        if reached.as_ref().is_err_and(|error| error.failure != Failure::Interrupted) && tension.is_some() {
            recorder.forget_after(seen);
            reached = with_soft_bars(model, ratio, (&place, None), exact, recorder);
        }
        let found = match reached {
            Ok(found) if found.negative_eigenvalues == Some(0) => found,
            Err(error) if error.failure == Failure::Interrupted => return Some(Err(error)),
            _ => {
                recorder.forget_after(seen);
                break;
            }
        };
        (place, tension) = (model.coordinates(&found.x), Some(found.tension));
        largest.push(tension.as_deref().map_or(0.0, max_abs));
        history.extend(found.history);
        let (x, seen) = (model.start_from(place.clone()), recorder.steps());
        let rigid = recorder.minimize(model, Start { x, tension: tension.clone() }, options);
        if is_certain(model, origin, &rigid) {
            return Some(rigid);
        }
        recorder.forget_after(seen);
    }
    let growth = unbounded_growth(&largest)?;
    let x = model.start_from(place);
    Some(Err(NewtonError { failure: Failure::Unbounded { growth }, x, tension: tension?, history: vec![] }))
}

/// Returns the last growth of these largest tensions, if the last two are those of tensions without bound.
fn unbounded_growth(largest: &[f64]) -> Option<f64> {
    let [a, b, c] = *largest.last_chunk()?;
    [b / a, c / b].iter().all(|growth| UNBOUNDED_GROWTH.contains(growth)).then_some(c / b)
}
