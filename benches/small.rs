//! Times of small sheets: one iteration of a relaxation, one Newton step of a path, and random starts on one thread and
//! on two.
//!
//! ```text
//! cargo bench --bench small
//! ```
//!
//! The sheet is a patch of 2 x 2 reference cells with bars of several stiffnesses. Relaxations have random rest angles
//! within 0.3 rad; paths turn a lock by 0.2 rad; starts are random ones around the drawn state. Times are medians of
//! rounds, taken by turns. The states that two threads find are those of one, to the last bit.
#![allow(clippy::unwrap_used)]

mod common;

use common::{in_turns, measuring, random};
use foldwell::analysis::path::{PathOptions, follow_path};
use foldwell::analysis::relax::relax_from;
use foldwell::analysis::wells::starts::{Outcome, Starts, relax_around};
use foldwell::model::{Assembly, Drive, Driven, Gauge, RIGID, Terms};
use foldwell::numerics::parallel::Threads;
use foldwell::sheet::fold;
use foldwell::solver::{Options, Problem};
use rand::RngExt;
use std::time::Instant;

const CELLS: [usize; 2] = [2, 2];
/// Largest distance of a rest angle from the drawn one, and the angle by which a lock is turned, in radians.
const OFF: f64 = 0.3;
const TURN: f64 = 0.2;
/// Relaxations of a round, and starts.
const RELAXATIONS: u64 = 20;
const STARTS: usize = 200;

fn main() {
    let sheet = fold::parse(include_str!("../meshes/open-star.fold"), "open-star.fold").unwrap();
    let patch = Assembly::patch(sheet, CELLS).bars(RIGID).creases(1.0).build().unwrap();
    let rounds = if measuring() { 9 } else { 1 };
    println!(
        "{:>8} {:>9} {:>22} {:>22} {:>10}",
        "bars", "unknowns", "relaxation, ms/iter.", "path, ms/Newton step", "ms/state"
    );
    for bars in [1e2, 1e4, 1e6, RIGID] {
        let models: Vec<_> = (0..RELAXATIONS).map(|seed| terms(&patch, bars, seed).model(Gauge::Held)).collect();
        let (mut iterations, mut steps, mut states) = (0, 0, 0);
        let mut relax = || {
            let clock = Instant::now();
            let found = models.iter().map(|model| relax_from(model, model.start(), Options::default(), &mut |_| true));
            iterations = found.map(|found| found.unwrap().iterations).sum();
            clock.elapsed().as_secs_f64()
        };
        let locked = locked(&patch, bars);
        let mut path = || {
            let clock = Instant::now();
            let drive = Drive { quantity: Driven::Lock(vec![locked.1]), to: locked.2 + TURN };
            let found = follow_path(&locked.0, &drive, None, &PathOptions::default(), &mut |_, _| true).unwrap();
            (steps, states) = (found[0].points.iter().map(|point| point.iterations).sum(), found[0].points.len());
            clock.elapsed().as_secs_f64()
        };
        let times = in_turns(rounds, &mut [&mut relax, &mut path]);
        let [per_iteration, per_step, per_state] =
            [times[0] / iterations as f64, times[1] / steps.max(1) as f64, times[1] / states as f64];
        let unknowns = models[0].layout().unknowns;
        println!(
            "{bars:8.0e} {unknowns:9} {:22.3} {:22.3} {:10.3}",
            1e3 * per_iteration,
            1e3 * per_step,
            1e3 * per_state
        );
    }
    starts(&terms(&patch, RIGID, 0), rounds);
}

/// The patch with bars of this stiffness and random rest angles.
fn terms(patch: &Assembly, bars: f64, seed: u64) -> Assembly {
    let mut numbers = random(seed);
    let rest = patch.drawn_angles().iter().map(|angle| angle + numbers.random_range(-OFF..OFF)).collect();
    patch.with_terms(Terms::bars_and_creases(bars, 1.0, rest))
}

/// The patch with a lock on a crease; that crease and its drawn angle.
fn locked(patch: &Assembly, bars: f64) -> (Assembly, usize, f64) {
    let (edge, angle) = patch.drawn_angles().iter().enumerate().find(|(_, angle)| angle.is_finite()).unwrap();
    let terms = Terms::bars_and_creases(bars, 1.0, patch.drawn_angles().to_vec());
    (patch.with_terms(Terms { locks: vec![(edge, *angle)], ..terms }), edge, *angle)
}

fn starts(assembly: &Assembly, rounds: usize) {
    let starts = Starts { count: STARTS, seed: 1, spread: 1.0, options: Options::default() };
    let mut found = [vec![], vec![]];
    let [one, two] = &mut found;
    let run = |threads: usize, found: &mut Vec<Outcome>| {
        let clock = Instant::now();
        *found = Threads::new(Some(threads)).install(|| relax_around(assembly, None, &starts, &|| true));
        clock.elapsed().as_secs_f64()
    };
    let times = in_turns(rounds, &mut [&mut || run(1, one), &mut || run(2, two)]);
    println!(
        "{STARTS} starts: {:.1} ms on one thread, {:.2} times as fast on two",
        1e3 * times[0],
        times[0] / times[1]
    );
    let places = found.map(|outcomes| outcomes.into_iter().map(place).collect::<Vec<_>>());
    assert!(places[0] == places[1], "two threads find other states");
}

fn place(outcome: Outcome) -> Option<Vec<f64>> {
    if let Outcome::Well(found) = outcome { Some(found.place.coordinates) } else { None }
}
