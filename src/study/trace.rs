//! `kind = "trace"`: trajectories of rigid folding from the drawn state, and relaxations at their states.

mod summary;
mod trajectory;

use self::trajectory::{Path, is_tube, summary};
use super::states::{self, Shown};
use super::supported::small_tolerance;
use super::{Answer, Context, NoAnswer, StudyError, StudyResult, branches, energies, ratios, relax};
use crate::analysis::along::{RelaxedTrajectory, StateAlong, relax_along, relaxed_cylinder};
use crate::analysis::chart::coordinates_in;
use crate::analysis::intersections::SelfIntersection;
use crate::analysis::state::{Cylinder, State};
use crate::analysis::trace::{Folded, Intersects, Stop, TraceError, TraceOptions, Traced, trace};
use crate::model::{Assembly, Configuration, Domain, Gauge, Model};
use crate::numerics::worst;
use crate::output::figure::surface::{self, TrajectoryPoint};
use crate::output::strain_space::StrainSurface;
use crate::output::table::{EnergiesAndResiduals, StateRow};
use crate::scene::forms::BranchChoice;
use crate::scene::spec::{CreaseAngle, Draw, Engine, TraceSpec};
use crate::solver::continuation;
use crate::solver::{Options, Problem};
pub use summary::{ArcLength, ClosedTube, RayName, TraceSummary, TrajectorySummary, TurningPoint};

/// Longest step, and tolerance of the closure residual, used unless the scene gives others.
const MAX_STEP: f64 = 0.25;
const TOLERANCE: f64 = 3e-14;
/// Number of states examined for self-intersection between two calls of the observer.
const OBSERVED: usize = 64;
/// Largest number of pictures of a trajectory, and that of states on the page of a study, which take far less room.
const PICTURES: usize = 40;
const STATES_ON_PAGE: usize = 200;

/// Checks that trajectories can start from the drawn state: that of one cell, or of a finite sheet; or from a tube.
pub(crate) fn check(context: &Context<'_>, spec: &TraceSpec) -> Result<(), StudyError> {
    small_tolerance(context, spec.tolerance.as_ref())?;
    branches::check(context)?;
    let assembly = context.assembly;
    if *assembly.domain() == Domain::Patch && assembly.sheet().is_repeated() {
        let message = "trajectories of a patch of a periodic sheet are not known";
        let help = "use domain = \"screw\", of a cell that is drawn rolled up \"tube\", or a mesh without lattice";
        return Err(context.refuse(message, help).into());
    }
    if spec.engine != Engine::Kinematic && assembly.terms().bars.is_none() {
        let message = "the energy engine relaxes bars, and this scene has none";
        let help = "give `bars` in [energy] a stiffness (inf: rigid), or leave `engine` out";
        return Err(context.refuse(message, help).into());
    }
    ratios::check(context, spec.response.as_ref())?;
    stop(context, spec).map(|_| ())
}

fn stop(context: &Context<'_>, spec: &TraceSpec) -> Result<Stop, StudyError> {
    let Some(said) = &spec.stop else { return Ok(Stop::default()) };
    let crease_angle = |wanted: &CreaseAngle| {
        let key = wanted.crease.0;
        let edge = context.assembly.sheet().edges.iter().position(|edge| edge.key == key);
        edge.map(|edge| (edge, wanted.angle.radians)).ok_or_else(|| {
            let message = format!("the sheet has no crease {key}");
            context.file.error_at(wanted.crease.span(), message, "name an edge as [i, j, n1, n2]")
        })
    };
    Ok(Stop {
        arc_length: said.arc_length.as_ref().map(|length| length.0),
        curvature: said.curvature.as_ref().map(|curvature| curvature.0),
        crease_angle: said.crease_angle.as_ref().map(crease_angle).transpose()?,
        self_intersection: said.self_intersection == Some(true),
    })
}

/// Follows the trajectories that the scene asks for.
pub(crate) fn compute(context: &Context<'_>, spec: &TraceSpec) -> Result<Answer, NoAnswer> {
    let options = TraceOptions {
        max_step: spec.max_step.as_ref().map_or(MAX_STEP, |step| step.0),
        tolerance: spec.tolerance.as_ref().map_or(TOLERANCE, |tolerance| tolerance.0),
        branch: match spec.branch.as_deref() {
            Some(BranchChoice::Number(branch)) => Some(*branch),
            _ => None,
        },
        stop: stop(context, spec)?,
    };
    let traced = follow(context, &options).map_err(NoAnswer::because)?;
    let relaxations = relaxed(context, spec.engine, &traced);
    context.end_steps();
    let pictures = if context.study.draw.contains(&Draw::Html) { STATES_ON_PAGE } else { PICTURES };
    let paths: Vec<Path<'_>> =
        traced.iter().enumerate().map(|(k, traced)| Path { traced, relaxed: relaxations.get(k), pictures }).collect();
    let mut answer = Answer::empty(context.study);
    add_files(&mut answer, context, spec, &paths);
    // after an interruption during the search for self-intersections, the table lacks their entries
    let stopped = context.interrupted().then(|| "interrupted".to_owned());
    let reason = paths.iter().find_map(Path::failure).or(stopped);
    let error = worst(paths.iter().filter_map(Path::residual));
    let result = summary(context, &paths, spec.engine, is_asked(context, &options));
    answer.conclude(StudyResult::Trace(result), error, reason);
    Ok(answer)
}

/// Whether the study looks for self-intersections.
fn is_asked(context: &Context<'_>, options: &TraceOptions) -> bool {
    options.stop.self_intersection || !context.study.check.is_empty()
}

/// Follows the trajectories, and examines their states for self-intersections if the study or a stop asks for it.
fn follow(context: &Context<'_>, options: &TraceOptions) -> Result<Vec<Traced>, TraceError> {
    let (assembly, asked) = (context.assembly, is_asked(context, options));
    let mut finder = asked.then(|| SelfIntersection::new(assembly));
    let model = assembly.model(Gauge::Held);
    let mut crosses = |state: &Folded| {
        let shown = state_at(&model, coordinates_in(assembly.domain(), state), &state.angles);
        finder.as_mut().is_some_and(|finder| finder.marks(assembly.drawn(), &shown).any)
    };
    let mut step = 0;
    let mut observe = |_: (usize, i8), point: &continuation::CurvePoint| {
        step += 1;
        context.step_with_residual(step, None, point.residual)
    };
    let crosses = asked.then_some(&mut crosses as Intersects<'_>);
    trace(assembly, options, crosses, &mut observe)
}

/// Makes the state with these coordinates and fold angles of all edges the reference state of a model, and returns it.
pub(crate) fn enter_folded(model: &mut Model, coordinates: Vec<f64>, angles: &[f64]) -> State {
    let folded = Configuration::new(coordinates, model.angles_among(angles), None);
    model.enter(&folded);
    state_at(model, folded.coordinates, angles)
}

/// Returns the state of a model at these coordinates, with the fold angles of all edges.
fn state_at(model: &Model, coordinates: Vec<f64>, angles: &[f64]) -> State {
    let tension = vec![0.0; model.layout().stiff.len()];
    let state = State::new(model, &model.unknowns(&coordinates), &tension);
    State { coordinates, fold_angle: angles.to_vec(), ..state }
}

/// Returns the relaxations at the states of every trajectory; none if the engine is kinematic.
fn relaxed(context: &Context<'_>, engine: Engine, traced: &[Traced]) -> Vec<RelaxedTrajectory> {
    if engine == Engine::Kinematic {
        return Vec::new();
    }
    let mut watch = relax::watcher(context);
    traced.iter().map(|one| relax_along(context.assembly, Options::default(), one, &mut watch)).collect()
}

/// Adds the table of all states, pictures of some, and the trajectories in the space of lattice strains. Keeps the last
/// state of the first trajectory for studies that start from it.
fn add_files(answer: &mut Answer, context: &Context<'_>, spec: &TraceSpec, paths: &[Path<'_>]) {
    let assembly = context.assembly;
    let mut model = assembly.model(Gauge::Held);
    let mut finder = context.self_intersection();
    let (mut rows, mut pictures, mut shown) = (Vec::new(), Vec::new(), (0, String::new()));
    for path in paths {
        let first = pictures.len();
        for step in 0..path.len() {
            let (folded, along) = (&path.traced.states[step], path.relaxed_at(step));
            let pause = rows.len() % OBSERVED == OBSERVED - 1 && finder.is_some();
            if pause && !context.step_with_residual(rows.len(), None, 0.0) {
                finder = None;
            }
            let state = folded_state(assembly, &mut model, folded);
            let state =
                along.map_or(state, |along| State { fold_angle: along.angles.clone(), ..along.relaxed.state.clone() });
            let marks = finder.as_mut().map(|finder| finder.marks(assembly.drawn(), &state));
            let row = row(assembly, (path, step), (folded, along), &state, marks.as_ref().map(|marks| marks.any));
            let compared = along.filter(|_| spec.engine == Engine::Both);
            let ratios = ratios::of_state(assembly, spec.response.as_ref(), &state.coordinates);
            rows.push(StateRow { error_to_kinematic: compared.map(|along| along.error), ratios, ..row });
            if step % path.every() == 0 || step + 1 == path.len() {
                pictures.push((rows.len() - 1, Shown { state, residuals: None, marks }));
            }
        }
        let (step, words) = path.shown();
        let within = if step + 1 < path.len() { step / path.every() } else { pictures.len() - first - 1 };
        shown = (first + within, words);
    }
    answer.add(format!("{}.csv", context.name()), states::table_of_rows(context, &rows));
    if is_tube(assembly) {
        let closed = closed_tubes(assembly, &mut model, paths);
        answer.add(format!("{}-closed-tubes.csv", context.name()), states::table_of_rows(context, &closed));
    }
    let timed = pictures.iter().map(|(row, shown)| (*row, *row, shown));
    states::add(answer, context, timed, Some((shown.0, &shown.1)));
    add_paths(answer, context, paths, &rows);
    answer.state = saved_state(assembly, &model, paths);
}

/// Returns a row for each state on the way in which a tube is closed again.
fn closed_tubes(assembly: &Assembly, model: &mut Model, paths: &[Path<'_>]) -> Vec<StateRow> {
    let mut rows = Vec::new();
    for path in paths {
        for folded in &path.traced.closed_tubes {
            let state = folded_state(assembly, model, folded);
            rows.push(StateRow { step: None, ..row(assembly, (path, 0), (folded, None), &state, None) });
        }
    }
    rows
}

/// Returns the state of a model with the fold angles of a state on a trajectory.
fn folded_state(assembly: &Assembly, model: &mut Model, folded: &Folded) -> State {
    enter_folded(model, coordinates_in(assembly.domain(), folded), &folded.angles)
}

/// Adds the trajectories in the space of lattice strains, as a picture and for later surface studies, which draw them.
fn add_paths(answer: &mut Answer, context: &Context<'_>, paths: &[Path<'_>], mut rows: &[StateRow]) {
    let mut lines = Vec::new();
    for path in paths {
        let (own, rest) = rows.split_at(path.len());
        let point = |shape: Cylinder| TrajectoryPoint::new(shape.strain.into(), shape.curvature, shape.theta);
        lines.push(own.iter().filter_map(|row| row.shape).map(point).collect::<Vec<TrajectoryPoint>>());
        rows = rest;
    }
    if context.draws(Draw::Svg) && !lines.iter().all(Vec::is_empty) {
        let rays = if lines.len() == 1 { "one trajectory".to_owned() } else { format!("{} trajectories", lines.len()) };
        let caption = context.caption(format!("{rays}, coloured by curvature"));
        let file = format!("{}-strain.svg", context.name());
        answer.add(file, surface::svg(&StrainSurface::default(), &lines, &caption));
    }
    answer.paths = lines;
}

/// Returns the last state of the first trajectory.
fn saved_state(assembly: &Assembly, model: &Model, paths: &[Path<'_>]) -> Option<Configuration> {
    let path = paths.first()?;
    let along = path.relaxed.and_then(|relaxed| relaxed.states.last());
    let (coordinates, angles) = match (along, path.traced.states.last()) {
        (Some(along), _) => (along.relaxed.state.coordinates.clone(), &along.angles),
        (None, Some(folded)) => (coordinates_in(assembly.domain(), folded), &folded.angles),
        (None, None) => return None,
    };
    Some(Configuration::new(coordinates, model.angles_among(angles), None))
}

fn row(
    assembly: &Assembly,
    (path, step): (&Path<'_>, usize),
    (folded, along): (&Folded, Option<&StateAlong>),
    state: &State,
    self_intersecting: Option<bool>,
) -> StateRow {
    let shape = match along {
        None => folded.shape.as_ref().map(Cylinder::from),
        Some(along) => relaxed_cylinder(assembly.drawn(), folded, along),
    };
    let branch = path.traced.branch;
    let residuals = along.map(|along| [along.relaxed.residual_force, along.relaxed.residual_length]);
    StateRow {
        branch: Some(branch.0 as i64),
        sign: Some(i64::from(branch.1)),
        step: Some(step as i64),
        arc_length: Some(folded.arc_length),
        shape,
        solution: EnergiesAndResiduals::new(energies::columns_if_any(assembly.terms(), state), residuals),
        self_intersecting,
        seam: is_tube(assembly).then(|| [folded.seam.map(|seam| seam.turn), folded.seam.map(|seam| seam.rise)]),
        fold: state.fold_angle.clone(),
        ..StateRow::default()
    }
}
