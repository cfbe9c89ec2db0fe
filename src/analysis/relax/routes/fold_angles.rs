//! Newton's method in the fold angles of a patch.
//!
//! In positions a small fold turns distant parts by large angles, and the number of iterations grows with the size of
//! the patch. In fold angles it does not (`cargo bench --bench intrinsic`). Positions are found from the angles
//! afterwards, and Newton's method in positions goes on from there: it needs one or two iterations and certifies the
//! result.

use super::has_failed;
use crate::analysis::relax::options::{IntrinsicFailure, Method};
use crate::analysis::relax::run::{Ending, Run, is_interruption};
use crate::analysis::state::State;
use crate::model::intrinsic::{FoldedUp, IntrinsicModel, Unsupported};
use crate::model::{Element, Model};
use crate::numerics::parallel;
use crate::numerics::vector::max_abs;
use crate::solver::constrained::{ConstrainedFailure, ConstrainedIterate, minimize_constrained};
use crate::solver::{Failure, Iterate, NewtonError, Problem, Start, minimize_iterates};

/// Fewest interior vertices of a patch that [`Method::Auto`] relaxes in fold angles: smaller ones take next to no time
/// either way.
const FEWEST_VERTICES: usize = 400;
/// Fraction of the first step in positions up to which distant parts turn too far for it, so that fold angles are
/// faster (measured: `cargo bench --bench intrinsic`; rest angles along modes, 12 to 96 cells a side: 0.06 to 0.25;
/// random ones, for which positions are as fast up to 48 cells: 0.5 to 1).
const DAMPED: f64 = 0.25;
/// Largest fold angle of a result, in radians, beyond which faces have passed through each other.
const LARGEST_ANGLE_RAD: f64 = 1.01 * std::f64::consts::PI;

/// Begins a relaxation: in fold angles where the method says so, and in positions elsewhere or where they fail.
pub(crate) fn begin(run: &mut Run<'_>, mut start: Start) -> Ending {
    let failure = match form(run, &start) {
        Ok(None) => return run.minimize(start),
        Ok(Some(intrinsic)) => {
            if run.method == Method::Auto {
                if let Some(ending) = minimize_unless_damped(run, &start) {
                    return ending;
                }
                start.x = run.begin_anew();
            }
            match solved_and_confirmed(&intrinsic, run, &start) {
                Ok(ending) => return ending,
                Err(failure) => failure,
            }
        }
        Err(reason) => reason.into(),
    };
    run.intrinsic_failure = Some(failure);
    start.x = run.begin_anew();
    run.minimize(start)
}

/// Whether the method leaves the choice to try fold angles where positions failed, and they have not been tried.
pub(super) fn may_help(run: &Run<'_>, ending: &Ending) -> bool {
    let is_open = run.method == Method::Auto && run.intrinsic_failure.is_none() && !run.is_restarted();
    is_open && has_failed(run, ending) && run.model.takes_any_shape()
}

/// The equilibrium that fold angles reach from the same start; the failure in positions where they reach none.
pub(super) fn from_the_start(run: &mut Run<'_>, ending: Ending) -> Ending {
    let Ok(intrinsic) = IntrinsicModel::new(&run.model) else { return ending };
    let in_angles = |run: &mut Run<'_>| {
        let start = Start::from(run.begin_anew());
        solved_and_confirmed(&intrinsic, run, &start).map_err(|failure| run.intrinsic_failure = Some(failure)).ok()
    };
    run.prefer(ending, in_angles, |_, _| true)
}

/// Minimises in fold angles, and confirms the result in positions.
fn solved_and_confirmed(
    intrinsic: &IntrinsicModel,
    run: &mut Run<'_>,
    start: &Start,
) -> Result<Ending, IntrinsicFailure> {
    let failure = match solve(intrinsic, run, start) {
        Err(IntrinsicFailure::Solver(ConstrainedFailure::Interrupted)) => {
            let tension = vec![0.0; run.model.compliance().len()];
            let (failure, x) = (Failure::Interrupted, start.x.clone());
            return Ok(Err(NewtonError { failure, x, tension, history: vec![] }));
        }
        Err(failure) => failure,
        Ok(near) => {
            let steps = run.recorder.steps();
            let failure = match run.minimize(near) {
                Ok(found) if found.negative_eigenvalues == Some(0) => return Ok(Ok(found)),
                Ok(found) => IntrinsicFailure::Saddle { negative: found.negative_eigenvalues },
                Err(error) if is_interruption(&error) => return Ok(Err(error)),
                Err(error) => IntrinsicFailure::NotConfirmed { failure: error.failure },
            };
            // what did not confirm the state does not belong to the history
            run.recorder.forget_after(steps);
            failure
        }
    };
    Err(failure)
}

/// Minimises in positions; `None` where no more than a part of the first step can be taken.
fn minimize_unless_damped(run: &mut Run<'_>, start: &Start) -> Option<Ending> {
    let (mut steps, mut damped) = (0, false);
    let recorder = &mut run.recorder;
    let ending = minimize_iterates(&mut run.model, start.clone(), run.options, &mut |at: &Iterate<'_, Model>| {
        let go_on = recorder.see(at.step, || State::new(at.problem, at.x, at.tension));
        damped = go_on && steps == 1 && at.step.fraction <= DAMPED;
        steps += 1;
        go_on && !damped
    });
    if damped { None } else { Some(ending) }
}

/// Returns the model in fold angles, if the method asks for it.
fn form(run: &Run<'_>, start: &Start) -> Result<Option<IntrinsicModel>, Unsupported> {
    match run.method {
        Method::Vertices => Ok(None),
        Method::Intrinsic => IntrinsicModel::new(&run.model).map(Some),
        // a start that knows its tensions is next to a solution
        Method::Auto if start.tension.is_some() || !run.model.takes_any_shape() => Ok(None),
        Method::Auto => {
            let form = IntrinsicModel::new(&run.model).ok();
            Ok(form.filter(|form| form.interior_vertices() >= FEWEST_VERTICES))
        }
    }
}

/// Solves in fold angles, and moves the model to the state found. Returns it as a start.
fn solve(intrinsic: &IntrinsicModel, run: &mut Run<'_>, start: &Start) -> Result<Start, IntrinsicFailure> {
    let (shown, recorder) = (&run.model, &mut run.recorder);
    let mut seen = |at: &ConstrainedIterate<'_>| recorder.see(at.step, || state_of(intrinsic, shown, at));
    let z = intrinsic.variables(shown, &start.x);
    // what confirms the result in positions needs the analysis of their couplings
    let analyse = || _ = shown.layout().tearing();
    let large = shown.compliance().len() >= parallel::FEWEST_SHARED_ELEMENTS;
    let minimize = || minimize_constrained(intrinsic, z, &mut seen);
    let found = parallel::meanwhile(large, analyse, minimize).map_err(|error| error.failure)?;
    let angle = max_abs(&intrinsic.measures(&found.z)[0]);
    if !(angle <= LARGEST_ANGLE_RAD) {
        return Err(IntrinsicFailure::FoldedThrough { angle });
    }
    Ok(intrinsic.hand_over(&mut run.model, &found.z, &found.multipliers))
}

/// Returns the state of these fold angles and lengths. Tensions of rigid measures are those of the multipliers.
fn state_of(intrinsic: &IntrinsicModel, model: &Model, at: &ConstrainedIterate<'_>) -> State {
    let FoldedUp { coordinates, angles, lengths, torques, forces } = intrinsic.folded_up(model, at.z, at.multipliers);
    let on_edge = |element: &Element<'_>, of_edges: &[f64]| element.edge().map_or(f64::NAN, |edge| of_edges[edge]);
    let value = |element: &Element<'_>| on_edge(element, if element.is_angle() { &angles } else { &lengths });
    let tension = |row: usize, element: &Element<'_>| match model.compliance()[row] {
        0.0 if element.is_angle() => on_edge(element, &torques),
        0.0 => on_edge(element, &forces),
        compliance => (value(element) - element.spring.rest) / compliance,
    };
    State { coordinates, ..State::of_measures(model, value, tension) }
}
