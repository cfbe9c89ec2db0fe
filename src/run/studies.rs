//! The kinds of study: ask the analysis, write its files, summarise.

use super::draw::{self, Shown};
use super::reason::reason;
use super::resume::Kept;
use super::runner::Runner;
use super::{Progress, RunError, bloch, branches, landscape, surface, trace, wells};
use crate::analysis;
use crate::analysis::exact::error_to_kinematic;
use crate::analysis::intersections::LYING;
use crate::analysis::modes::{Modes, SPARSE_EIGENVALUES, decomposed_dense};
use crate::analysis::relax::{RelaxError, Relaxed};
use crate::analysis::restored::{self, Forces};
use crate::analysis::state::State;
use crate::analysis::view::View;
use crate::model::{Assembly, Gauge, Model};
use crate::numerics::larger;
use crate::output::figure::rounded;
use crate::output::picture::Picture;
use crate::output::summary::{EnergySummary, IterationSummary, ModesSummary, RelaxSummary, StudyResult, StudySummary};
use crate::output::table::{Table, Value};
use crate::output::vtk::{self, VtuMesh};
use crate::scene::forms::{RandomStart, Start};
use crate::scene::spec::{Draw, ModesSpec, RelaxSpec, StudyKind, StudySpec};
use crate::scene::{Located, SceneFile};
use crate::solver::{Options, Step};
use rand::{RngExt, SeedableRng};
use std::time::Instant;

/// Checks what a study says before anything is written.
pub fn check(file: &SceneFile, assembly: &Assembly, view: &View, study: &StudySpec) -> Result<(), RunError> {
    match &*study.kind {
        StudyKind::Relax(_) if !assembly.terms().has_energy() => {
            let help = "give bars, creases or facets a stiffness";
            Err(file.error_at(study.kind.span(), "there is no energy to relax", help).into())
        }
        StudyKind::Relax(spec) => match &spec.start {
            Some(start) => start_file(file, assembly, view, start).map(|_| ()),
            None => Ok(()),
        },
        StudyKind::Modes(spec) => match &spec.eigenvalues {
            Some(count) => enough_eigenvalues(file, assembly, count),
            None => Ok(()),
        },
        StudyKind::Branches(_) => branches::check(file, assembly, study),
        StudyKind::Trace(spec) => trace::check(file, assembly, study, spec),
        StudyKind::Surface(_) => surface::check(file, assembly, study),
        StudyKind::Landscape(spec) => landscape::check(file, assembly, study, spec),
        StudyKind::Bloch(spec) => bloch::check(file, assembly, study, spec),
        StudyKind::Wells(_) => wells::check(file, assembly, study),
    }
}

/// Whether the model has so many eigenvalues that a study of modes can find.
fn enough_eigenvalues(file: &SceneFile, assembly: &Assembly, count: &Located<usize>) -> Result<(), RunError> {
    let held = assembly.drawn().held.len() + assembly.terms().pinned();
    let unknowns = assembly.drawn().coordinates.len().saturating_sub(held);
    let wanted = (**count).min(unknowns);
    match decomposed_dense(unknowns, wanted, unknowns) {
        Ok(_) => Ok(()),
        Err(error) => {
            let help = format!("ask for at most {SPARSE_EIGENVALUES}, or take fewer cells");
            Err(file.error_at(count.span(), error.to_string(), help).into())
        }
    }
}

/// `kind = "relax"`.
pub fn relax(runner: &mut Runner<'_>, study: &StudySpec, spec: &RelaxSpec) -> Result<StudySummary, RunError> {
    let assembly = runner.assembly;
    let mut model = assembly.model(Gauge::Held);
    let Some((x, forces)) = start(runner, spec, &mut model)? else { return Ok(nowhere_to_start(study)) };
    let tensions = restored::tensions(&model, &x, &forces);
    let known = spec.start.as_deref().is_some_and(|start| matches!(start, Start::Study(_) | Start::File(_)));
    let start = if known { restored::start(&model, x, tensions.clone()) } else { x.into() };
    let first = State::new(&model, &start.x, start.tension.as_ref().unwrap_or(&tensions));
    let mut options = Options::default();
    if let Some(tolerance) = &spec.tolerance {
        options.tolerance = tolerance.0;
    }
    let clock = Instant::now();
    let found = analysis::relax::relax_from(&mut model, start, options, &mut watcher(runner, study));
    let seconds = clock.elapsed().as_secs_f64();
    match found {
        Ok(relaxed) => {
            let residuals = Some([relaxed.residual_force, relaxed.residual_length]);
            let shown = format!("equilibrium, energy {}", rounded(relaxed.state.total(), 5));
            let self_intersecting = write_states(runner, study, [&first, &relaxed.state], residuals, &shown)?;
            let coordinates = relaxed.state.coordinates.clone();
            let tension = Some(relaxed.tension.clone());
            runner.keep_state(study, Kept { coordinates, angles: model.angles(), tension })?;
            let angles = draw::with_all_angles(assembly, &relaxed.state).fold_angle;
            let error_to_kinematic = error_to_kinematic(assembly.sheet(), assembly.tiling(), &model, &angles);
            let drawn = spec.start.as_ref().is_none_or(|start| matches!(**start, Start::Drawn));
            let (branch_point_start, directions) = if drawn { branches::branch_point(assembly) } else { (None, None) };
            let result = RelaxSummary {
                self_intersecting,
                error_to_kinematic,
                branch_point_start,
                directions_at_start: directions.map(branches::word),
                ..result_of(assembly, &relaxed)
            };
            Ok(relaxation_summary(study, seconds, result, None))
        }
        Err(error) => {
            let residuals = error.history.last().map(|step| [step.residual_force, step.residual_length]);
            let shown = "last state of a relaxation without end";
            let self_intersecting = write_states(runner, study, [&first, &error.state], residuals, shown)?;
            let result = RelaxSummary { self_intersecting, ..last_of(assembly, &error) };
            Ok(relaxation_summary(study, seconds, result, Some(reason(assembly, error.failure, &error.state))))
        }
    }
}

/// Shows the steps of a relaxation.
pub fn watcher(runner: &Runner<'_>, study: &StudySpec) -> impl FnMut(&Step) -> bool {
    let mut step = 0;
    move |last| {
        step += 1;
        let residual = last.residual_force.max(last.residual_length);
        runner.watch(&Progress { study: study.name.0.clone(), step, of: None, residual })
    }
}

/// Table and pictures of the start and the end of a relaxation, with the residuals at its end; whether that passes through itself,
/// where it is asked.
fn write_states(
    runner: &Runner<'_>,
    study: &StudySpec,
    states: [&State; 2],
    residuals: Option<[f64; 2]>,
    state: &str,
) -> Result<Option<bool>, RunError> {
    let states = states.map(|state| draw::with_all_angles(runner.assembly, state));
    let mut check = draw::self_intersection(runner, study);
    let [first, last] = states.each_ref().map(|state| {
        let marks = check.as_mut().map(|check| check.marks(runner.assembly.drawn(), state, LYING));
        Shown { state, residuals: None, marks }
    });
    let shown = [first, Shown { residuals, ..last }];
    draw::table(runner, study, &shown)?;
    draw::series(runner, study, &shown, (1, state))?;
    Ok(shown[1].marks.as_ref().map(|marks| marks.any))
}

/// The unknowns from which a relaxation starts, and what is known of their forces; `None` where the study to start from ended in no
/// state.
fn start(runner: &Runner<'_>, spec: &RelaxSpec, model: &mut Model) -> Result<Option<(Vec<f64>, Forces)>, RunError> {
    let Some(start) = &spec.start else { return Ok(Some((model.start(), Forces::Unknown))) };
    match &**start {
        Start::Drawn => Ok(Some((model.start(), Forces::Unknown))),
        Start::Random(random) => Ok(Some((random_start(random, model), Forces::Unknown))),
        Start::File(_) => {
            let found = start_file(runner.file, runner.assembly, &runner.view, start)?;
            Ok(found.map(|(coordinates, mesh)| from_mesh(runner, model, coordinates, &mesh)))
        }
        Start::Study(name) => {
            let fits = |kept: &&Kept| {
                kept.coordinates.len() == runner.assembly.drawn().coordinates.len()
                    && kept.angles.len() == model.angles().len()
            };
            let Some(kept) = runner.state(name).filter(fits) else { return Ok(None) };
            model.set_angles(&kept.angles);
            let forces = kept.tension.clone().map_or(Forces::Unknown, Forces::OfMeasures);
            Ok(Some((model.start_from(kept.coordinates.clone()), forces)))
        }
    }
}

/// The unknowns of a state that a VTU file gives, its angles continued from those of the file, and the forces that the file has.
fn from_mesh(runner: &Runner<'_>, model: &mut Model, coordinates: Vec<f64>, mesh: &VtuMesh) -> (Vec<f64>, Forces) {
    let edges = runner.assembly.tiling().edges.len();
    let on_edges = |values: &Option<Vec<f64>>| match values {
        Some(values) => runner.view.on_edges(edges, &mesh.lines, values),
        None => vec![f64::NAN; edges],
    };
    let angles = restored::angles(model, &on_edges(&mesh.fold_angle));
    model.set_angles(&angles);
    let forces = Forces::OfEdges { tension: on_edges(&mesh.tension), torque: on_edges(&mesh.torque) };
    (model.start_from(coordinates), forces)
}

/// The coordinates that a VTU file gives, and the file; `None` where the start is no file.
fn start_file(
    file: &SceneFile,
    assembly: &Assembly,
    view: &View,
    start: &Located<Start>,
) -> Result<Option<(Vec<f64>, VtuMesh)>, RunError> {
    let Start::File(path) = &**start else { return Ok(None) };
    let mesh = vtk::read_vtu(&file.resolve(path))?;
    let found = view.coordinates(assembly.drawn(), &mesh.points);
    found.map(|found| Some((found, mesh))).ok_or_else(|| {
        let count = assembly.drawn().coordinates.len() / 3;
        let message = format!("{} does not say where this sheet is", path.display());
        let help = format!("a start file has the {count} points of a patch or of a torus with fixed lattice");
        file.error_at(start.span(), message, help).into()
    })
}

/// The drawn state with every unknown moved by a random amount up to the amplitude; the axis of a screw keeps its direction.
fn random_start(random: &RandomStart, model: &mut Model) -> Vec<f64> {
    let mut numbers = rand_chacha::ChaCha8Rng::seed_from_u64(random.seed);
    let amplitude = random.random.0;
    let x: Vec<f64> = model.start().iter().map(|x| x + amplitude * (2.0 * numbers.random::<f64>() - 1.0)).collect();
    let mut coordinates = model.coordinates(&x);
    if let Some(drawn) = model.domain().turns(&model.coordinates(&model.start())) {
        model.domain().point_axis(&mut coordinates, drawn.direction);
    }
    model.start_from(coordinates)
}

/// What there is to say of a study that starts from one without a state.
pub fn nowhere_to_start(study: &StudySpec) -> StudySummary {
    StudySummary {
        reason: Some("the study from which it starts did not converge".into()),
        ..StudySummary::unanswered(&study.name.0, study.kind.name())
    }
}

/// The summary of a relaxation, with its reason where it failed.
fn relaxation_summary(study: &StudySpec, seconds: f64, result: RelaxSummary, failure: Option<String>) -> StudySummary {
    let converged = failure.is_none();
    StudySummary {
        converged,
        seconds,
        error: converged.then_some(larger(result.residual_force, result.residual_length)),
        reason: failure,
        result: Some(StudyResult::Relax(result)),
        ..StudySummary::unanswered(&study.name.0, study.kind.name())
    }
}

/// What a relaxation found; what is asked of the state besides is left open.
fn result_of(assembly: &Assembly, relaxed: &Relaxed) -> RelaxSummary {
    RelaxSummary {
        energy: energy(assembly, &relaxed.state),
        iterations: relaxed.iterations,
        factorizations: relaxed.factorizations,
        chord_solves: relaxed.solves,
        residual_force: relaxed.residual_force,
        residual_length: relaxed.residual_length,
        negative_eigenvalues: Some(relaxed.negative_eigenvalues),
        self_stresses: relaxed.self_stresses,
        history: history(&relaxed.history),
        ..RelaxSummary::default()
    }
}

/// Where a relaxation that failed ended, likewise.
fn last_of(assembly: &Assembly, error: &RelaxError) -> RelaxSummary {
    let last = error.history.last();
    RelaxSummary {
        energy: energy(assembly, &error.state),
        iterations: error.history.iter().filter(|step| step.fraction > 0.0).count(),
        factorizations: error.history.iter().map(|step| step.factorizations).sum(),
        chord_solves: error.history.iter().map(|step| step.solves).sum(),
        residual_force: last.map_or(f64::NAN, |step| step.residual_force),
        residual_length: last.map_or(f64::NAN, |step| step.residual_length),
        history: history(&error.history),
        ..RelaxSummary::default()
    }
}

fn energy(assembly: &Assembly, state: &State) -> EnergySummary {
    EnergySummary {
        bars: assembly.terms().bars.map(|_| state.energy_bars),
        creases: assembly.terms().creases.as_ref().map(|_| state.energy_creases),
        facets: assembly.terms().facets.as_ref().map(|_| state.energy_facets),
        total: state.total(),
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
    };
    steps.iter().enumerate().map(row).collect()
}

/// `kind = "modes"`.
pub fn modes(runner: &mut Runner<'_>, study: &StudySpec, spec: &ModesSpec) -> Result<StudySummary, RunError> {
    let assembly = runner.assembly;
    let eigenvalues = spec.eigenvalues.as_ref().map_or(0, |n| **n);
    let (clock, mut step, observed) = (Instant::now(), 0, &*runner);
    let found = analysis::modes::modes(assembly, eigenvalues, &mut || {
        step += 1;
        observed.watch(&Progress { study: study.name.0.clone(), step, of: None, residual: f64::NAN })
    });
    let seconds = clock.elapsed().as_secs_f64();
    let mut summary = StudySummary {
        converged: found.is_ok(),
        seconds,
        ..StudySummary::unanswered(&study.name.0, study.kind.name())
    };
    match found {
        Ok(modes) => {
            write_modes(runner, study, &modes)?;
            summary.error = modes.gap.map(f64::recip);
            summary.result = Some(StudyResult::Modes(modes_summary(&modes)));
        }
        Err(error) => summary.reason = Some(error.to_string()),
    }
    Ok(summary)
}

fn modes_summary(modes: &Modes) -> ModesSummary {
    ModesSummary {
        zero_modes: modes.zero_modes,
        self_stresses: modes.self_stresses,
        rigid_motions: modes.rigid_motions,
        folding_modes: modes.folding_modes,
        maxwell_count: modes.maxwell_count,
        gap: modes.gap,
        eigenvalues: modes.eigenvalues.clone(),
    }
}

/// A table of the eigenvalues; the drawn state with each mode as displacement; a picture of the softest mode that is no
/// rigid motion, drawn at a tenth of the sheet's size.
fn write_modes(runner: &Runner<'_>, study: &StudySpec, modes: &Modes) -> Result<(), RunError> {
    let mut table = Table::new(vec!["mode".into(), "eigenvalue".into()]);
    for (k, value) in modes.eigenvalues.iter().enumerate() {
        table.push(vec![Value::Whole(k as i64), Value::Number(*value)]);
    }
    table.write(&runner.path(format!("{}.csv", study.name.0)))?;
    if modes.vectors.is_empty() || study.draw.is_empty() {
        return Ok(());
    }
    let drawn = drawn_picture(runner, study);
    let moving = |rates: &Vec<f64>| {
        let displacement = runner.view.velocities(runner.assembly.drawn(), rates);
        Picture { displacement, ..drawn.clone() }
    };
    let pictures: Vec<Picture> = modes.vectors.iter().map(moving).collect();
    draw::write(runner, study, &pictures)?;
    if study.draw.contains(&Draw::Svg) {
        let softest = modes.rigid_motions.min(pictures.len() - 1);
        let value = rounded(modes.eigenvalues.get(softest).copied().unwrap_or(f64::NAN), 5);
        let state = format!("mode {softest}, eigenvalue {value}, drawn with an amplitude of a tenth of the sheet");
        draw::svg(runner, study, &pictures[softest].displaced(0.1), &state)?;
    }
    Ok(())
}

/// The drawn state, of which modes are velocities.
pub fn drawn_picture(runner: &Runner<'_>, study: &StudySpec) -> Picture {
    picture_at(runner, study, runner.assembly.drawn().coordinates.clone())
}

/// A state of which modes are velocities, from all its coordinates.
pub fn picture_at(runner: &Runner<'_>, study: &StudySpec, coordinates: Vec<f64>) -> Picture {
    let assembly = runner.assembly;
    let edges = assembly.tiling().edges.len();
    let state = State { energy: vec![f64::NAN; edges], ..State::empty(coordinates, edges) };
    let state = draw::with_all_angles(assembly, &state);
    let picture = Picture::of_state(&runner.view, assembly.drawn(), &state);
    match draw::self_intersection(runner, study) {
        Some(mut check) => picture.with_crossing(&check.marks(assembly.drawn(), &state, LYING).faces),
        None => picture,
    }
}
