//! `kind = "surface"`: the surface of folded states of one cell, or their curve.

mod summary;

use super::trace::enter_folded;
use super::{Answer, Context, NoAnswer, StudyError, StudyResult, energies, states, supported};
use crate::analysis::chart::screw_coordinates;
use crate::analysis::state::{Cylinder, State};
use crate::analysis::surface::{FoldedSurface, SurfaceOptions, SurfacePoint, surface};
use crate::math::Vec3;
use crate::model::{Assembly, Configuration, Domain, Gauge, Terms};
use crate::numerics::worst;
use crate::output::artifact::Artifact;
use crate::output::figure::rounded;
use crate::output::figure::surface::{self as figure, TrajectoryPoint};
use crate::output::strain_space::StrainSurface;
use crate::output::table::{EnergiesAndResiduals, StateRow, Table};
use crate::scene::spec::{Draw, StudyKind, StudySpec, SurfaceSpec};
use crate::scene::values::Count;
use crate::scene::{Located, SceneFile};
use crate::sheet::Edge;
use crate::solver::atlas::{Coverage, KEPT};
use std::f64::consts::TAU;
pub use summary::{PieceSummary, SurfaceSummary};

/// Number of states over a whole turn, along each direction, unless the scene gives another.
const RESOLUTION: u32 = 32;
/// Largest resolution that is accepted: discs of 6e-5 rad.
const MOST_RESOLUTION: u32 = 100_000;
/// Tolerance of the closure residual.
const TOLERANCE: f64 = 3e-14;
/// Largest number of states of a surface.
const MOST_POINTS: usize = 300_000;
/// Number of states between two calls of the observer.
const OBSERVED: usize = 256;

/// Checks that the sheet is a screw: surfaces are drawn in the space of lattice strains, which other domains do not
/// have.
pub(crate) fn check(context: &Context<'_>, spec: &SurfaceSpec) -> Result<(), StudyError> {
    check_resolution(context.file, spec.resolution.as_ref())?;
    if *context.assembly.domain() == Domain::Screw {
        supported::one_stiffness_each(context, "surfaces of folded states")?;
        return supported::drawn_lengths(context, "surfaces of folded states");
    }
    let message = "a surface of folded states is drawn in the space of lattice strains";
    Err(context.refuse(message, "use domain = \"screw\"").into())
}

/// Returns an error if the resolution is so fine that states could not be told from each other.
pub(crate) fn check_resolution(file: &SceneFile, given: Option<&Located<Count>>) -> Result<(), StudyError> {
    let Some(resolution) = given.filter(|given| given.0 > MOST_RESOLUTION) else { return Ok(()) };
    let message = format!("a resolution of {} is finer than closure is solved", resolution.0);
    let help = format!("choose at most {MOST_RESOLUTION}; 32 states over a whole turn are usual");
    Err(file.error_at(resolution.span(), &message, &help).into())
}

/// Returns a text about the parts of the scene that this study does not use; `None` if it uses all.
pub fn left_out(assembly: &Assembly, study: &StudySpec) -> Option<String> {
    let surface = matches!(*study.kind, StudyKind::Surface(_));
    let name = &study.name.0;
    (surface && !assembly.terms().locks.is_empty())
        .then(|| format!("locks in study `{name}`: the surface is what folds without them"))
}

/// Computes the surface of the sheet without its locks.
pub(crate) fn compute(context: &Context<'_>, spec: &SurfaceSpec) -> Result<Answer, NoAnswer> {
    let assembly = context.assembly;
    let unlocked = assembly.with_terms(Terms { locks: Vec::new(), ..assembly.terms().clone() });
    let options = SurfaceOptions {
        radius: TAU / f64::from(spec.resolution.as_ref().map_or(RESOLUTION, |count| count.0)),
        tolerance: TOLERANCE,
        max_curvature: spec.max_curvature.as_ref().map_or_else(|| curvature_of_cell(assembly), |most| most.0),
        max_points: MOST_POINTS,
    };
    let found = surface(&unlocked, &options, &mut |step| context.step(step, None));
    let mut surface = found.map_err(NoAnswer::because)?;
    let mut answer = Answer::empty(context.study);
    add_files(&mut answer, context, &unlocked, (&mut surface, options.max_curvature));
    let result = summary(&surface, &options);
    answer.conclude(StudyResult::Surface(result.clone()), result.max_residual, reason(&surface));
    Ok(answer)
}

/// Returns `1 / sqrt(A)` with the area `A` of the cell; 1 for a sheet without lattice.
pub(crate) fn curvature_of_cell(assembly: &Assembly) -> f64 {
    assembly.sheet().lattice.map_or(1.0, |[first, second]| first.cross(&second).norm().sqrt().recip())
}

/// Returns the reason for which a surface is incomplete; `None` if it is complete.
fn reason(surface: &FoldedSurface) -> Option<String> {
    match surface.coverage {
        Coverage::Complete if surface.lost > 0 => Some(format!(
            "along {} of the ways away from spatially periodic states no folded state was found: what lies there may be missing",
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

/// The states of a surface in the coordinates of the model.
struct States {
    states: Vec<State>,
    /// Whether each state intersects itself; `None` if the study does not ask for that check or it is incomplete.
    crossing: Option<Vec<bool>>,
}

/// Returns the states of a surface. If the observer asks to stop, the surface is reduced to the states computed by
/// then, or to its first `KEPT` ones.
fn states_of(context: &Context<'_>, unlocked: &Assembly, surface: &mut FoldedSurface) -> States {
    let mut model = unlocked.model(Gauge::Held);
    let mut finder = context.self_intersection();
    let (mut states, mut crossing) = (Vec::new(), Vec::new());
    for (k, point) in surface.points.iter().enumerate() {
        if k % OBSERVED == 0 && !context.step(surface.points.len() + k, None) {
            surface.coverage = Coverage::Interrupted;
            finder = None;
        }
        if k >= KEPT && surface.coverage == Coverage::Interrupted {
            break;
        }
        let state = enter_folded(&mut model, screw_coordinates(&point.shape), &point.angles);
        crossing.extend(finder.as_mut().map(|finder| finder.marks(unlocked.drawn(), &state).any));
        states.push(state);
    }
    surface.truncate(states.len());
    let crossing = (finder.is_some() && crossing.len() == states.len()).then_some(crossing);
    States { states, crossing }
}

/// Adds the table of the states, the surface in the space of lattice strains and its picture; keeps the last state for
/// studies that start from it.
fn add_files(
    answer: &mut Answer,
    context: &Context<'_>,
    unlocked: &Assembly,
    (surface, max_curvature): (&mut FoldedSurface, f64),
) {
    let found = states_of(context, unlocked, surface);
    let surface = &*surface;
    let row = |k: usize| row(unlocked.terms(), k, &surface.points[k], &found);
    let rows: Vec<StateRow> = (0..surface.points.len()).map(row).collect();
    answer.add(format!("{}.csv", context.name()), states::table_of_rows(context, &rows));
    if let Some((last, state)) = surface.points.iter().zip(&found.states).next_back() {
        add_mesh(answer, context, mesh(context.assembly, surface, &rows), max_curvature);
        let angles = context.assembly.model(Gauge::Held).angles_among(&last.angles);
        answer.state = Some(Configuration::new(state.coordinates.clone(), angles, None));
    }
}

fn row(terms: &Terms, k: usize, point: &SurfacePoint, found: &States) -> StateRow {
    let state = &found.states[k];
    StateRow {
        branch: Some(point.branch.0 as i64),
        sign: Some(i64::from(point.branch.1)),
        step: Some(k as i64),
        shape: Some(Cylinder::from(&point.shape)),
        solution: EnergiesAndResiduals {
            energy: energies::columns_if_any(terms, state),
            ..EnergiesAndResiduals::default()
        },
        self_intersecting: found.crossing.as_ref().map(|crossing| crossing[k]),
        fold: point.angles.clone(),
        ..StateRow::default()
    }
}

/// Returns the surface in the space of lattice strains, with the rows of the table as its data.
fn mesh(assembly: &Assembly, surface: &FoldedSurface, rows: &[StateRow]) -> StrainSurface {
    let shapes = || surface.points.iter().map(|point| &point.shape);
    let fold = |(number, edge): (usize, &Edge)| {
        (Table::edge_column("fold", &edge.key), surface.points.iter().map(|point| point.angles[number]).collect())
    };
    StrainSurface {
        points: shapes().map(|shape| Vec3::from(shape.strain)).collect(),
        triangles: surface.triangles.clone(),
        segments: surface.segments.clone(),
        curvature: shapes().map(|shape| shape.curvature).collect(),
        theta: shapes().map(|shape| shape.theta).collect(),
        folds: assembly.sheet().edges.iter().enumerate().map(fold).collect(),
        energy: rows.iter().map(|row| row.solution.energy.total).collect(),
        self_intersecting: rows.iter().map(|row| row.self_intersecting.map(u8::from)).collect(),
    }
}

/// Adds the surface as triangles, and its picture, which also shows the trajectories of earlier studies up to the
/// largest curvature of the surface.
fn add_mesh(answer: &mut Answer, context: &Context<'_>, mesh: StrainSurface, max_curvature: f64) {
    let name = context.name();
    if context.draws(Draw::Svg) {
        let studies = context.file.scene.studies.iter().map(|study| &study.name.0);
        let before = studies.take_while(|study| *study != name).filter_map(|study| context.earlier.paths.get(study));
        let mut paths: Vec<_> = before.flatten().flat_map(|path| within(path, max_curvature)).collect();
        let on_curve = |k: usize| TrajectoryPoint::new(mesh.points[k], mesh.curvature[k], mesh.theta[k]);
        paths.extend(mesh.segments.iter().map(|segment| segment.map(on_curve).to_vec()));
        let caption = context.caption(format!("all folded states up to a curvature of {}", rounded(max_curvature, 4)));
        answer.add(format!("{name}.svg"), figure::svg(&mesh, &paths, &caption));
    }
    if context.draws(Draw::Vtk) {
        let file = format!("{name}/{name}_0000.vtp");
        answer.add(&file, Artifact::Surface(mesh));
        answer.add(format!("{name}.pvd"), Artifact::Series(vec![(0.0, file)]));
    }
}

/// Returns the pieces of a trajectory whose absolute curvature is at most `max_curvature`.
fn within(path: &[TrajectoryPoint], max_curvature: f64) -> Vec<Vec<TrajectoryPoint>> {
    let outside = |point: &TrajectoryPoint| !(point.curvature.abs() <= max_curvature);
    let pieces = path.split(outside).filter(|piece| piece.len() > 1);
    pieces.map(<[TrajectoryPoint]>::to_vec).collect()
}

fn summary(surface: &FoldedSurface, options: &SurfaceOptions) -> SurfaceSummary {
    let coverage = match surface.coverage {
        _ if surface.negative.is_some() && surface.points.is_empty() => "no-real-branch",
        Coverage::Complete if surface.lost > 0 => "open",
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
        dimension: surface.dimension,
        triangles: surface.triangles.len(),
        coverage: coverage.to_owned(),
        established: surface.negative.map(|negative| negative.to_string()),
        gaps: surface.gaps,
        closed: surface.closed && !surface.points.is_empty(),
        oriented: surface.oriented,
        tips: surface.tips,
        max_curvature: options.max_curvature,
        radius: surface.radius,
        max_residual: worst(surface.points.iter().map(|point| point.residual)),
        branches: surface.branches.iter().map(piece).collect(),
    }
}
