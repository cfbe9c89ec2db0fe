//! Random starts: the sheet crumpled to random fold angles, with soft bars, and then released.
//!
//! Every crease is given a rest angle at random around the drawn one, every coordinate is moved at random (flat sheets
//! have to leave the flat state), a screw gets an axis at random, and the sheet relaxes with bars of at most a thousand
//! times the stiffness of its creases, so that no folded state is out of reach. From there it relaxes with its own bars
//! and rest angles. Where that ends in no well the start is made anew, a few times. Its random numbers depend on the
//! seed and its own number alone.

use super::settle::{MinimumTracker, Settled, StartState};
use crate::model::{Assembly, Boundary};
use crate::numerics::parallel;
use crate::numerics::random::symmetric;
use crate::solver::{Failure, Options};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use std::f64::consts::PI;

/// Stiffness of bars over that of creases while the sheet is crumpled.
const SOFT: f64 = 1e3;
/// Random part of a coordinate, over the mean edge.
const MOVED: f64 = 0.05;
/// When a crumpled state is good enough to be released.
const CRUMPLED: Options = Options { tolerance: 1e-4, iterations: 60 };
/// How often a start that ends in no well is crumpled anew.
const TRIES: usize = 4;

/// Where to start, and how often.
#[derive(Clone, Copy, Debug)]
pub struct Starts {
    /// Number of starts.
    pub count: usize,
    /// Seed of the random numbers.
    pub seed: u64,
    /// Largest distance of a random rest angle from the drawn fold angle, in radians.
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

/// Relaxes from all starts, in their order. `go_on` is asked after each and returns false to stop.
pub fn relax_all(assembly: &Assembly, starts: &Starts, go_on: &(dyn Fn() -> bool + Sync)) -> Vec<Outcome> {
    parallel::map_with_state(
        starts.count,
        || true,
        |going, number| {
            if !*going {
                return Outcome::Interrupted;
            }
            let found = one(assembly, starts, number);
            *going = go_on();
            found
        },
    )
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
        Failure::Stuck { .. } => "no step lowers the energy",
        Failure::TooManySteps { .. } => "too many steps",
        Failure::Uncertain { .. } => "a direction without cost, or rounding, leaves angles open",
        Failure::Factor(_) => "the linear algebra failed",
        Failure::Interrupted => "interrupted",
    }
}

fn one(assembly: &Assembly, starts: &Starts, number: usize) -> Outcome {
    let mut numbers = ChaCha8Rng::seed_from_u64(starts.seed);
    numbers.set_stream(number as u64);
    let mut within = |size: f64| size * symmetric(&mut numbers);
    let mut assembly = assembly.clone();
    if assembly.boundary() == Boundary::Screw {
        assembly = assembly.with_axis(within(0.5 * PI));
    }
    let mut last = Outcome::Saddle;
    for _ in 0..TRIES {
        last = match crumpled(&assembly, starts.spread, &mut within) {
            Ok(place) => released(&assembly, &place, starts.options),
            Err(failure) => Outcome::Failed(failure),
        };
        if matches!(last, Outcome::Well(_)) {
            break;
        }
    }
    last
}

/// What the sheet does with its own bars and rest angles.
fn released(assembly: &Assembly, from: &StartState, options: Options) -> Outcome {
    match MinimumTracker::new(assembly, 1.0).free(from, false, options, &mut |_| true) {
        Err(error) => Outcome::Failed(error.failure),
        Ok(found) if found.relaxed.negative_eigenvalues > 0 => Outcome::Saddle,
        Ok(found) => Outcome::Well(Box::new(found)),
    }
}

/// A state near random fold angles. One in which the relaxation did not converge is as good a start as any, where it is a state.
fn crumpled(assembly: &Assembly, spread: f64, within: &mut dyn FnMut(f64) -> f64) -> Result<StartState, Failure> {
    let mut terms = assembly.terms().clone();
    if let Some(creases) = &mut terms.creases {
        creases.rest = assembly.drawn_angles().iter().map(|angle| angle + within(spread)).collect();
        terms.bars = terms.bars.map(|bars| bars.min(SOFT * creases.stiffness));
    }
    let mut settler = MinimumTracker::new(&assembly.with_terms(terms), 1.0);
    let mut from = settler.drawn();
    shake(assembly, &mut from.coordinates, within);
    match settler.free(&from, false, CRUMPLED, &mut |_| true) {
        Ok(found) => Ok(found.place),
        Err(error) => match error.failure {
            Failure::Uncertain { .. } | Failure::Stuck { .. } | Failure::TooManySteps { .. }
                if error.state.coordinates.iter().all(|x| x.is_finite()) =>
            {
                Ok(settler.ended(&error.state))
            }
            failure => Err(failure),
        },
    }
}

/// Moves every coordinate at random; those that are no lengths by what moves points as far. The axis of a screw has its direction by chance
/// already.
fn shake(assembly: &Assembly, coordinates: &mut [f64], within: &mut dyn FnMut(f64) -> f64) {
    let (domain, edge) = (&assembly.drawn().domain, assembly.mean_edge());
    let units = domain.units(coordinates, edge);
    let points = coordinates.len() - units.len();
    let direction = domain.turns(coordinates).map(|turns| turns.direction);
    for (k, x) in coordinates.iter_mut().enumerate() {
        *x += within(MOVED * edge) * k.checked_sub(points).map_or(1.0, |shared| units[shared]);
    }
    if let Some(direction) = direction {
        domain.point_axis(coordinates, direction);
    }
}
