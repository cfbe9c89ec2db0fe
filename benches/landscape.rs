//! Cost of a map of a landscape, relative to relaxations of the same patch.
//!
//! ```text
//! cargo bench --bench landscape
//! ```
//!
//! Patches of 6 x 6 reference cells with rigid bars. A relaxation starts from the drawn sheet, with fixed rest angles
//! displaced along a mode. A map has directions all over the sphere of curvature tensors, rest angles that are free
//! across the modes, and starts each sample at the prediction of third order, on one thread and on two. Times are
//! medians of rounds, taken by turns; only their ratios are meaningful.
#![allow(clippy::unwrap_used)]

mod common;

use common::{in_turns, measuring};
use foldwell::analysis::landscape::sphere::{Direction, SphereNet, samples};
use foldwell::analysis::landscape::{HeldSheet, TaylorPaths};
use foldwell::analysis::relax::relax_from;
use foldwell::math::Vec3;
use foldwell::model::{Assembly, Gauge, RIGID, Terms};
use foldwell::numerics::parallel::Threads;
use foldwell::sheet::fold;
use foldwell::solver::Options;
use std::time::Instant;

const AMPLITUDE: f64 = 1e-3;

fn main() {
    let (rounds, rings) = if measuring() { (5, 11) } else { (1, 1) };
    let sheet = fold::parse(include_str!("../meshes/open-star.fold"), "open-star.fold").unwrap();
    let patch = Assembly::patch(sheet, [6, 6]).bars(RIGID).creases(1.0).build().unwrap();
    let held = HeldSheet::patch(&patch).unwrap();
    let courses = TaylorPaths::new(&held).unwrap();
    let rates = held.named([0.8, -0.3, 0.4]).unwrap();
    let edges = patch.tiling().edges.iter().zip(patch.drawn_angles());
    let bent: Vec<f64> = edges.map(|(edge, angle)| angle + AMPLITUDE * rates[edge.edge]).collect();
    let bent = patch.with_terms(Terms::bars_and_creases(RIGID, 1.0, bent));
    let points: Vec<Vec3> = SphereNet::new(rings).directions.iter().map(Direction::point).collect();
    let relaxation = || {
        let clock = Instant::now();
        for _ in 0..20 {
            let model = bent.model(Gauge::Held);
            relax_from(&model, model.start(), Options::default(), &mut |_| true).unwrap();
        }
        clock.elapsed().as_secs_f64() / 20.0
    };
    let map = |threads: usize| {
        let clock = Instant::now();
        let found = Threads::new(Some(threads)).install(|| samples(&held, &courses, &points, AMPLITUDE, &|| true));
        assert!(found.iter().all(|sample| sample.as_ref().is_some_and(Result::is_ok)));
        clock.elapsed().as_secs_f64() / points.len() as f64
    };
    let times = in_turns(rounds, &mut [&mut || relaxation(), &mut || map(1), &mut || map(2)]);
    let [one, alone, shared] = [times[0], times[1], times[2]];
    println!("{} samples of 6 x 6 cells", points.len());
    println!("a relaxation            {:8.3} ms", 1e3 * one);
    println!("a sample, one thread    {:8.3} ms, {:.2} relaxations", 1e3 * alone, alone / one);
    println!("a sample, two threads   {:8.3} ms, {:.2} relaxations", 1e3 * shared, shared / one);
}
