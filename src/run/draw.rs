//! Files of states: tables, VTK series and pictures, as far as a study asks for them.

use super::{RunError, Runner};
use crate::analysis::intersections::{Marks, SelfIntersection};
use crate::analysis::state::{Cylinder, State, cylinder};
use crate::model::Assembly;
use crate::output::figure::{Caption, sheet};
use crate::output::picture::Picture;
use crate::output::table::{StateRow, Table};
use crate::output::{files, vtk};
use crate::scene::spec::{Check, Draw, StudySpec};

/// The state with the fold angle of every edge between two faces, also of those that are no hinge of the model: these from
/// its coordinates, in (-pi, pi].
pub fn with_all_angles(assembly: &Assembly, state: &State) -> State {
    let angles = assembly.fold_angles_at(&state.coordinates);
    let known = |(known, other): (&f64, f64)| if known.is_nan() { other } else { *known };
    State { fold_angle: state.fold_angle.iter().zip(angles).map(known).collect(), ..state.clone() }
}

/// A state with what else is known of it.
pub struct Shown<'a> {
    /// The state.
    pub state: &'a State,
    /// Scaled residuals of force and length; `None` where they were not computed.
    pub residuals: Option<[f64; 2]>,
    /// What passes through itself; `None` where that was not asked.
    pub marks: Option<Marks>,
}

/// What finds self-intersection in the states of a study; `None` where that is not asked.
pub fn self_intersection(runner: &Runner<'_>, study: &StudySpec) -> Option<SelfIntersection> {
    let asked = study.check.contains(&Check::SelfIntersection);
    asked.then(|| SelfIntersection::new(runner.assembly))
}

/// Writes the table of states of a study: one row each.
pub fn table(runner: &Runner<'_>, study: &StudySpec, states: &[Shown<'_>]) -> Result<(), RunError> {
    let keys: Vec<_> = runner.assembly.sheet().edges.iter().map(|edge| edge.key).collect();
    let rows: Vec<StateRow> = states.iter().enumerate().map(|(step, shown)| row(runner, step, shown)).collect();
    Ok(Table::of_states(&keys, &rows).write(&runner.path(format!("{}.csv", study.name.0)))?)
}

fn row(runner: &Runner<'_>, step: usize, shown: &Shown<'_>) -> StateRow {
    let (assembly, state) = (runner.assembly, shown.state);
    let shape = cylinder(&assembly.drawn().domain, &assembly.drawn().coordinates, &state.coordinates);
    let of = |get: fn(&Cylinder) -> f64| shape.as_ref().map(get);
    let terms = assembly.terms();
    StateRow {
        step: Some(step as i64),
        curvature: of(|c| c.curvature),
        theta: [of(|c| c.theta[0]), of(|c| c.theta[1])],
        strain: [of(|c| c.strain[0]), of(|c| c.strain[1]), of(|c| c.strain[2])],
        energy: [
            terms.bars.map(|_| state.energy_bars),
            terms.creases.as_ref().map(|_| state.energy_creases),
            terms.facets.as_ref().map(|_| state.energy_facets),
            Some(state.total()),
        ],
        residual_force: shown.residuals.map(|r| r[0]),
        residual_length: shown.residuals.map(|r| r[1]),
        self_intersecting: shown.marks.as_ref().map(|marks| marks.any),
        fold: cell_angles(runner, state),
        ..StateRow::default()
    }
}

/// Fold angles of the edges of the cell: of a patch or a torus, those of the cell in its middle.
fn cell_angles(runner: &Runner<'_>, state: &State) -> Vec<f64> {
    let tiling = runner.assembly.tiling();
    let middle = tiling.cells.map(|n| (n - 1) / 2);
    let mut angles = vec![f64::NAN; runner.assembly.sheet().edges.len()];
    for (edge, &angle) in tiling.edges.iter().zip(&state.fold_angle) {
        if edge.cell == middle {
            angles[edge.edge] = angle;
        }
    }
    angles
}

/// The picture of a state, with what passes through itself.
pub fn picture(runner: &Runner<'_>, shown: &Shown<'_>) -> Picture {
    let picture = Picture::of_state(&runner.view, runner.assembly.drawn(), shown.state);
    shown.marks.iter().fold(picture, |picture, marks| picture.with_crossing(&marks.faces))
}

/// Writes the VTK series, and the picture of one of the states with what it is, as the study asks.
pub fn series(
    runner: &Runner<'_>,
    study: &StudySpec,
    states: &[Shown<'_>],
    (shown, state): (usize, &str),
) -> Result<(), RunError> {
    let pictures: Vec<Picture> = states.iter().map(|shown| picture(runner, shown)).collect();
    write(runner, study, &pictures)?;
    if let (true, Some(picture)) = (study.draw.contains(&Draw::Svg), pictures.get(shown)) {
        svg(runner, study, picture, state)?;
    }
    Ok(())
}

/// Writes the VTK series alone, as the study asks.
pub fn states(runner: &Runner<'_>, study: &StudySpec, states: &[Shown<'_>]) -> Result<(), RunError> {
    write(runner, study, &states.iter().map(|shown| picture(runner, shown)).collect::<Vec<_>>())
}

/// Writes pictures as a VTK series, time being their number.
pub fn write(runner: &Runner<'_>, study: &StudySpec, pictures: &[Picture]) -> Result<(), RunError> {
    if !study.draw.contains(&Draw::Vtk) {
        return Ok(());
    }
    let name = &study.name.0;
    let mut entries = Vec::new();
    for (k, picture) in pictures.iter().enumerate() {
        let file = format!("{name}/{name}_{k:04}.vtu");
        vtk::write_vtu(&runner.path(&file), picture)?;
        entries.push((k as f64, file));
    }
    Ok(vtk::write_pvd(&runner.path(format!("{name}.pvd")), &entries)?)
}

/// Writes one picture as SVG, with what state it is.
pub fn svg(runner: &Runner<'_>, study: &StudySpec, picture: &Picture, state: &str) -> Result<(), RunError> {
    let path = runner.path(format!("{}.svg", study.name.0));
    Ok(files::write_figure(&path, sheet::svg(picture, &caption(runner, state)))?)
}

/// The title of the scene, and what is shown.
pub fn caption(runner: &Runner<'_>, state: &str) -> Caption {
    Caption { title: runner.file.title().to_string(), state: state.to_owned() }
}
