//! Tables, VTK series and pictures of states.

use super::{Answer, Context, energies};
use crate::analysis::intersections::Marks;
use crate::analysis::state::{State, cylinder};
use crate::output::artifact::Artifact;
use crate::output::figure::{Annotations, sheet};
use crate::output::paraview;
use crate::output::picture::Picture;
use crate::output::table::{EnergiesAndResiduals, StateRow, Table};
use crate::scene::spec::Draw;

/// A state to be written or drawn, with its residuals and self-intersections.
pub(crate) struct Shown {
    /// The state, with the fold angles of all edges.
    pub state: State,
    /// Scaled residuals of force and length; `None` if they were not computed.
    pub residuals: Option<[f64; 2]>,
    /// The faces that intersect others; `None` if the study does not ask for that check.
    pub marks: Option<Marks>,
}

/// Returns the state with the fold angle of every edge between two faces.
pub(crate) fn with_all_angles(context: &Context<'_>, state: &State) -> State {
    state.clone().with_angles(context.assembly.fold_angles_at(&state.coordinates))
}

/// Returns the table of states that are reached in these steps, with one row for each.
pub(crate) fn table<'s>(context: &Context<'_>, states: impl IntoIterator<Item = (usize, &'s Shown)>) -> Table {
    let rows: Vec<StateRow> = states.into_iter().map(|(step, shown)| row(context, step, shown)).collect();
    table_of_rows(context, &rows)
}

/// Returns the table with these rows.
pub(crate) fn table_of_rows(context: &Context<'_>, rows: &[StateRow]) -> Table {
    let keys: Vec<_> = context.assembly.sheet().edges.iter().map(|edge| edge.key).collect();
    Table::of_states(&keys, rows)
}

fn row(context: &Context<'_>, step: usize, shown: &Shown) -> StateRow {
    let (assembly, state) = (context.assembly, &shown.state);
    StateRow {
        step: Some(step as i64),
        shape: cylinder(assembly.drawn(), &state.coordinates),
        solution: EnergiesAndResiduals::new(energies::columns(assembly.terms(), state), shown.residuals),
        self_intersecting: shown.marks.as_ref().map(|marks| marks.any),
        fold: cell_angles(context, state),
        ..StateRow::default()
    }
}

/// Returns the fold angles of the edges of the cell; on a patch or a torus, those of its middle cell.
pub(crate) fn cell_angles(context: &Context<'_>, state: &State) -> Vec<f64> {
    let tiling = context.assembly.tiling();
    let middle = tiling.cells.map(|n| (n - 1) / 2);
    let mut angles = vec![f64::NAN; context.assembly.sheet().edges.len()];
    for (edge, &angle) in tiling.edges.iter().zip(&state.fold_angle) {
        if edge.cell == middle {
            angles[edge.edge] = angle;
        }
    }
    angles
}

/// Returns the picture of a state, with its self-intersections marked.
pub fn picture(context: &Context<'_>, shown: &Shown) -> Picture {
    let mut picture = Picture::of_state(context.view, context.assembly.drawn(), &shown.state);
    if let Some(marks) = &shown.marks {
        picture.self_intersecting = marks.faces.iter().map(|&face| u8::from(face)).collect();
    }
    picture
}

/// Returns the picture of the state with these coordinates, onto which modes are drawn as velocities.
pub(crate) fn picture_at(context: &Context<'_>, coordinates: Vec<f64>) -> Picture {
    let (assembly, edges) = (context.assembly, context.assembly.edges());
    let state = State { energy: vec![f64::NAN; edges], ..State::empty(coordinates, edges) };
    let state = with_all_angles(context, &state);
    let marks = context.self_intersection().map(|mut check| check.marks(assembly.drawn(), &state));
    picture(context, &Shown { state, residuals: None, marks })
}

/// Adds the VTK series of states, each with the number of its row in the table and its time in the series, and the SVG
/// picture of one of them, given by its place among these states, with its description, as the study asks.
pub(crate) fn add<'s>(
    answer: &mut Answer,
    context: &Context<'_>,
    states: impl IntoIterator<Item = (usize, usize, &'s Shown)>,
    shown: Option<(usize, &str)>,
) {
    let pictures: Vec<(usize, usize, Picture)> =
        states.into_iter().map(|(row, time, shown)| (row, time, picture(context, shown))).collect();
    let drawn = shown.and_then(|(number, state)| Some((pictures.get(number)?.2.clone(), state)));
    add_series(answer, context, [""; 2], pictures);
    if let Some((picture, state)) = drawn {
        add_figure(answer, context, &picture, state);
    }
}

/// Adds pictures of motions as a VTK series, as [`add_series`] does; the time of a picture is its number.
pub(crate) fn add_motions(answer: &mut Answer, context: &Context<'_>, endings: [&str; 2], pictures: Vec<Picture>) {
    add_series(answer, context, endings, pictures.into_iter().enumerate().map(|(k, picture)| (k, k, picture)));
}

/// Adds the state with these coordinates that moves at each of these rates, if there are any and the study draws, and
/// returns the motion of the number `shown`, drawn with an amplitude of a tenth of the sheet's size.
pub(crate) fn add_moving(
    answer: &mut Answer,
    context: &Context<'_>,
    endings: [&str; 2],
    (coordinates, rates): (&[f64], &[Vec<f64>]),
    shown: usize,
) -> Option<Picture> {
    if rates.is_empty() || context.study.draw.is_empty() {
        return None;
    }
    let at_rest = picture_at(context, coordinates.to_vec());
    let velocities = |rates: &Vec<f64>| context.view.velocities(context.assembly.drawn(), coordinates, rates);
    let moving = |rates: &Vec<f64>| Picture { displacement: velocities(rates), ..at_rest.clone() };
    let pictures: Vec<Picture> = rates.iter().map(moving).collect();
    let shown = pictures.get(shown)?.displaced(0.1);
    add_motions(answer, context, endings, pictures);
    Some(shown)
}

/// Adds pictures as a VTK series if the study asks for it, each with the number that names its file and its time. The
/// names of files and collection are that of the study with these endings; the series without has a script for ParaView.
pub(crate) fn add_series(
    answer: &mut Answer,
    context: &Context<'_>,
    [of_file, of_series]: [&str; 2],
    pictures: impl IntoIterator<Item = (usize, usize, Picture)>,
) {
    if !context.draws(Draw::Vtk) {
        return;
    }
    let (name, mut entries) = (context.name(), Vec::new());
    for (number, time, picture) in pictures {
        let file = format!("{name}/{name}{of_file}_{number:04}.vtu");
        answer.add(&file, picture);
        entries.push((time as f64, file));
    }
    answer.add(format!("{name}{of_series}.pvd"), Artifact::Series(entries));
    if of_series.is_empty() {
        answer.add(format!("{name}-paraview.py"), Artifact::Script(paraview::script(name)));
    }
}

/// Adds one picture as SVG, with the description `state`, if the study asks for it.
pub(crate) fn add_figure(answer: &mut Answer, context: &Context<'_>, picture: &Picture, state: &str) {
    add_figure_as(context.name(), answer, context, (picture, state, 1.0));
}

/// Adds a picture under another name than that of the study, without its ending, with so many times the loads.
pub(crate) fn add_figure_as(
    name: &str,
    answer: &mut Answer,
    context: &Context<'_>,
    (picture, state, factor): (&Picture, &str, f64),
) {
    if context.draws(Draw::Svg) {
        let numbers = context.study.draw.contains(&Draw::Numbers);
        // arrows of a weight, on every vertex, would hide the sheet
        let weighs = context.file.scene.loads.iter().any(|load| load.weight.is_some());
        let loads = context.assembly.terms().loads.iter().filter(|_| !weighs && factor != 0.0);
        let loads = loads.map(|(vertex, force)| (*vertex, force * factor)).collect();
        let added = Annotations { loads, numbers };
        answer.add(format!("{name}.svg"), sheet::svg(picture, &added, &context.caption(state)));
    }
}
