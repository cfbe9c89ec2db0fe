//! Trajectories: rigid folding followed from the drawn state along every ray, until it comes back or is told to stop.
//!
//! The curve is the closure of the fold angles of one cell (or of a finite sheet) with the locked creases left out, and
//! [`crate::solver::continuation`] follows it. Arc length is that of the fold angles. Turning points of the curvature
//! and of the three strains are the zeros of their rates.
//!
//! A tube starts closed, and its closing condition is one equation more: [`start`] has its rays.

mod error;
mod start;

use super::tube::SeamPlace;
use crate::kinematics::{Closing, Closure, Displacement, Embedding, Ray, RealDirections, Shape, SpatiallyPeriodic};
use crate::math::Vec3;
use crate::model::Assembly;
use crate::numerics::DenseMatrix;
use crate::sheet::Seam;
use crate::solver::Implicit;
use crate::solver::continuation::{Curve, CurveOptions, End, Event, Point, Trajectory, follow};
pub use error::TraceError;
use start::Start;
use std::f64::consts::TAU;

/// Cosine of the angle within which a trajectory arrives along a ray.
const ALONG: f64 = 0.999;
/// Rates of strains, per arc length, up to which they are rounding errors: such a strain has no turning points.
const NO_RATE: f64 = 1e-12;
/// States between two questions whether to go on.
const OBSERVED: usize = 256;
/// Quantities whose turning points are reported, in the order of their indicators.
pub(crate) const TURNING: [&str; 4] = ["curvature", "strain11", "strain22", "strain12"];
/// The indicators after these.
const CURVATURE: usize = TURNING.len();
const CREASE_ANGLE: usize = CURVATURE + 1;
const INTERSECTION: usize = CURVATURE + 2;

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

/// Conditions that end a trajectory: the first that is met.
#[derive(Clone, Copy, Debug, Default)]
pub struct Stop {
    /// Arc length.
    pub arc_length: Option<f64>,
    /// Magnitude of the curvature.
    pub curvature: Option<f64>,
    /// An edge and its fold angle.
    pub crease_angle: Option<(usize, f64)>,
    /// Faces passing through each other.
    pub self_intersection: bool,
}

/// Says whether faces of a state pass through each other.
pub(crate) type Intersects<'a> = &'a mut dyn FnMut(&Folded) -> bool;

/// A state on a trajectory.
#[derive(Clone, Debug)]
pub struct Folded {
    /// Arc length from the start.
    pub arc_length: f64,
    /// Fold angles of all edges, continuous along the trajectory.
    pub angles: Vec<f64>,
    /// Rates of the fold angles per arc length.
    pub rates: Vec<f64>,
    /// The cylinder; `None` for a finite sheet.
    pub shape: Option<Shape>,
    /// The seam of a tube; `None` for other sheets.
    pub seam: Option<SeamPlace>,
    /// Vertices of the cell, vertex 0 and the first face at it as drawn.
    pub positions: Vec<Vec3>,
    /// Largest component of the closure residual.
    pub residual: f64,
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
    /// Arc length where faces first pass through each other; `None` where that does not happen or was not asked.
    pub first_self_intersection: Option<f64>,
    /// Corrections made.
    pub corrections: usize,
}

/// The closure of a sheet as a curve, with what is watched along it.
struct TracedClosure<'a, 'b> {
    closing: Closing<'a>,
    embedding: &'a Embedding,
    periodic: bool,
    /// Whether the first state is spatially periodic, without curvature.
    starts_straight: bool,
    /// The seam of a tube.
    seam: Option<Seam>,
    /// States of the trajectory that are known, by rising arc length: near them curvatures keep their sign, and seams their
    /// direction.
    known: Vec<Known>,
    stop: Stop,
    intersects: Option<Intersects<'b>>,
    /// Whether faces of the first state pass through each other; false also where that is not asked.
    crosses: bool,
}

/// A state from which the sign of the curvature and the direction of the seam are carried on.
struct Known {
    arc_length: f64,
    angles: Vec<f64>,
    shape: Shape,
    seam: Option<SeamPlace>,
}

impl TracedClosure<'_, '_> {
    /// Asks whether faces of the first state pass through each other.
    fn look_at_start(&mut self, x: Vec<f64>) {
        let start = Point { arc_length: 0.0, tangent: vec![0.0; x.len()], x, residual: 0.0, corrections: 0 };
        let state = self.folded(&start);
        self.crosses = self.intersects.as_mut().is_some_and(|intersects| intersects(&state));
    }

    fn folded(&mut self, point: &Point) -> Folded {
        let (angles, rates) = (self.closing.angles(&point.x), self.closing.rates(&point.tangent));
        let placement = self.embedding.place(&angles);
        let positions = placement.positions.clone();
        let mut shape = Shape::of(self.embedding, placement).ok();
        let turning = shape.as_mut().filter(|shape| shape.turns());
        let seam = turning.and_then(|shape| self.carry_on(point.arc_length, &angles, shape));
        Folded { arc_length: point.arc_length, angles, rates, shape, seam, positions, residual: point.residual }
    }

    /// The states at these points; fewer where `go_on` says to stop.
    fn states(&mut self, points: &[Point], go_on: &mut dyn FnMut() -> bool) -> Vec<Folded> {
        let mut states = Vec::with_capacity(points.len());
        for (k, point) in points.iter().enumerate() {
            if k > 0 && k % OBSERVED == 0 && !go_on() {
                break;
            }
            states.push(self.folded(point));
        }
        states
    }

    /// Gives a state's curvature the sign that it has next to the nearest known one, and makes it known. Returns the seam of
    /// a tube.
    fn carry_on(&mut self, arc_length: f64, angles: &[f64], shape: &mut Shape) -> Option<SeamPlace> {
        let after = self.known.partition_point(|known| known.arc_length < arc_length);
        let beside = [after.checked_sub(1), (after < self.known.len()).then_some(after)];
        let away = |k: &usize| (self.known[*k].arc_length - arc_length).abs();
        let nearest = beside.into_iter().flatten().min_by(|a, b| away(a).total_cmp(&away(b)));
        let last = nearest.map(|k| &self.known[k]);
        let place = |seam: Seam| SeamPlace::new(shape, &seam, last.and_then(|last| last.seam.as_ref()));
        let seam = self.seam.and_then(place);
        if let Some(last) = last {
            shape.continue_over(self.embedding, &last.shape, [&last.angles, angles]);
            if last.arc_length == arc_length {
                return seam;
            }
        }
        if shape.curvature.is_finite() {
            self.known.insert(after, Known { arc_length, angles: angles.to_vec(), shape: shape.clone(), seam });
        }
        seam
    }

    /// Rates of curvature and strains; NaN where nothing turns.
    fn rates(&self, state: &Folded) -> [f64; 4] {
        let moving = Displacement::new(self.embedding, &state.angles, &state.rates).lattice;
        let found = state.shape.as_ref().zip(moving).and_then(|(shape, moving)| shape.rate(self.embedding, &moving));
        let turns = state.shape.as_ref().is_some_and(Shape::turns);
        found.map_or([f64::NAN; 4], |rate| {
            let strain = rate.strain.map(|rate| if rate.abs() <= NO_RATE { 0.0 } else { rate });
            [if turns { rate.curvature } else { f64::NAN }, strain[0], strain[1], strain[2]]
        })
    }
}

impl Implicit for TracedClosure<'_, '_> {
    fn unknowns(&self) -> usize {
        self.closing.unknowns()
    }

    fn equations(&self) -> usize {
        self.closing.equations()
    }

    fn linearize(&mut self, x: &[f64], residual: &mut [f64], jacobian: &mut DenseMatrix) {
        self.closing.linearize(x, residual, jacobian);
    }
}

impl Curve for TracedClosure<'_, '_> {
    fn indicators(&mut self, point: &Point, out: &mut Vec<f64>) {
        let state = self.folded(point);
        let curvature = state.shape.as_ref().map_or(f64::NAN, |shape| shape.curvature.abs());
        // what a straight state has of curvature is rounding
        let straight = self.starts_straight && point.arc_length == 0.0 && curvature.is_finite();
        let curvature = if straight { 0.0 } else { curvature };
        out.extend(if self.periodic { self.rates(&state) } else { [f64::NAN; 4] });
        out.push(self.stop.curvature.map_or(f64::NAN, |most| curvature - most));
        out.push(self.stop.crease_angle.map_or(f64::NAN, |(edge, angle)| state.angles[edge] - angle));
        let crosses = self.intersects.as_mut().map(|intersects| intersects(&state));
        out.push(crosses.map_or(f64::NAN, |crosses| if crosses { 1.0 } else { -1.0 }));
    }
}

/// Follows every ray that the options ask for; none where it is established that no direction is real, or that a tube is
/// rigid. `observe` sees branch, sign and every state's arc length, and returns false to stop.
///
/// The rays of a tube are those of branch 0: with sign 1 the quantity grows whose closing condition is not kept, the rise of
/// the seam or its turn.
///
/// # Errors
/// [`TraceError`] where the rays cannot be found, or the branch that the options ask for is not there.
pub fn trace(
    assembly: &Assembly,
    options: &TraceOptions,
    intersects: Option<Intersects<'_>>,
    observe: &mut dyn FnMut((usize, i8), &Point) -> bool,
) -> Result<Vec<Traced>, TraceError> {
    let found = start::start(assembly)?;
    let count = found.rays.iter().map(|ray| ray.branch + 1).max().unwrap_or(0);
    if let Some(branch) = options.branch.filter(|&branch| branch >= count && count > 0) {
        return Err(TraceError::NoSuchBranch { branch, count });
    }
    let closure = Closure::of_cell(assembly.sheet())?.with_locked(&assembly.locked_edges());
    let embedding = Embedding::new(assembly.sheet())?;
    let condition = found.tube.as_ref().map(|(tube, kept)| tube.keeping(*kept));
    let closing = Closing::new(&closure, found.angles.clone());
    let planar = SpatiallyPeriodic(&embedding);
    let closing = match &condition {
        Some(condition) => closing.keeping(condition),
        None if found.planar => closing.keeping(&planar),
        None => closing,
    };
    let mut folding = TracedClosure {
        closing,
        embedding: &embedding,
        periodic: assembly.boundary().is_one_cell(),
        starts_straight: condition.is_none(),
        seam: found.tube.as_ref().map(|(tube, _)| tube.seam()),
        known: Vec::new(),
        stop: options.stop,
        intersects,
        crosses: false,
    };
    folding.look_at_start(folding.closing.folding(&found.angles));
    if folding.crosses && options.stop.self_intersection {
        return Err(TraceError::CrossesAlready);
    }
    let wanted = found.rays.iter().filter(|ray| options.branch.is_none_or(|branch| branch == ray.branch));
    let mut traced = Vec::new();
    for ray in wanted {
        let one = along(&mut folding, options, (ray, &found), observe);
        let interrupted = one.end == End::Interrupted;
        traced.push(one);
        if interrupted {
            break;
        }
    }
    Ok(traced)
}

/// The trajectory along one ray.
fn along(
    folding: &mut TracedClosure<'_, '_>,
    options: &TraceOptions,
    (ray, all): (&Ray, &Start<'_>),
    observe: &mut dyn FnMut((usize, i8), &Point) -> bool,
) -> Traced {
    let (branch, rays) = ((ray.branch, ray.sign), &all.rays);
    let start = folding.closing.folding(&all.angles);
    let directions: Vec<Vec<f64>> = rays.iter().map(|ray| folding.closing.folding(&ray.direction)).collect();
    let leaving = folding.closing.folding(&ray.direction);
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
    folding.known.clear();
    let found = follow(folding, start, leaving, &options, &mut |point| observe(branch, point));
    let Trajectory { points, events, mut end } = found;
    let states = folding.states(&points, &mut || observe(branch, &points[0]));
    if states.len() < points.len() {
        end = End::Interrupted;
    }
    let ends_at = match &end {
        End::Closed(back) => arrival(&back.arrival, &directions).map(|ray| (rays[ray].branch, rays[ray].sign)),
        _ => None,
    };
    let first_self_intersection = match (&end, points.last(), crossing(&events)) {
        (End::Stopped { indicator: INTERSECTION }, Some(last), None) => Some(last.arc_length),
        (_, _, found) => found.filter(|_| !folding.crosses).or(folding.crosses.then_some(0.0)),
    };
    let turning = |event: &&Event| event.indicator < TURNING.len();
    let mut turned = |event: &Event| (event.indicator, folding.folded(&event.point));
    Traced {
        branch,
        directions: all.directions,
        ends_at,
        corrections: points.iter().map(|point| point.corrections).sum(),
        first_self_intersection,
        turning_points: events.iter().filter(turning).map(&mut turned).collect(),
        states,
        end,
    }
}

/// Where faces first pass through each other.
fn crossing(events: &[Event]) -> Option<f64> {
    events.iter().find(|event| event.indicator == INTERSECTION).map(|event| event.point.arc_length)
}

/// The number of the ray against which a trajectory arrives.
fn arrival(tangent: &[f64], directions: &[Vec<f64>]) -> Option<usize> {
    let along = |direction: &Vec<f64>| direction.iter().zip(tangent).map(|(a, b)| a * b).sum::<f64>();
    directions.iter().position(|direction| -along(direction) > ALONG)
}
