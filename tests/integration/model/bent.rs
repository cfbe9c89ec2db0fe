//! Sheets bent along a linear folding mode, with almost no forces, on increasingly large patches.

use crate::common::{Testing, patch};
use foldwell::kinematics::folding_modes::folding_modes;
use foldwell::model::{Gauge, Terms};
use foldwell::solver::{Options, minimize};

/// Claim: rest angles along one linear mode of `open-star`, of amplitudes 0.06, 0.01 and 0 (rest angles as drawn),
/// relax to the usual tolerance in at most 25 steps on patches from 4 x 4 to 24 x 24 cells, although fold angles are
/// known only to the rounding errors of coordinates as large as the sheet.
#[test]
fn bent_patches_converge() {
    let mut failed = Vec::new();
    for n in [4, 6, 8, 12, 16, 24] {
        let case = patch("open-star", [n, n]);
        let mode = folding_modes(case.sheet()).unwrap().named([1.0, 0.0, 0.0]).unwrap();
        for amplitude in [0.06, 0.01, 0.0] {
            let rest =
                case.tiling().edges.iter().zip(case.drawn_angles()).map(|(e, angle)| angle + amplitude * mode[e.edge]);
            let rest: Vec<f64> = rest.collect();
            for k in [1e2, 1e6, f64::INFINITY] {
                let mut model = case.model_of(&Terms::bars_and_creases(k, 1.0, rest.clone()), Gauge::Held);
                let start = model.start();
                let options = Options { iterations: 25, ..Options::default() };
                let found = minimize(&mut model, start, options, &mut |_| true);
                println!(
                    "n = {n}, amplitude {amplitude}, k = {k:e}: {:?}",
                    found.as_ref().map(|f| f.history.len() - 1)
                );
                if let Err(error) = found {
                    failed.push(format!("n = {n}, amplitude {amplitude}, k = {k:e}: {error}"));
                }
            }
        }
    }
    assert!(failed.is_empty(), "{} of 54 failed: {failed:#?}", failed.len());
}
