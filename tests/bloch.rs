//! Spatially varying modes: theory, section 8.
#![allow(clippy::unwrap_used)] // in helpers of tests as in tests

mod common;

use common::mesh;
use foldwell::analysis::bloch::duality::{displacement, fold_rates};
use foldwell::analysis::bloch::strain_form::StrainForm;
use foldwell::analysis::bloch::{Decay, Determinant, Polarization, Rigidity, ZeroLines, Zone};
use foldwell::numerics::complex::{ComplexMatrix, ComplexSvd, complex_svd};
use foldwell::sheet::generate::Random;
use foldwell::sheet::{Pattern, Sheet, generate};
use nalgebra::Complex;
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

/// Claim: the leading quartic that the strains of the three linear modes give is that of the determinant's expansion up to one
/// factor (1e-8 of its largest coefficient; rounding of moments of some 100 coefficients), reciprocity of any two modes holds to
/// 1e-12, the determinant vanishes to fourth order, and the traced lines leave `q = 0` in the directions of the real roots,
/// which are 0, 2 or 4 in number: on 200 random cells. All lines agree with the signs on a grid (`ZeroLines` refuses others).
#[test]
fn zero_lines_of_random_cells() {
    let (mut apart, mut reciprocity, mut residual, mut counts) = (0.0f64, 0.0f64, 0.0f64, [0; 5]);
    let mut topologies = std::collections::BTreeMap::new();
    let (mut angles, mut slowest) = (0.0f64, 0.0f64);
    for sheet in random_cells() {
        let zone = Zone::new(&determinant(&sheet)).unwrap();
        assert_eq!(zone.order, 4, "{}", sheet.description);
        let form = StrainForm::new(&sheet).unwrap();
        let quartic = form.quartic();
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let factor = dot(&zone.form, &quartic) / dot(&quartic, &quartic);
        let largest = zone.form.iter().fold(0.0f64, |most, c| most.max(c.abs()));
        let off = zone.form.iter().zip(&quartic).map(|(a, b)| (a - factor * b).abs() / largest).fold(0.0, f64::max);
        assert!(off <= 1e-8, "{}: {off:e}", sheet.description);
        apart = apart.max(off);
        let pair = [[0.3, -0.8, 0.5], [1.0, 0.2, -0.4]];
        let (one, two) = (form.pairing(pair[0], pair[1]), form.pairing(pair[1], pair[0]));
        reciprocity = reciprocity.max((one - two).abs() / form.strains.norm());
        let clock = std::time::Instant::now();
        let lines = ZeroLines::new(&zone).unwrap_or_else(|error| panic!("{}: {error}", sheet.description));
        slowest = slowest.max(clock.elapsed().as_secs_f64());
        let directions = zone.directions().unwrap();
        counts[directions.len()] += 1;
        assert_eq!(lines.through_origin(), directions.len(), "{}", sheet.description);
        for line in &lines.lines {
            residual = residual.max(line.residual);
            *topologies.entry((line.passes, line.winding.map(i32::abs))).or_insert(0) += 1;
            if line.passes > 0 {
                // the second point is the first after q = 0, the one before the last comes back to it
                for q in [line.points[1], {
                    let k = line.points.len() - 2;
                    [0, 1].map(|a| line.points[k][a] - line.points[k + 1][a])
                }] {
                    let off = |angle: &f64| (q[1].atan2(q[0]) - angle).sin().abs();
                    angles = angles.max(directions.iter().map(off).fold(f64::INFINITY, f64::min));
                }
            }
        }
        let sum: f64 = lines.regions.iter().map(|region| region.fraction).sum();
        assert!((sum - 1.0).abs() <= 1e-12);
    }
    println!(
        "quartic {apart:e}, reciprocity {reciprocity:e}, residual {residual:e}, lines at q = 0: {counts:?}, angles {angles:e}"
    );
    println!("passes and windings {topologies:?}, slowest {slowest}");
    assert!(reciprocity <= 1e-12 && residual <= 1e-12 && counts[1] == 0 && counts[3] == 0);
    assert!(counts[0] > 0 && counts[2] > 0, "{counts:?}");
    // the curves are 1e-4 away from q = 0 there
    assert!(angles <= 1e-2, "{angles:e}");
}

/// Claim: at every wavenumber there are as many zero modes as self stresses at the opposite one, and by the fold rates as many at
/// the same one (duality): from a null vector of `R(z)` the fold rates are a self stress at `z`, whose displacement is that
/// null vector again; a left null vector is a self stress at `1/z`, and has a displacement there that stretches no bar. On
/// roots of random cells and at a complex pair. Tolerance: 1e-9 for null vectors of roots known to 1e-10.
#[test]
fn duality_at_finite_wavenumber() {
    let mut worst = [0.0f64; 4];
    for sheet in random_cells().take(60) {
        let rigidity = Rigidity::of_sheet(&sheet, false).unwrap();
        let decay = Decay::new(&determinant(&sheet), 0, 0.9).unwrap();
        for root in decay.roots.iter().filter(|root| root.condition <= 1e4 && root.kappa().abs() < 2.0) {
            let z = [Complex::from_polar(1.0, 0.9), root.z];
            let inverse = z.map(|z| z.inv());
            let ComplexSvd { u, singular_values, v } = complex_svd(&rigidity.at(z)).unwrap();
            let last = u.ncols() - 1;
            let rank = singular_values.iter().filter(|value| **value > 1e-7 * singular_values[0]).count();
            assert_eq!(rank, last, "{singular_values:?}");
            let mode: Vec<_> = v.column(last).iter().copied().collect();
            let rates = fold_rates(&sheet, z, &mode);
            let size = |list: &[Complex<f64>]| list.iter().map(|x| x.norm_sqr()).sum::<f64>().sqrt();
            let force = rigidity.equilibrium(z) * ComplexMatrix::from_column_slice(rates.len(), 1, &rates);
            worst[0] = worst[0].max(force.norm() / size(&rates));
            let back = displacement(&sheet, z, &rates).unwrap();
            let off: Vec<_> = back.iter().zip(&mode).map(|(a, b)| a - b).collect();
            worst[1] = worst[1].max(size(&off) / size(&back));
            let stress: Vec<_> = u.column(last).iter().map(|x| x.conj()).collect();
            let force = rigidity.equilibrium(inverse) * ComplexMatrix::from_column_slice(stress.len(), 1, &stress);
            worst[2] = worst[2].max(force.norm());
            let moved = displacement(&sheet, inverse, &stress).unwrap();
            let stretch = rigidity.at(inverse) * ComplexMatrix::from_column_slice(moved.len(), 1, &moved);
            worst[3] = worst[3].max(stretch.norm() / size(&moved));
        }
    }
    println!("duality: {worst:?}");
    assert!(worst.iter().all(|error| *error <= 1e-9), "{worst:?}");
}
