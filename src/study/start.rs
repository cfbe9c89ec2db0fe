//! The state from which a study starts: the drawn one, that of an earlier study or file, or a random one near the drawn
//! state.
//!
//! Every study with a key `start` calls [`check`] before anything is computed and [`initial_state`] when it begins. A
//! state of an earlier study or of a file comes with its tensions where they were kept, so that an equilibrium is one
//! again.

use super::{Context, NoAnswer, StudyError};
use crate::analysis::restored::{self, Forces};
use crate::model::{Configuration, Model};
use crate::numerics::random::numbers;
use crate::output::vtk::{self, VtuMesh};
use crate::scene::Located;
use crate::scene::forms::{RandomStart, StartSpec};
use crate::solver::Start;

/// Whether a study starts from the drawn state.
pub(crate) fn is_drawn(start: Option<&Located<StartSpec>>) -> bool {
    start.is_none_or(|start| matches!(**start, StartSpec::Drawn))
}

/// Checks that the start, if it is a file, can be read and contains a state of this sheet.
pub(crate) fn check(context: &Context<'_>, start: Option<&Located<StartSpec>>) -> Result<(), StudyError> {
    start.map_or(Ok(()), |start| start_file(context, start).map(|_| ()))
}

/// Returns the state from which the study starts; the drawn state if the scene names no start. It is [`unavailable`] if
/// the study that it names ended in no state of this model.
///
/// The unknowns belong to `model`, whose reference state becomes this state: coordinates held against drift keep the
/// values that they have in it, and angles continue from those that it was kept with, without jumps of `2 pi`. The
/// model may have any gauge, but only with [`Gauge::Held`](crate::model::Gauge::Held) unknown tensions of rigid
/// measures can be found. Tensions are known where forces are balanced, or nearly so, in a state of an earlier study or
/// of a file.
pub(crate) fn initial_state(
    context: &Context<'_>,
    start: Option<&Located<StartSpec>>,
    model: &mut Model,
) -> Result<Start, NoAnswer> {
    let Some(start) = start else { return Ok(model.start().into()) };
    let earlier = match &**start {
        StartSpec::Drawn => return Ok(model.start().into()),
        StartSpec::Random(random) => return Ok(random_start(random, model).into()),
        StartSpec::File(_) => {
            start_file(context, start)?.map(|(coordinates, mesh)| from_mesh(context, model, coordinates, &mesh))
        }
        StartSpec::Study(name) => from_study(context, name, model),
    };
    let (x, forces) = earlier.ok_or_else(unavailable)?;
    Ok(restored::start(model, x, &forces))
}

/// Returns why a study has no answer whose start study has no final state.
pub(crate) fn unavailable() -> NoAnswer {
    NoAnswer::because("the study from which it starts did not converge")
}

/// Returns the unknowns of the state in which an earlier study ended, and its forces; `None` if it ended in no state of
/// this model.
fn from_study(context: &Context<'_>, name: &str, model: &mut Model) -> Option<(Vec<f64>, Forces)> {
    let fits = |saved: &&Configuration| {
        saved.coordinates.len() == context.assembly.drawn().coordinates.len()
            && saved.angles.len() == model.angles().len()
    };
    let saved = context.earlier.states.get(name).filter(fits)?;
    let forces = saved.tension.clone().map_or(Forces::Unknown, Forces::OfMeasures);
    Some((model.enter(saved).x, forces))
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
    let memory = restored::memory(model, |name| on_edges(&mesh.memory.get(name).cloned()));
    let forces = Forces::OfEdges { tension: on_edges(&mesh.tension), torque: on_edges(&mesh.torque) };
    (model.enter(&Configuration { memory, ..Configuration::new(coordinates, angles, None) }).x, forces)
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
    let amplitude = random.random.0;
    let x: Vec<f64> =
        model.start().iter().zip(numbers(random.seed)).map(|(x, number)| x + amplitude * number).collect();
    let mut coordinates = model.coordinates(&x);
    if let Some(drawn) = model.domain().turns(&model.coordinates(&model.start())) {
        model.domain().point_axis(&mut coordinates, drawn.direction);
    }
    model.start_from(coordinates)
}
