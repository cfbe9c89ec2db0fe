//! Spatially varying modes: theory, section 8.
#![allow(clippy::unwrap_used)] // in helpers of tests as in tests

mod common;

use common::mesh;
use foldwell::analysis::bloch::{Decay, Determinant, Polarization, Rigidity};
use foldwell::sheet::generate::Random;
use foldwell::sheet::{Pattern, Sheet, generate};
use serde_json::Value;

fn random(size: [usize; 2], seed: u64) -> Sheet {
    generate(&Pattern::Random(Random { size, seed, ..Random::default() })).unwrap()
}

/// 200 random cells of 2 x 2 to 4 x 4 vertices.
fn random_cells() -> impl Iterator<Item = Sheet> {
    let sizes = (2..=4).flat_map(|a| (2..=4).map(move |b| [a, b]));
    (0..200).zip(sizes.cycle()).map(|(seed, size)| random(size, 1000 + seed))
}

fn determinant(sheet: &Sheet) -> Determinant {
    Determinant::new(&Rigidity::of_sheet(sheet, false).unwrap()).unwrap()
}

/// Claim: the coefficients of the reference cell are those that an independent program found (exact up to the sign), and its
/// decay rates at q1 = 0.9 too. Tolerance: 1e-14 of coefficients of 0.05; 1e-13 for decay rates of condition below 100.
#[test]
fn stored_numbers_of_open_star() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/cases/open-star.json");
    let case: Value = serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap();
    let found = determinant(&mesh("open-star"));
    let stored = case["bloch"]["determinant_centred_up_to_sign"].as_array().unwrap();
    let terms: Vec<(f64, f64, f64)> = found.polynomial.terms().filter(|(_, _, c)| c.abs() > 1e-12).collect();
    println!(
        "{terms:?}\nsymmetry {:e}, imaginary {:e}, error {:e}",
        found.symmetry_error, found.imaginary_part, found.error
    );
    assert_eq!(terms.len(), stored.len());
    let expected: Vec<[f64; 3]> = stored.iter().map(|t| [0, 1, 2].map(|k| t[k].as_f64().unwrap())).collect();
    let same = |sign: f64| {
        let near = |(m, n, c): &(f64, f64, f64)| {
            expected.iter().any(|e| e[0] == *m && e[1] == *n && (sign * e[2] - c).abs() <= 1e-14)
        };
        terms.iter().all(near)
    };
    assert!(same(1.0) || same(-1.0), "{terms:?}");
    let decay = Decay::new(&found, 0, 0.9).unwrap();
    let stored = case["bloch"]["kappa2"].as_array().unwrap();
    assert_eq!(decay.roots.len(), stored.len());
    for (root, kappa) in decay.roots.iter().zip(stored) {
        let error = (root.kappa() - kappa.as_f64().unwrap()).abs();
        assert!(error <= 1e-13, "{root:?} {kappa}");
    }
}

/// Claim: on 200 random cells the centred determinant is symmetric and real to 1e-12, powers are whole numbers, decay rates pair
/// to 1e-9 where they are well conditioned, and as many roots are inside as outside: no polarization.
#[test]
fn random_cells_are_symmetric_and_not_polarized() {
    let (mut symmetry, mut imaginary, mut error, mut pairing, mut left_out, mut pairs) =
        (0.0f64, 0.0f64, 0.0f64, 0.0f64, 0, 0);
    for sheet in random_cells() {
        let found = determinant(&sheet);
        assert!(
            found.symmetric && found.polynomial.lowest.iter().all(|low| low.fract() == 0.0),
            "{}",
            sheet.description
        );
        symmetry = symmetry.max(found.symmetry_error);
        imaginary = imaginary.max(found.imaginary_part);
        error = error.max(found.error);
        for q1 in [-2.5, -1.0, 0.4, 0.9, 1.7, 2.9] {
            let pairs_here = Decay::new(&found, 0, q1).unwrap();
            let here = pairs_here.pairing();
            assert!(here.error <= 1e-9, "{}: {here:?}", sheet.description);
            pairing = pairing.max(here.error);
            left_out += here.left_out;
            pairs += pairs_here.roots.len();
        }
        let Polarization { polarization, .. } = Polarization::new(&found, 16).unwrap();
        assert_eq!(polarization, [0.0, 0.0], "{}", sheet.description);
    }
    println!(
        "symmetry {symmetry:e}, imaginary {imaginary:e}, error {error:e}, pairing {pairing:e}, left out {left_out} of {pairs}"
    );
    assert!(symmetry <= 1e-12 && imaginary <= 1e-12 && error <= 1e-12);
    assert!(20 * left_out <= pairs, "{left_out} roots of {pairs} are ill-conditioned");
}

/// Claim: at a flat state the determinant vanishes identically (theory, section 8): this is said, not computed with.
#[test]
fn flat_sheets_have_no_determinant() {
    let refused = Determinant::new(&Rigidity::of_sheet(&mesh("open-flat"), false).unwrap());
    let message = refused.unwrap_err().to_string();
    assert!(message.contains("flat sheet"), "{message}");
}
