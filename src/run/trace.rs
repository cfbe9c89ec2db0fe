//! `kind = "trace"`: asks the analysis, writes the states of all trajectories, summarises.

use super::draw::{self, Shown};
use super::resume::Kept;
use super::runner::Runner;
use super::{Progress, RunError, branches};
use crate::analysis::branches::Question as Start;
use crate::analysis::chart::coordinates;
use crate::analysis::intersections::{LYING, SelfIntersection};
use crate::analysis::state::State;
use crate::analysis::trace::{Folded, Question, Stop, TURNING, Traced, trace};
use crate::model::assemble::{Surroundings, assemble, drawn_angles};
use crate::model::{Gauge, Model};
use crate::output::summary::{
    ArcLength, RayName, StudyResult, StudySummary, TraceSummary, TrajectorySummary, TurningPoint,
};
use crate::output::table::{StateRow, Table};
use crate::scene::SceneFile;
use crate::scene::build::Built;
use crate::scene::forms::BranchChoice;
use crate::scene::spec::{Engine, StudySpec, TraceSpec};
use crate::sheet::EdgeKey;
use crate::solver::Problem;
use crate::solver::continuation::End;
use std::time::Instant;

/// Longest step and bound on the residual where the scene says nothing.
const MAX_STEP: f64 = 0.25;
const TOLERANCE: f64 = 3e-14;
/// Most pictures of a trajectory.
const PICTURES: usize = 40;

/// Trajectories start from the drawn state of one cell, or of a finite sheet.
pub fn check(file: &SceneFile, built: &Built, study: &StudySpec, spec: &TraceSpec) -> Result<(), RunError> {
    branches::check(file, built, study)?;
    if built.surroundings == Surroundings::Patch && built.sheet.lattice.is_some() {
        let message = "trajectories of a patch of a periodic sheet are not known";
        return Err(file
            .error_at(study.kind.span(), message, "use domain = \"screw\", or a mesh without lattice")
            .into());
    }
    if spec.engine != Engine::Kinematic {
        let message = "this version follows trajectories with the kinematic engine only";
        return Err(file.error_at(study.kind.span(), message, "leave `engine` out").into());
    }
    stop(file, built, spec).map(|_| ())
}

fn stop(file: &SceneFile, built: &Built, spec: &TraceSpec) -> Result<Stop, RunError> {
    let Some(said) = &spec.stop else { return Ok(Stop::default()) };
    let crease_angle = match &said.crease_angle {
        None => None,
        Some(wanted) => {
            let key = wanted.crease.0;
            let found = built.sheet.edges.iter().position(|edge| edge.key == key);
            let edge = found.ok_or_else(|| {
                let EdgeKey { i, j, shift: [n1, n2] } = key;
                let message = format!("the sheet has no crease [{i}, {j}, {n1}, {n2}]");
                file.error_at(wanted.crease.span(), message, "name an edge as [i, j, n1, n2]")
            })?;
            Some((edge, wanted.angle.0))
        }
    };
    Ok(Stop {
        arc_length: said.arc_length.as_ref().map(|length| length.0),
        curvature: said.curvature.as_ref().map(|curvature| curvature.0),
        crease_angle,
        self_intersection: said.self_intersection == Some(true),
    })
}

/// Runs the study.
pub fn study(runner: &mut Runner<'_>, study: &StudySpec, spec: &TraceSpec) -> Result<StudySummary, RunError> {
    let built = runner.built;
    let angles = drawn_angles(&built.drawn, &built.tiling);
    let start = Start {
        sheet: &built.sheet,
        tiling: &built.tiling,
        surroundings: built.surroundings,
        angles: &angles,
        recipe: &built.recipe,
    };
    let question = Question {
        start,
        max_step: spec.max_step.as_ref().map_or(MAX_STEP, |step| step.0),
        tolerance: spec.tolerance.as_ref().map_or(TOLERANCE, |tolerance| tolerance.0),
        branch: match spec.branch.as_deref() {
            Some(BranchChoice::Number(branch)) => Some(*branch),
            _ => None,
        },
        stop: stop(runner.file, built, spec)?,
    };
    let clock = Instant::now();
    let found = follow(runner, study, &question);
    let seconds = clock.elapsed().as_secs_f64();
    let mut summary = StudySummary {
        name: study.name.0.clone(),
        kind: study.kind.name().to_owned(),
        converged: false,
        seconds,
        error: None,
        reason: None,
        result: None,
    };
    match found {
        Ok(traced) => {
            write(runner, study, &traced)?;
            let failed = |one: &Traced| matches!(one.end, End::Failed | End::Steps | End::Interrupted);
            summary.converged = !traced.iter().any(failed);
            summary.reason = (!summary.converged).then(|| "a trajectory did not come to its end".to_owned());
            let states = traced.iter().flat_map(|one| &one.states);
            summary.error = Some(states.map(|state| state.residual).fold(0.0, f64::max));
            summary.result = Some(StudyResult::Trace(summarized(&traced)));
        }
        Err(error) => summary.reason = Some(error.to_string()),
    }
    Ok(summary)
}

/// Follows the trajectories, watched for self-intersection where the study or a stop asks for it.
fn follow(
    runner: &Runner<'_>,
    study: &StudySpec,
    question: &Question<'_>,
) -> Result<Vec<Traced>, crate::analysis::trace::TraceError> {
    let built = runner.built;
    let asked = question.stop.self_intersection || !study.check.is_empty();
    let mut finder = asked.then(|| SelfIntersection::new(&built.sheet, &built.tiling, built.surroundings, built.shown));
    let model = model(built);
    let mut crosses = |state: &Folded| {
        let shown = shown_state(built, &model, state);
        finder.as_mut().is_some_and(|finder| finder.marks(&built.drawn, &shown, LYING).any)
    };
    let mut step = 0;
    let mut observe = |_: (usize, i8), point: &crate::solver::continuation::Point| {
        step += 1;
        let (study, residual) = (study.name.0.clone(), point.residual);
        runner.watch(&Progress { study, step, of: None, residual, target: None })
    };
    if asked { trace(question, Some(&mut crosses), &mut observe) } else { trace(question, None, &mut observe) }
}

fn model(built: &Built) -> Model {
    assemble(&built.drawn, &built.tiling, &built.recipe, Gauge::Held)
}

/// A folded state as the model sees it, with the fold angles of all edges.
fn shown_state(built: &Built, model: &Model, folded: &Folded) -> State {
    state_at(built, model, coordinates(folded), &folded.angles)
}

/// The state of a model at coordinates, with the fold angles of all edges.
pub fn state_at(built: &Built, model: &Model, coordinates: Vec<f64>, angles: &[f64]) -> State {
    let tension = vec![0.0; model.layout().stiff.len()];
    let state = State::new(model, &model.unknowns(&coordinates), &tension, built.tiling.edges.len());
    State { coordinates, fold_angle: angles.to_vec(), ..state }
}

/// The angles of the model's hinges, from which a relaxation of this state continues.
pub fn hinge_angles(model: &Model, angles: &[f64]) -> Vec<f64> {
    let terms = model.soft().iter().chain(model.stiff()).filter(|term| term.is_angle());
    terms.flat_map(|term| (0..term.len()).map(|k| angles[term.edge(k)]).collect::<Vec<_>>()).collect()
}

fn write(runner: &mut Runner<'_>, study: &StudySpec, traced: &[Traced]) -> Result<(), RunError> {
    let built = runner.built;
    let mut model = model(built);
    let mut finder = draw::self_intersection(runner, study);
    let (mut rows, mut pictures) = (Vec::new(), Vec::new());
    for one in traced {
        let every = one.states.len().div_ceil(PICTURES);
        for (step, folded) in one.states.iter().enumerate() {
            model.set_angles(&hinge_angles(&model, &folded.angles));
            model.start_from(coordinates(folded));
            let state = shown_state(built, &model, folded);
            let marks = finder.as_mut().map(|finder| finder.marks(&built.drawn, &state, LYING));
            rows.push(row(built, one, step, folded, &state, marks.as_ref().map(|marks| marks.any)));
            if step % every == 0 || step + 1 == one.states.len() {
                pictures.push((state, marks));
            }
        }
    }
    let keys: Vec<EdgeKey> = built.sheet.edges.iter().map(|edge| edge.key).collect();
    Table::of_states(&keys, &rows).write(&runner.path(format!("{}.csv", study.name.0)))?;
    let (states, marks): (Vec<State>, Vec<_>) = pictures.into_iter().unzip();
    let shown: Vec<Shown<'_>> =
        states.iter().zip(marks).map(|(state, marks)| Shown { state, residuals: None, marks }).collect();
    draw::series(runner, study, &shown)?;
    if let Some(last) = traced.first().and_then(|one| one.states.last()) {
        let kept = Kept { coordinates: coordinates(last), angles: hinge_angles(&model, &last.angles) };
        runner.keep_state(study, kept)?;
    }
    Ok(())
}

fn row(
    built: &Built,
    one: &Traced,
    step: usize,
    folded: &Folded,
    state: &State,
    self_intersecting: Option<bool>,
) -> StateRow {
    let shape = folded.shape.as_ref();
    let recipe = &built.recipe;
    let any = recipe.bars.is_some() || recipe.creases.is_some();
    StateRow {
        branch: Some(one.branch.0 as i64),
        sign: Some(i64::from(one.branch.1)),
        step: Some(step as i64),
        arc_length: Some(folded.arc_length),
        curvature: shape.map(|shape| shape.curvature),
        theta: [0, 1].map(|k| shape.map(|shape| shape.theta[k])),
        strain: [0, 1, 2].map(|k| shape.map(|shape| shape.strain[k])),
        energy: [
            recipe.bars.map(|_| state.energy_bars),
            recipe.creases.as_ref().map(|_| state.energy_creases),
            recipe.facets.as_ref().map(|_| state.energy_facets),
            any.then(|| state.total()),
        ],
        residual_length: None,
        residual_force: None,
        self_intersecting,
        fold: folded.angles.clone(),
    }
}

fn summarized(traced: &[Traced]) -> TraceSummary {
    if traced.is_empty() {
        let end = "no-real-branch".to_owned();
        return TraceSummary { branches: vec![TrajectorySummary { end, ..TrajectorySummary::default() }] };
    }
    TraceSummary { branches: traced.iter().map(trajectory).collect() }
}

fn trajectory(one: &Traced) -> TrajectorySummary {
    let end = match one.end {
        End::Closed(_) => "closed",
        End::Stopped { .. } | End::Length => "stop",
        End::Steps | End::Failed | End::Interrupted => "failed",
    };
    TrajectorySummary {
        branch: Some(one.branch.0),
        sign: Some(one.branch.1),
        closed: matches!(one.end, End::Closed(_)),
        arc_length: one.states.last().map_or(0.0, |state| state.arc_length),
        steps: one.states.len() - 1,
        iterations: one.corrections,
        max_residual: one.states.iter().map(|state| state.residual).fold(0.0, f64::max),
        ends_at: one.ends_at.map(|(branch, sign)| RayName { branch, sign }),
        end: end.to_owned(),
        first_self_intersection: one.first_self_intersection.map(|arc_length| ArcLength { arc_length }),
        error_to_kinematic: None,
        turning_points: one.turning_points.iter().map(turning_point).collect(),
    }
}

fn turning_point((quantity, state): &(usize, Folded)) -> TurningPoint {
    let shape = state.shape.as_ref();
    let value =
        shape.map_or(f64::NAN, |shape| if *quantity == 0 { shape.curvature } else { shape.strain[quantity - 1] });
    TurningPoint { of: TURNING[*quantity].to_owned(), arc_length: state.arc_length, value }
}
