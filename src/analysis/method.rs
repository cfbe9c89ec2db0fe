//! The choice between two methods of relaxation: Newton's method in the positions of the vertices, and in the fold
//! angles of a patch.
//!
//! In positions a small fold turns distant parts by large angles, and the number of iterations grows with the size of
//! the patch. In fold angles it does not (`cargo bench --bench intrinsic`). Positions are found from the angles
//! afterwards, and Newton's method in positions goes on from there: it needs one or two iterations and certifies the
//! result.

use super::recorder::Recorder;
use super::state::State;
use crate::model::intrinsic::{FoldedUp, IntrinsicModel, Unsupported};
use crate::model::{Elements, Model};
use crate::numerics::parallel;
use crate::numerics::vector::max_abs;
use crate::solver::constrained::{
    ConstrainedFailure, ConstrainedIterate, ConstrainedStep, Settings, minimize_constrained_iterates,
};
use crate::solver::inertia::in_words;
use crate::solver::{Equilibrium, Failure, Iterate, NewtonError, Options, Problem, Start, Step, minimize_iterates};
use std::num::NonZeroUsize;
use thiserror::Error;

/// Fewest interior vertices of a patch that [`Method::Auto`] relaxes in fold angles: smaller ones take next to no time
/// either way.
const FEWEST_VERTICES: usize = 400;
/// Fraction of the first step in positions up to which distant parts turn too far for it, so that fold angles are
/// faster (measured: `cargo bench --bench intrinsic`; rest angles along modes, 12 to 96 cells a side: 0.06 to 0.25;
/// random ones, for which positions are as fast up to 48 cells: 0.5 to 1).
const DAMPED: f64 = 0.25;
/// Largest fold angle of a result, in radians, beyond which faces have passed through each other.
const LARGEST_ANGLE: f64 = 1.01 * std::f64::consts::PI;

/// The unknowns of a relaxation.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Method {
    /// Positions; but fold angles for a patch with many vertices that starts without known tensions and of whose first
    /// step in positions no more than a quarter can be taken.
    #[default]
    Auto,
    /// Positions of the vertices.
    Vertices,
    /// Fold angles, wherever the model has such a form.
    Intrinsic,
}

/// Tolerance, number of steps, and method of a relaxation, and the states that are kept.
#[derive(Clone, Copy, Debug, Default)]
pub struct RelaxOptions {
    /// Tolerance and number of steps of Newton's method.
    pub newton: Options,
    /// The unknowns.
    pub method: Method,
    /// Which states on the way are kept: one in so many, the first and the last one included; none without it.
    pub keep_every: Option<NonZeroUsize>,
}

impl From<Options> for RelaxOptions {
    fn from(newton: Options) -> Self {
        Self { newton, method: Method::Auto, keep_every: None }
    }
}

/// Why a relaxation that was to be made in fold angles was made in positions alone.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
pub enum IntrinsicFailure {
    /// The model has no form in fold angles.
    #[error(transparent)]
    Unsupported(#[from] Unsupported),
    /// The iteration in fold angles did not converge.
    #[error(transparent)]
    Solver(#[from] ConstrainedFailure),
    /// Some edge is folded beyond a half turn.
    #[error("an edge is folded by {angle:.3} rad: faces have passed through each other")]
    FoldedThrough {
        /// The largest fold angle, in radians.
        angle: f64,
    },
    /// The state that was found is no minimum.
    #[error("the state found in fold angles is no minimum: {} negative eigenvalues", in_words(*negative))]
    Saddle {
        /// Number of negative eigenvalues, `None` where it is not known.
        negative: Option<usize>,
    },
    /// Newton's method in positions did not converge from the state that was found.
    #[error("the state found in fold angles was not confirmed in positions: {failure}")]
    NotConfirmed {
        /// Its reason.
        failure: Failure,
    },
}

/// Minimises in fold angles if the method says so, and confirms the result in positions. `history` receives the steps
/// that do not belong to the result. Returns `None` if that was not tried or failed, with the reason of the failure;
/// the model is then as it was.
pub(super) fn minimize_in_angles(
    model: &mut Model,
    start: &Start,
    (options, method): (Options, Method),
    recorder: &mut Recorder<'_>,
    history: &mut Vec<Step>,
) -> (Option<Result<Equilibrium, NewtonError>>, Option<IntrinsicFailure>) {
    let intrinsic = match form(model, start, method) {
        Ok(None) => return (None, None),
        Ok(Some(intrinsic)) => intrinsic,
        Err(reason) => return (None, Some(reason.into())),
    };
    let (angles, coordinates) = (model.angles(), model.coordinates(&start.x));
    let reset = |model: &mut Model| {
        model.set_angles(&angles);
        model.start_from(coordinates.clone());
    };
    if method == Method::Auto {
        match minimize_unless_damped(model, start, options, recorder) {
            Ok(found) => return (Some(found), None),
            Err(steps) => history.extend(steps),
        }
        reset(model);
    }
    let found = solve(&intrinsic, model, start, recorder, history).and_then(|near| {
        match recorder.minimize(model, near, options) {
            Ok(found) if found.negative_eigenvalues == Some(0) => Ok(Ok(found)),
            Ok(found) => Err(IntrinsicFailure::Saddle { negative: found.negative_eigenvalues }),
            Err(error) if error.failure == Failure::Interrupted => Ok(Err(error)),
            Err(error) => Err(IntrinsicFailure::NotConfirmed { failure: error.failure }),
        }
    });
    match found {
        Ok(found) => (Some(found), None),
        Err(IntrinsicFailure::Solver(ConstrainedFailure::Interrupted)) => {
            let tension = vec![0.0; model.compliance().len()];
            let error = NewtonError { failure: Failure::Interrupted, x: start.x.clone(), tension, history: vec![] };
            (Some(Err(error)), None)
        }
        Err(reason) => {
            // what did not confirm the state does not belong to the history
            recorder.forget_after(history.len());
            reset(model);
            (None, Some(reason))
        }
    }
}

/// Minimises in positions, unless no more than a part of the first step can be taken; then the steps are returned.
fn minimize_unless_damped(
    model: &mut Model,
    start: &Start,
    options: Options,
    recorder: &mut Recorder<'_>,
) -> Result<Result<Equilibrium, NewtonError>, Vec<Step>> {
    let (mut steps, mut damped) = (0, false);
    let found = minimize_iterates(model, start.clone(), options, &mut |at: &Iterate<'_, Model>| {
        let go_on = recorder.see(at.step, || State::new(at.problem, at.x, at.tension));
        damped = go_on && steps == 1 && at.step.fraction <= DAMPED;
        steps += 1;
        go_on && !damped
    });
    match found {
        Err(error) if damped => Err(error.history),
        found => Ok(found),
    }
}

/// Returns the model in fold angles, if the method asks for it.
fn form(model: &Model, start: &Start, method: Method) -> Result<Option<IntrinsicModel>, Unsupported> {
    match method {
        Method::Vertices => Ok(None),
        Method::Intrinsic => IntrinsicModel::new(model).map(Some),
        // a start that knows its tensions is next to a solution
        Method::Auto if start.tension.is_some() || !model.is_free_patch() => Ok(None),
        Method::Auto => {
            let form = IntrinsicModel::new(model).ok();
            Ok(form.filter(|form| form.interior_vertices() >= FEWEST_VERTICES))
        }
    }
}

/// Solves in fold angles, and moves the model to the state found. Returns it as a start.
fn solve(
    intrinsic: &IntrinsicModel,
    model: &mut Model,
    start: &Start,
    recorder: &mut Recorder<'_>,
    history: &mut Vec<Step>,
) -> Result<Start, IntrinsicFailure> {
    let shown = &*model;
    let mut seen = |at: &ConstrainedIterate<'_>| {
        let step = step_of(at.step);
        history.push(step);
        recorder.see(&step, || state_of(intrinsic, shown, at))
    };
    let z = intrinsic.variables(model, &start.x);
    // what confirms the result in positions needs the analysis of their couplings
    let analyse = || _ = model.layout().tearing();
    let large = model.compliance().len() >= parallel::FEWEST_SHARED_ELEMENTS;
    let minimize = || minimize_constrained_iterates(intrinsic, z, Settings::default(), &mut seen);
    let found = parallel::meanwhile(large, analyse, minimize).map_err(|error| error.failure)?;
    let angle = max_abs(&intrinsic.fold_angles(&found.z));
    if !(angle <= LARGEST_ANGLE) {
        return Err(IntrinsicFailure::FoldedThrough { angle });
    }
    Ok(intrinsic.hand_over(model, &found.z, &found.multipliers))
}

/// Returns the state of these fold angles and lengths. Tensions of rigid measures are those of the multipliers.
fn state_of(intrinsic: &IntrinsicModel, model: &Model, at: &ConstrainedIterate<'_>) -> State {
    let FoldedUp { coordinates, angles, lengths, torques, forces } = intrinsic.folded_up(model, at.z, at.multipliers);
    let value = |term: &dyn Elements, k: usize| {
        let of_edges = if term.is_angle() { &angles } else { &lengths };
        of_edges[term.edge(k)]
    };
    let tension = |row: usize, term: &dyn Elements, k: usize| match model.compliance()[row] {
        0.0 if term.is_angle() => torques[term.edge(k)],
        0.0 => forces[term.edge(k)],
        compliance => (value(term, k) - term.spring(k).rest) / compliance,
    };
    State { coordinates, ..State::of_measures(model, value, tension) }
}

fn step_of(step: &ConstrainedStep) -> Step {
    Step {
        energy: step.value,
        residual_force: step.imbalance,
        residual_length: step.violation,
        fraction: step.fraction,
        shift: 0.0,
        factorizations: step.factorizations,
        solves: step.solves,
        intrinsic: true,
    }
}
