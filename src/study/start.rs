//! The state from which a study starts: the drawn one, that of an earlier study or file, or a random one near the drawn
//! state.
//!
//! Every study with a key `start` calls [`check`] before anything is computed and [`initial_state`] when it begins. A
//! state of an earlier study or of a file comes with its tensions where they were kept, so that an equilibrium is one
//! again.

use super::answer::Answer;
use super::context::Context;
use super::error::StudyError;
use crate::analysis::restored::{self, Forces};
use crate::model::{Configuration, Model};
use crate::numerics::random::symmetric;
use crate::output::vtk::{self, VtuMesh};
use crate::scene::Located;
use crate::scene::forms::{RandomStart, StartSpec};
use crate::solver;
use rand::SeedableRng;

/// The state from which a study starts, in the unknowns of the model with which it was made.
#[derive(Clone, Debug)]
pub(crate) struct InitialState {
    /// The unknowns of the model.
    pub x: Vec<f64>,
    /// The tension of every stiff measure of the model. Those of an earlier state are those that were kept; where they
    /// are missing or disagree with the geometry, they follow from lengths and angles, and those of rigid measures from
    /// the balance of forces if the state is near an equilibrium.
    pub tension: Vec<f64>,
    /// Whether `tension` belongs to a state near an equilibrium, so that Newton's method should begin with it.
    pub tension_helps: bool,
    /// Whether this is the drawn state.
    pub is_drawn: bool,
}

impl InitialState {
    /// Returns the start of a relaxation from this state: with the tensions if they help.
    pub(crate) fn for_solver(&self) -> solver::Start {
        let tension = self.tension_helps.then(|| self.tension.clone());
        solver::Start { x: self.x.clone(), tension }
    }

    /// Returns the same state independent of the numbering of the unknowns, with all its tensions.
    pub(crate) fn state(self, model: &Model) -> Configuration {
        model.configuration(&self.x, Some(self.tension))
    }
}

/// Checks that the start, if it is a file, can be read and contains a state of this sheet.
pub(crate) fn check(context: &Context<'_>, start: Option<&Located<StartSpec>>) -> Result<(), StudyError> {
    start.map_or(Ok(()), |start| start_file(context, start).map(|_| ()))
}

/// Returns the state from which the study starts; the drawn state if the scene names no start. `None` if the study that
/// it names ended in no state of this model: the answer then is [`unavailable`].
///
/// The unknowns belong to `model`, whose reference state becomes this state: coordinates held against drift keep the
/// values that they have in it, and angles continue from those that it was kept with, without jumps of `2 pi`. The
/// model may have any gauge, but only with [`Gauge::Held`](crate::model::Gauge::Held) unknown tensions of rigid
/// measures can be found.
pub(crate) fn initial_state(
    context: &Context<'_>,
    start: Option<&Located<StartSpec>>,
    model: &mut Model,
) -> Result<Option<InitialState>, StudyError> {
    let Some(start) = start else { return Ok(Some(without_forces(model, model.start(), true))) };
    let (x, forces) = match &**start {
        StartSpec::Drawn => return Ok(Some(without_forces(model, model.start(), true))),
        StartSpec::Random(random) => {
            let x = random_start(random, model);
            return Ok(Some(without_forces(model, x, false)));
        }
        StartSpec::File(_) => match start_file(context, start)? {
            Some((coordinates, mesh)) => from_mesh(context, model, coordinates, &mesh),
            None => return Ok(None),
        },
        StartSpec::Study(name) => match from_study(context, name, model) {
            Some(found) => found,
            None => return Ok(None),
        },
    };
    Ok(Some(earlier(model, x, &forces)))
}

/// Returns the answer of a study whose start study has no final state.
pub(crate) fn unavailable(context: &Context<'_>) -> Answer {
    Answer::failed(context.study, "the study from which it starts did not converge")
}

/// Returns a state of which no force is known.
fn without_forces(model: &Model, x: Vec<f64>, is_drawn: bool) -> InitialState {
    let tension = restored::tensions(model, &x, &Forces::Unknown);
    InitialState { x, tension, tension_helps: false, is_drawn }
}

/// Returns an earlier state of which these forces are known.
fn earlier(model: &Model, x: Vec<f64>, known: &Forces) -> InitialState {
    let tension = restored::tensions(model, &x, known);
    let solver::Start { x, tension: completed } = restored::start(model, x, tension.clone());
    let tension_helps = completed.is_some();
    InitialState { x, tension: completed.unwrap_or(tension), tension_helps, is_drawn: false }
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
    let forces = Forces::OfEdges { tension: on_edges(&mesh.tension), torque: on_edges(&mesh.torque) };
    (model.enter(&Configuration { coordinates, angles, tension: None }).x, forces)
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
