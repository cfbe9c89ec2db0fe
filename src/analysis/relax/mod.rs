//! Relaxation: from a start to the equilibrium of a model, directly or by raising what drives it step by step.

mod certainty;
mod options;
pub mod recorder;
mod routes;
mod run;

use super::state::State;
use crate::model::{Assembly, Configuration, Gauge, Model};
use crate::solver::tension::{self, BalancedTensions};
use crate::solver::{Equilibrium, Failure, NewtonError, Options, Start, Step};
use certainty::{CERTAIN, uncertainty};
pub use options::{IntrinsicFailure, Method, RelaxOptions};
use recorder::KeptState;
pub use routes::soft_bars::FoldingBranch;
use routes::{ROUTES, fold_angles, straight_screw};
pub use run::RouteTried;
use run::{Ending, Run};
use std::fmt;
use std::ops::Range;
use thiserror::Error;

/// An equilibrium.
#[derive(Clone, Debug)]
pub struct Relaxed {
    /// The state with the energy and force of every edge.
    pub state: State,
    /// The same state as a start of other analyses. Its tensions are the limit of stiff ones where they are not unique.
    pub configuration: Configuration,
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
    /// Negative eigenvalues of the energy's Hessian on what rigid terms leave free; `None` where their number cannot be
    /// established.
    pub negative_eigenvalues: Option<usize>,
    /// Self stresses of the rigid measures; `None` where none is rigid.
    pub self_stresses: Option<usize>,
    /// All accepted steps.
    pub history: Vec<Step>,
    /// The ways that were taken, in order: in positions or fold angles from the start, then those that were tried after
    /// it.
    pub routes: Vec<RouteTried>,
    /// Why fold angles were given up, if they were tried as unknowns.
    pub intrinsic_failure: Option<IntrinsicFailure>,
    /// The branch on which a flat or singular start was left; `None` for other starts.
    pub branch_choice: Option<FoldingBranch>,
    /// Which steps of the history were made with bars that stretch, to leave a singular start.
    pub soft_steps: Range<usize>,
    /// The states on the way that [`RelaxOptions::keep_every`] asks for.
    pub kept: Vec<KeptState>,
}

/// Relaxation failed; the last accepted state is here.
#[derive(Error)]
#[error("{failure}")]
pub struct RelaxError {
    /// Why.
    pub failure: Failure,
    /// Last accepted state, with the energy and force of every edge.
    pub state: State,
    /// The same state as a start of other analyses.
    pub configuration: Configuration,
    /// All accepted steps.
    pub history: Vec<Step>,
    /// The ways that were taken, in order.
    pub routes: Vec<RouteTried>,
    /// Why fold angles were given up, if they were tried as unknowns.
    pub intrinsic_failure: Option<IntrinsicFailure>,
    /// Which steps of the history were made with bars that stretch, to leave a singular start.
    pub soft_steps: Range<usize>,
    /// The states on the way that [`RelaxOptions::keep_every`] asks for.
    pub kept: Vec<KeptState>,
}

/// Says why it failed and how far it came, not the numbers of the state.
impl fmt::Debug for RelaxError {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (steps, edges) = (self.history.len(), self.state.energy.len());
        write!(out, "{} (after {steps} steps; a sheet of {edges} edges)", self.failure)
    }
}

/// The equilibrium that a sheet reaches from its drawn state.
///
/// ```
/// use foldwell::{Assembly, Pattern, RIGID, Rest, generate, relax};
///
/// let sheet = generate(&Pattern::named("miura")?)?;
/// let assembly = Assembly::patch(sheet, [2, 2]).bars(RIGID).creases(1.0).rest(Rest::Flat).build()?;
/// let relaxed = relax(&assembly)?;
/// assert!(relaxed.state.total() < 1e-12 && relaxed.negative_eigenvalues == Some(0));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`RelaxError`] with the reason and the last accepted state, where it does not converge.
pub fn relax(assembly: &Assembly) -> Result<Relaxed, Box<RelaxError>> {
    let model = assembly.model(Gauge::Held);
    relax_from(&model, model.start(), Options::default(), &mut |_| true)
}

/// The equilibrium that a model reaches from a start: unknowns, and tensions where they are known. The model stays as
/// it is; many starts may share it. `observe` sees every accepted step and returns false to stop. [`Options`] alone
/// leave the method to [`Method::Auto`].
///
/// Newton's method begins at the start, in positions or in fold angles. Where it fails, or ends in a saddle or another
/// state that need not be the answer, other ways are tried one after the other: [`Relaxed::routes`] names those that
/// helped. A start that knows its tensions asks for the equilibrium next to it, whatever its stability.
///
/// ```
/// use foldwell::analysis::relax::RelaxOptions;
/// use foldwell::analysis::relax::relax_from;
/// use foldwell::model::Gauge;
/// use foldwell::{Assembly, Pattern, RIGID, Rest, generate};
///
/// let sheet = generate(&Pattern::named("miura")?)?;
/// let assembly = Assembly::patch(sheet, [2, 2]).bars(RIGID).creases(1.0).rest(Rest::Flat).build()?;
/// // the held gauge is the one for minimisation; the unknowns of the drawn state are one start among others
/// let model = assembly.model(Gauge::Held);
/// let mut steps = 0;
/// let relaxed = relax_from(&model, model.start(), RelaxOptions::default(), &mut |_step| {
///     steps += 1;
///     steps <= 100
/// })?;
/// assert!(relaxed.negative_eigenvalues == Some(0) && steps == relaxed.history.len());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`RelaxError`] with the reason and the last accepted state, where it does not converge.
pub fn relax_from(
    model: &Model,
    start: impl Into<Start>,
    options: impl Into<RelaxOptions>,
    observe: &mut dyn FnMut(&Step) -> bool,
) -> Result<Relaxed, Box<RelaxError>> {
    relax_model(model.clone(), start, options, observe).map(|(relaxed, _, _)| relaxed)
}

/// Relaxes as [`relax_from`] does, and returns the model at the equilibrium too, with its unknowns there: for those who
/// go on with it.
pub(crate) fn relax_model(
    model: Model,
    start: impl Into<Start>,
    options: impl Into<RelaxOptions>,
    observe: &mut dyn FnMut(&Step) -> bool,
) -> Result<(Relaxed, Model, Vec<f64>), Box<RelaxError>> {
    let start = start.into();
    let mut run = Run::new(model, &start, options.into(), observe);
    let straight = straight_screw::begins_straight(&run);
    let begin = if straight { straight_screw::begin } else { fold_angles::begin };
    let mut ending = begin(&mut run, start);
    let in_angles = run.intrinsic_failure.is_none() && run.recorder.history.iter().any(|step| step.intrinsic);
    run.note(if in_angles { "fold angles" } else { "positions" }, 0, &ending);
    for route in &ROUTES {
        if (route.wanted)(&run, &ending) {
            let steps = run.recorder.steps();
            ending = (route.go)(&mut run, ending);
            run.note(route.name, steps, &ending);
        }
    }
    match ending.and_then(|found| certain(&run, found)) {
        Ok(found) => Ok(relaxed(run, found)),
        Err(error) => Err(Box::new(failed(run, error))),
    }
}

/// The equilibrium; an error where it is not known well enough.
fn certain(run: &Run<'_>, found: Equilibrium) -> Ending {
    match uncertainty(&run.model, &found, run.options.tolerance) {
        Some(angle) if !(angle <= CERTAIN) => {
            let force = found.history.last().map_or(f64::NAN, |step| step.residual_force);
            let failure = Failure::Uncertain { angle, force, tolerance: run.options.tolerance };
            Err(NewtonError { failure, x: found.x, tension: found.tension, history: found.history })
        }
        _ => Ok(found),
    }
}

/// The answer of a relaxation that ended in an equilibrium, and the model with its unknowns there.
fn relaxed(run: Run<'_>, found: Equilibrium) -> (Relaxed, Model, Vec<f64>) {
    let Run { mut model, start, recorder, routes, soft_steps, intrinsic_failure, .. } = run;
    let branch_choice = FoldingBranch::of(&model, &found.x, &start.angles, !soft_steps.is_empty());
    let settled = tension::settle(&model, &found);
    let found = with_least_tensions(&model, found, &settled);
    let found = straight_screw::counted(&mut model, found);
    let state = State::new(&model, &found.x, &settled.tension);
    let (history, kept) = recorder.end(Some(&state));
    let relaxed = Relaxed {
        state,
        configuration: model.configuration(&found.x, Some(settled.tension)),
        iterations: history.iter().filter(|step| step.fraction > 0.0).count(),
        factorizations: history.iter().map(|step| step.factorizations).sum(),
        solves: history.iter().map(|step| step.solves).sum(),
        residual_force: settled.residuals.force,
        residual_length: settled.residuals.length,
        negative_eigenvalues: found.negative_eigenvalues,
        self_stresses: settled.self_stresses,
        history,
        routes,
        intrinsic_failure,
        branch_choice,
        soft_steps,
        kept,
    };
    (relaxed, model, found.x)
}

/// The equilibrium with the limit of stiff tensions where self stresses leave a choice, and with its negative
/// eigenvalues counted by them.
fn with_least_tensions(model: &Model, found: Equilibrium, settled: &BalancedTensions) -> Equilibrium {
    if settled.self_stresses.unwrap_or(0) == 0 {
        return found;
    }
    let negative_eigenvalues = tension::negative_eigenvalues(model, &found.x, &settled.tension);
    Equilibrium { tension: settled.tension.clone(), negative_eigenvalues, ..found }
}

/// The failure of a relaxation with its last state.
fn failed(run: Run<'_>, error: NewtonError) -> RelaxError {
    let Run { model, recorder, routes, soft_steps, intrinsic_failure, .. } = run;
    let failure = error.failure;
    let state = State::new(&model, &error.x, &error.tension);
    let configuration = model.configuration(&error.x, Some(error.tension));
    // stopped in fold angles, it ends where it started
    let is_last = recorder.history.last().is_some_and(|step| !step.intrinsic);
    let (history, kept) = recorder.end(is_last.then_some(&state));
    RelaxError { failure, state, configuration, history, routes, intrinsic_failure, soft_steps, kept }
}
