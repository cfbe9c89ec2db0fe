//! Relaxation: from a start to the equilibrium of a model, directly or by raising what drives it step by step.

use super::state::State;
use crate::model::Model;
use crate::solver::{Equilibrium, Failure, NewtonError, Options, Start, Step, minimize, tension};
use thiserror::Error;

/// Smallest step of the continuation that is tried before giving up.
const LEAST_STEP: f64 = 1.0 / 64.0;
/// Tolerance of the states in between.
const LOOSE: f64 = 1e-6;

/// An equilibrium.
#[derive(Clone, Debug)]
pub struct Relaxed {
    /// The state.
    pub state: State,
    /// Unknowns, to start another study from.
    pub x: Vec<f64>,
    /// Tensions of the stiff measures, of least norm where they are not unique.
    pub tension: Vec<f64>,
    /// Accepted Newton steps, those of the continuation included.
    pub iterations: usize,
    /// Factorizations made.
    pub factorizations: usize,
    /// Solves made, chord corrections included.
    pub solves: usize,
    /// Largest unbalanced force over the largest force of an element.
    pub residual_force: f64,
    /// Largest `|L - L0 - t/k|` over the mean edge.
    pub residual_length: f64,
    /// Negative eigenvalues of the energy's Hessian on what rigid terms leave free.
    pub negative_eigenvalues: usize,
    /// Self stresses of the rigid measures; `None` where none is rigid.
    pub self_stresses: Option<usize>,
    /// All accepted steps.
    pub history: Vec<Step>,
}

/// Relaxation failed; the last accepted state is here.
#[derive(Debug, Error)]
#[error("{failure}")]
pub struct RelaxError {
    /// Why.
    pub failure: Failure,
    /// Last accepted state.
    pub state: State,
    /// Its unknowns.
    pub x: Vec<f64>,
    /// All accepted steps.
    pub history: Vec<Step>,
}

/// Relaxes from a start. `observe` sees every accepted step and returns false to stop.
///
/// Where the direct way fails, all rest angles and locked angles are moved from their values at the start to their
/// targets in steps that adapt.
pub fn relax(
    model: &mut Model,
    start: impl Into<Start>,
    options: Options,
    edges: usize,
    observe: &mut dyn FnMut(&Step) -> bool,
) -> Result<Relaxed, Box<RelaxError>> {
    let start = start.into();
    let origin = model.angles();
    let mut history = Vec::new();
    let found = match minimize(model, start.clone(), options, observe) {
        Err(error) if hopeless(error.failure) => Err(error),
        Err(error) => {
            model.set_angles(&origin);
            history.extend(error.history);
            follow(model, start.x, options, observe, &mut history)
        }
        found => found,
    };
    match found {
        Ok(equilibrium) => Ok(finish(model, equilibrium, history, edges)),
        Err(error) => {
            history.extend(error.history);
            let state = State::new(model, &error.x, &error.tension, edges);
            Err(Box::new(RelaxError { failure: error.failure, state, x: error.x, history }))
        }
    }
}

/// Failures that smaller steps cannot mend.
fn hopeless(failure: Failure) -> bool {
    matches!(failure, Failure::Interrupted | Failure::SingularStart)
}

/// Continuation in the rest values.
fn follow(
    model: &mut Model,
    start: Vec<f64>,
    options: Options,
    observe: &mut dyn FnMut(&Step) -> bool,
    history: &mut Vec<Step>,
) -> Result<Equilibrium, NewtonError> {
    let (targets, origin) = (model.rests(), model.values(&start));
    let (mut x, mut done, mut step) = (start, 0.0, 0.25);
    let loose = Options { tolerance: options.tolerance.max(LOOSE), iterations: options.iterations.min(50) };
    loop {
        let next = f64::min(done + step, 1.0);
        let angles = model.angles();
        model.set_rests(&origin, &targets, next);
        match minimize(model, x.clone(), if next < 1.0 { loose } else { options }, observe) {
            Ok(found) if next == 1.0 => return Ok(found),
            Ok(found) => {
                history.extend(found.history);
                (x, done, step) = (found.x, next, 2.0 * step);
            }
            Err(error) if error.failure == Failure::Interrupted || step <= LEAST_STEP => {
                model.set_rests(&origin, &targets, 1.0);
                return Err(error);
            }
            Err(error) => {
                history.extend(error.history);
                model.set_angles(&angles);
                step /= 2.0;
            }
        }
    }
}

fn finish(model: &Model, found: Equilibrium, mut history: Vec<Step>, edges: usize) -> Relaxed {
    let settled = tension::settle(model, &found);
    history.extend(found.history);
    Relaxed {
        state: State::new(model, &found.x, &settled.tension, edges),
        x: found.x,
        tension: settled.tension,
        iterations: history.iter().filter(|step| step.fraction > 0.0).count(),
        factorizations: history.iter().map(|step| step.factorizations).sum(),
        solves: history.iter().map(|step| step.solves).sum(),
        residual_force: settled.residual_force,
        residual_length: settled.residual_length,
        negative_eigenvalues: found.negative_eigenvalues,
        self_stresses: settled.self_stresses,
        history,
    }
}
