//! Trajectories: rigid folding followed from the drawn state along every ray, until it comes back or is told to stop.
//!
//! The curve is the closure of the fold angles of one cell (or of a finite sheet) with the locked creases left out, and
//! [`crate::solver::continuation`] follows it. Arc length is that of the fold angles. Turning points of the curvature
//! and of the three strains are the zeros of their rates.
//!
//! A tube starts closed, and its closing condition is one equation more: [`start`] has its rays.

mod curve;
mod error;
mod start;
mod state;

use super::tube::SeamPlace;
use crate::kinematics::{Closing, Closure, Embedding, Ray, RealDirections, SpatiallyPeriodic};
use crate::model::Assembly;
use crate::solver::continuation::{CurveOptions, CurvePoint, End, Event, Trajectory, follow};
pub(crate) use curve::TURNING;
use curve::{CLOSED, CREASE_ANGLE, CURVATURE, INTERSECTION, Watched};
pub use error::TraceError;
use start::TraceStart;
pub(crate) use state::Intersects;
pub use state::{Folded, Stop};
use std::f64::consts::TAU;

/// Arc length before the end of a closed trajectory where a zero is that of its first state.
const AT_START: f64 = 1e-6;

/// How trajectories are followed.
#[derive(Clone, Copy, Debug)]
pub struct TraceOptions {
    /// Longest step in arc length.
    pub max_step: f64,
    /// Bound on the closure residual.
    pub tolerance: f64,
    /// Only this branch.
    pub branch: Option<usize>,
    /// The conditions that end a trajectory.
    pub stop: Stop,
}

/// A trajectory along one ray.
#[derive(Clone, Debug)]
pub struct Traced {
    /// Branch and sign of the ray.
    pub branch: (usize, i8),
    /// Why it ends.
    pub end: End,
    /// What is established about the directions in which folding leaves the drawn state: whether these rays are all.
    pub directions: RealDirections,
    /// The ray along which it comes back.
    pub ends_at: Option<(usize, i8)>,
    /// Its states, the drawn one or the closed tube first.
    pub states: Vec<Folded>,
    /// Turning points: which quantity of [`TURNING`], and where.
    pub turning_points: Vec<(usize, Folded)>,
    /// States of a tube on the way in which it is closed again, both closing conditions met; empty for other sheets.
    pub closed_tubes: Vec<Folded>,
    /// Arc length where faces first pass through each other; `None` where that does not happen or was not asked.
    pub first_self_intersection: Option<f64>,
    /// Corrections made.
    pub corrections: usize,
}

/// Follows every ray that the options ask for; none where it is established that no direction is real, or that a tube
/// is rigid. `observe` sees branch, sign and every state's arc length, and returns false to stop.
///
/// The rays of a tube are those of branch 0: with sign 1 the quantity grows whose closing condition is not kept, the
/// rise of the seam or its turn.
///
/// # Errors
/// [`TraceError`] where the rays cannot be found, or the branch that the options ask for is not there.
pub fn trace(
    assembly: &Assembly,
    options: &TraceOptions,
    intersects: Option<Intersects<'_>>,
    observe: &mut dyn FnMut((usize, i8), &CurvePoint) -> bool,
) -> Result<Vec<Traced>, TraceError> {
    let found = start::start(assembly)?;
    let count = found.rays.iter().map(|ray| ray.branch + 1).max().unwrap_or(0);
    if let Some(branch) = options.branch.filter(|&branch| branch >= count && count > 0) {
        return Err(TraceError::NoSuchBranch { branch, count });
    }
    let closure = Closure::of_cell(assembly.sheet())?.with_locked(&assembly.locked_edges());
    let embedding = Embedding::new(assembly.sheet())?;
    let tube = found.tube.as_ref();
    let condition = tube.map(|(tube, kept)| tube.keeping(*kept));
    let planar = SpatiallyPeriodic(&embedding);
    let closing = Closing::new(&closure, found.angles.clone()).keeping(condition.as_ref());
    let mut closing = closing.keeping(found.planar.then_some(&planar));
    let mut watched = Watched {
        embedding: &embedding,
        periodic: assembly.domain().is_one_cell(),
        starts_straight: condition.is_none(),
        tube: tube.map(|(tube, kept)| (tube.seam, *kept)),
        drawn: tube.and_then(|(tube, _)| Some(SeamPlace::drawn(assembly.sheet().screws.as_ref()?, &tube.seam))),
        known: Vec::new(),
        stop: options.stop,
        intersects,
        crosses: false,
    };
    watched.look_at_start(&closing, closing.folding(&found.angles));
    if watched.crosses && options.stop.self_intersection {
        return Err(TraceError::CrossesAlready);
    }
    let wanted = found.rays.iter().filter(|ray| options.branch.is_none_or(|branch| branch == ray.branch));
    let mut traced = Vec::new();
    for ray in wanted {
        traced.push(along((&mut closing, &mut watched), options, (ray, &found), observe));
        if traced.last().is_some_and(|one: &Traced| one.end == End::Interrupted) {
            break;
        }
    }
    Ok(traced)
}

/// The trajectory along one ray.
fn along(
    (closing, watched): (&mut Closing<'_>, &mut Watched<'_, '_>),
    options: &TraceOptions,
    (ray, all): (&Ray, &TraceStart<'_>),
    observe: &mut dyn FnMut((usize, i8), &CurvePoint) -> bool,
) -> Traced {
    let (branch, rays) = ((ray.branch, ray.sign), &all.rays);
    let start = closing.folding(&all.angles);
    let leaving = closing.folding(&ray.direction);
    let mut stops = vec![CURVATURE, CREASE_ANGLE];
    stops.extend(options.stop.self_intersection.then_some(INTERSECTION));
    let options = CurveOptions {
        tolerance: options.tolerance,
        max_step: options.max_step,
        length: options.stop.arc_length.unwrap_or(f64::INFINITY),
        period: Some(TAU),
        stops,
        ..CurveOptions::default()
    };
    watched.known.clear();
    let mut indicators =
        |closing: &mut Closing<'_>, point: &CurvePoint, out: &mut Vec<f64>| watched.indicators(closing, point, out);
    let found = follow(closing, start, leaving, &options, &mut indicators, &mut |point| observe(branch, point));
    let Trajectory { points, events, mut end } = found;
    let states = watched.states(closing, &points, &mut || observe(branch, &points[0]));
    if states.len() < points.len() {
        end = End::Interrupted;
    }
    let ends_at = match &end {
        End::Closed(back) => {
            let along = rays.iter().find(|ray| back.is_against(&closing.folding(&ray.direction)));
            along.map(|ray| (ray.branch, ray.sign))
        }
        _ => None,
    };
    let ends_at_start = matches!(end, End::Closed(_));
    let crossing = events.iter().find(|event| event.indicator == INTERSECTION).map(|event| event.point.arc_length);
    let first_self_intersection = match (&end, points.last(), crossing) {
        (End::Stopped { indicator: INTERSECTION }, Some(last), None) => Some(last.arc_length),
        (_, _, found) => found.filter(|_| !watched.crosses).or(watched.crosses.then_some(0.0)),
    };
    let turning = |event: &&Event| event.indicator < TURNING.len();
    let length = points.last().map_or(0.0, |last| last.arc_length);
    let back = |event: &Event| ends_at_start && event.point.arc_length > length - AT_START;
    let closed = |event: &&Event| event.indicator == CLOSED && !back(event);
    let mut at = |event: &Event| watched.folded(closing, &event.point);
    Traced {
        branch,
        directions: all.directions,
        ends_at,
        corrections: points.iter().map(|point| point.corrections).sum(),
        first_self_intersection,
        turning_points: events.iter().filter(turning).map(|event| (event.indicator, at(event))).collect(),
        closed_tubes: events.iter().filter(closed).map(&mut at).collect(),
        states,
        end,
    }
}
