//! The path of minima on which the rest values move from those of the start to their targets.
//!
//! The start is an equilibrium where all rest values are its own. From there the path is followed as
//! [`solver::path`](crate::solver::path) does, as long as it is stable. At a branch point or a limit point the sheet
//! goes to the next minimum below, as one would in an experiment, and the path goes on from there. Where rigid bars
//! make the start singular, as that of a flat sheet, bars that stretch a little are taken along this path, and become
//! rigid along a second one.

use super::{saddle, soft_bars};
use crate::analysis::relax::run::{Ending, Run, is_better, is_interruption};
use crate::analysis::state::State;
use crate::model::{DrivenModel, Model};
use crate::solver::path::{ParametrizedProblem, PathSettings, PathState, reach};
use crate::solver::{Equilibrium, Failure, NewtonError, Problem, Start, Step};

/// Longest step in arc length, in mean edges: with 0.2 other branches are taken for the path.
const LONGEST_STEP: f64 = 0.05;
/// Number of steps, of paths and of minimisations between them, after which a path is given up.
const MOST_STEPS: usize = 2000;
/// Tolerance of the states on the way.
const TOLERANCE_ON_THE_WAY: f64 = 1e-9;
/// Parts of the whole way that are tried at once where no step of a path leads on.
const PARTS_OF_THE_WAY: [f64; 4] = [1.0 / 8.0, 1.0 / 16.0, 1.0 / 32.0, 1.0 / 64.0];
/// Part of the whole way by which a limit point is passed: the state at it is where two equilibria meet.
const BEYOND_LIMIT: f64 = 0.005;
/// Stiffness of bars that stretch a little, over that of the softest hinge.
const SOFT_RATIO: f64 = 1e4;

/// The equilibrium at the end of the path; the ending before where the path does not lead there, or to a state in which
/// the forces of rigid measures hide whether the others are balanced.
pub(super) fn follow(run: &mut Run<'_>, ending: Ending) -> Ending {
    let certain = |run: &mut Run<'_>| {
        let ending = followed(run)?;
        let is_hidden = ending.as_ref().is_ok_and(|found| soft_bars::hides_others(run, found));
        (!is_hidden).then_some(ending)
    };
    run.prefer(ending, certain, is_better)
}

/// The ending of the path, first with bars as they are; `None` where the path does not lead to the targets.
fn followed(run: &mut Run<'_>) -> Option<Ending> {
    let as_they_are = along_rests(run);
    if as_they_are.is_some() || !run.model.has_rigid_bars() || soft_bars::has_locks(run) {
        return as_they_are;
    }
    let stiffness = SOFT_RATIO * run.model.softest_hinge();
    run.soft_steps = 0..0;
    match run.with_soft_bars(SOFT_RATIO, true, along_rests)? {
        Ok(found) => {
            let bars: Vec<(usize, f64)> = run.model.rigid_bars().collect();
            along(run, &|model| DrivenModel::by_compliance(model, bars.clone(), [stiffness.recip(), 0.0]), found)
        }
        interrupted => Some(interrupted),
    }
}

/// Follows the path of rest values from the start of the relaxation.
fn along_rests(run: &mut Run<'_>) -> Option<Ending> {
    let x = run.begin_anew();
    let ends = [run.model.values(&x), run.model.rests()];
    from_minimum(run, &|model| DrivenModel::by_rests(model, ends.clone()), x)
}

/// Minimises at the beginning of a drive and follows the minimum to its target. `None` where there is none to follow.
pub(super) fn from_minimum(run: &mut Run<'_>, drive: &dyn Fn(Model) -> DrivenModel, x: Vec<f64>) -> Option<Ending> {
    let begin = drive(run.model.clone()).parameter();
    drive_to(run, drive, begin);
    let begun = run.minimize(x);
    if let Ok(found) = begun {
        return along(run, drive, found);
    }
    let target = drive(run.model.clone()).target();
    drive_to(run, drive, target);
    begun.err().filter(is_interruption).map(Err)
}

/// Follows a path of minima from a start to its target, where it ends with a minimum. `None` where it does not lead
/// there; the model is left at the target.
fn along(run: &mut Run<'_>, drive: &dyn Fn(Model) -> DrivenModel, start: Equilibrium) -> Option<Ending> {
    let ending = follow_minima(run, drive, start);
    let target = drive(run.model.clone()).target();
    drive_to(run, drive, target);
    ending
}

/// Takes the model to a value of the parameter.
fn drive_to(run: &mut Run<'_>, drive: &dyn Fn(Model) -> DrivenModel, parameter: f64) {
    let mut driven = drive(run.model.clone());
    driven.set_parameter(parameter);
    run.model = driven.model;
}

/// Follows a path while it is stable. Where it becomes unstable it is left to the lower side, and goes on from the
/// minimum there; where no step of the path leads on, as next to the apex of a screw, from a minimum a little farther.
fn follow_minima(run: &mut Run<'_>, drive: &dyn Fn(Model) -> DrivenModel, mut start: Equilibrium) -> Option<Ending> {
    let driven = drive(run.model.clone());
    let (mut parameter, target) = (driven.parameter(), driven.target());
    let first = run.recorder.steps();
    while run.recorder.steps() < first + MOST_STEPS {
        let (reached, place) = match stretch(run, drive, (parameter, start)) {
            Ok(reached) => reached,
            Err(interrupted) => return Some(Err(interrupted)),
        };
        let (model, x) = (run.model.clone(), place.x.clone());
        let found = if place.tension.is_some() { minimum(run, drive, reached, place) } else { None };
        let found = found.map(|found| (reached, found)).or_else(|| farther(run, drive, reached, (&model, &x)));
        match found? {
            (_, Err(interrupted)) => return Some(Err(interrupted)),
            (next, Ok(found)) if next == target => return Some(Ok(found)),
            (next, Ok(found)) => (parameter, start) = (next, found),
        }
    }
    None
}

/// The minimum next to a start at a parameter; `None` where none is found, an error where the observer asks to stop.
fn minimum(run: &mut Run<'_>, drive: &dyn Fn(Model) -> DrivenModel, parameter: f64, start: Start) -> Option<Ending> {
    drive_to(run, drive, parameter);
    let settled = run.minimize(start);
    let left = saddle::left(run, settled, &saddle::WAYS[..1]);
    let is_wanted = match &left {
        Ok(found) => found.negative_eigenvalues == Some(0),
        Err(error) => is_interruption(error),
    };
    is_wanted.then_some(left)
}

/// Minimises a little farther on the way from a state at which no step of the path leads on: as far as that succeeds.
/// Returns the parameter there with the ending; `None` where it succeeds nowhere.
fn farther(
    run: &mut Run<'_>,
    drive: &dyn Fn(Model) -> DrivenModel,
    from: f64,
    (place, x): (&Model, &[f64]),
) -> Option<(f64, Ending)> {
    let driven = drive(place.clone());
    let target = driven.target();
    let way = driven.parameter_scale() * (target - from).signum();
    PARTS_OF_THE_WAY.into_iter().find_map(|part| {
        let next = if (target - from).abs() <= (part * way).abs() { target } else { from + part * way };
        run.model.clone_from(place);
        minimum(run, drive, next, x.to_vec().into()).map(|ending| (next, ending))
    })
}

/// Follows a path from an equilibrium at a parameter as far as it is stable. Returns the parameter from which to go on,
/// and the last state, without tensions where no step leads on; an error where the observer asks to stop.
fn stretch(
    run: &mut Run<'_>,
    drive: &dyn Fn(Model) -> DrivenModel,
    (from, start): (f64, Equilibrium),
) -> Result<(f64, Start), NewtonError> {
    let (mut driven, recorder) = (drive(run.model.clone()), &mut run.recorder);
    driven.set_parameter(from);
    let target = driven.target();
    let settings = PathSettings {
        tolerance: TOLERANCE_ON_THE_WAY,
        max_step: LONGEST_STEP,
        steps: MOST_STEPS,
        target,
        ..PathSettings::default()
    };
    let begin = Start { x: start.x.clone(), tension: Some(start.tension.clone()) };
    let (mut interrupted, mut unstable, mut furthest) = (false, false, from);
    let reached = reach(&mut driven, begin, &settings, &mut |driven, state| {
        interrupted = !recorder.see(&step_of(driven, state), || State::new(&driven.model, &state.x, &state.tension));
        unstable = state.negative_eigenvalues.is_some_and(|count| count > 0);
        let goes_on = !interrupted && !unstable;
        if goes_on && (state.parameter - furthest) * (target - from) > 0.0 {
            furthest = state.parameter;
        }
        goes_on
    });
    let (parameter, leads_on, x, tension) = match reached {
        Err(_) => (from, unstable, start.x, start.tension),
        Ok((state, arrived)) => {
            let turned = (interrupted || unstable) && state.tangent.parameter * (target - from) < 0.0;
            // where the path turns back at a limit point, the next equilibrium is sought beyond it
            let beyond = furthest + BEYOND_LIMIT * driven.parameter_scale() * (target - from).signum();
            interrupted &= !arrived;
            run.model = driven.model;
            let parameter = if turned { beyond } else { state.parameter };
            (if arrived { target } else { parameter }, arrived || unstable, state.x, state.tension)
        }
    };
    if interrupted {
        return Err(NewtonError { failure: Failure::Interrupted, x, tension, history: vec![] });
    }
    Ok((parameter, Start { x, tension: leads_on.then_some(tension) }))
}

/// The record of a state of a path among the steps of a relaxation.
fn step_of(driven: &DrivenModel, state: &PathState) -> Step {
    let stored = state.tension.iter().zip(driven.compliance()).map(|(t, c)| 0.5 * c * t * t);
    Step {
        energy: driven.energy(&state.x) + stored.sum::<f64>(),
        residual_force: state.residual_force,
        residual_length: state.residual_length,
        fraction: 1.0,
        shift: 0.0,
        factorizations: state.iterations,
        solves: state.iterations,
        intrinsic: false,
    }
}
