//! `kind = "surface"`: asks the analysis, writes the states and their triangles, summarises.

use super::draw;
use super::resume::Kept;
use super::runner::Runner;
use super::trace::state_at;
use super::{Progress, RunError};
use crate::analysis::chart::{hinge_angles, screw_coordinates};
use crate::analysis::intersections::LYING;
use crate::analysis::state::State;
use crate::analysis::surface::{Surface, SurfaceOptions, SurfacePoint, surface};
use crate::math::Vec3;
use crate::model::{Assembly, Boundary, Gauge, Terms};
use crate::numerics::{larger, worst};
use crate::output::figure::surface::{self as figure, PathPoint};
use crate::output::strain_space::StrainSurface;
use crate::output::summary::{PieceSummary, StudyResult, StudySummary, SurfaceSummary};
use crate::output::table::{StateRow, Table, read_columns};
use crate::output::{files, vtk};
use crate::scene::spec::{Draw, StudyKind, StudySpec, SurfaceSpec};
use crate::scene::values::Count;
use crate::scene::{Located, SceneFile};
use crate::sheet::EdgeKey;
use crate::solver::atlas::{Coverage, KEPT};
use std::f64::consts::TAU;
use std::time::Instant;

/// States along each direction over a whole turn where the scene says nothing.
const RESOLUTION: u32 = 32;
/// Finest resolution that is accepted: discs of 6e-5 rad.
const MOST_RESOLUTION: u32 = 100_000;
/// Bound on the closure residual.
const TOLERANCE: f64 = 3e-14;
/// States beyond which a surface is given up.
const MOST_POINTS: usize = 300_000;
/// The observer is asked after so many states.
const OBSERVED: usize = 256;

/// Surfaces are drawn in the space of lattice strains: refuses other domains than the screw.
pub fn check(file: &SceneFile, assembly: &Assembly, study: &StudySpec) -> Result<(), RunError> {
    if let StudyKind::Surface(SurfaceSpec { resolution: Some(resolution), .. }) = &*study.kind {
        check_resolution(file, resolution)?;
    }
    if assembly.boundary() == Boundary::Screw {
        return Ok(());
    }
    let message = "a surface of folded states is drawn in the space of lattice strains";
    Err(file.error_at(study.kind.span(), message, "use domain = \"screw\"").into())
}

/// Refuses a resolution at which states could not be told from each other.
pub fn check_resolution(file: &SceneFile, resolution: &Located<Count>) -> Result<(), RunError> {
    if resolution.0 <= MOST_RESOLUTION {
        return Ok(());
    }
    let message = format!("a resolution of {} is finer than closure is solved", resolution.0);
    let help = format!("choose at most {MOST_RESOLUTION}; 32 states over a whole turn are usual");
    Err(file.error_at(resolution.span(), &message, &help).into())
}

/// What this study does not use of the scene.
pub fn left_out(assembly: &Assembly, study: &StudySpec) -> Option<String> {
    let surface = matches!(*study.kind, StudyKind::Surface(_));
    let name = &study.name.0;
    (surface && !assembly.terms().locks.is_empty())
        .then(|| format!("locks in study `{name}`: the surface is what folds without them"))
}

/// Runs the study.
pub fn study(runner: &mut Runner<'_>, study: &StudySpec, spec: &SurfaceSpec) -> Result<StudySummary, RunError> {
    let assembly = runner.assembly;
    let unlocked = assembly.with_terms(Terms { locks: Vec::new(), ..assembly.terms().clone() });
    let options = SurfaceOptions {
        radius: TAU / f64::from(spec.resolution.as_ref().map_or(RESOLUTION, |count| count.0)),
        tolerance: TOLERANCE,
        max_curvature: spec.max_curvature.as_ref().map_or_else(|| curvature_of_cell(assembly), |most| most.0),
        max_points: MOST_POINTS,
    };
    let clock = Instant::now();
    let found = surface(&unlocked, &options, &mut |step| watch(runner, study, step));
    let mut summary = StudySummary {
        seconds: clock.elapsed().as_secs_f64(),
        ..StudySummary::unanswered(&study.name.0, study.kind.name())
    };
    match found {
        Ok(mut surface) => {
            write(runner, study, &unlocked, (&mut surface, options.max_curvature))?;
            summary.reason = reason(&surface);
            summary.converged = summary.reason.is_none();
            let result = summarized(&surface, &options);
            summary.error = result.max_residual;
            summary.result = Some(StudyResult::Surface(result));
        }
        Err(error) => summary.reason = Some(error.to_string()),
    }
    Ok(summary)
}

/// One over the square root of the area of the cell.
pub fn curvature_of_cell(assembly: &Assembly) -> f64 {
    assembly.sheet().lattice.map_or(1.0, |[first, second]| first.cross(&second).norm().sqrt().recip())
}

fn watch(runner: &Runner<'_>, study: &StudySpec, step: usize) -> bool {
    runner.watch(&Progress { study: study.name.0.clone(), step, of: None, residual: f64::NAN })
}

/// Why a surface is not whole; `None` where it is.
fn reason(surface: &Surface) -> Option<String> {
    match surface.coverage {
        Coverage::Complete if surface.lost > 0 => Some(format!(
            "along {} of the ways away from the drawn state no folded state was found: what lies there may be missing",
            surface.lost
        )),
        Coverage::Complete => None,
        Coverage::GivenUp { charts } => Some(format!(
            "the surface was given up before all of it was covered: it could not be followed beyond {charts} of its states, \
             as where several branches come close to each other; choose a smaller max_curvature"
        )),
        Coverage::Open { charts } => Some(format!("the surface could not be followed beyond {charts} of its states")),
        Coverage::TooManyCharts => Some(format!(
            "the surface has more than {MOST_POINTS} states: choose a smaller resolution or max_curvature"
        )),
        Coverage::Interrupted => Some("interrupted".to_owned()),
    }
}

/// The states of a surface as the model sees them.
struct States {
    states: Vec<State>,
    /// Whether each passes through itself; `None` where that was not asked, or not answered for all.
    crossing: Option<Vec<bool>>,
}

/// The states of a surface. Where the observer asks to stop, the surface is cut down to those it has by then, or to the
/// first few.
fn states(runner: &Runner<'_>, study: &StudySpec, unlocked: &Assembly, surface: &mut Surface) -> States {
    let assembly = runner.assembly;
    let mut model = unlocked.model(Gauge::Held);
    let mut finder = draw::self_intersection(runner, study);
    let (mut states, mut crossing) = (Vec::new(), Vec::new());
    for (k, point) in surface.points.iter().enumerate() {
        if k % OBSERVED == 0 && !watch(runner, study, surface.points.len() + k) {
            surface.coverage = Coverage::Interrupted;
            finder = None;
        }
        if k >= KEPT && surface.coverage == Coverage::Interrupted {
            break;
        }
        let coordinates = screw_coordinates(&point.shape);
        model.set_angles(&hinge_angles(&model, &point.angles));
        model.start_from(coordinates.clone());
        let state = state_at(&model, coordinates, &point.angles);
        crossing.extend(finder.as_mut().map(|finder| finder.marks(assembly.drawn(), &state, LYING).any));
        states.push(state);
    }
    surface.truncate(states.len());
    let crossing = (finder.is_some() && crossing.len() == states.len()).then_some(crossing);
    States { states, crossing }
}

fn write(
    runner: &mut Runner<'_>,
    study: &StudySpec,
    unlocked: &Assembly,
    (surface, max_curvature): (&mut Surface, f64),
) -> Result<(), RunError> {
    let assembly = runner.assembly;
    let found = states(runner, study, unlocked, surface);
    let surface = &*surface;
    let row = |k: usize| row(unlocked.terms(), k, &surface.points[k], &found);
    let rows: Vec<StateRow> = (0..surface.points.len()).map(row).collect();
    let keys: Vec<EdgeKey> = assembly.sheet().edges.iter().map(|edge| edge.key).collect();
    let name = &study.name.0;
    Table::of_states(&keys, &rows).write(&runner.path(format!("{name}.csv")))?;
    if let Some((last, state)) = surface.points.iter().zip(&found.states).next_back() {
        draw(runner, study, &mesh(&keys, surface, &rows), max_curvature)?;
        let model = assembly.model(Gauge::Held);
        let angles = hinge_angles(&model, &last.angles);
        runner.keep_state(study, Kept { coordinates: state.coordinates.clone(), angles, tension: None })?;
    }
    Ok(())
}

fn row(terms: &Terms, k: usize, point: &SurfacePoint, found: &States) -> StateRow {
    let (shape, state) = (&point.shape, &found.states[k]);
    let any = terms.bars.is_some() || terms.creases.is_some();
    StateRow {
        branch: Some(point.branch.0 as i64),
        sign: Some(i64::from(point.branch.1)),
        step: Some(k as i64),
        arc_length: None,
        curvature: Some(shape.curvature),
        theta: shape.theta.map(Some),
        strain: shape.strain.map(Some),
        energy: [
            terms.bars.map(|_| state.energy_bars),
            terms.creases.as_ref().map(|_| state.energy_creases),
            terms.facets.as_ref().map(|_| state.energy_facets),
            any.then(|| state.total()),
        ],
        residual_force: None,
        residual_length: None,
        self_intersecting: found.crossing.as_ref().map(|crossing| crossing[k]),
        error_to_kinematic: None,
        fold: point.angles.clone(),
    }
}

/// The rows of the table as a surface.
fn mesh(keys: &[EdgeKey], surface: &Surface, rows: &[StateRow]) -> StrainSurface {
    let shapes = || surface.points.iter().map(|point| &point.shape);
    let fold = |(edge, key): (usize, &EdgeKey)| {
        (Table::fold_column(key), surface.points.iter().map(|point| point.angles[edge]).collect())
    };
    StrainSurface {
        points: shapes().map(|shape| Vec3::from(shape.strain)).collect(),
        triangles: surface.triangles.clone(),
        curvature: shapes().map(|shape| shape.curvature).collect(),
        theta: shapes().map(|shape| shape.theta).collect(),
        folds: keys.iter().enumerate().map(fold).collect(),
        energy: rows.iter().map(|row| row.energy[3]).collect(),
        self_intersecting: rows.iter().map(|row| row.self_intersecting.map(u8::from)).collect(),
    }
}

fn draw(runner: &Runner<'_>, study: &StudySpec, mesh: &StrainSurface, max_curvature: f64) -> Result<(), RunError> {
    let name = &study.name.0;
    if study.draw.contains(&Draw::Vtk) {
        let file = format!("{name}/{name}_0000.vtp");
        vtk::write_vtp(&runner.path(&file), mesh)?;
        vtk::write_pvd(&runner.path(format!("{name}.pvd")), &[(0.0, file)])?;
    }
    if study.draw.contains(&Draw::Svg) {
        let paths = paths(runner, study, max_curvature)?;
        let caption = draw::caption(runner, &format!("all folded states up to a curvature of {max_curvature}"));
        files::write_figure(&runner.path(format!("{name}.svg")), figure::svg(mesh, &paths, &caption))?;
    }
    Ok(())
}

/// The trajectories of the `trace` studies before this one, as far as the surface goes: from their tables, which are
/// there also where an earlier run made them.
fn paths(runner: &Runner<'_>, study: &StudySpec, max_curvature: f64) -> Result<Vec<Vec<PathPoint>>, RunError> {
    const COLUMNS: [&str; 8] = ["branch", "sign", "curvature", "strain11", "strain22", "strain12", "theta1", "theta2"];
    let mut paths = Vec::new();
    let earlier = runner.file.scene.studies.iter().take_while(|earlier| earlier.name.0 != study.name.0);
    for earlier in earlier.filter(|earlier| matches!(*earlier.kind, StudyKind::Trace(_))) {
        let table = runner.path(format!("{}.csv", earlier.name.0));
        let rows = if table.exists() { read_columns(&table, COLUMNS)? } else { Vec::new() };
        let (mut path, mut last) = (Vec::new(), None);
        for [branch, sign, curvature, strain11, strain22, strain12, theta1, theta2] in rows {
            let within = curvature.abs() <= max_curvature;
            if last != Some((branch, sign)) || !within {
                paths.push(std::mem::take(&mut path));
            }
            last = Some((branch, sign));
            let strain = Vec3::new(strain11, strain22, strain12);
            let turn = larger(theta1.abs(), theta2.abs());
            path.extend(within.then_some(PathPoint { strain, curvature, turn }));
        }
        paths.push(path);
    }
    paths.retain(|path| path.len() > 1);
    Ok(paths)
}

fn summarized(surface: &Surface, options: &SurfaceOptions) -> SurfaceSummary {
    let coverage = match surface.coverage {
        _ if surface.negative.is_some() => "no-real-branch",
        Coverage::Complete => "complete",
        Coverage::Open { .. } => "open",
        Coverage::GivenUp { .. } => "given-up",
        Coverage::TooManyCharts => "too-many-points",
        Coverage::Interrupted => "interrupted",
    };
    let piece = |&(branch, sign): &(usize, i8)| {
        let points = surface.points.iter().filter(|point| point.branch == (branch, sign)).count();
        PieceSummary { branch, sign, points }
    };
    SurfaceSummary {
        points: surface.points.len(),
        triangles: surface.triangles.len(),
        coverage: coverage.to_owned(),
        established: surface.negative.map(|negative| negative.to_string()),
        gaps: surface.gaps,
        closed: surface.closed && !surface.points.is_empty(),
        oriented: surface.oriented,
        tips: surface.points.iter().filter(|point| point.radius == 0.0).count(),
        max_curvature: options.max_curvature,
        radius: surface.radius,
        max_residual: worst(surface.points.iter().map(|point| point.residual)),
        branches: surface.branches.iter().map(piece).collect(),
    }
}
