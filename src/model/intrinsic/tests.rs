//! Conditions of patches with and without openings, and their derivatives entry by entry.

use super::*;
use crate::model::{Assembly, Gauge, RIGID, Terms};
use crate::numerics::DenseMatrix;
use crate::numerics::derivatives::{TOLERANCE, check_jacobian};
use crate::numerics::vector::max_abs;
use crate::sheet::{Sheet, fold};
use crate::solver::constrained::Block;

fn star() -> Sheet {
    fold::parse(include_str!("../../../meshes/open-star.fold"), "open-star.fold").unwrap()
}

fn kirigami() -> Sheet {
    fold::parse(include_str!("../../../meshes/kirigami.fold"), "kirigami.fold").unwrap()
}

/// The model of a patch with soft facets, and its intrinsic form.
fn patch(sheet: Sheet, cells: [usize; 2], bars: f64) -> (Model, IntrinsicModel) {
    let assembly = Assembly::patch(sheet, cells).bars(bars).creases(1.0).facets(2.0).build().unwrap();
    let model = assembly.model(Gauge::Held);
    let intrinsic = IntrinsicModel::new(&model).unwrap();
    (model, intrinsic)
}

fn drawn(model: &Model, intrinsic: &IntrinsicModel) -> Vec<f64> {
    intrinsic.variables(model, &model.start())
}

fn members(intrinsic: &IntrinsicModel, block: usize, z: &[f64]) -> Vec<f64> {
    intrinsic.blocks.variables.members(block).iter().map(|&k| z[k as usize]).collect()
}

/// Claim: all conditions hold in the drawn state, with soft and with rigid bars. A patch without openings has as many
/// as leave `rim - 3` motions of rigid faces (Euler), and the kirigami patch has six more for each opening and one for
/// each bar across a notch of its rim. Tolerance: rounding of products of some twenty rotations.
#[test]
fn drawn_patches_meet_their_conditions() {
    for (sheet, openings) in [(star(), 0), (kirigami(), 4)] {
        for bars in [RIGID, 1e3] {
            let (model, intrinsic) = patch(sheet.clone(), [3, 3], bars);
            let z = drawn(&model, &intrinsic);
            let mut out = Block::default();
            for block in 0..intrinsic.blocks.len() {
                intrinsic.linearize(block, &z, None, &mut out);
                assert!(max_abs(&out.values) <= 1e-14, "{block}: {:?}", out.values);
            }
            let of_rows = |rows| intrinsic.words.iter().filter(|word| word.rows() == rows).count();
            assert_eq!(of_rows(6), openings);
            let folds = intrinsic.angles.iter().filter(|angle| matches!(angle, EdgeValue::Variable(_))).count();
            let rim = intrinsic.topology.rims().unwrap().iter().map(loops::Rim::len).max().unwrap();
            // E_int - 3 V_int - 6 h = rim - 3 - 3 h, and rims of openings of four edges
            let free = folds - 3 * of_rows(3) - 6 * openings;
            assert_eq!(free + 3 * openings + 3, rim + 4 * openings);
        }
    }
}

/// Claim: every entry of the Jacobian of every kind of condition is right, in the drawn state and beside it, where
/// nothing closes. Source: differences ([`check_jacobian`]).
#[test]
fn jacobians_entry_by_entry() {
    for sheet in [star(), kirigami()] {
        let (model, intrinsic) = patch(sheet, [2, 3], 1e3);
        let mut z = drawn(&model, &intrinsic);
        for _ in 0..2 {
            for (block, word) in intrinsic.words.iter().enumerate() {
                let values = |z: &[f64]| {
                    let mut out = Block::default();
                    word.linearize(z, None, &mut out);
                    out.values
                };
                let (local, mut out) = (members(&intrinsic, block, &z), Block::default());
                word.linearize(&local, None, &mut out);
                let jacobian = DenseMatrix::from_column_slice(word.rows(), local.len(), &out.jacobian);
                check_jacobian(values, &local, &jacobian, TOLERANCE).unwrap_or_else(|e| panic!("{block}: {e}"));
            }
            (0..).zip(&mut z).for_each(|(k, z)| *z *= 1.0 + 0.01 * f64::sin(f64::from(k)));
        }
    }
}

/// Claim: every entry of the Hessian of `multipliers . F` is right where the conditions are met. Source: differences of
/// the Jacobian, which is checked above.
#[test]
fn hessians_entry_by_entry() {
    for sheet in [star(), kirigami()] {
        let (model, intrinsic) = patch(sheet, [2, 3], 1e3);
        let z = drawn(&model, &intrinsic);
        for (block, word) in intrinsic.words.iter().enumerate() {
            let multipliers: Vec<f64> = (0..word.rows()).map(|k| 1.0 - 0.3 * k as f64).collect();
            let forces = |z: &[f64]| {
                let mut out = Block::default();
                word.linearize(z, None, &mut out);
                let columns = out.jacobian.chunks_exact(word.rows());
                columns.map(|column| column.iter().zip(&multipliers).map(|(a, b)| a * b).sum()).collect::<Vec<f64>>()
            };
            let (local, mut out) = (members(&intrinsic, block, &z), Block::default());
            word.linearize(&local, Some(&multipliers), &mut out);
            let entry = |i: usize, j: usize| out.hessian[i.max(j) * (i.max(j) + 1) / 2 + i.min(j)];
            let hessian = DenseMatrix::from_fn(local.len(), local.len(), entry);
            check_jacobian(forces, &local, &hessian, TOLERANCE).unwrap_or_else(|e| panic!("{block}: {e}"));
        }
    }
}

/// Claim: the drawn angles and lengths put every vertex where it is drawn, those that one or two bars hold too.
/// Tolerance: rounding over the radius of the patch.
#[test]
fn drawn_angles_place_the_drawn_patch() {
    for sheet in [star(), kirigami()] {
        let (mut model, intrinsic) = patch(sheet, [5, 4], RIGID);
        let (z, expected) = (drawn(&model, &intrinsic), model.coordinates(&model.start()));
        let none = vec![0.0; intrinsic.blocks.total_rows()];
        let start = intrinsic.hand_over(&mut model, &z, &none);
        let found = model.coordinates(&start.x);
        let error = found.iter().zip(&expected).fold(0.0f64, |most, (a, b)| most.max((a - b).abs()));
        assert!(error <= 1e-12, "{error:e}");
        assert!(start.tension.is_some_and(|tension| tension.iter().all(|t| *t == 0.0)));
    }
}

/// Claim: what has no form in fold angles is refused with its reason: other domains, pins of two vertices, and edges
/// without stiffness.
#[test]
fn other_models_are_refused() {
    let refused = |assembly: Assembly| IntrinsicModel::new(&assembly.model(Gauge::Held)).unwrap_err();
    let torus = Assembly::torus(star(), [2, 2]).bars(RIGID).creases(1.0).build().unwrap();
    assert_eq!(refused(torus), Unsupported::Domain);
    let soft = Assembly::patch(kirigami(), [3, 3]).bars(RIGID).creases(1.0).facets(0.0).build();
    assert!(soft.is_err() || matches!(refused(soft.unwrap()), Unsupported::NoHinge { .. } | Unsupported::Topology));
    let whole = Assembly::patch(star(), [3, 3]).bars(RIGID).creases(1.0).build().unwrap();
    let bare = whole.with_terms(Terms { bars: None, ..whole.terms().clone() });
    assert!(matches!(refused(bare), Unsupported::NoBar { .. }));
    let pinned = Assembly::patch(star(), [3, 3]).bars(RIGID).creases(1.0).pin(0, [0, 0], [true; 3]);
    assert_eq!(refused(pinned.pin(0, [1, 0], [true; 3]).build().unwrap()), Unsupported::Pins);
}
