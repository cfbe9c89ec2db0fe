//! Cost of spatially varying modes.
//!
//! ```text
//! cargo bench --bench bloch
//! ```
//!
//! Random cells of 4 to 16 vertices. `coefficients`: the determinant from the matrix; `map`: its values at 512 x 512
//! wavenumbers from the coefficients; `zero lines`: all lines of zeros, every point to 1e-12; `decay`: the roots at one
//! wavenumber. Times are medians of runs taken by turns, in milliseconds. At the end, the slowest computation of the
//! lines of zeros among 200 random cells, each run once.
#![allow(clippy::unwrap_used)]

mod common;

use common::{in_turns, measuring, seconds};
use foldwell::analysis::bloch::{Decay, Determinant, Rigidity, ZeroLines, Zone};
use foldwell::sheet::generate::Random;
use foldwell::sheet::{Pattern, generate};

fn main() {
    let (rounds, side) = if measuring() { (21, 512) } else { (1, 16) };
    println!(
        "{:>9} {:>13} {:>9} {:>11} {:>9} {:>7}",
        "vertices", "coefficients", "map", "zero lines", "decay", "lines"
    );
    for size in [[2, 2], [3, 3], [4, 4]] {
        let sheet = generate(&Pattern::Random(Random { size, seed: 1, ..Random::default() })).unwrap();
        let rigidity = Rigidity::of_sheet(&sheet, false).unwrap();
        let determinant = Determinant::new(&rigidity).unwrap();
        let zone = Zone::new(&determinant).unwrap();
        let lines = ZeroLines::new(&zone).unwrap().lines.len();
        let times = in_turns(
            rounds,
            &mut [
                &mut || seconds(|| Determinant::new(&rigidity).unwrap()),
                &mut || seconds(|| determinant.polynomial.map([side, side])),
                &mut || seconds(|| ZeroLines::new(&zone).unwrap().refined(&zone, &rigidity)),
                &mut || seconds(|| Decay::new(&determinant, 0, 0.9).unwrap().refined(&determinant, &rigidity)),
            ],
        );
        let [coefficients, map, zero_lines, decay] = [0, 1, 2, 3].map(|k| 1e3 * times[k]);
        println!("{:>9} {coefficients:>13.2} {map:>9.2} {zero_lines:>11.2} {decay:>9.3} {lines:>7}", size[0] * size[1]);
    }
    println!("slowest zero lines of 200 cells: {:.2}", 1e3 * slowest(if measuring() { 200 } else { 1 }));
}

/// Returns the largest time in seconds of the lines of zeros among the random cells of
/// `tests/integration/analysis/bloch.rs`.
fn slowest(cells: u64) -> f64 {
    let sizes = (2..=4).flat_map(|a| (2..=4).map(move |b| [a, b])).cycle();
    let of = |(seed, size): (u64, [usize; 2])| {
        let sheet = generate(&Pattern::Random(Random { size, seed: 1000 + seed, ..Random::default() })).unwrap();
        let rigidity = Rigidity::of_sheet(&sheet, false).unwrap();
        let zone = Zone::new(&Determinant::new(&rigidity).unwrap()).unwrap();
        seconds(|| ZeroLines::new(&zone).unwrap().refined(&zone, &rigidity))
    };
    (0..cells).zip(sizes).map(of).fold(f64::NAN, f64::max)
}
