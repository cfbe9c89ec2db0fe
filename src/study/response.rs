//! `kind = "response"`: the linear modes of a periodic sheet, what they do to it as a whole, and Poisson's ratios.

mod summary;

use super::{Answer, Context, NoAnswer, StudyError, StudyResult, start, states};
use crate::analysis::response::{
    Field, LinearMode, Moduli, NoRatio, Response, SelfStress, SymmetryTypes, moduli_at, response_at,
};
use crate::math::Vec3;
use crate::model::{Domain, Gauge};
use crate::output::figure::{ratios, rounded};
use crate::output::picture::Picture;
use crate::output::table::{Table, Value};
use crate::scene::forms::StartSpec;
use crate::scene::spec::{Draw, ResponseSpec};
use std::f64::consts::PI;
pub use summary::{LinearModeSummary, ModuliSummary, PoissonSummary, ResponseSummary, SymmetrySummary};

/// Directions over half a turn, if the scene does not say.
const DIRECTIONS: u32 = 72;
/// Amplitude of the mode in the picture, relative to the size of the sheet.
const SHOWN: f64 = 0.1;
/// Components of a curvature below this part of the largest are shown as 0: they are rounding.
const NOISE: f64 = 1e-12;

/// Checks that the sheet is periodic, and that the start is a state of one cell.
pub(crate) fn check(context: &Context<'_>, spec: &ResponseSpec) -> Result<(), StudyError> {
    start::check(context, spec.start.as_ref())?;
    let assembly = context.assembly;
    let refuse = |message: &str, help: &str| Err(context.refuse(message, help).into());
    if matches!(assembly.drawn().domain, Domain::Patch) {
        let help = "give domain = \"torus\" or \"screw\", of a mesh with the key `foldwell:lattice`";
        return refuse("the linear response is that of a periodic sheet", help);
    }
    let Some(start) = spec.start.as_ref().filter(|start| !matches!(***start, StartSpec::Drawn)) else { return Ok(()) };
    let help = "give cells = [1, 1], or domain = \"screw\"";
    let message = "the linear response is that of a state of one cell, and cells of a larger torus may differ";
    Ok(context.file.error_if(assembly.tiling().cells != [1, 1], start.span(), message, help)?)
}

/// Computes the response of the state that the scene names.
pub(crate) fn compute(context: &Context<'_>, spec: &ResponseSpec) -> Result<Answer, NoAnswer> {
    let mut model = context.assembly.model(Gauge::Held);
    let start = start::initial_state(context, spec.start.as_ref(), &mut model)?;
    let state = model.configuration(&start.x, start.tension);
    let response = response_at(context.assembly, &state).map_err(NoAnswer::because)?;
    let (name, mut answer) = (context.name(), Answer::empty(context.study));
    answer.add(format!("{name}.csv"), modes_table(context, &response.modes));
    answer.add(format!("{name}-stresses.csv"), stresses_table(context, &response.stresses));
    let directions = spec.directions.as_ref().map_or(DIRECTIONS, |count| count.0);
    answer.add(format!("{name}-ratios.csv"), ratios_table(&response, directions));
    add_pictures(&mut answer, context, &response, &state.coordinates);
    let mut summary = summary(&response);
    match moduli_at(context.assembly, &state) {
        Ok(found) => summary.moduli = Some(moduli_summary(&found)),
        Err(error) => summary.no_moduli = Some(error.to_string()),
    }
    answer.conclude(StudyResult::Response(Box::new(summary)), Some(response.error), None);
    Ok(answer)
}

/// Returns a row for each mode: strain, curvature tensor, lattice rotations and the rates of all fold angles.
fn modes_table(context: &Context<'_>, modes: &[LinearMode]) -> Table {
    let edges = context.assembly.sheet().edges.iter().map(|edge| &edge.key);
    let table = Table::new("mode,strain11,strain22,strain12,curvature11,curvature22,curvature12")
        .with(["rotation1_x", "rotation1_y", "rotation1_z", "rotation2_x", "rotation2_y", "rotation2_z"])
        .with_edges("rate", edges);
    table.with_numbered(modes.iter().map(|mode| {
        let rotations = mode.lattice_rotations.iter().flat_map(|omega| omega.iter());
        mode.strain.iter().chain(&mode.curvature).chain(rotations).chain(&mode.rates).copied()
    }))
}

/// Returns a row for each self stress: its work on strains and curvatures, the tensions of the bars, and the torques of
/// the hinges that keep their angles.
fn stresses_table(context: &Context<'_>, stresses: &[SelfStress]) -> Table {
    let edges = || context.assembly.sheet().edges.iter().map(|edge| &edge.key);
    let table = Table::new("stress,force11,force22,force12,moment11,moment22,moment12")
        .with_edges("tension", edges())
        .with_edges("torque", edges());
    table.with_numbered(
        stresses.iter().map(|stress| {
            stress.force.iter().chain(&stress.moment).chain(&stress.tension).chain(&stress.torque).copied()
        }),
    )
}

/// Returns a row for each direction; where there is no ratio its field is empty, and the reason is in another.
fn ratios_table(response: &Response, directions: u32) -> Table {
    Table::new("direction,in_plane,bending,no_in_plane,no_bending").with_rows((0..directions).map(|k| {
        let angle = PI * f64::from(k) / f64::from(directions);
        let ratios = ratios_at(response, angle);
        let numbers = ratios.map(|ratio| ratio.ok().into());
        let reasons = ratios.map(|ratio| Value::Word(ratio.err().map_or("", |reason| reason.word())));
        [angle.into()].into_iter().chain(numbers).chain(reasons)
    }))
}

/// Returns the ratios in the plane and of bending along a direction; a sheet that is rolled up has no modes of this
/// kind.
fn ratios_at(response: &Response, angle: f64) -> [Result<f64, NoRatio>; 2] {
    let spaces = response.poisson.as_ref().map(|poisson| [&poisson.in_plane, &poisson.bending]);
    spaces.map_or([Err(NoRatio::NoTensor); 2], |spaces| spaces.map(|space| space.ratio(angle)))
}

/// Adds every mode as a state with its velocities, the picture of the last mode, and the plot of the ratios.
fn add_pictures(answer: &mut Answer, context: &Context<'_>, response: &Response, coordinates: &[f64]) {
    if context.study.draw.is_empty() || response.modes.is_empty() {
        return;
    }
    let at_rest = states::picture_at(context, coordinates.to_vec());
    let moving = |mode: &LinearMode| {
        let displacement = velocities(context, mode, coordinates);
        Picture { displacement, ..at_rest.clone() }
    };
    let pictures: Vec<Picture> = response.modes.iter().map(moving).collect();
    if let Some((last, mode)) = pictures.last().zip(response.modes.last()) {
        let largest = mode.curvature.iter().fold(0.0, |most, k| f64::max(most, k.abs()));
        let [k11, k22, k12] = mode.curvature.map(|k| rounded(if k.abs() > NOISE * largest { k } else { 0.0 }, 4));
        let state = format!(
            "mode {} with curvature [{k11}, {k22}, {k12}], drawn with an amplitude of a tenth of the sheet",
            response.modes.len() - 1
        );
        states::add_figure(answer, context, &last.displaced(SHOWN), &state);
    }
    states::add_motions(answer, context, [""; 2], pictures);
    if context.draws(Draw::Svg) && response.poisson.is_some() {
        let [in_plane, bending] = [0, 1].map(|which| move |angle: f64| ratios_at(response, angle)[which].ok());
        let plots: [(&str, ratios::RatioOf<'_>); 2] =
            [("Poisson's ratio in the plane", &in_plane), ("Poisson's ratio of bending", &bending)];
        let state = "ratios by direction, x along the first lattice vector";
        answer.add(format!("{}-ratios.svg", context.name()), ratios::svg(&plots, &context.caption(state)));
    }
}

/// Returns the velocities of a mode at the points of the picture.
fn velocities(context: &Context<'_>, mode: &LinearMode, coordinates: &[f64]) -> Vec<Vec3> {
    match &mode.field {
        Field::OfCells { .. } => {
            let at = |&(vertex, cell): &(usize, [i32; 2])| mode.field.at(vertex, cell).unwrap_or_else(Vec3::zeros);
            context.view.places.iter().map(at).collect()
        }
        Field::OfCoordinates(rates) => context.view.velocities(context.assembly.drawn(), coordinates, rates),
    }
}

/// Returns why there is no ratio along the first lattice vector, of tensors with this name.
fn in_words(reason: NoRatio, what: &str) -> String {
    match reason {
        NoRatio::NoTensor => format!("no mode has a {what}"),
        NoRatio::Any => format!("modes combine to a {what} of any ratio"),
        NoRatio::NothingAlong => format!("the {what} has nothing along the first lattice vector"),
    }
}

fn summary(response: &Response) -> ResponseSummary {
    let mode = |mode: &LinearMode| LinearModeSummary {
        strain: mode.strain,
        curvature: mode.curvature,
        lattice_rotations: mode.lattice_rotations.map(Into::into),
    };
    let [in_plane, bending] = ratios_at(response, 0.0);
    let poisson = match &response.poisson {
        Some(found) => PoissonSummary {
            in_plane: in_plane.ok(),
            bending: bending.ok(),
            no_in_plane: in_plane.err().map(|reason| in_words(reason, "strain without curvature")),
            no_bending: bending.err().map(|reason| in_words(reason, "curvature without twist")),
            opposite: found.relation.opposite(),
            because: found.relation.because(),
            sum: found.sum,
            neutral_height: found.neutral_height,
        },
        None => PoissonSummary {
            because: "the sheet is rolled up: its modes change a curvature that it has".to_owned(),
            ..PoissonSummary::default()
        },
    };
    ResponseSummary {
        linear_modes: response.modes.iter().map(mode).collect(),
        table_rank: response.table.rank,
        table: response.table.clone(),
        self_stresses: response.self_stresses,
        stresses: response.stresses.clone(),
        symmetries: response.symmetries.iter().map(symmetry).collect(),
        lattice: response.lattice,
        poisson,
        ..ResponseSummary::default()
    }
}

fn symmetry(types: &SymmetryTypes) -> SymmetrySummary {
    SymmetrySummary {
        operation: types.symmetry.kind.words().to_owned(),
        direction: types.symmetry.direction.map(Into::into),
        even: types.modes[0],
        odd: types.modes[1],
        even_stresses: types.stresses[0],
        odd_stresses: types.stresses[1],
    }
}

fn moduli_summary(moduli: &Moduli) -> ModuliSummary {
    ModuliSummary {
        stretching: moduli.matrices.map(|found| found.stretching),
        coupling: moduli.matrices.map(|found| found.coupling),
        bending: moduli.matrices.map(|found| found.bending),
        rigid_limit: moduli.rigid_limit,
        rigid_modes: moduli.rigid_modes.clone(),
        softest: moduli.softest.clone(),
    }
}
