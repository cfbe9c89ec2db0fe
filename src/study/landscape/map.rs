//! The map of a landscape: energies over the sphere of curvature tensors, with the exact cone of cylinders.
//!
//! Samples are kept in a log as they are computed, so that an interrupted map continues where it stopped.

use super::summary::MapSummary;
use crate::analysis::landscape::cone::{Cone, distance};
use crate::analysis::landscape::samples::{Sample, SampleError};
use crate::analysis::landscape::sphere::{self, Direction};
use crate::analysis::landscape::{HeldSheet, LandscapeError, TaylorPaths};
use crate::math::Vec3;
use crate::model::Assembly;
use crate::numerics::worst;
use crate::output::artifact::Artifact;
use crate::output::figure::sphere::{self as figure, Sphere};
use crate::output::net::Net;
use crate::output::table::{Table, Value};
use crate::scene::spec::{Draw, MapSpec};
use crate::study::{Answer, Context, StudyError};
use std::f64::consts::{SQRT_2, TAU};
use std::sync::atomic::{AtomicUsize, Ordering};

/// Number of rings, unless the scene gives another.
const RINGS: u32 = 8;
/// Number of samples between two writings of the log.
const BATCH: usize = 64;
/// Number of points of the exact cone on each nappe, and number of those at which the distance to a zero of the energy
/// is computed.
const CONE: usize = 96;
const PROBES: usize = 8;
/// Columns of the table; NaN is the energy of a sample that failed.
const COLUMNS: &str = "k11,k22,k12,energy_bars,energy_creases,energy_total,residual_force,residual_length,iterations";
const TOTAL: usize = 5;
const ITERATIONS: usize = 8;

type Row = [f64; 9];

/// The results of a map.
pub(crate) struct Map {
    /// The part of the summary.
    pub summary: MapSummary,
    /// The reason for which the map is incomplete; `None` if it is complete.
    pub reason: Option<String>,
}

/// Samples the map; adds its table and its pictures to `answer`.
pub(crate) fn compute(context: &Context<'_>, spec: &MapSpec, answer: &mut Answer) -> Result<Map, StudyError> {
    let (amplitude, rings) = (spec.amplitude.0, spec.rings.as_ref().map_or(RINGS, |count| count.0) as usize);
    let net = sphere::SphereNet::new(rings);
    let points: Vec<Vec3> = net.directions.iter().map(Direction::point).collect();
    let (rows, mut reason) = sampled(context, answer, &points, amplitude)?;
    let (cone, cone_distance) = cone(context.assembly, amplitude).unwrap_or_else(|error| {
        reason.get_or_insert(error.to_string());
        Default::default()
    });
    let cone_points = cone.iter().map(Vec::len).sum();
    if cone_points < 2 * CONE && reason.is_none() {
        reason = Some(format!("{} of {} points of the exact cone were not found", 2 * CONE - cone_points, 2 * CONE));
    }
    let energies: Vec<f64> = rows.iter().map(|row| row[TOTAL]).collect();
    if rows.len() == points.len() {
        let sphere = Sphere { points: &points, triangles: &net.triangles, energies: &energies, cone: &cone };
        add_files(answer, context, &sphere, amplitude);
    }
    let summary = MapSummary {
        amplitude,
        samples: rows.len(),
        failed: energies.iter().filter(|energy| energy.is_nan()).count(),
        iterations: rows.iter().map(|row| row[ITERATIONS] as usize).sum(),
        largest_energy: worst(energies.iter().copied().filter(|energy| !energy.is_nan())),
        cone_points,
        cone_distance,
    };
    Ok(Map { summary, reason })
}

/// Returns a row for every point, beginning with those kept by an interrupted run, and the reason for which some are
/// missing.
fn sampled(
    context: &Context<'_>,
    answer: &mut Answer,
    points: &[Vec3],
    amplitude: f64,
) -> Result<(Vec<Row>, Option<String>), StudyError> {
    let with_courses = |held: HeldSheet| TaylorPaths::new(&held).map(|courses| (held, courses));
    let (held, courses) = match HeldSheet::new(context.assembly).and_then(with_courses) {
        Ok(found) => found,
        Err(error) => return Ok((Vec::new(), Some(error.to_string()))),
    };
    let kept = context.checkpoints.log(&format!("{}.map.jsonl", context.name()))?;
    let mut rows: Vec<Row> = kept.iter().map_while(|line| row_of(line)).take(points.len()).collect();
    let mut reason = None;
    let done = AtomicUsize::new(rows.len());
    let go_on = || context.step(done.fetch_add(1, Ordering::Relaxed) + 1, Some(points.len()));
    while rows.len() < points.len() && reason.is_none() {
        let batch = &points[rows.len()..points.len().min(rows.len() + BATCH)];
        let found = sphere::samples(&held, &courses, batch, amplitude, &go_on);
        for (point, sample) in batch.iter().zip(found) {
            match sample {
                Some(sample) if reason.is_none() => {
                    let row = row(point, sample);
                    context.checkpoints.log_line(&line_of(&row))?;
                    rows.push(row);
                }
                _ => reason = Some("interrupted".to_owned()),
            }
        }
    }
    answer.add(format!("{}-map.csv", context.name()), table(&rows));
    let failed = rows.iter().filter(|row| row[TOTAL].is_nan()).count();
    Ok((rows, reason.or_else(|| (failed > 0).then(|| format!("{failed} samples of the map did not converge")))))
}

fn row(point: &Vec3, sample: Result<Sample, SampleError>) -> Row {
    let [k11, k22, k12] = sphere::curvature(point);
    let nan = f64::NAN;
    sample.map_or([k11, k22, k12, nan, nan, nan, nan, nan, 0.0], |sample| {
        let (relaxed, state) = (&sample.relaxed, &sample.relaxed.state);
        let [bars, creases, total] = [state.energy_bars, state.energy_creases, state.total()];
        let [force, length] = [relaxed.residual_force, relaxed.residual_length];
        [k11, k22, k12, bars, creases, total, force, length, sample.iterations as f64]
    })
}

/// Returns a row as a line of the log, with null for NaN, which JSON does not have.
fn line_of(row: &Row) -> String {
    // numbers and null only, so that serialization cannot fail
    serde_json::to_string(&row.map(|number| Some(number).filter(|number| !number.is_nan()))).unwrap_or_default()
}

/// Returns the row of a line of the log; `None` if it is none.
fn row_of(line: &str) -> Option<Row> {
    let row: [Option<f64>; 9] = serde_json::from_str(line).ok()?;
    Some(row.map(|number| number.unwrap_or(f64::NAN)))
}

fn table(rows: &[Row]) -> Table {
    let mut table = Table::new(COLUMNS);
    let value = |(column, number): (usize, &f64)| {
        if column == ITERATIONS { Value::Whole(*number as i64) } else { Value::Number(*number) }
    };
    rows.iter().for_each(|row| table.push(row.iter().enumerate().map(value)));
    table
}

/// Returns the exact cone, as a closed curve on each nappe, and the largest angle between its points and the zeros of
/// the energy, in radians.
fn cone(assembly: &Assembly, amplitude: f64) -> Result<(Vec<Vec<Vec3>>, Option<f64>), SampleError> {
    let held = HeldSheet::new(assembly)?;
    let courses = TaylorPaths::new(&held)?;
    let modes = held.bending.clone().ok_or(LandscapeError::NoCurvatures)?;
    let exact = Cone::new(assembly.sheet(), &modes, &assembly.rigid_facets_of_cell()).map_err(LandscapeError::from)?;
    let mut largest: Option<f64> = None;
    let mut curves = Vec::new();
    for nappe in [1, -1] {
        let at = |k: usize| exact.point(k as f64 * TAU / CONE as f64, nappe, amplitude);
        let curve: Vec<Vec3> = (0..CONE).filter_map(at).collect();
        for point in curve.iter().step_by(CONE / PROBES) {
            let off = distance(&held, &courses, point, amplitude)?;
            largest = Some(largest.map_or(off, |most| most.max(off)));
        }
        curves.push(curve);
    }
    Ok((curves, largest))
}

fn add_files(answer: &mut Answer, context: &Context<'_>, sphere: &Sphere<'_>, amplitude: f64) {
    let name = context.name();
    if context.draws(Draw::Vtk) {
        let file = format!("{name}/{name}_map.vtp");
        answer.add(&file, Artifact::Net(net(sphere)));
        answer.add(format!("{name}.pvd"), Artifact::Series(vec![(0.0, file)]));
    }
    if context.draws(Draw::Svg) {
        let caption = context.caption(format!("energies of curvature tensors of norm {amplitude}"));
        answer.add(format!("{name}-map.svg"), figure::svg(sphere, &caption));
    }
}

/// Returns the sphere in the coordinates `(k11, k22, sqrt(2) k12)`, with the closed curves of the cone, on which the
/// energy is zero.
fn net(sphere: &Sphere<'_>) -> Net {
    let all: Vec<Vec3> = sphere.points.iter().chain(sphere.cone.iter().flatten()).copied().collect();
    let mut start = sphere.points.len();
    let closed = |curve: &Vec<Vec3>| {
        let first = start;
        start += curve.len();
        (first..start).chain((!curve.is_empty()).then_some(first)).collect()
    };
    let curves: Vec<Vec<usize>> = sphere.cone.iter().map(closed).collect();
    let tensors: Vec<[f64; 3]> = all.iter().map(sphere::curvature).collect();
    let component = |k: usize| tensors.iter().map(|tensor| tensor[k]).collect::<Vec<f64>>();
    let energy = sphere.energies.iter().copied().chain(std::iter::repeat(0.0)).take(all.len()).collect();
    let arrays = vec![
        ("energy", energy),
        ("k11", component(0)),
        ("k22", component(1)),
        ("k12", component(2)),
        ("gaussian_curvature", tensors.iter().map(|[k11, k22, k12]| k11 * k22 - k12 * k12).collect()),
    ];
    let points = tensors.iter().map(|[k11, k22, k12]| Vec3::new(*k11, *k22, SQRT_2 * k12)).collect();
    Net { points, triangles: sphere.triangles.to_vec(), curves, arrays, of_curves: Vec::new() }
}
