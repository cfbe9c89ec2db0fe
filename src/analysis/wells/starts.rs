//! Random starts: the sheet crumpled to random fold angles, with soft bars, and then released.
//!
//! Every crease that is not rigid is given a rest angle at random around the drawn one, every coordinate is moved at
//! random (flat sheets have to leave the flat state), rigid parts by as much as their vertices are in the mean, a screw
//! gets an axis at random, and the sheet relaxes with bars of at most a thousand times the stiffness of its median
//! crease, in the place of membranes too, so that no folded state is out of reach; on pins that hold its shape, and with
//! rigid parts, of a thousand, a hundred and ten times by turns. From there it relaxes with its own terms and rest
//! angles. Where that ends in no well the start is made anew, a few times. Its random numbers depend on the seed and its
//! own number alone. Trusses, which have no creases, start from coordinates that are moved farther.
//!
//! Each random start of a patch has a second one beside it: the drawn sheet with parts turned inside out. Stiff domes snap
//! to such states, and crumpled sheets miss them. The first one is the whole sheet, as is the only one of a tube, the
//! others one to three random balls of vertices that are neither pinned nor at the rim, small balls as often as large
//! ones. Starts from balls are left out around another state with a spread below half a turn. A second start counts where it leads to a well, and one from balls where
//! the sheet does not pass through itself there: it has many other wells.
//!
//! Random angles are those around another state if one is given. The first start then is that state itself, so that it
//! is among the wells if it is one, and a screw keeps the axis that it has there.

use super::placement::holds_shape;
use super::settle::{MinimumTracker, Settled};
use crate::analysis::intersections::SelfIntersection;
use crate::analysis::state::State;
use crate::math::{Vec3, point};
use crate::model::{Assembly, Configuration, Domain, Gauge};
use crate::numerics::parallel;
use crate::numerics::random::symmetric;
use crate::sheet::TiledEdge;
use crate::solver::{Failure, Options, Problem};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use std::collections::{BTreeSet, HashSet};
use std::f64::consts::PI;

/// Stiffness of bars over that of creases while the sheet is crumpled.
const SOFT: f64 = 1e3;
/// The same for a sheet whose shape pins or parts hold, by turns: they make bars resist that a free sheet would not
/// stretch.
const SOFT_ON_PINS: [f64; 3] = [1e3, 1e2, 1e1];
/// Random part of a coordinate, over the mean edge.
const MOVED: f64 = 0.05;
/// The same without creases, for a spread of half a turn: joints may come to the other side of their neighbours.
const MOVED_JOINTS: f64 = 2.0;
/// When a crumpled state is good enough to be released.
const CRUMPLED: Options = Options { tolerance: 1e-4, iterations: 60 };
/// Most balls of vertices that are turned inside out in a start.
const BALLS: usize = 3;
/// Least displacement, over the mean edge, of what is not where it was drawn.
const DISPLACED: f64 = 1e-9;
/// Least length of the sum of the normals of faces, over their area, with which a part of a sheet has a mean normal.
const LEAST_MEAN_NORMAL: f64 = 1e-3;
/// How often a start that ends in no well is crumpled anew.
const TRIES: usize = 4;

/// Where to start, and how often.
#[derive(Clone, Copy, Debug)]
pub struct Starts {
    /// Number of starts.
    pub count: usize,
    /// Seed of the random numbers.
    pub seed: u64,
    /// Largest distance of a random rest angle from the fold angle in the state around which starts are, in radians; without
    /// creases that of a coordinate, of which half a turn is two mean edges.
    pub spread: f64,
    /// When a well is converged.
    pub options: Options,
}

/// What came of a start.
#[derive(Clone, Debug)]
pub enum Outcome {
    /// A minimum, by inertia.
    Well(Box<Settled>),
    /// An equilibrium that is no minimum, however often it was tried.
    Saddle,
    /// A relaxation failed.
    Failed(Failure),
    /// The observer asked to stop.
    Interrupted,
}

/// Relaxes from all starts around a state, in their order; around the drawn one if none is given. `go_on` is asked
/// after each and returns false to stop.
pub fn relax_around(
    assembly: &Assembly,
    state: Option<&Configuration>,
    starts: &Starts,
    go_on: &(dyn Fn() -> bool + Sync),
) -> Vec<Outcome> {
    let centre = state.map(|state| Centre::new(assembly, state));
    let settler = MinimumTracker::new(assembly, 1.0);
    let in_parts = centre.is_none() || starts.spread >= PI;
    let crosses = |well: &Settled| SelfIntersection::new(assembly).marks(assembly.drawn(), &well.relaxed.state).any;
    let outcomes = parallel::map_with_state(
        starts.count,
        || true,
        |going, number| {
            if !*going {
                return (Outcome::Interrupted, None);
            }
            let found = one((assembly, &settler), centre.as_ref(), starts, number);
            let from = mirrored(assembly, &settler, (starts.seed, number)).filter(|_| number == 0 || in_parts);
            let mirrored = from.map(|from| released(&settler, &from.without_tension(), starts.options));
            *going = go_on();
            (found, mirrored.filter(|found| matches!(found, Outcome::Well(well) if number == 0 || !crosses(well))))
        },
    );
    let (mut outcomes, mirrored): (Vec<Outcome>, Vec<Option<Outcome>>) = outcomes.into_iter().unzip();
    outcomes.extend(mirrored.into_iter().flatten());
    outcomes
}

/// The drawn patch with parts turned inside out, by number: first the whole of it, then random balls of its inner vertices;
/// of a tube the whole alone. `None` for other domains, and for parts that are flat, but for the whole, or have no mean normal.
fn mirrored(assembly: &Assembly, settler: &MinimumTracker, (seed, number): (u64, usize)) -> Option<Configuration> {
    let (tiling, drawn) = (assembly.tiling(), &assembly.drawn().coordinates);
    let mut tube = drawn.clone();
    if assembly.domain().evert(&mut tube) {
        let angles: Vec<f64> = assembly.drawn_angles().iter().map(|angle| -DISPLACED * angle).collect();
        return (number == 0 && assembly.terms().pins.is_empty()).then(|| settler.at(tube, &angles));
    }
    let mut numbers = ChaCha8Rng::seed_from_u64(seed);
    numbers.set_stream(u64::MAX - number as u64);
    let mut below_one = || 0.5 * (1.0 + symmetric(&mut numbers));
    let at_rim = tiling.edges.iter().filter(|edge| edge.wings.contains(&None)).flat_map(|edge| edge.ends);
    let pinned = assembly.terms().pins.iter().map(|(vertex, _)| *vertex);
    let stays: HashSet<usize> = at_rim.map(|end| end.vertex).chain(pinned).filter(|_| number > 0).collect();
    let mut part: Vec<usize> = (0..drawn.len() / 3).filter(|vertex| !stays.contains(vertex)).collect();
    if *assembly.domain() != Domain::Patch || part.is_empty() {
        return None;
    }
    let (count, mut place) = (part.len() as f64, drawn.clone());
    for _ in 0..=number % BALLS {
        let centre = point(drawn, part[(below_one() * count) as usize]);
        let far = |vertex: usize| (point(drawn, vertex) - centre).norm();
        part.sort_by(|a, b| far(*a).total_cmp(&far(*b)));
        let size = if number == 0 { count } else { count.powf(below_one()).round() };
        inside_out(assembly, &mut place, &part[..size as usize])?;
    }
    let displaced = |vertex| (point(&place, vertex) - point(drawn, vertex)).norm() > DISPLACED * assembly.mean_edge();
    let turned = |edge: &TiledEdge| edge.ends.iter().any(|end| displaced(end.vertex));
    // next to 0, to the other side for what is folded by half a turn
    let angle = |(edge, angle): (&TiledEdge, &f64)| if turned(edge) { -DISPLACED * angle } else { *angle };
    let next: Vec<f64> = tiling.edges.iter().zip(assembly.drawn_angles()).map(angle).collect();
    part.into_iter().any(|vertex| number == 0 || displaced(vertex)).then(|| settler.at(place.clone(), &next))
}

/// Mirrors a part of the vertices at the plane across the mean normal of its faces through their other vertices and pins, or
/// through its own centre, but for what is pinned. `None` where there is no mean normal.
fn inside_out(assembly: &Assembly, place: &mut [f64], part: &[usize]) -> Option<()> {
    let (from, pins) = (place.to_vec(), &assembly.terms().pins);
    let point = |vertex: usize| point(&from, vertex);
    let part: BTreeSet<usize> = part.iter().copied().collect();
    let faces = assembly.tiling().triangles.iter().map(|triangle| triangle.corners.map(|site| site.vertex));
    let faces: Vec<[usize; 3]> = faces.filter(|face| face.iter().any(|vertex| part.contains(vertex))).collect();
    let across = faces.iter().map(|face| {
        let [a, b, c] = face.map(point);
        (b - a).cross(&(c - a))
    });
    let (sum, size) = across.fold((Vec3::zeros(), 0.0), |(sum, size), normal| (sum + normal, size + normal.norm()));
    let normal = (sum.norm() > LEAST_MEAN_NORMAL * size).then(|| sum.normalize())?;
    let is_held = |vertex: &usize| !part.contains(vertex) || pins.iter().any(|(pin, _)| pin == vertex);
    let held: BTreeSet<usize> = faces.into_iter().flatten().filter(is_held).collect();
    let on_plane = if held.is_empty() { &part } else { &held };
    let centre = on_plane.iter().map(|&vertex| point(vertex)).sum::<Vec3>() / on_plane.len() as f64;
    for &vertex in &part {
        let mirrored = point(vertex) - 2.0 * normal.dot(&(point(vertex) - centre)) * normal;
        let pinned = |axis: usize| pins.iter().any(|(pin, axes)| *pin == vertex && axes[axis]);
        (0..3).filter(|&axis| !pinned(axis)).for_each(|axis| place[3 * vertex + axis] = mirrored[axis]);
    }
    Some(())
}

/// Why starts failed, and how many for each reason, the most frequent first.
pub(crate) fn failures(outcomes: &[Outcome]) -> Vec<(&'static str, usize)> {
    let mut counts: Vec<(&'static str, usize)> = Vec::new();
    for outcome in outcomes {
        let Outcome::Failed(failure) = outcome else { continue };
        match counts.iter_mut().find(|(reason, _)| *reason == reason_of(failure)) {
            Some((_, count)) => *count += 1,
            None => counts.push((reason_of(failure), 1)),
        }
    }
    counts.sort_by_key(|(_, count)| std::cmp::Reverse(*count));
    counts
}

/// A failure without its numbers.
fn reason_of(failure: &Failure) -> &'static str {
    match failure {
        Failure::Infeasible { .. } => "the rigid measures cannot be met",
        Failure::SingularStart => "singular start",
        Failure::NotFinite => "the energy is not a finite number",
        Failure::Collapsed(_) => "a triangle collapsed",
        Failure::Unbounded { .. } => "the forces cannot balance with rigid bars",
        Failure::Stuck { .. } => "no step lowers the energy",
        Failure::TooManySteps { .. } => "too many steps",
        Failure::Uncertain { .. } => "a direction without cost, or rounding, leaves angles open",
        Failure::Factor(_) => "the linear algebra failed",
        Failure::Interrupted => "interrupted",
    }
}

/// The state around which starts are random.
struct Centre<'a> {
    state: &'a Configuration,
    /// Fold angle of every edge, continued through pi; NaN where there is no hinge.
    angles: Vec<f64>,
}

impl<'a> Centre<'a> {
    fn new(assembly: &Assembly, state: &'a Configuration) -> Self {
        let mut model = assembly.model(Gauge::Held);
        let x = model.enter(state).x;
        let no_tension = vec![0.0; model.compliance().len()];
        Self { state, angles: State::new(&model, &x, &no_tension).fold_angle }
    }
}

/// The outcome of the start with this number; `settler` relaxes the sheet with its own bars and rest angles.
fn one(
    (assembly, settler): (&Assembly, &MinimumTracker),
    centre: Option<&Centre<'_>>,
    starts: &Starts,
    number: usize,
) -> Outcome {
    if let Some(Centre { state, .. }) = centre.filter(|_| number == 0) {
        let found = released(settler, state, starts.options);
        if matches!(found, Outcome::Well(_)) {
            return found;
        }
    }
    let mut numbers = ChaCha8Rng::seed_from_u64(starts.seed);
    numbers.set_stream(number as u64);
    let mut within = |size: f64| size * symmetric(&mut numbers);
    let turned = (*assembly.domain() == Domain::Screw && centre.is_none()).then(|| {
        let turned = assembly.with_axis(within(0.5 * PI));
        (MinimumTracker::new(&turned, 1.0), turned)
    });
    let (settler, assembly) = turned.as_ref().map_or((settler, assembly), |(settler, turned)| (settler, turned));
    let softness = if holds_shape(assembly) { SOFT_ON_PINS[number % SOFT_ON_PINS.len()] } else { SOFT };
    let mut last = Outcome::Saddle;
    for _ in 0..TRIES {
        last = match crumpled(assembly, centre, (starts.spread, softness), &mut within) {
            Ok(place) => released(settler, &place.without_tension(), starts.options),
            Err(failure) => Outcome::Failed(failure),
        };
        if matches!(last, Outcome::Well(_)) {
            break;
        }
    }
    last
}

/// Relaxes the sheet with its own bars and rest angles from a state, and returns the outcome.
fn released(settler: &MinimumTracker, from: &Configuration, options: Options) -> Outcome {
    match settler.free(from, options, &mut |_| true) {
        Err(error) => Outcome::Failed(error.failure),
        Ok(found) if found.relaxed.negative_eigenvalues != Some(0) => Outcome::Saddle,
        Ok(found) => Outcome::Well(Box::new(found)),
    }
}

/// A state near random fold angles. One in which the relaxation did not converge is as good a start as any, where it is
/// a state.
fn crumpled(
    assembly: &Assembly,
    centre: Option<&Centre<'_>>,
    (spread, softness): (f64, f64),
    within: &mut dyn FnMut(f64) -> f64,
) -> Result<Configuration, Failure> {
    let angles = centre.map_or(assembly.drawn_angles(), |centre| &centre.angles);
    // loads that the sheet bears could fold soft bars over
    let mut terms = assembly.terms().unloaded();
    let moved = if terms.creases.is_some() { MOVED } else { MOVED_JOINTS * spread / PI };
    if let Some(creases) = &mut terms.creases {
        let random = angles.iter().map(|angle| angle + within(spread));
        let rigid = |edge: usize| creases.stiffness.of(edge).is_infinite();
        let rest =
            random.zip(&creases.rest).enumerate().map(|(edge, (random, own))| if rigid(edge) { *own } else { random });
        creases.rest = rest.collect();
        let most = softness * creases.stiffness.median();
        terms = terms.with_bars_at_most(most);
    }
    let settler = MinimumTracker::new(&assembly.with_terms(terms), 1.0);
    let mut from = match centre {
        Some(Centre { state, angles }) => settler.at(state.coordinates.clone(), angles),
        None => settler.drawn(),
    };
    shake(assembly, &mut from.coordinates, &mut || within(moved * assembly.mean_edge()));
    match settler.free(&from.without_tension(), CRUMPLED, &mut |_| true) {
        Ok(found) => Ok(found.place),
        Err(error) => match error.failure {
            Failure::Uncertain { .. } | Failure::Stuck { .. } | Failure::TooManySteps { .. }
                if error.state.coordinates.iter().all(|x| x.is_finite()) =>
            {
                Ok(error.configuration.without_tension())
            }
            failure => Err(failure),
        },
    }
}

/// Moves every coordinate at random; those that are no lengths by what moves points as far. The axis of a screw has its
/// direction by chance already.
fn shake(assembly: &Assembly, coordinates: &mut [f64], moved: &mut dyn FnMut() -> f64) {
    let domain = &assembly.drawn().domain;
    let units = domain.units(coordinates, assembly.mean_edge());
    let points = coordinates.len() - units.len();
    let direction = domain.turns(coordinates).map(|turns| turns.direction);
    for (k, x) in coordinates.iter_mut().enumerate() {
        *x += moved() * k.checked_sub(points).map_or(1.0, |shared| units[shared]);
    }
    if let Some(direction) = direction {
        domain.point_axis(coordinates, direction);
    }
}
