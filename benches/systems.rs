//! The sparse symmetric systems of Newton steps: times of factorization and solution, and files for other solvers.
//!
//! ```text
//! cargo bench --bench systems                      times of this program
//! cargo bench --bench systems -- write FOLDER      and the matrices, for benches/peers/systems.py
//! ```
//!
//! The matrix is `S = H + R^T w R` at the relaxed state of rigid 12 x 12, 24 x 24 and 48 x 48 cells, with the full
//! Hessian, which makes it positive definite. The pattern is analysed once and is not timed. The matrix is factored,
//! and one right-hand side is solved, by turns with tearing (`numerics::tearing`, as in the program) and as a whole, on
//! one thread. The residual is relative to the largest entries of the matrix and of the solution.
#![allow(clippy::unwrap_used)]

mod common;

use common::{Star, in_turns, measuring, size, vector};
use foldwell::numerics::factor::Factor;
use foldwell::numerics::parallel::Threads;
use foldwell::numerics::sparse::{SparsityPattern, symmetric_product};
use foldwell::numerics::tearing::TornFactor;
use foldwell::numerics::vector::max_abs;
use foldwell::solver::kkt::KktSystem;
use foldwell::solver::{HessianKind, Linearization, Options, Problem, minimize};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::time::Instant;

const ROUNDS: usize = 7;

fn main() {
    let folder = folder();
    let sizes: &[usize] = if measuring() || folder.is_some() { &[12, 24, 48, 96] } else { &[3] };
    println!("{:>13} {:>6} {:>35} {:>35}", "", "", "factor, ms", "solve, ms");
    println!(
        "{:>3} {:>9} {:>6} {:>9} {:>9} {:>6} {:>8} {:>9} {:>9} {:>6} {:>8} {:>9} {:>9} {:>9}",
        "n",
        "unknowns",
        "open",
        "1 thread",
        "2",
        "ratio",
        "whole",
        "1 thread",
        "2",
        "ratio",
        "whole",
        "millions",
        "whole",
        "residual"
    );
    for &n in sizes {
        one(n, folder.as_deref());
    }
}

/// Returns the argument after `write`.
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
    let (layout, pattern, entries) = (model.layout(), at.pattern(), &system.values);
    let tearing = layout.tearing().unwrap();
    let mut whole = Factor::new(pattern, &layout.node, &[&layout.soft, &layout.stiff]).unwrap();
    let outer = at.rank_one_terms(1.0, &system.weights);
    let threads = [1, 2].map(|count| Threads::new(Some(count)));
    let [mut torn, mut other] = [(); 2].map(|()| TornFactor::of(tearing).unwrap());
    let [one, two] = &threads;
    let factoring = in_turns(
        ROUNDS,
        &mut [
            &mut || one.install(|| clock(|| torn.factor(pattern, entries, &outer))),
            &mut || two.install(|| clock(|| other.factor(pattern, entries, &outer))),
            &mut || one.install(|| clock(|| whole.factor(pattern, entries))),
        ],
    );
    // the second of two solves: a step solves several times, and the peers are timed in a sequence of solves
    let twice = |threads: &Threads, solve: &mut dyn FnMut(&mut [f64])| {
        solve(&mut right.clone());
        let mut solution = right.clone();
        threads.install(|| clock(|| solve(&mut solution)))
    };
    let solving = in_turns(
        ROUNDS,
        &mut [&mut || twice(one, &mut |x| torn.solve(x)), &mut || twice(two, &mut |x| other.solve(x)), &mut || {
            twice(one, &mut |x| whole.solve(x))
        }],
    );
    let mut solution = right.clone();
    torn.solve(&mut solution);
    let mut product = vec![0.0; unknowns];
    symmetric_product(pattern, entries, &solution, &mut product);
    let size = pattern.largest_diagonal(entries) * max_abs(&solution);
    let residual = common::difference(&product, &right) / size;
    let times = |times: &[f64]| {
        let [one, two, whole] = [times[0], times[1], times[2]].map(|time| 1e3 * time);
        format!("{one:9.2} {two:9.2} {:6.2} {whole:8.2}", one / two)
    };
    println!(
        "{n:3} {unknowns:9} {:6} {} {} {:9.2} {:9.2} {residual:9.0e}",
        tearing.open(),
        times(&factoring),
        times(&solving),
        1e-6 * torn.stored() as f64,
        1e-6 * whole.stored() as f64
    );
    if let Some(folder) = folder {
        write(folder, n, pattern, entries, [&factoring[..2], &solving[..2]]);
    }
}

/// Returns the seconds of wall clock that work takes.
fn clock<T>(work: impl FnOnce() -> T) -> f64 {
    let start = Instant::now();
    std::hint::black_box(work());
    start.elapsed().as_secs_f64()
}

/// Writes the matrix, and the times in seconds of one torn factorization and one solve, each on one and on two threads.
fn write(folder: &Path, n: usize, pattern: &SparsityPattern, entries: &[f64], [factor, solve]: [&[f64]; 2]) {
    let unknowns = pattern.size();
    let mut text =
        format!("%%MatrixMarket matrix coordinate real symmetric\n{unknowns} {unknowns} {}\n", entries.len());
    let places = (0..unknowns).flat_map(|column| pattern.column(column).iter().map(move |row| (row, column)));
    for ((row, column), entry) in places.zip(entries) {
        writeln!(text, "{} {} {entry:e}", row + 1, column + 1).unwrap();
    }
    std::fs::create_dir_all(folder).unwrap();
    std::fs::write(folder.join(format!("{n}.mtx")), text).unwrap();
    let times = format!("{{ \"factor\": {factor:?}, \"solve\": {solve:?} }}\n");
    std::fs::write(folder.join(format!("{n}.json")), times).unwrap();
}
