//! `kind = "relax"`: the equilibrium that Newton's method reaches from a start.

use super::answer::{Answer, SavedState};
use super::context::Context;
use super::error::StudyError;
use super::reason::reason;
use super::states::{self, Shown};
use super::{branches, energies};
use crate::analysis::exact::error_to_kinematic;
use crate::analysis::intersections::STACKED_LAYERS_MARGIN;
use crate::analysis::method::{Method, RelaxOptions};
use crate::analysis::relax::{RelaxError, Relaxed, relax_from};
use crate::analysis::restored::{self, Forces};
use crate::analysis::state::State;
use crate::model::{Gauge, Model};
use crate::numerics::larger;
use crate::numerics::random::symmetric;
use crate::output::figure::rounded;
use crate::output::summary::{IterationSummary, MethodName, RelaxSummary, StudyResult};
use crate::output::vtk::{self, VtuMesh};
use crate::scene::Located;
use crate::scene::forms::{RandomStart, StartSpec};
use crate::scene::spec::{MethodSpec, RelaxSpec};
use crate::solver::Step;
use rand::SeedableRng;

/// Checks that the model has an energy and that a start file fits the sheet.
pub(crate) fn check(context: &Context<'_>, spec: &RelaxSpec) -> Result<(), StudyError> {
    if !context.assembly.terms().has_energy() {
        return Err(context.refuse("there is no energy to relax", "give bars, creases or facets a stiffness").into());
    }
    match &spec.start {
        Some(start) => start_file(context, start).map(|_| ()),
        None => Ok(()),
    }
}

/// Computes the equilibrium from the start that the scene names.
pub(crate) fn compute(context: &Context<'_>, spec: &RelaxSpec) -> Result<Answer, StudyError> {
    let mut model = context.assembly.model(Gauge::Held);
    let Some((x, forces)) = start(context, spec, &mut model)? else { return Ok(start_unavailable(context)) };
    let tensions = restored::tensions(&model, &x, &forces);
    let known = spec.start.as_deref().is_some_and(|start| matches!(start, StartSpec::Study(_) | StartSpec::File(_)));
    let start = if known { restored::start(&model, x, tensions.clone()) } else { x.into() };
    let first = State::new(&model, &start.x, start.tension.as_ref().unwrap_or(&tensions));
    let mut options = RelaxOptions { method: method(spec.method), ..RelaxOptions::default() };
    if let Some(tolerance) = &spec.tolerance {
        options.newton.tolerance = tolerance.0;
    }
    match relax_from(&mut model, start, options, &mut watcher(context)) {
        Ok(relaxed) => Ok(found(context, spec, &model, &first, relaxed)),
        Err(error) => Ok(not_found(context, &first, &error)),
    }
}

/// Returns the answer of a relaxation that converged.
fn found(context: &Context<'_>, spec: &RelaxSpec, model: &Model, first: &State, relaxed: Relaxed) -> Answer {
    let (assembly, mut answer) = (context.assembly, Answer::empty(context.study));
    let residuals = Some([relaxed.residual_force, relaxed.residual_length]);
    let shown = format!("equilibrium, energy {}", rounded(relaxed.state.total(), 5));
    let self_intersecting = add_states(&mut answer, context, [first, &relaxed.state], residuals, &shown);
    let angles = states::with_all_angles(context, &relaxed.state).fold_angle;
    let drawn = spec.start.as_ref().is_none_or(|start| matches!(**start, StartSpec::Drawn));
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
    let Relaxed { state, tension, .. } = relaxed;
    answer.state = Some(SavedState { coordinates: state.coordinates, angles: model.angles(), tension: Some(tension) });
    answer
}

/// Returns the answer of a relaxation that did not converge, with its last state.
fn not_found(context: &Context<'_>, first: &State, error: &RelaxError) -> Answer {
    let mut answer = Answer::empty(context.study);
    let residuals = error.history.last().map(|step| [step.residual_force, step.residual_length]);
    let shown = "last state of a relaxation without end";
    let self_intersecting = add_states(&mut answer, context, [first, &error.state], residuals, shown);
    let result = RelaxSummary { self_intersecting, ..last_of(context, error) };
    let why = reason(context.assembly, error.failure, &error.state);
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

/// Adds the table and pictures of the first and last state of a relaxation, with the residuals of the last one. Returns
/// whether the last state intersects itself; `None` if the study does not ask for that check.
fn add_states(
    answer: &mut Answer,
    context: &Context<'_>,
    ends: [&State; 2],
    residuals: Option<[f64; 2]>,
    shown: &str,
) -> Option<bool> {
    let mut check = context.self_intersection();
    let [first, last] = ends.map(|state| {
        let state = states::with_all_angles(context, state);
        let marks = check.as_mut().map(|check| check.marks(context.assembly.drawn(), &state, STACKED_LAYERS_MARGIN));
        Shown { state, residuals: None, marks }
    });
    let both = [first, Shown { residuals, ..last }];
    answer.add(format!("{}.csv", context.name()), states::table(context, &both));
    states::add(answer, context, &both, Some((1, shown)));
    both[1].marks.as_ref().map(|marks| marks.any)
}

/// Returns the unknowns from which a relaxation starts, and the known forces at that state; `None` if the study to
/// start from has no final state.
fn start(context: &Context<'_>, spec: &RelaxSpec, model: &mut Model) -> Result<Option<(Vec<f64>, Forces)>, StudyError> {
    let Some(start) = &spec.start else { return Ok(Some((model.start(), Forces::Unknown))) };
    match &**start {
        StartSpec::Drawn => Ok(Some((model.start(), Forces::Unknown))),
        StartSpec::Random(random) => Ok(Some((random_start(random, model), Forces::Unknown))),
        StartSpec::File(_) => {
            let found = start_file(context, start)?;
            Ok(found.map(|(coordinates, mesh)| from_mesh(context, model, coordinates, &mesh)))
        }
        StartSpec::Study(name) => {
            let fits = |saved: &&SavedState| {
                saved.coordinates.len() == context.assembly.drawn().coordinates.len()
                    && saved.angles.len() == model.angles().len()
            };
            let Some(saved) = context.earlier.states.get(name).filter(fits) else { return Ok(None) };
            model.set_angles(&saved.angles);
            let forces = saved.tension.clone().map_or(Forces::Unknown, Forces::OfMeasures);
            Ok(Some((model.start_from(saved.coordinates.clone()), forces)))
        }
    }
}

/// Returns the unknowns of the state in a VTU file and the forces that the file contains. Angles continue from those of
/// the file.
fn from_mesh(context: &Context<'_>, model: &mut Model, coordinates: Vec<f64>, mesh: &VtuMesh) -> (Vec<f64>, Forces) {
    let edges = context.assembly.edges();
    let on_edges = |values: &Option<Vec<f64>>| match values {
        Some(values) => context.view.on_edges(edges, &mesh.lines, values),
        None => vec![f64::NAN; edges],
    };
    let angles = restored::angles(model, &on_edges(&mesh.fold_angle));
    model.set_angles(&angles);
    let forces = Forces::OfEdges { tension: on_edges(&mesh.tension), torque: on_edges(&mesh.torque) };
    (model.start_from(coordinates), forces)
}

/// Returns the coordinates in the start file and the content of that file; `None` if the start is not a file.
fn start_file(context: &Context<'_>, start: &Located<StartSpec>) -> Result<Option<(Vec<f64>, VtuMesh)>, StudyError> {
    let StartSpec::File(path) = &**start else { return Ok(None) };
    let mesh = vtk::read_vtu(&context.file.resolve(path))?;
    let found = context.view.coordinates(context.assembly.drawn(), &mesh.points);
    found.map(|found| Some((found, mesh))).ok_or_else(|| {
        let count = context.assembly.drawn().coordinates.len() / 3;
        let message = format!("{} does not say where this sheet is", path.display());
        let help = format!("a start file has the {count} points of a patch or of a torus with fixed lattice");
        context.file.error_at(start.span(), message, help).into()
    })
}

/// Returns the unknowns of the drawn state, each displaced by a random amount up to the amplitude; the axis of a screw
/// keeps its direction.
fn random_start(random: &RandomStart, model: &mut Model) -> Vec<f64> {
    let mut numbers = rand_chacha::ChaCha8Rng::seed_from_u64(random.seed);
    let amplitude = random.random.0;
    let x: Vec<f64> = model.start().iter().map(|x| x + amplitude * symmetric(&mut numbers)).collect();
    let mut coordinates = model.coordinates(&x);
    if let Some(drawn) = model.domain().turns(&model.coordinates(&model.start())) {
        model.domain().point_axis(&mut coordinates, drawn.direction);
    }
    model.start_from(coordinates)
}

/// Returns the answer of a study whose start study has no final state.
pub(crate) fn start_unavailable(context: &Context<'_>) -> Answer {
    Answer::failed(context.study, "the study from which it starts did not converge")
}

/// Returns the summary of a relaxation, without the checks that the study asks for.
fn result_of(context: &Context<'_>, relaxed: &Relaxed) -> RelaxSummary {
    RelaxSummary {
        energy: energies::summary(context.assembly.terms(), &relaxed.state),
        iterations: relaxed.iterations,
        factorizations: relaxed.factorizations,
        chord_solves: relaxed.solves,
        residual_force: relaxed.residual_force,
        residual_length: relaxed.residual_length,
        negative_eigenvalues: Some(relaxed.negative_eigenvalues),
        self_stresses: relaxed.self_stresses,
        intrinsic_failure: relaxed.intrinsic_failure.map(|failure| failure.to_string()),
        history: history(&relaxed.history),
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
        intrinsic_failure: error.intrinsic_failure.map(|failure| failure.to_string()),
        history: history(&error.history),
        ..RelaxSummary::default()
    }
}

fn method(spec: MethodSpec) -> Method {
    match spec {
        MethodSpec::Auto => Method::Auto,
        MethodSpec::Vertices => Method::Vertices,
        MethodSpec::Intrinsic => Method::Intrinsic,
    }
}

fn history(steps: &[Step]) -> Vec<IterationSummary> {
    let row = |(iteration, step): (usize, &Step)| IterationSummary {
        iteration,
        energy: step.energy,
        residual_force: step.residual_force,
        residual_length: step.residual_length,
        step: step.fraction,
        shift: step.shift,
        method: if step.intrinsic { MethodName::Intrinsic } else { MethodName::Vertices },
    };
    steps.iter().enumerate().map(row).collect()
}
