//! Sheets whose minimum has no energy: disturbed from the state of rest, they return to it.

use crate::common::{self, Numbers, Testing, on};
use foldwell::analysis::relax::relax_from;
use foldwell::model::{Boundary, Gauge, Terms};
use foldwell::solver::Options;

/// Claim: from a start moved at random by up to 0.003 of an edge, with the drawn lengths and angles at rest, a sheet
/// returns to the drawn angles at every stiffness, on patch and torus. Tolerance: the forces end below 1e-12 of those
/// of a crease folded by a milliradian.
#[test]
fn sheets_come_back_to_rest() {
    come_back(&[(Boundary::Patch, [4, 4]), (Boundary::FreeTorus, [2, 2])]);
}

/// Claim: the same on a screw, where the return is not unique: at `kappa = 0` the axis may have any direction in the
/// plane, which rotates the sheet in the plane and costs no energy.
#[test]
fn screws_come_back_to_rest() {
    come_back(&[(Boundary::Screw, [1, 1])]);
}

fn come_back(domains: &[(Boundary, [usize; 2])]) {
    let mut failed = Vec::new();
    for &(boundary, cells) in domains {
        let case = on(common::mesh("open-star"), cells, boundary);
        for k in [1e2, 1e4, 1e6, 1e8, 1e12, f64::INFINITY] {
            for seed in 1..6 {
                let model = case.model_of(&Terms::bars_and_creases(k, 1.0, case.drawn_angles().to_vec()), Gauge::Held);
                let mut numbers = Numbers::new(seed);
                let start: Vec<f64> = model.start().iter().map(|x| x + numbers.within(0.003)).collect();
                match relax_from(&model, start, Options::default(), &mut |_| true) {
                    Ok(found) => {
                        let off = common::distance(&found.state.fold_angle, case.drawn_angles());
                        assert!(off < 1e-9, "{boundary:?}, k = {k:e}, seed {seed}: off by {off:e}");
                    }
                    Err(error) => failed.push(format!("{boundary:?}, k = {k:e}, seed {seed}: {error}")),
                }
            }
        }
    }
    assert!(failed.is_empty(), "{} failed: {failed:#?}", failed.len());
}
