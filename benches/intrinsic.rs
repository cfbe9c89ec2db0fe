//! Relaxation in fold angles beside relaxation in the positions of the vertices: steps and time against the size of the
//! patch, the amplitude of the fold and the stiffness of the bars.
//!
//! Patches of the reference cell. Rest angles go along one mode of rigid folding, the same in every cell, named by its
//! curvatures; or they are random, within 0.1 rad of the drawn angles for each hinge. Both methods end with the same
//! certificate in positions; steps count those in fold angles and those in positions. One thread, wall clock. Where the
//! methods find different minima, the difference of the energies is shown.
//!
//! ```text
//! cargo bench --bench intrinsic                 all parts (15 minutes: moved vertices take most of it)
//! cargo bench --bench intrinsic -- sizes        12 to 96 cells a side, rigid bars
//! cargo bench --bench intrinsic -- stiffness    bars from soft to rigid
//! cargo bench --bench intrinsic -- random       random rest angles, 4 to 158 cells a side
//! ```

#![allow(clippy::unwrap_used)] // benchmarks, also their helpers, may fail

mod common;

use common::{exponent, measuring, random, uniform, wanted};
use foldwell::analysis::relax::{Method, RelaxOptions, Relaxed, relax_from};
use foldwell::kinematics::folding_modes;
use foldwell::model::{Assembly, Gauge, RIGID, Terms};
use foldwell::sheet::fold;
use std::time::Instant;

const MODES: [[f64; 3]; 5] =
    [[0.0, 0.05, 0.0], [0.0, 0.2, 0.0], [0.05, 0.05, 0.0], [0.05, -0.05, 0.0], [0.2, 0.2, 0.0]];
/// Largest number of cells a side at which vertices are moved for every mode; for the first mode there is no limit.
const MOST_CELLS_OF_VERTICES: usize = 48;

fn main() {
    println!("{:28} {:>9} {:>22} {:>24} {:>7}", "", "", "fold angles", "positions", "");
    println!(
        "{:>28} {:>9} {:>6} {:>7} {:>7} {:>6} {:>7} {:>9} {:>7} {:>10}",
        "rest angles", "cells", "steps", "s", "force", "steps", "s", "force", "ratio", "difference"
    );
    let parts: [(&str, fn()); 3] = [("sizes", sizes), ("stiffness", stiffness), ("random", random_rest)];
    parts.iter().filter(|(name, _)| wanted(name)).for_each(|(_, run)| run());
}

fn sizes() {
    for mode in MODES {
        let mut steps = vec![];
        for cells in if measuring() { vec![12, 24, 48, 96] } else { vec![3] } {
            let both = cells <= MOST_CELLS_OF_VERTICES || mode == MODES[0];
            steps.push((cells as f64, compare(&star(cells), Rest::Mode(mode), RIGID, both) as f64));
        }
        if steps.len() > 1 {
            println!("{:>28} steps grow with the power {:.2} of the side", format!("{mode:?}"), exponent(&steps));
        }
    }
}

fn stiffness() {
    let cells = if measuring() { 24 } else { 3 };
    for bars in [1e2, 1e4, 1e8, RIGID] {
        println!("bars of stiffness {bars:e}");
        MODES.into_iter().for_each(|mode| _ = compare(&star(cells), Rest::Mode(mode), bars, true));
    }
}

fn random_rest() {
    for cells in if measuring() { vec![4, 8, 12, 24, 48, 96, 158] } else { vec![3] } {
        compare(&star(cells), Rest::Random, RIGID, true);
    }
}

enum Rest {
    Mode([f64; 3]),
    Random,
}

fn star(cells: usize) -> Assembly {
    let sheet = fold::parse(include_str!("../meshes/open-star.fold"), "open-star.fold").unwrap();
    Assembly::patch(sheet, [cells; 2]).build().unwrap()
}

/// Prints a row; the number of steps in fold angles and after them.
fn compare(assembly: &Assembly, rest: Rest, bars: f64, both: bool) -> usize {
    let (name, angles): (String, Vec<f64>) = match rest {
        Rest::Mode(mode) => {
            let rates = folding_modes(assembly.sheet()).unwrap().named(mode).unwrap();
            let pairs = assembly.tiling().edges.iter().zip(assembly.drawn_angles());
            (format!("{mode:?}"), pairs.map(|(edge, angle)| angle + rates[edge.edge]).collect())
        }
        Rest::Random => {
            let mut numbers = random(1);
            let angles = assembly.drawn_angles().iter().map(|angle| angle + uniform(&mut numbers, 0.1));
            ("random".to_owned(), angles.collect())
        }
    };
    let terms = Terms::bars_and_creases(bars, 1.0, angles);
    let (found, time) = timed(assembly, &terms, Method::Intrinsic);
    let found = found.unwrap_or_else(|| panic!("{name}: not relaxed"));
    let given_up = if found.intrinsic_failure.is_some() { "given up" } else { "" };
    print!("{name:>28} {:>9} {:6} {time:7.2} {:7.0e}", assembly.shown()[0], found.iterations, found.residual_force);
    if !both {
        println!(" {given_up}");
        return found.iterations;
    }
    match timed(assembly, &terms, Method::Vertices) {
        (Some(moved), seconds) => println!(
            " {:6} {seconds:7.2} {:9.0e} {:7.1} {:10.1e} {given_up}",
            moved.iterations,
            moved.residual_force,
            seconds / time,
            moved.state.total() / found.state.total() - 1.0
        ),
        (None, seconds) => println!(" {:>6} {seconds:7.2} not converged {given_up}", "-"),
    }
    found.iterations
}

fn timed(assembly: &Assembly, terms: &Terms, method: Method) -> (Option<Relaxed>, f64) {
    let model = assembly.with_terms(terms.clone()).model(Gauge::Held);
    let (start, clock) = (model.start(), Instant::now());
    let found = relax_from(&model, start, RelaxOptions { method, ..RelaxOptions::default() }, &mut |_| true);
    (found.ok(), clock.elapsed().as_secs_f64())
}
