//! `kind = "relax"`: the equilibrium that Newton's method reaches from a start.

mod summary;

use super::states::{self, Shown};
use super::supported::small_tolerance;
use super::{Answer, Context, NoAnswer, StudyError, StudyResult, branches, energies, start};
use crate::analysis::exact::error_to_kinematic;
use crate::analysis::relax::recorder::KeptState;
use crate::analysis::relax::{RelaxError, RelaxOptions, Relaxed, RouteTried, relax_from};
use crate::analysis::restored;
use crate::analysis::state::State;
use crate::model::{Assembly, Gauge, Model};
use crate::numerics::larger;
use crate::output::figure::rounded;
use crate::scene::spec::RelaxSpec;
use crate::sheet::Info;
use crate::solver::{Failure, Step};
use std::num::NonZeroUsize;
use std::ops::Range;
pub use summary::{IterationSummary, MethodName, RelaxSummary, RouteSummary};

/// Reason for the failure of a relaxation that has left a singular start with extensible bars.
const NO_BRANCH: &str = "the start is singular, and the state that bars that stretch reach from it has no rigid one nearby: \
                         give bars a finite stiffness, or start a little folded";
/// Advice where forces cannot balance with rigid bars.
const NO_BALANCE: &str = "the pattern does not fold rigidly as far as its rest angles ask: give bars a finite stiffness, or \
                          facets a lower one";

/// Quality of a triangle below which rounding errors of its shape can matter; 1 for an equilateral triangle.
const THIN: f64 = 1e-2;
/// Largest difference between a locked angle and its prescribed value that counts as rounding, in radians.
const MET: f64 = 1e-9;

/// Checks that the model has an energy and that a start file fits the sheet.
pub(crate) fn check(context: &Context<'_>, spec: &RelaxSpec) -> Result<(), StudyError> {
    small_tolerance(context, spec.tolerance.as_ref())?;
    if !context.assembly.terms().has_energy() {
        return Err(context.refuse("there is no energy to relax", "give bars, creases or facets a stiffness").into());
    }
    if context.assembly.check_balance(&[]).is_err() {
        let help = "balance the loads, or pin a vertex along their direction; a path can hold it instead";
        return Err(context.refuse("only a drive supports the loads, and a relaxation drives nothing", help).into());
    }
    start::check(context, spec.start.as_ref())
}

/// Computes the equilibrium from the start that the scene names.
pub(crate) fn compute(context: &Context<'_>, spec: &RelaxSpec) -> Result<Answer, NoAnswer> {
    let mut model = context.assembly.model(Gauge::Held);
    let start = start::initial_state(context, spec.start.as_ref(), &mut model)?;
    let first = restored::state_at(&model, &start);
    let mut options = RelaxOptions { method: spec.method, ..RelaxOptions::default() };
    options.keep_every = spec.keep_every.as_ref().and_then(|count| NonZeroUsize::new(count.0 as usize));
    if let Some(tolerance) = &spec.tolerance {
        options.newton.tolerance = tolerance.0;
    }
    match relax_from(&model, start, options, &mut watcher(context)) {
        Ok(relaxed) => Ok(found(context, spec, &model, &first, relaxed)),
        Err(error) => Ok(not_found(context, &first, &error)),
    }
}

/// Returns the answer of a relaxation that converged.
fn found(context: &Context<'_>, spec: &RelaxSpec, model: &Model, first: &State, relaxed: Relaxed) -> Answer {
    let (assembly, mut answer) = (context.assembly, Answer::empty(context.study));
    let residuals = Some([relaxed.residual_force, relaxed.residual_length]);
    let shown = format!("equilibrium, energy {}", rounded(relaxed.state.total(), 5));
    let states = reached([first, &relaxed.state], residuals, &relaxed.kept, &relaxed.history);
    let self_intersecting = add_states(&mut answer, context, &states, &shown);
    let angles = states::with_all_angles(context, &relaxed.state).fold_angle;
    let drawn = start::is_drawn(spec.start.as_ref());
    let (branch_point_start, directions) = if drawn { branches::branch_point(assembly) } else { (None, None) };
    let result = RelaxSummary {
        self_intersecting,
        error_to_kinematic: error_to_kinematic(assembly.sheet(), assembly.tiling(), model, &angles),
        branch_point_start,
        directions_at_start: directions.map(branches::word),
        ..result_of(context, &relaxed)
    };
    let error = larger(result.residual_force, result.residual_length);
    answer.conclude(StudyResult::Relax(result), Some(error), None);
    answer.state = Some(relaxed.configuration);
    answer
}

/// Returns the answer of a relaxation that did not converge, with its last state.
fn not_found(context: &Context<'_>, first: &State, error: &RelaxError) -> Answer {
    let mut answer = Answer::empty(context.study);
    let residuals = error.history.last().map(|step| [step.residual_force, step.residual_length]);
    let shown = "last state of a relaxation without end";
    let states = reached([first, &error.state], residuals, &error.kept, &error.history);
    let self_intersecting = add_states(&mut answer, context, &states, shown);
    let result = RelaxSummary { self_intersecting, ..last_of(context, error) };
    let why = reason(context.assembly, error.failure, &error.state);
    let why = match error.failure {
        Failure::Unbounded { .. } => format!("{why}; {NO_BALANCE}"),
        _ if error.soft_steps.is_empty() => why,
        _ => format!("{why}; {NO_BRANCH}"),
    };
    answer.conclude(StudyResult::Relax(result), None, Some(why));
    answer
}

/// Returns the observer of a relaxation, which reports its steps to the observer of the run.
pub(crate) fn watcher<'a>(context: &'a Context<'_>) -> impl FnMut(&Step) -> bool + 'a {
    let mut step = 0;
    move |last| {
        step += 1;
        context.step_with_residual(step, None, last.residual_force.max(last.residual_length))
    }
}

/// A state of a relaxation: its number, its residuals if they are to be shown, and the state itself.
type Reached<'a> = (usize, Option<[f64; 2]>, &'a State);

/// Returns the states of a relaxation that are shown: those that were kept, by their iterations; without them the first
/// and the last one. `residuals` are those of the last one.
fn reached<'a>(
    [first, last]: [&'a State; 2],
    residuals: Option<[f64; 2]>,
    kept: &'a [KeptState],
    history: &[Step],
) -> Vec<Reached<'a>> {
    if kept.is_empty() {
        return vec![(0, None, first), (1, residuals, last)];
    }
    let of = |iteration: usize| {
        let at = history.get(iteration).map(|step| [step.residual_force, step.residual_length]);
        if iteration + 1 == history.len() { residuals } else { at }
    };
    kept.iter().map(|kept| (kept.iteration, of(kept.iteration), &kept.state)).collect()
}

/// Adds the table and pictures of states, with a drawing of the last one. Returns whether the last state intersects
/// itself; `None` if the study does not ask for that check.
fn add_states(answer: &mut Answer, context: &Context<'_>, states: &[Reached<'_>], shown: &str) -> Option<bool> {
    let mut check = context.self_intersection();
    let mut all = |&(iteration, residuals, state): &Reached<'_>| {
        let state = states::with_all_angles(context, state);
        let marks = check.as_mut().map(|check| check.marks(context.assembly.drawn(), &state));
        (iteration, Shown { state, residuals, marks })
    };
    let all: Vec<(usize, Shown)> = states.iter().map(&mut all).collect();
    let table = states::table(context, all.iter().map(|(iteration, state)| (*iteration, state)));
    answer.add(format!("{}.csv", context.name()), table);
    let timed = all.iter().enumerate().map(|(row, (iteration, state))| (row, *iteration, state));
    states::add(answer, context, timed, Some((all.len() - 1, shown)));
    all.last()?.1.marks.as_ref().map(|marks| marks.any)
}

/// Returns the summary of a relaxation, without the checks that the study asks for.
fn result_of(context: &Context<'_>, relaxed: &Relaxed) -> RelaxSummary {
    RelaxSummary {
        energy: energies::summary(context.assembly.terms(), &relaxed.state),
        dissipated: (!relaxed.configuration.memory.is_empty()).then_some(relaxed.state.dissipated),
        iterations: relaxed.iterations,
        factorizations: relaxed.factorizations,
        chord_solves: relaxed.solves,
        residual_force: relaxed.residual_force,
        residual_length: relaxed.residual_length,
        negative_eigenvalues: relaxed.negative_eigenvalues,
        self_stresses: relaxed.self_stresses,
        routes: relaxed.routes.iter().map(route).collect(),
        intrinsic_failure: relaxed.intrinsic_failure.map(|failure| failure.to_string()),
        branch_choice: relaxed.branch_choice,
        history: history(&relaxed.history, &relaxed.soft_steps),
        ..RelaxSummary::default()
    }
}

/// Returns the same summary of a relaxation that failed, from its last step.
fn last_of(context: &Context<'_>, error: &RelaxError) -> RelaxSummary {
    let last = error.history.last();
    RelaxSummary {
        energy: energies::summary(context.assembly.terms(), &error.state),
        iterations: error.history.iter().filter(|step| step.fraction > 0.0).count(),
        factorizations: error.history.iter().map(|step| step.factorizations).sum(),
        chord_solves: error.history.iter().map(|step| step.solves).sum(),
        residual_force: last.map_or(f64::NAN, |step| step.residual_force),
        residual_length: last.map_or(f64::NAN, |step| step.residual_length),
        routes: error.routes.iter().map(route).collect(),
        intrinsic_failure: error.intrinsic_failure.map(|failure| failure.to_string()),
        history: history(&error.history, &error.soft_steps),
        ..RelaxSummary::default()
    }
}

fn route(tried: &RouteTried) -> RouteSummary {
    let RouteTried { name, iterations, failure, negative_eigenvalues } = *tried;
    let failure = failure.map(|failure| failure.to_string());
    RouteSummary { name: name.to_owned(), iterations, failure, negative_eigenvalues }
}

/// Returns the rows of the history, of which those of `soft` were made with bars that stretch.
fn history(steps: &[Step], soft: &Range<usize>) -> Vec<IterationSummary> {
    let row = |(iteration, step): (usize, &Step)| IterationSummary {
        iteration,
        energy: step.energy,
        residual_force: step.residual_force,
        residual_length: step.residual_length,
        step: step.fraction,
        shift: step.shift,
        method: match step.intrinsic {
            true => MethodName::Intrinsic,
            false if soft.contains(&iteration) => MethodName::SoftBars,
            false => MethodName::Vertices,
        },
    };
    steps.iter().enumerate().map(row).collect()
}

/// Returns a description of the failure, with its possible cause: a lock that is not satisfied or a thin triangle.
fn reason(assembly: &Assembly, failure: Failure, state: &State) -> String {
    let cause = match failure {
        Failure::Infeasible { .. } => unmet_lock(assembly, state),
        Failure::Uncertain { force, tolerance, .. } if !(force <= tolerance) => thin_triangle(assembly),
        Failure::Stuck { .. } | Failure::TooManySteps { .. } => thin_triangle(assembly),
        _ => None,
    };
    match cause {
        Some(cause) => format!("{failure}; {cause}"),
        None => failure.to_string(),
    }
}

/// Describes the lock whose crease has the largest difference from its prescribed angle in the last state.
fn unmet_lock(assembly: &Assembly, state: &State) -> Option<String> {
    let off = |&(edge, angle): &(usize, f64)| {
        let here = *state.fold_angle.get(edge)?;
        Some((edge, angle, here)).filter(|_| (angle - here).abs() > MET)
    };
    let farther = |a: &(usize, f64, f64), b: &(usize, f64, f64)| (a.1 - a.2).abs().total_cmp(&(b.1 - b.2).abs());
    let (edge, angle, here) = assembly.terms().locks.iter().filter_map(off).max_by(farther)?;
    let key = assembly.sheet().edges[assembly.tiling().edges[edge].edge].key;
    Some(format!("the lock of crease {key} at {angle} rad stays at {here:.6} rad"))
}

fn thin_triangle(assembly: &Assembly) -> Option<String> {
    let info = Info::new(assembly.sheet());
    let quality = info.worst_triangle_quality;
    let named = info.thinnest.first().map_or(String::new(), |thin| format!(", with the vertices {:?}", thin.vertices));
    (quality < THIN)
        .then(|| format!("the worst triangle of the sheet is thin, of quality {quality:.1e} (1: equilateral){named}"))
}
