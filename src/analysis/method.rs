//! The choice between two methods of relaxation: Newton's method in the positions of the vertices, and in the fold
//! angles of a patch.
//!
//! In positions a small fold turns distant parts by large angles, and the number of iterations grows with the size of
//! the patch. In fold angles it does not (`cargo bench --bench intrinsic`). Positions are found from the angles
//! afterwards, and Newton's method in positions goes on from there: it needs one or two iterations and certifies the
//! result.

use crate::model::Model;
use crate::model::intrinsic::{IntrinsicModel, Unsupported};
use crate::numerics::parallel;
use crate::numerics::vector::max_abs;
use crate::solver::constrained::{ConstrainedFailure, ConstrainedStep, Settings, minimize_constrained};
use crate::solver::{Equilibrium, Failure, NewtonError, Options, Problem, Start, Step, minimize};
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

/// Tolerance, number of steps, and method of a relaxation.
#[derive(Clone, Copy, Debug, Default)]
pub struct RelaxOptions {
    /// Tolerance and number of steps of Newton's method.
    pub newton: Options,
    /// The unknowns.
    pub method: Method,
}

impl From<Options> for RelaxOptions {
    fn from(newton: Options) -> Self {
        Self { newton, method: Method::Auto }
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
    #[error("the state found in fold angles is no minimum: {negative} negative eigenvalues")]
    Saddle {
        /// Number of negative eigenvalues.
        negative: usize,
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
    observe: &mut dyn FnMut(&Step) -> bool,
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
        match minimize_unless_damped(model, start, options, observe) {
            Ok(found) => return (Some(found), None),
            Err(steps) => history.extend(steps),
        }
        reset(model);
    }
    let found = solve(&intrinsic, model, start, observe, history).and_then(|near| {
        match minimize(model, near, options, observe) {
            Ok(found) if found.negative_eigenvalues == 0 => Ok(Ok(found)),
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
    observe: &mut dyn FnMut(&Step) -> bool,
) -> Result<Result<Equilibrium, NewtonError>, Vec<Step>> {
    let (mut steps, mut damped) = (0, false);
    let found = minimize(model, start.clone(), options, &mut |step| {
        damped = steps == 1 && step.fraction <= DAMPED;
        steps += 1;
        !damped && observe(step)
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
    observe: &mut dyn FnMut(&Step) -> bool,
    history: &mut Vec<Step>,
) -> Result<Start, IntrinsicFailure> {
    let mut seen = |step: &ConstrainedStep| {
        history.push(step_of(step));
        observe(&step_of(step))
    };
    let z = intrinsic.variables(model, &start.x);
    // what confirms the result in positions needs the analysis of their couplings
    let analyse = || _ = model.layout().tearing();
    let large = model.compliance().len() >= parallel::FEWEST_SHARED_ELEMENTS;
    let minimize = || minimize_constrained(intrinsic, z, Settings::default(), &mut seen);
    let found = parallel::meanwhile(large, analyse, minimize).map_err(|error| error.failure)?;
    let angle = max_abs(&intrinsic.fold_angles(&found.z));
    if !(angle <= LARGEST_ANGLE) {
        return Err(IntrinsicFailure::FoldedThrough { angle });
    }
    Ok(intrinsic.hand_over(model, &found.z, &found.multipliers))
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
