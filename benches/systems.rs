//! The sparse symmetric systems of a Newton step, factored and solved; written for others to solve.
//!
//! ```text
//! cargo bench --bench systems                      times of this program
//! cargo bench --bench systems -- write FOLDER      and the matrices, for benches/peers/systems.py
//! ```
//!
//! `S = H + R^T w R` at the relaxed state of rigid 12 x 12, 24 x 24 and 48 x 48 cells, with the full Hessian: positive
//! definite. The pattern is analysed once and is not timed; numbers are factored, and one right-hand side is
//! solved. One thread. The residual is relative to the largest entry of the matrix and of the solution.
#![allow(clippy::unwrap_used)]

mod common;

use common::{Star, in_turns, measuring, seconds, size, vector};
use foldwell::numerics::factor::Factor;
use foldwell::numerics::parallel;
use foldwell::numerics::sparse::symmetric_product;
use foldwell::solver::saddle::Saddle;
use foldwell::solver::{Curvature, Linearization, Options, Problem, minimize};
use std::fmt::Write;
use std::path::{Path, PathBuf};

const ROUNDS: usize = 7;

fn main() {
    parallel::set_threads(1);
    let folder = folder();
    let sizes: &[usize] = if measuring() || folder.is_some() { &[12, 24, 48] } else { &[3] };
    println!("{:>3} {:>9} {:>10} {:>10} {:>9}", "n", "unknowns", "factor ms", "solve ms", "residual");
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
    model.linearize(&found.x, &found.tension, Curvature::Full, &mut at);
    let rigid = vec![0.0; measures];
    let mut saddle = Saddle::new(model.layout(), &at).unwrap();
    let inertia = saddle.factor(model.layout(), &at, &rigid, 0.0).unwrap();
    assert_eq!(inertia.negative, 0, "a minimum");
    let right = vector(2, unknowns, 1.0);
    let mut solution = Vec::new();
    let (layout, pattern, entries) = (model.layout(), at.pattern(), saddle.entries());
    let mut factor = Factor::of(layout.symbolic().unwrap()).unwrap();
    let factoring = in_turns(ROUNDS, &mut [&mut || seconds(|| factor.factor(pattern, entries))]);
    let solving = in_turns(
        ROUNDS,
        &mut [&mut || {
            solution.clone_from(&right);
            seconds(|| factor.solve(&mut solution))
        }],
    );
    let mut product = vec![0.0; unknowns];
    symmetric_product(pattern, entries, &solution, &mut product);
    let size = pattern.largest_diagonal(entries) * solution.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
    let residual = common::difference(&product, &right) / size;
    println!("{n:3} {unknowns:9} {:10.2} {:10.2} {residual:9.0e}", 1e3 * factoring[0], 1e3 * solving[0]);
    if let Some(folder) = folder {
        let mut text =
            format!("%%MatrixMarket matrix coordinate real symmetric\n{unknowns} {unknowns} {}\n", entries.len());
        let places = (0..unknowns).flat_map(|column| pattern.column(column).iter().map(move |row| (row, column)));
        for ((row, column), entry) in places.zip(entries) {
            writeln!(text, "{} {} {entry:e}", row + 1, column + 1).unwrap();
        }
        std::fs::create_dir_all(folder).unwrap();
        std::fs::write(folder.join(format!("{n}.mtx")), text).unwrap();
        let times = format!("{{ \"factor\": {:e}, \"solve\": {:e} }}\n", factoring[0], solving[0]);
        std::fs::write(folder.join(format!("{n}.json")), times).unwrap();
    }
}
