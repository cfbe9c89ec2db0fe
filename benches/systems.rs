//! The sparse symmetric systems of a Newton step, factored and solved; written for others to solve.
//!
//! ```text
//! cargo bench --bench systems                      times of this program
//! cargo bench --bench systems -- write FOLDER      and the matrices, for benches/peers/systems.py
//! ```
//!
//! `S = H + R^T w R` at the relaxed state of rigid 12 x 12, 24 x 24 and 48 x 48 cells, with the full Hessian: positive
//! definite. The pattern is analysed once and is not timed; numbers are factored, and one right-hand side is
//! solved, torn (`numerics::tearing`, as the program does it) and whole, in turns. One thread. The residual is relative to the
//! largest entry of the matrix and of the solution.
#![allow(clippy::unwrap_used)]

mod common;

use common::{Star, in_turns, measuring, seconds, size, vector};
use foldwell::numerics::factor::Factor;
use foldwell::numerics::sparse::{SparsityPattern, symmetric_product};
use foldwell::numerics::tearing::TornFactor;
use foldwell::numerics::vector::max_abs;
use foldwell::solver::kkt::KktSystem;
use foldwell::solver::{HessianKind, Linearization, Options, Problem, minimize};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

const ROUNDS: usize = 7;

fn main() {
    let folder = folder();
    let sizes: &[usize] = if measuring() || folder.is_some() { &[12, 24, 48] } else { &[3] };
    println!("{:>13} {:>6} {:>27} {:>27}", "", "hinges", "torn: factor, solve, stored", "whole");
    println!(
        "{:>3} {:>9} {:>6} {:>9} {:>8} {:>8} {:>9} {:>8} {:>8} {:>9}",
        "n", "unknowns", "open", "ms", "ms", "millions", "ms", "ms", "millions", "residual"
    );
    for &n in sizes {
        one(n, folder.as_deref());
    }
}

/// The word after `write`.
fn folder() -> Option<PathBuf> {
    std::env::args().skip_while(|word| word != "write").nth(1).map(PathBuf::from)
}

fn one(n: usize, folder: Option<&Path>) {
    let mut model = Star::new(n).model(f64::INFINITY);
    let (unknowns, measures) = size(&model);
    let start = model.start();
    let found = minimize(&mut model, start, Options::default(), &mut |_| true).unwrap();
    let mut at = Linearization::new(model.layout());
    model.linearize(&found.x, &found.tension, HessianKind::Full, &mut at);
    let rigid = vec![0.0; measures];
    let mut system = KktSystem::new(model.layout()).unwrap();
    let inertia = system.factor(&at, &rigid, 0.0).unwrap();
    assert_eq!(inertia.negative, 0, "a minimum");
    let right = vector(2, unknowns, 1.0);
    let (layout, pattern, entries) = (model.layout(), at.pattern(), system.entries());
    let tearing = layout.tearing().unwrap();
    let mut torn = TornFactor::of(tearing).unwrap();
    let mut whole = Factor::new(pattern, &layout.node, &[&layout.soft, &layout.stiff]).unwrap();
    let outer = at.rank_one_terms(1.0, system.weights());
    let factoring = in_turns(
        ROUNDS,
        &mut [&mut || seconds(|| torn.factor(pattern, entries, &outer)), &mut || {
            seconds(|| whole.factor(pattern, entries))
        }],
    );
    // the second of two: a step solves several times, and the peers are timed one solve after the other
    let twice = |solve: &mut dyn FnMut(&mut [f64])| {
        solve(&mut right.clone());
        let mut solution = right.clone();
        seconds(|| solve(&mut solution))
    };
    let solving =
        in_turns(ROUNDS, &mut [&mut || twice(&mut |x| torn.solve(x)), &mut || twice(&mut |x| whole.solve(x))]);
    let mut solution = right.clone();
    torn.solve(&mut solution);
    let mut product = vec![0.0; unknowns];
    symmetric_product(pattern, entries, &solution, &mut product);
    let size = pattern.largest_diagonal(entries) * max_abs(&solution);
    let residual = common::difference(&product, &right) / size;
    println!(
        "{n:3} {unknowns:9} {:6} {:9.2} {:8.2} {:8.2} {:9.2} {:8.2} {:8.2} {residual:9.0e}",
        tearing.open(),
        1e3 * factoring[0],
        1e3 * solving[0],
        1e-6 * torn.stored() as f64,
        1e3 * factoring[1],
        1e3 * solving[1],
        1e-6 * whole.stored() as f64
    );
    if let Some(folder) = folder {
        write(folder, n, pattern, entries, [factoring[0], solving[0]]);
    }
}

/// The matrix, and seconds for one torn factorization and one solve.
fn write(folder: &Path, n: usize, pattern: &SparsityPattern, entries: &[f64], [factor, solve]: [f64; 2]) {
    let unknowns = pattern.size();
    let mut text =
        format!("%%MatrixMarket matrix coordinate real symmetric\n{unknowns} {unknowns} {}\n", entries.len());
    let places = (0..unknowns).flat_map(|column| pattern.column(column).iter().map(move |row| (row, column)));
    for ((row, column), entry) in places.zip(entries) {
        writeln!(text, "{} {} {entry:e}", row + 1, column + 1).unwrap();
    }
    std::fs::create_dir_all(folder).unwrap();
    std::fs::write(folder.join(format!("{n}.mtx")), text).unwrap();
    let times = format!("{{ \"factor\": {factor:e}, \"solve\": {solve:e} }}\n");
    std::fs::write(folder.join(format!("{n}.json")), times).unwrap();
}
