//! Relaxation: from a start to the equilibrium of a model, directly or by raising what drives it step by step.

use super::apex;
use super::certainty::{CERTAIN, off_rest, uncertainty};
use super::fallback::{self, hopeless};
use super::method::{self, IntrinsicFailure, RelaxOptions, Stalled};
use super::recorder::{KeptState, Recorder};
use super::rigid_forces::rigid_over_others;
use super::singular_start::{self, BranchChoice, Origin};
use super::state::State;
use super::straight;
use crate::model::{Assembly, Domain, Gauge, Model};
use crate::solver::{Equilibrium, Failure, NewtonError, Options, Problem, Start, Step, tension};
use std::fmt;
use std::ops::Range;
use thiserror::Error;

/// How often what holds a sheet against rigid motions is chosen again.
const HOLDS: usize = 20;
/// Largest force of a rigid measure over those of the others from which on it hides them.
const HIDDEN: f64 = 100.0;
/// An equilibrium.
#[derive(Clone, Debug)]
pub struct Relaxed {
    /// The state.
    pub state: State,
    /// The model's unknowns: where what is held was chosen again, others than those of the start.
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
    /// Negative eigenvalues of the energy's Hessian on what rigid terms leave free; `None` where their number cannot be
    /// established.
    pub negative_eigenvalues: Option<usize>,
    /// Self stresses of the rigid measures; `None` where none is rigid.
    pub self_stresses: Option<usize>,
    /// All accepted steps.
    pub history: Vec<Step>,
    /// Why fold angles were given up, if they were tried as unknowns.
    pub intrinsic_failure: Option<IntrinsicFailure>,
    /// The branch on which a flat or singular start was left; `None` for other starts.
    pub branch_choice: Option<BranchChoice>,
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
    /// Last accepted state.
    pub state: State,
    /// Its unknowns.
    pub x: Vec<f64>,
    /// All accepted steps.
    pub history: Vec<Step>,
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
    let mut model = assembly.model(Gauge::Held);
    let start = model.start();
    relax_from(&mut model, start, Options::default(), &mut |_| true)
}

/// The equilibrium that a model reaches from a start: unknowns, and tensions where they are known. `observe` sees every accepted
/// step and returns false to stop. [`Options`] alone leave the method to [`Method::Auto`](super::method::Method::Auto).
///
/// Where the direct way fails, a screw that it left nearly straight is relaxed by way of straight states; else, and where that fails too,
/// all rest angles, rest lengths and locked angles are moved from their values at the start to their targets in steps that adapt.
///
/// ```
/// use foldwell::analysis::method::RelaxOptions;
/// use foldwell::analysis::relax::relax_from;
/// use foldwell::model::Gauge;
/// use foldwell::{Assembly, Pattern, RIGID, Rest, generate};
///
/// let sheet = generate(&Pattern::named("miura")?)?;
/// let assembly = Assembly::patch(sheet, [2, 2]).bars(RIGID).creases(1.0).rest(Rest::Flat).build()?;
/// // the held gauge is the one for minimisation; the unknowns of the drawn state are one start among others
/// let mut model = assembly.model(Gauge::Held);
/// let start = model.start();
/// let mut steps = 0;
/// let relaxed = relax_from(&mut model, start, RelaxOptions::default(), &mut |_step| {
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
    model: &mut Model,
    start: impl Into<Start>,
    options: impl Into<RelaxOptions>,
    observe: &mut dyn FnMut(&Step) -> bool,
) -> Result<Relaxed, Box<RelaxError>> {
    let (start, RelaxOptions { newton: options, method, keep_every }) = (start.into(), options.into());
    let mut recorder = Recorder::new(observe, keep_every);
    let restarted = start.tension.is_some();
    let origin = Origin { place: model.coordinates(&start.x), angles: model.angles(), energy: model.energy(&start.x) };
    let mut history = Vec::new();
    let (first, mut intrinsic_failure) =
        method::minimize_in_angles(model, &start, (options, method), &mut recorder, &mut history);
    let mut soft_steps = 0..0;
    let found = match first.unwrap_or_else(|| recorder.minimize(model, start.clone(), options)) {
        Err(error) if error.failure == Failure::SingularStart && model.has_rigid_bars() => {
            model.set_angles(&origin.angles);
            history.extend(error.history);
            let left = singular_start::leave(model, &origin, options, &mut recorder, &mut history);
            soft_steps = 0..history.len();
            left
        }
        Err(error) if hopeless(error.failure) => Err(error),
        Err(error) => {
            let stalled = Stalled { origin: &origin, restarted, method, error, tried: intrinsic_failure };
            let (found, failure) = recovered(model, stalled, options, &mut recorder, &mut history);
            intrinsic_failure = failure;
            found
        }
        found => found,
    };
    let found = if restarted || !soft_steps.is_empty() {
        found
    } else {
        let (better, soft) =
            singular_start::leave_if_in_doubt(model, found, &origin, options, &mut recorder, &mut history);
        soft_steps = soft;
        better
    };
    let found = found.and_then(|found| relaxed_with_a_valid_gauge(model, found, options, &mut recorder, &mut history));
    let found = found.and_then(|found| {
        // a restarted equilibrium stays where it is
        let moved = !restarted || !history.is_empty() || found.history.iter().any(|step| step.fraction > 0.0);
        let off = if moved { off_rest(model, &found.x) } else { 0.0 };
        let may_bend = off > 0.0 && apex::at_apex(model, &found.x, off);
        let found = if may_bend { apex::bent(model, found, off, options, &mut recorder, &mut history)? } else { found };
        if moved { refined(model, found, options, &mut recorder, &mut history) } else { Ok(found) }
    });
    let found = found.and_then(|found| without_self_stress(model, found, options, &mut recorder, &mut history));
    let open = match found {
        Ok(found) => match uncertainty(model, &found, options.tolerance) {
            Some(angle) if !(angle <= CERTAIN) => {
                let force = found.history.last().map_or(f64::NAN, |step| step.residual_force);
                let failure = Failure::Uncertain { angle, force, tolerance: options.tolerance };
                NewtonError { failure, x: found.x, tension: found.tension, history: found.history }
            }
            _ => {
                let branch_choice = BranchChoice::of(model, &found.x, &origin.angles, !soft_steps.is_empty());
                let found = straight::counted(model, found);
                let relaxed = finish(model, found, history);
                let kept = recorder.into_kept(Some(&relaxed.state));
                return Ok(Relaxed { intrinsic_failure, branch_choice, soft_steps, kept, ..relaxed });
            }
        },
        Err(error) => error,
    };
    Err(Box::new(RelaxError { intrinsic_failure, soft_steps, ..failed(model, open, history, recorder) }))
}

/// The equilibrium that is reached after positions failed: in fold angles, or by the ways of [`fallback`]; and why fold angles were given
/// up, if they were tried.
fn recovered(
    model: &mut Model,
    stalled: Stalled<'_>,
    options: Options,
    recorder: &mut Recorder<'_>,
    history: &mut Vec<Step>,
) -> (Result<Equilibrium, NewtonError>, Option<IntrinsicFailure>) {
    let origin = stalled.origin;
    let (in_angles, failure) = method::minimize_stalled_in_angles(model, stalled, options, recorder, history);
    let found = match in_angles {
        Err(error) if error.failure != Failure::Interrupted => {
            fallback::relaxed(model, error, origin, options, recorder, history)
        }
        found => found,
    };
    (found, failure)
}

/// The failure of a relaxation with its last state.
fn failed(model: &Model, error: NewtonError, mut history: Vec<Step>, recorder: Recorder<'_>) -> RelaxError {
    history.extend(error.history);
    let state = State::new(model, &error.x, &error.tension);
    // stopped in fold angles, it ends where it started
    let is_last = history.last().is_some_and(|step| !step.intrinsic);
    let kept = recorder.into_kept(is_last.then_some(&state));
    let (failure, x) = (error.failure, error.x);
    RelaxError { failure, state, x, history, intrinsic_failure: None, soft_steps: 0..0, kept }
}

/// The equilibrium, once what holds the sheet against rigid motions does nothing else. It was chosen in the drawn state, and may hold
/// a shape in another one, so that where the sheet then stays is no equilibrium: it is chosen again, and the sheet goes on from
/// there.
fn relaxed_with_a_valid_gauge(
    model: &mut Model,
    mut found: Equilibrium,
    options: Options,
    recorder: &mut Recorder<'_>,
    history: &mut Vec<Step>,
) -> Result<Equilibrium, NewtonError> {
    for _ in 0..HOLDS {
        if model.gauge_is_valid(&found.x) {
            break;
        }
        history.append(&mut found.history);
        let x = model.rebase_gauge(model.coordinates(&found.x));
        found = recorder.minimize(model, Start { x, tension: Some(found.tension) }, options)?;
    }
    Ok(found)
}

/// The equilibrium of a screw whose rigid measures are under so much tension that they hide what is left of the others' forces, with
/// these as small as residuals usually are; itself where they are not, or where that cannot be reached.
///
/// Next to zero curvature the rows of rigid measures are nearly dependent and their tensions grow without bound, and residuals are
/// measured against the largest force.
fn refined(
    model: &mut Model,
    mut found: Equilibrium,
    options: Options,
    recorder: &mut Recorder<'_>,
    history: &mut Vec<Step>,
) -> Result<Equilibrium, NewtonError> {
    if !matches!(model.domain(), Domain::Screw) || rigid_over_others(model, &found) <= HIDDEN {
        return Ok(found);
    }
    let place = model.place();
    let start = Start { x: found.x.clone(), tension: Some(found.tension.clone()) };
    let tolerance = options.tolerance / HIDDEN;
    let steps = recorder.steps();
    match recorder.minimize(model, start, Options { tolerance, ..options }) {
        Ok(other) => {
            history.append(&mut found.history);
            Ok(other)
        }
        Err(error) if error.failure == Failure::Interrupted => {
            history.append(&mut found.history);
            Err(error)
        }
        Err(_) => {
            recorder.forget_after(steps);
            model.go_to(&place);
            Ok(found)
        }
    }
}

/// The equilibrium with tensions of least norm. Where a self stress was large beside them, what was balanced to the tolerance with it need
/// not be so without: the iteration then goes on from there.
fn without_self_stress(
    model: &mut Model,
    mut found: Equilibrium,
    options: Options,
    recorder: &mut Recorder<'_>,
    history: &mut Vec<Step>,
) -> Result<Equilibrium, NewtonError> {
    let settled = tension::settle(model, &found);
    let met = found.history.last().is_some_and(|step| step.residual_force <= options.tolerance);
    if !met || settled.residuals.force <= options.tolerance {
        return Ok(found);
    }
    history.append(&mut found.history);
    recorder.minimize(model, Start { x: found.x, tension: Some(settled.tension) }, options)
}

fn finish(model: &Model, found: Equilibrium, mut history: Vec<Step>) -> Relaxed {
    let settled = tension::settle(model, &found);
    history.extend(found.history);
    Relaxed {
        state: State::new(model, &found.x, &settled.tension),
        x: found.x,
        tension: settled.tension,
        iterations: history.iter().filter(|step| step.fraction > 0.0).count(),
        factorizations: history.iter().map(|step| step.factorizations).sum(),
        solves: history.iter().map(|step| step.solves).sum(),
        residual_force: settled.residuals.force,
        residual_length: settled.residuals.length,
        negative_eigenvalues: found.negative_eigenvalues,
        self_stresses: settled.self_stresses,
        history,
        intrinsic_failure: None,
        branch_choice: None,
        soft_steps: 0..0,
        kept: vec![],
    }
}
