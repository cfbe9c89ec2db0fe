//! Spatially varying modes (theory, section 8).

use crate::common::{Numbers, Scene, mesh};
use crate::theory::duality::{displacement, fold_rates};
use crate::theory::strain_form::StrainForm;
use approx::{abs_diff_eq, assert_abs_diff_eq};
use foldwell::analysis::bloch::bands::{DynamicalMatrix, Stiffnesses, along_path};
use foldwell::analysis::bloch::decay::WELL_CONDITIONED;
use foldwell::analysis::bloch::strip::fit;
use foldwell::analysis::bloch::zero_lines::ZeroLine;
use foldwell::analysis::bloch::{
    BlochError, Decay, Determinant, Laurent, ModeShape, Polarization, Rigidity, Strip, ZeroLines, ZeroModeCounts, Zone,
};
use foldwell::kinematics::{Embedding, Shape};
use foldwell::math::Vec3;
use foldwell::numerics::DenseMatrix;
use foldwell::numerics::complex::{ComplexMatrix, eigenvalues};
use foldwell::numerics::dense::{Svd, full_svd};
use foldwell::sheet::build::{Drawing, build, draw};
use foldwell::sheet::generate::Random;
use foldwell::sheet::{Corner, EdgeKey, Pattern, Sheet, generate};
use nalgebra::Complex;
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::{PI, TAU};

fn random(size: [usize; 2], seed: u64) -> Sheet {
    generate(&Pattern::Random(Random { size, seed, ..Random::default() })).unwrap()
}

/// Returns 200 random cells of 2 x 2 to 4 x 4 vertices.
fn random_cells() -> impl Iterator<Item = Sheet> {
    let sizes = (2..=4).flat_map(|a| (2..=4).map(move |b| [a, b]));
    (0..200).zip(sizes.cycle()).map(|(seed, size)| random(size, 1000 + seed))
}

fn determinant(sheet: &Sheet) -> Determinant {
    Determinant::new(&Rigidity::of_sheet(sheet, false).unwrap()).unwrap()
}

/// Claim: the coefficients of the reference cell, and its decay rates at q1 = 0.9, are those of an independent program
/// (exact up to the sign). Tolerance: 1e-14 for coefficients of 0.05; 1e-13 for decay rates of condition below 100.
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
            expected.iter().any(|e| e[0] == *m && e[1] == *n && abs_diff_eq!(sign * e[2], c, epsilon = 1e-14))
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

/// Claim: on 200 random cells the centred determinant is symmetric and real to 1e-12, powers are integers, decay rates
/// pair to 1e-9 if they are well conditioned, and as many roots are inside as outside the unit circle: no polarization.
/// At most one in a hundred of the roots corrected on the matrix is ill-conditioned.
#[test]
fn random_cells_are_symmetric_and_not_polarized() {
    let (mut symmetry, mut imaginary, mut error, mut pairing) = (0.0f64, 0.0f64, 0.0f64, 0.0f64);
    let (mut left_out, mut first_left_out, mut pairs) = (0, 0, 0);
    for sheet in random_cells() {
        let rigidity = Rigidity::of_sheet(&sheet, false).unwrap();
        let found = Determinant::new(&rigidity).unwrap();
        assert!(
            found.symmetric && found.polynomial.lowest.iter().all(|low| low.fract() == 0.0),
            "{}",
            sheet.description
        );
        symmetry = symmetry.max(found.symmetry_error);
        imaginary = imaginary.max(found.imaginary_part);
        error = error.max(found.error);
        for q1 in [-2.5, -1.0, 0.4, 0.9, 1.7, 2.9] {
            let first = Decay::new(&found, 0, q1).unwrap();
            first_left_out += first.pairing().left_out;
            let pairs_here = first.clone().refined(&found, &rigidity);
            let here = pairs_here.pairing();
            let error = here.error.unwrap_or_default(); // all of a wavenumber's roots may be left out, and are counted
            assert!(error <= 1e-9, "{}: {here:?}", sheet.description);
            pairing = pairing.max(error);
            left_out += here.left_out;
            pairs += pairs_here.roots.len();
        }
        let Polarization { polarization, .. } = Polarization::new(&found, 16).unwrap();
        assert_eq!(polarization, [0.0, 0.0], "{}", sheet.description);
    }
    println!(
        "symmetry {symmetry:e}, imaginary {imaginary:e}, error {error:e}, pairing {pairing:e}, {left_out} of {pairs} left \
         out, {first_left_out} by the polynomial"
    );
    assert!(symmetry <= 1e-12 && imaginary <= 1e-12 && error <= 1e-12);
    assert!(100 * left_out <= pairs, "{left_out} roots of {pairs} are ill-conditioned");
}

/// Claim: at a flat state the determinant vanishes identically (theory, section 8), since each of the four vertices
/// moves freely across the sheet; this is reported as an error.
#[test]
fn flat_sheets_have_no_determinant() {
    let refused = Determinant::new(&Rigidity::of_sheet(&mesh("open-flat"), false).unwrap());
    let message = refused.unwrap_err().to_string();
    assert!(message.contains("vanishes at all wavenumbers") && message.ends_with("4 or more"), "{message}");
}

/// Returns the distance of real wavenumbers from a singular `R` along the gradient: the smallest singular value divided
/// by its gradient, `u^H dR v`. The rounding error of singular values, 1e-15 of the largest, is subtracted.
fn distance_from_singular(rigidity: &Rigidity, q: [f64; 2]) -> f64 {
    let z = q.map(|q| Complex::from_polar(1.0, q));
    let Svd { u, singular_values, v } = full_svd(&rigidity.at(z)).unwrap();
    let last = singular_values.len() - 1;
    let slope = |a: usize| (u.column(last).adjoint() * rigidity.derivative(z, a) * v.column(last))[(0, 0)] * z[a];
    (singular_values[last] - 1e-15 * singular_values[0]).max(0.0) / slope(0).norm().hypot(slope(1).norm())
}

/// Returns the largest distance of a point of a line from its first point.
fn extent(line: &ZeroLine) -> f64 {
    let from = |q: &[f64; 2]| (q[0] - line.points[0][0]).hypot(q[1] - line.points[0][1]);
    line.points.iter().map(from).fold(0.0, f64::max)
}

/// Returns the angle in radians between the line at `q = 0` and the nearest of some directions; 0 if the line does not
/// pass there.
fn off_directions(line: &ZeroLine, directions: &[f64]) -> f64 {
    let last = line.points.len() - 1;
    // the line leaves q = 0 towards the second point, and returns to it from the last but one
    let ends = [line.points[1], [0, 1].map(|a| line.points[last - 1][a] - line.points[last][a])];
    let off = |q: &[f64; 2]| {
        let from = |angle: &f64| (q[1].atan2(q[0]) - angle).sin().abs();
        directions.iter().map(from).fold(f64::INFINITY, f64::min)
    };
    if line.passes > 0 { ends.iter().map(off).fold(0.0, f64::max) } else { 0.0 }
}

/// Claim: the leading quartic from the strains of the three linear modes is that of the determinant's expansion up to
/// one factor (1e-8 of its largest coefficient; rounding errors of moments of some 100 coefficients), reciprocity of
/// any two modes holds to 1e-12, the determinant vanishes to fourth order, and the traced lines leave `q = 0` in the
/// directions of the real roots, of which there are 0, 2 or 4: on 200 random cells. All lines agree with the signs on a
/// grid (`ZeroLines` refuses others), and their points are zeros to 1e-12, by their own estimate and by the singular
/// values of the matrix.
#[test]
fn zero_lines_of_random_cells() {
    let (mut apart, mut reciprocity, mut counts) = (0.0f64, 0.0f64, [0; 5]);
    let (mut residuals, mut by_matrix, mut checked, mut small) = (Vec::new(), 0.0f64, 0, 0);
    let mut topologies = BTreeMap::new();
    let (mut angles, mut slowest) = (0.0f64, 0.0f64);
    for sheet in random_cells() {
        let rigidity = Rigidity::of_sheet(&sheet, false).unwrap();
        let zone = Zone::new(&Determinant::new(&rigidity).unwrap()).unwrap();
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
        let lines = lines.refined(&zone, &rigidity);
        slowest = slowest.max(clock.elapsed().as_secs_f64());
        let away = |q: &&[f64; 2]| q.iter().any(|q| ((q + PI).rem_euclid(TAU) - PI).abs() > 0.1);
        for q in lines.lines.iter().flat_map(|line| &line.points).filter(away).step_by(29) {
            by_matrix = by_matrix.max(distance_from_singular(&rigidity, *q));
            checked += 1;
        }
        let directions = zone.directions().unwrap();
        counts[directions.len()] += 1;
        assert_eq!(
            lines.lines.iter().map(|line| line.passes).sum::<usize>(),
            directions.len(),
            "{}",
            sheet.description
        );
        residuals.push(lines.lines.iter().map(|line| line.residual).fold(0.0, f64::max));
        small += lines.lines.iter().filter(|line| extent(line) < TAU / 192.0).count();
        for line in &lines.lines {
            *topologies.entry((line.passes, line.winding.map(i32::abs))).or_insert(0) += 1;
            angles = angles.max(off_directions(line, &directions));
        }
        let sum: f64 = lines.regions.iter().map(|region| region.fraction).sum();
        assert_abs_diff_eq!(sum, 1.0, epsilon = 1e-12);
    }
    residuals.sort_by(f64::total_cmp);
    let exact = residuals.iter().filter(|residual| **residual <= 1e-12).count();
    println!("quartic {apart:e}, reciprocity {reciprocity:e}, lines at q = 0: {counts:?}, angles {angles:e}");
    println!(
        "points to 1e-12 in {exact} cells of {}, median {:e}, worst {:e}",
        residuals.len(),
        residuals[100],
        residuals[199]
    );
    println!("passes and windings {topologies:?}, {small} lines smaller than the mesh, slowest {slowest}");
    println!("smallest singular value over its gradient at {checked} points: {by_matrix:e}");
    assert!(reciprocity <= 1e-12 && counts[1] == 0 && counts[3] == 0);
    assert!(residuals[199] <= 1e-12 && by_matrix <= 1e-12 && checked > 5000);
    assert!(counts[0] > 0 && counts[2] > 0, "{counts:?}");
    // the points of the lines are at 1e-4 from q = 0 there
    assert!(angles <= 1e-2, "{angles:e}");
}

/// Returns the determinant `(cos q1 - cos s1)^2 + (cos q2 - cos s2)^2 - depth`, which does not belong to a sheet: zero
/// on four closed lines around `(+-s1, +-s2)`, ellipses of the semiaxes `sqrt(depth) / sin s` up to terms of their
/// cube; without zeros for negative depth.
fn four_loops(s: [f64; 2], depth: f64) -> Determinant {
    let mut coefficients = DenseMatrix::zeros(5, 5);
    for (a, cosine) in s.map(f64::cos).into_iter().enumerate() {
        for (power, c) in [(0, 0.25), (1, -cosine), (2, 0.5 + cosine * cosine), (3, -cosine), (4, 0.25)] {
            coefficients[if a == 0 { (power, 2) } else { (2, power) }] += c;
        }
    }
    coefficients[(2, 2)] -= depth;
    let polynomial = Laurent { coefficients, lowest: [-2.0, -2.0] };
    let none = f64::EPSILON;
    Determinant { polynomial, symmetric: true, symmetry_error: 0.0, imaginary_part: 0.0, error: none, magnitude: 8.0 }
}

/// Claim: closed lines a thousandth as large as the mesh of the grid, where no sign on the grid differs, are found, all
/// four and no others, at the zeros of the polynomial; a determinant that nearly touches zero has none. Tolerance: 1e-4
/// of the semiaxes for the terms of their cube, and for lengths of polygons of turns of 0.15.
#[test]
fn lines_smaller_than_the_mesh() {
    let mesh = TAU / 192.0;
    for s in [[1.234f64, 2.1], [0.7, 0.31], [2.9, 1.6]] {
        for radius in [1e-3 * mesh, 0.3 * mesh] {
            let axes = s.map(|angle| radius * s[0].sin() / angle.sin());
            let depth = (radius * s[0].sin()).powi(2);
            let lines = ZeroLines::new(&Zone::new(&four_loops(s, depth)).unwrap()).unwrap();
            assert_eq!(lines.lines.len(), 4, "{s:?} {radius:e}");
            for line in &lines.lines {
                assert_eq!((line.winding, line.passes), ([0, 0], 0));
                for q in &line.points {
                    let part = |a: usize| (((q[a] + PI).rem_euclid(TAU) - PI).abs() - s[a]) / axes[a];
                    let off = (part(0).hypot(part(1)) - 1.0).abs();
                    assert!(off <= 2.0 * radius / s[0].sin().min(s[1].sin()) + 1e-6, "{off:e}");
                }
            }
        }
        for depth in [-1e-9, -1e-13] {
            let none = ZeroLines::new(&Zone::new(&four_loops(s, depth)).unwrap()).unwrap();
            assert!(none.lines.is_empty() && none.regions.len() == 1);
        }
    }
}

/// Claim: at every wavenumber there are as many zero modes as self stresses at the opposite one, and by the fold rates
/// as many at the same one (duality): the fold rates of a null vector of `R(z)` are a self stress at `z`, whose
/// displacement is that null vector again; a left null vector is a self stress at `1/z`, and has a displacement there
/// that stretches no bar. Tested on roots of random cells and at a complex pair. Tolerance: 1e-9 for null vectors of
/// roots known to 1e-10.
#[test]
fn duality_at_finite_wavenumber() {
    let mut worst = [0.0f64; 4];
    for sheet in random_cells().take(60) {
        let rigidity = Rigidity::of_sheet(&sheet, false).unwrap();
        let decay = Decay::new(&determinant(&sheet), 0, 0.9).unwrap();
        for root in decay.roots.iter().filter(|root| root.condition <= 1e4 && root.kappa().abs() < 2.0) {
            let z = [Complex::from_polar(1.0, 0.9), root.z];
            let inverse = z.map(|z| z.inv());
            let Svd { u, singular_values, v } = full_svd(&rigidity.at(z)).unwrap();
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

/// Returns the matrix of forces on the vertices due to tensions in some bars, which are multiplied by `z1` and `z2`
/// from a cell to the next; assembled vertex by vertex from the edges. Rows are coordinates, columns are bars.
fn equilibrium(sheet: &Sheet, bars: &[usize], z: [Complex<f64>; 2]) -> ComplexMatrix {
    let mut matrix = ComplexMatrix::zeros(3 * sheet.vertices.len(), bars.len());
    for (column, &bar) in bars.iter().enumerate() {
        let key = sheet.edges[bar].key;
        let [i, j] = key.ends();
        let pull = (sheet.position(j) - sheet.position(i)).normalize();
        // vertex j of cell (0, 0) is the end of the copy of the bar that starts in cell -shift
        let there = z[0].powi(-key.shift[0]) * z[1].powi(-key.shift[1]);
        for axis in 0..3 {
            matrix[(3 * key.i + axis, column)] += Complex::from(pull[axis]);
            matrix[(3 * key.j + axis, column)] -= there * pull[axis];
        }
    }
    matrix
}

/// Returns the number of singular values above 1e-9 of the largest one, after adding zeros to make the matrix square.
fn rank(matrix: &ComplexMatrix) -> usize {
    let n = matrix.nrows().max(matrix.ncols());
    let square = matrix.clone().resize(n, n, Complex::ZERO);
    let values = full_svd(&square).unwrap().singular_values;
    values.iter().filter(|value| **value > 1e-9 * values[0]).count()
}

/// Claim (index theorem): at every pair of factors the number of zero modes minus self stresses is the number of
/// coordinates minus bars: for triangulated cells, where both numbers are also those at `1/z` (duality); for cells
/// without one bar; for one with an opening. At random real and complex wavenumbers, on zero lines, at complex roots
/// and at `q = 0`; modes from the rigidity matrix at `z`, self stresses at `1/z` from independently assembled forces.
/// The numbers are printed: they are generic off the lines, and larger on them.
#[test]
fn index_theorem() {
    let mut numbers = Numbers::new(5);
    let mut found: BTreeMap<(&str, &str, isize), BTreeMap<[usize; 2], usize>> = BTreeMap::new();
    let mut kirigami_sheets = vec![mesh("kirigami")];
    kirigami_sheets.extend((0..8).filter_map(|seed| random_kirigami([3, 3], 2, seed)));
    let triangulated = random_cells().step_by(5).map(|sheet| ("triangulated", sheet));
    for (kind, sheet) in triangulated.chain(kirigami_sheets.into_iter().map(|sheet| ("opening", sheet))) {
        let full = Rigidity::of_sheet(&sheet, false).unwrap();
        for (kind, missing) in [(kind, None), ("bar less", Some(numbers.many(1, 0.49)[0] + 0.5))] {
            let out = missing.map(|part| (part * sheet.edges.len() as f64) as usize);
            let bars: Vec<usize> = (0..sheet.edges.len()).filter(|&bar| Some(bar) != out).collect();
            let rows = bars.iter().map(|&bar| full.rows[bar].clone()).collect();
            let rigidity = Rigidity { vertices: full.vertices, rows };
            let count = rigidity.columns() as isize - bars.len() as isize;
            for (place, z) in places(&sheet, &mut numbers) {
                let zero_modes = rigidity.columns() - rank(&rigidity.at(z));
                let stresses = |z| bars.len() - rank(&equilibrium(&sheet, &bars, z));
                let opposite = stresses(z.map(|z| z.inv()));
                assert_eq!(zero_modes as isize - opposite as isize, count, "{kind} {place} {z:?}");
                if kind == "triangulated" {
                    assert_eq!(stresses(z), zero_modes, "{place} {z:?}");
                }
                *found.entry((kind, place, count)).or_default().entry([zero_modes, opposite]).or_insert(0) += 1;
            }
        }
    }
    for (case, numbers) in &found {
        println!("{case:?}: [zero modes, self stresses] and how often: {numbers:?}");
    }
    assert_eq!(found[&("triangulated", "random real", 0)].keys().next(), Some(&[0, 0]));
    assert_eq!(found[&("triangulated", "zero line", 0)].keys().next(), Some(&[1, 1]));
}

/// Returns factors of all kinds: random ones and, for a triangulated cell, those on its zero lines and at its roots.
fn places(sheet: &Sheet, numbers: &mut Numbers) -> Vec<(&'static str, [Complex<f64>; 2])> {
    let on_zone = |q: [f64; 2]| q.map(|q| Complex::from_polar(1.0, q));
    let mut places = vec![("q = 0", [Complex::ONE; 2])];
    for _ in 0..5 {
        let [q1, q2, k1, k2] = [PI, PI, 1.0, 1.0].map(|size| numbers.within(size));
        places.push(("random real", on_zone([q1, q2])));
        places.push(("random complex", [Complex::from_polar(k1.exp(), q1), Complex::from_polar(k2.exp(), q2)]));
    }
    let rigidity = Rigidity::of_sheet(sheet, false).unwrap();
    let Ok(found) = Determinant::new(&rigidity) else { return places };
    let Ok(zone) = Zone::new(&found) else { return places };
    let lines = ZeroLines::new(&zone).unwrap().refined(&zone, &rigidity);
    let points = lines.lines.iter().flat_map(|line| &line.points);
    let off_origin = points.filter(|q| q.iter().any(|q| ((q + PI).rem_euclid(TAU) - PI).abs() > 0.3));
    places.extend(off_origin.step_by(97).map(|q| ("zero line", on_zone(*q))));
    let decay = Decay::new(&found, 0, 0.9).unwrap().refined(&found, &rigidity);
    let roots =
        decay.roots.iter().filter(|root| !root.on_circle() && root.condition <= 1e3 && root.kappa().abs() < 2.0);
    places.extend(roots.map(|root| ("complex root", [Complex::from_polar(1.0, 0.9), root.z])));
    places
}

/// Returns the roots `z2` at `q1` from the matrix itself, without a determinant: every row is scaled by a power of `z2`
/// to `A + z2 B`, whose roots are `mu - 1/w` with the eigenvalues `w` of `(A + mu B)^-1 B`.
fn pencil_roots(rigidity: &Rigidity, q1: f64) -> Vec<Complex<f64>> {
    let z1 = Complex::from_polar(1.0, q1);
    let low = |row: usize| rigidity.rows[row].terms.iter().map(|(corner, _)| corner.shift[1]).min().unwrap();
    let scaled = |z: f64| {
        let mut matrix = rigidity.at([z1, Complex::new(z, 0.0)]);
        matrix.row_iter_mut().enumerate().for_each(|(k, mut row)| row *= Complex::new(z.powi(-low(k)), 0.0));
        matrix
    };
    let [mut plus, mut minus] = [scaled(1.0), scaled(-1.0)];
    for column in 0..plus.ncols() {
        let size = (plus.column(column).norm() + minus.column(column).norm()).recip();
        plus.column_mut(column).scale_mut(size);
        minus.column_mut(column).scale_mut(size);
    }
    let half = Complex::new(0.5, 0.0);
    let (a, b) = ((&plus + &minus) * half, (&plus - &minus) * half);
    let mu = Complex::new(0.37, 1.21);
    let solved = (a + &b * mu).lu().solve(&b).unwrap();
    let found = eigenvalues(&solved).unwrap().into_iter().filter(|w| w.norm() > 1e-9).map(|w| mu - w.inv());
    found.map(|z| singular(rigidity, z1, z)).collect()
}

/// Finds a singular `R(z1, z2)` near a root by Newton's method: `z2 - 1 / trace(R^-1 dR/dz2)`.
fn singular(rigidity: &Rigidity, z1: Complex<f64>, mut z: Complex<f64>) -> Complex<f64> {
    for _ in 0..6 {
        let (matrix, slope) = (rigidity.at([z1, z]), rigidity.derivative([z1, z], 1));
        match matrix.lu().solve(&slope) {
            Some(ratio) if ratio.trace().norm() * z.norm() > 2.0 => z -= ratio.trace().inv(),
            _ => return z,
        }
    }
    z
}

/// Claim: decay rates agree with those of a matrix pencil, which uses no determinant, to 1e-9 if the roots are well
/// conditioned.
#[test]
fn decay_rates_agree_with_the_matrix_pencil() {
    let (mut worst, mut compared) = (0.0f64, 0);
    for sheet in random_cells() {
        let rigidity = Rigidity::of_sheet(&sheet, false).unwrap();
        let found = determinant(&sheet);
        for q1 in [0.4, 0.9, -2.2] {
            let direct = pencil_roots(&rigidity, q1);
            let decay = Decay::new(&found, 0, q1).unwrap().refined(&found, &rigidity);
            for root in decay.roots.iter().filter(|root| root.condition <= WELL_CONDITIONED) {
                let apart = direct.iter().map(|z| (z / root.z - 1.0).norm()).fold(f64::INFINITY, f64::min);
                worst = worst.max(apart);
                compared += 1;
            }
        }
    }
    println!("pencil: {worst:e} over {compared} roots");
    assert!(worst <= 1e-9 && compared > 2000, "{worst:e}, {compared}");
}

/// Claim: cells with an edge a millionth as long as the others, or stretched a million times along one lattice vector,
/// give roots that the matrix pencil confirms to 1e-6 if they are reported as well conditioned, or an error.
#[test]
fn ill_conditioned_cells() {
    let short = |seed: u64| {
        let mut sheet = random([2, 2], seed);
        sheet.vertices[1] = sheet.vertices[0] + (sheet.vertices[1] - sheet.vertices[0]) * 1e-6;
        sheet
    };
    let long = |seed: u64| {
        let mut sheet = random([3, 2], seed);
        sheet.vertices.iter_mut().chain(sheet.lattice.iter_mut().flatten()).for_each(|x| x.x *= 1e6);
        sheet
    };
    let (mut answers, mut refusals, mut worst) = (0, 0, 0.0f64);
    for sheet in (0..20).flat_map(|seed| [short(seed), long(seed)]) {
        let rigidity = Rigidity::of_sheet(&sheet, false).unwrap();
        match Determinant::new(&rigidity) {
            Err(error) => {
                assert!(error.to_string().contains("ill-conditioned"), "{error}");
                refusals += 1;
            }
            Ok(found) => {
                let direct = pencil_roots(&rigidity, 0.9);
                let limit = 1e-9 / found.error.max(1e-16);
                let decay = Decay::new(&found, 0, 0.9).unwrap().refined(&found, &rigidity);
                for root in decay.roots.iter().filter(|root| root.condition <= limit) {
                    let apart = direct.iter().map(|z| (z / root.z - 1.0).norm()).fold(f64::INFINITY, f64::min);
                    worst = worst.max(apart);
                    answers += 1;
                }
            }
        }
    }
    println!("ill-conditioned: {answers} roots to {worst:e}, {refusals} refusals");
    assert!(worst <= 1e-6 && answers + refusals > 0);
}

/// Claim: the determinant of a cell of four triangles round an apex, whose rim has a bar from a vertex to its own copy along
/// each lattice vector, is `c(z1) (z2 - 1)^2`: at every wavenumber both roots are 1, though the row of that bar vanishes there.
/// Source: its coefficients in 60 digits, for 60 random cells. Tolerance: 1e-9, within which a root is on the circle.
#[test]
fn bars_between_copies_of_one_vertex() {
    for seed in 0..20 {
        let mut numbers = Numbers::new(seed);
        let mut near = |x: f64, y: f64, z: f64| Vec3::new(x, y, z) + Vec3::from_fn(|_, _| numbers.within(0.2));
        let (l1, l2) = (near(2.0, 0.0, 0.0), near(0.0, 1.7, 0.0));
        let apex = 0.5 * (l1 + l2) + near(0.0, 0.0, 0.5);
        let coords = vec![Vec3::zeros(), l1, l1 + l2, l2, apex];
        let faces = vec![vec![0, 1, 4], vec![1, 2, 4], vec![2, 3, 4], vec![3, 0, 4]];
        let sheet = build(&Drawing { coords, faces, lattice: Some([l1, l2]), ..Drawing::default() }).unwrap();
        let rigidity = Rigidity::of_sheet(&sheet, false).unwrap();
        let determinant = Determinant::new(&rigidity).unwrap();
        for q in (1..32).map(|k| 0.1 * f64::from(k)) {
            let decay = Decay::new(&determinant, 0, q).unwrap().refined(&determinant, &rigidity);
            let are_one = decay.roots.iter().all(|root| root.multiplicity == 2 && root.z.ln().norm() <= 1e-9);
            assert!(decay.roots.len() == 2 && are_one, "{seed}, {q}: {:?}", decay.roots);
        }
    }
}

/// Returns the determinant of a mesh with rigid polygons.
fn kirigami(sheet: &Sheet) -> Determinant {
    Determinant::new(&Rigidity::of_sheet(sheet, true).unwrap()).unwrap()
}

/// Claim: on a kirigami cell with one rigid quadrilateral and one hole the symmetries of origami are broken: the
/// determinant is not symmetric, decay rates do not pair, and the polarization is (1/2, 1/2), as found by an
/// independent program (NumPy) from the same coordinates with both diagonals of the skew quadrilateral as bars.
#[test]
fn kirigami_is_polarized() {
    let found = kirigami(&mesh("kirigami"));
    let pairing = Decay::new(&found, 0, 0.9).unwrap().pairing();
    let Polarization { polarization, on_circle } = Polarization::new(&found, 32).unwrap();
    println!(
        "kirigami: asymmetry {}, {pairing:?}, {polarization:?}, {on_circle:?}, error {:e}",
        found.symmetry_error, found.error
    );
    assert!(!found.symmetric && found.symmetry_error > 0.1 && found.error <= 1e-12);
    assert!(pairing.error.unwrap() > 0.1, "{pairing:?}");
    assert_eq!((polarization, on_circle), ([0.5, 0.5], [0.0, 0.0]));
    assert!(matches!(Zone::new(&found), Err(BlochError::NotSymmetric { .. })));
}

/// Returns a random cell in which pairs of triangles are merged to `pairs` rigid quadrilaterals and as many openings;
/// `None` if there are not enough pairs apart from each other, or if the mesh is refused.
fn random_kirigami(size: [usize; 2], pairs: usize, seed: u64) -> Option<Sheet> {
    let mut numbers = Numbers::new(seed);
    let drawn = draw(&random(size, seed));
    let mut faces = drawn.faces.clone();
    let mut quadrilaterals = Vec::new();
    while quadrilaterals.len() < 2 * pairs {
        let mut joined = Vec::new();
        for (i, face) in faces.iter().enumerate() {
            for k in 0..3 {
                let [p, q, r] = [0, 1, 2].map(|step| face[(k + step) % 3]);
                let other = faces.iter().position(|other| (0..3).any(|k| other[k] == q && other[(k + 1) % 3] == p));
                if let Some(j) = other.filter(|&j| j > i) {
                    let far = faces[j].iter().copied().find(|&v| v != p && v != q)?;
                    joined.push(([i, j], vec![p, far, q, r]));
                }
            }
        }
        let at = (joined.len() as f64 * (0.5 + numbers.within(0.5))) as usize;
        let ([i, j], quadrilateral) = joined.into_iter().nth(at)?;
        faces.remove(j);
        faces.remove(i);
        quadrilaterals.push(quadrilateral);
    }
    let holes = quadrilaterals.split_off(pairs);
    build(&Drawing { faces: [faces, quadrilaterals].concat(), holes, ..drawn }).ok()
}

/// Returns the sheet with its rigid polygons and its openings exchanged.
fn exchanged(sheet: &Sheet) -> Sheet {
    let drawn = draw(sheet);
    let (blocks, triangles): (Vec<_>, Vec<_>) = drawn.faces.iter().cloned().partition(|face| face.len() > 3);
    build(&Drawing { faces: [triangles, drawn.holes.clone()].concat(), holes: blocks, ..drawn }).unwrap()
}

/// Returns the winding numbers of the centred determinant around zero along both directions, at some value of the other
/// wavenumber; `None` if it is nearly zero on the way, or turns too far between neighbouring points.
fn winding(found: &Determinant) -> Option<[f64; 2]> {
    let steps = 2000;
    let along = |a: usize, other: f64| {
        let value = |k: usize| {
            let mut q = [other; 2];
            q[a] = TAU * k as f64 / steps as f64;
            found.polynomial.at(q)
        };
        let turn = |k: usize| (value(k + 1) / value(k)).arg();
        let turns: Vec<f64> = (0..steps).map(turn).collect();
        let clear = turns.iter().all(|turn| turn.abs() < 1.0);
        clear.then(|| (turns.iter().sum::<f64>() / TAU * 2.0).round() / 2.0)
    };
    Some([along(0, 0.37)?, along(1, 0.37)?])
}

/// Claim: random kirigami cells have polarizations of many values, printed with the number of cells that have them. If
/// no root is on the circle they are multiples of 1/2, and equal the winding numbers of the determinant around the
/// zone; with faces and openings exchanged they change sign, as for dual sheets.
#[test]
fn polarizations_of_random_kirigami() {
    let mut tables = BTreeMap::new();
    let (mut gapped, mut cells) = (0, 0);
    for (size, pairs) in [([2, 2], 1), ([3, 2], 1), ([3, 2], 2), ([3, 3], 1), ([3, 3], 2)] {
        for seed in 0..60 {
            let Some(sheet) = random_kirigami(size, pairs, seed) else { continue };
            let Ok(found) = Determinant::new(&Rigidity::of_sheet(&sheet, true).unwrap()) else { continue };
            cells += 1;
            let Polarization { polarization, on_circle } = Polarization::new(&found, 24).unwrap();
            let halves = polarization.map(|p| (2.0 * p).round() as i32);
            let constant = (0..2).all(|a| abs_diff_eq!(2.0 * polarization[a], f64::from(halves[a]), epsilon = 1e-12));
            if on_circle != [0.0, 0.0] || !constant {
                continue; // roots cross the circle
            }
            gapped += 1;
            assert_eq!(winding(&found).unwrap_or(polarization), polarization, "{size:?} {pairs} {seed}");
            if seed % 5 == 0 {
                let other = Polarization::new(&kirigami(&exchanged(&sheet)), 8).unwrap();
                assert_eq!(other.polarization, polarization.map(|p| 0.0 - p), "{size:?} {pairs} {seed}");
            }
            tables.entry((size, pairs)).or_insert_with(BTreeMap::new).entry(halves).or_insert((0, seed)).0 += 1;
        }
    }
    println!("{gapped} of {cells} cells have no root on the circle");
    for (cells, values) in &tables {
        println!("{cells:?}: twice the polarization, (cells, first seed): {values:?}");
    }
    let values: BTreeSet<[i32; 2]> = tables.values().flat_map(|values| values.keys().copied()).collect();
    assert!(values.len() >= 15 && [[-2, 3], [0, 3], [2, 1], [-1, 0]].iter().all(|value| values.contains(value)));
}

/// Claim: the mesh of a strong polarization is the cell of this scan, and has this polarization.
#[test]
fn mesh_of_another_polarization() {
    let (sheet, cell) = (mesh("kirigami-polarized"), random_kirigami([3, 2], 1, 0).unwrap());
    let same = sheet.vertices.iter().zip(&cell.vertices).all(|(a, b)| (a - b).norm() <= 1e-12);
    assert!(same && sheet.vertices.len() == cell.vertices.len() && sheet.polygons.len() == cell.polygons.len());
    let found = kirigami(&sheet);
    let Polarization { polarization, on_circle } = Polarization::new(&found, 64).unwrap();
    assert_eq!((polarization, on_circle, winding(&found)), ([-1.0, 1.5], [0.0, 0.0], Some([-1.0, 1.5])));
}

/// Claim (Finbow-Singh and Whiteley's swap): with faces and holes exchanged, folding motions become self stresses: the
/// determinant of the exchanged sheet at `1/z` is that of the sheet at `z` up to a monomial and a factor. Tolerance:
/// 1e-10 of the largest coefficient.
#[test]
fn faces_and_holes_swap() {
    let sheet = mesh("kirigami");
    let [one, other] = [kirigami(&sheet), kirigami(&exchanged(&sheet))].map(|found| found.polynomial.coefficients);
    assert_eq!(one.shape(), other.shape());
    let (rows, columns) = one.shape();
    let turned = DenseMatrix::from_fn(rows, columns, |i, j| other[(rows - 1 - i, columns - 1 - j)]);
    let factor = one.dot(&turned) / turned.dot(&turned);
    let apart = (&one - turned * factor).amax() / one.amax();
    println!("swap: {apart:e}");
    assert!(apart <= 1e-10, "{apart:e}");
}

/// Claim (theory, section 8): on a cylinder the determinant of screw-periodic modes is symmetric, vanishes to second
/// order at `q = 0` and at `+-(theta1, theta2)`, the rigid rotations about directions perpendicular to the axis, where
/// a zero line passes; the roots pair as on a flat lattice. Tolerances: 1e-12 for symmetry; states close to 1e-12, and
/// the zero is simple.
#[test]
fn cylinders() {
    let sheet = mesh("open-star");
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/cases/open-star.json");
    let case: Value = serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap();
    let embedding = Embedding::new(&sheet).unwrap();
    let keys: Vec<Vec<i64>> = serde_json::from_value(case["edge_list"].clone()).unwrap();
    let states = case["states"].as_array().unwrap();
    assert_eq!(states.len(), 4);
    for state in states {
        let stored: Vec<f64> = serde_json::from_value(state["fold_angles"].clone()).unwrap();
        let angle = |edge: &foldwell::sheet::Edge| {
            let name = |key: &Vec<i64>| {
                let corner =
                    |vertex: i64, shift: [i64; 2]| Corner { vertex: vertex as usize, shift: shift.map(|n| n as i32) };
                EdgeKey::new(corner(key[0], [0, 0]), corner(key[1], [key[2], key[3]])).0
            };
            stored[keys.iter().position(|key| name(key) == edge.key).unwrap()]
        };
        let angles: Vec<f64> = sheet.edges.iter().map(angle).collect();
        let shape = Shape::at(&embedding, &angles).unwrap();
        let found = Determinant::new(&Rigidity::of_cylinder(&sheet, &shape)).unwrap();
        let zone = Zone::new(&found).unwrap();
        let (value, gradient) = zone.at(shape.theta);
        let distance = value.abs() / gradient[0].hypot(gradient[1]);
        println!("cylinder: symmetry {:e}, order {}, {distance:e} from a zero line", found.symmetry_error, zone.order);
        assert!(found.symmetric && found.symmetry_error <= 1e-12 && found.imaginary_part <= 1e-12);
        assert_eq!(zone.order, 2);
        assert!(distance <= 1e-9, "{distance:e}");
        let lines = ZeroLines::new(&zone).unwrap();
        assert_eq!(lines.lines.iter().map(|line| line.passes).sum::<usize>(), zone.directions().unwrap().len());
        let pairing = Decay::new(&found, 0, 0.9).unwrap().pairing();
        assert!(pairing.error.unwrap() <= 1e-9, "{pairing:?}");
    }
}

/// Claim: the zero modes of a strip of 40 cells with free edges, periodic along the first lattice vector with
/// wavenumber 0.9, grow and decay across it as predicted by the roots: factors from a cell to the next, fitted to the
/// modes of the strip only, agree to 1e-3 (rounding errors of a null space: 1e-6 and better). The strip has as many
/// zero modes as bars that its edges cut.
#[test]
fn strips_decay_as_predicted() {
    for (sheet, q1) in [(mesh("open-star"), 0.9), (random([2, 2], 3), 0.7), (random([2, 3], 5), 1.4)] {
        let rigidity = Rigidity::of_sheet(&sheet, false).unwrap();
        let (cells, width) = (40i32, rigidity.columns());
        let z1 = Complex::from_polar(1.0, q1);
        let size = width * cells as usize;
        let mut matrix = ComplexMatrix::zeros(size, size);
        let mut rows = 0;
        for cell in 0..cells {
            for row in &rigidity.rows {
                if row.terms.iter().all(|(corner, _)| (0..cells).contains(&(cell + corner.shift[1]))) {
                    for (corner, direction) in &row.terms {
                        let column = (cell + corner.shift[1]) as usize * width + 3 * corner.vertex;
                        for axis in 0..3 {
                            matrix[(rows, column + axis)] += z1.powi(corner.shift[0]) * direction[axis];
                        }
                    }
                    rows += 1;
                }
            }
        }
        let Svd { singular_values, v, .. } = full_svd(&matrix).unwrap();
        let zero_modes = singular_values.iter().filter(|value| **value < 1e-11 * singular_values[0]).count();
        assert_eq!(zero_modes, size - rows);
        let null = v.columns(size - zero_modes, zero_modes).into_owned();
        for root in Decay::new(&determinant(&sheet), 0, q1).unwrap().roots.iter().filter(|root| root.condition < 1e4) {
            if root.kappa().abs() > 1.0 {
                continue;
            }
            // the motion of the strip nearest to the predicted one, then its own factor from cell to cell
            let mode = ModeShape::new(&rigidity, [z1, root.z]).unwrap();
            let far = if root.kappa() > 0.0 { root.z.powi(1 - cells) } else { Complex::ONE };
            let predicted =
                (0..cells).flat_map(|cell| mode.displacement.iter().map(move |u| u * root.z.powi(cell) * far));
            let predicted = ComplexMatrix::from_vec(size, 1, predicted.collect());
            let nearest = &null * (null.adjoint() * &predicted);
            let part = |first: usize| nearest.rows(first * width, 20 * width).into_owned();
            let start = if root.kappa() > 0.0 { 15 } else { 4 };
            let (here, next) = (part(start), part(start + 1));
            let factor = here.dotc(&next) / here.norm_squared();
            let off = (factor / root.z - 1.0).norm().max((nearest - &predicted).norm() / predicted.norm());
            println!("strip: kappa {:.6}, measured {:.6}, off {off:e}", root.kappa(), factor.norm().ln());
            assert!(off <= 1e-3, "{off:e}");
        }
    }
}

/// Claim: the dynamical matrix agrees with the energies: at real wavenumbers its quadratic form is twice the energy per
/// cell of the wave, checked as `R^H k R` for bars only; its three lowest bands vanish at `q = 0`, and on a zero line
/// of the bars another one vanishes without creases but not with them.
#[test]
fn bands_of_the_energy() {
    let sheet = mesh("open-star");
    let bars = DynamicalMatrix::new(&sheet, Stiffnesses { bars: 1.0, ..Stiffnesses::default() }).unwrap();
    let both = DynamicalMatrix::new(&sheet, Stiffnesses { bars: 1.0, creases: 0.1, facets: 0.0 }).unwrap();
    let q = [0.7, -1.9];
    let mut weighted = Rigidity::of_sheet(&sheet, false).unwrap().at(q.map(|q| Complex::from_polar(1.0, q)));
    for (mut row, edge) in weighted.row_iter_mut().zip(&sheet.edges) {
        let [i, j] = edge.key.ends().map(|corner| sheet.position(corner));
        row *= Complex::new((j - i).norm().sqrt().recip(), 0.0);
    }
    assert!((bars.at(q) - weighted.adjoint() * &weighted).norm() <= 1e-14);
    let still = both.bands([0.0, 0.0]).unwrap();
    assert!(still[2].abs() <= 1e-14 && still[3] > 1e-3, "{still:?}");
    let lines = ZeroLines::new(&Zone::new(&determinant(&sheet)).unwrap()).unwrap();
    let on_line = lines.lines.iter().flat_map(|line| &line.points).find(|q| q[0].hypot(q[1]) > 1.0).copied().unwrap();
    let (soft, stiff) = (bars.bands(on_line).unwrap()[0], both.bands(on_line).unwrap()[0]);
    println!("bands at a zero line: {soft:e} and {stiff:e}");
    assert!(soft.abs() <= 1e-13 && stiff > 1e-4);
    assert_eq!(along_path(&[[0.0, 0.0], [1.0, 0.0], [1.0, 2.0]], 4).len(), 9);
}

/// Claim: edge modes of a strip of 60 star cells, measured from the null space of its own matrix, decay with the roots
/// of the determinant of one cell to 1e-6 (rounding leaves 1e-13), at both edges, and there are as many zero modes as
/// rows stick out.
#[test]
fn edge_modes_decay_with_the_roots() {
    let rigidity = Rigidity::of_sheet(&mesh("open-star"), false).unwrap();
    let found = Determinant::new(&rigidity).unwrap();
    let strip = Strip::new(&rigidity, 60).unwrap();
    let mut compared = 0;
    for q1 in [0.9, 2.4] {
        let modes = strip.at(q1).unwrap();
        assert_eq!((modes.zero_modes, modes.self_stresses), (4, 0));
        for (first, upwards) in [(0, true), (59, false)] {
            let factors = modes.factors(first, upwards, 1).unwrap();
            let decay = Decay::new(&found, 0, q1).unwrap();
            let bound = decay.roots.iter().filter(|root| !root.on_circle() && (root.kappa() < 0.0) == upwards);
            for root in bound {
                let apart = factors.iter().map(|z| (z / root.z).ln().norm()).fold(f64::INFINITY, f64::min);
                assert!(apart <= 1e-6, "{q1} {root:?} {apart:e}");
                compared += 1;
            }
        }
    }
    assert_eq!(compared, 4);
}

/// Claim: where a kirigami cell of polarization -3/2 meets one of 3/2, three zero modes are bound, and in the other
/// order three self stresses, as the winding numbers of the determinants predict; edges free in one case and clamped in
/// the other, so that modes and stresses have nothing to cancel with. Cells that do not fit are told apart.
#[test]
fn interfaces_bind_what_the_windings_predict() {
    let [one, other] = ["kirigami-polarized", "kirigami-reversed"].map(mesh);
    let inside = |sheet: &Sheet, q1| Rigidity::of_sheet(sheet, true).unwrap().roots_inside(q1).unwrap() as i64;
    for q1 in [1.8, 3.0] {
        let modes = Strip::with_interface([&other, &one], true, 40).unwrap().at(q1).unwrap();
        let bound = modes.bound(10..30).unwrap();
        assert_eq!((bound.zero_modes, bound.self_stresses), (3, 0));
        assert_eq!(inside(&one, q1) - inside(&other, q1), 3);
        let modes = Strip::with_interface([&one, &other], true, 40).unwrap().clamped().at(q1).unwrap();
        let bound = modes.bound(10..30).unwrap();
        assert_eq!((modes.zero_modes, bound.zero_modes, bound.self_stresses), (0, 0, 3));
    }
    assert_eq!(fit(&one, &other), None);
    assert!(fit(&one, &mesh("kirigami")).unwrap().contains("vertices"));
}

/// Claim (equation 16): at given wavenumbers zero modes are as many as self stresses at the opposite wavenumber, also
/// where there are some: at `q = 0` of the star cell and on a point of its zero lines, where both are one.
#[test]
fn counts_at_wavenumbers() {
    let sheet = mesh("open-star");
    let rigidity = Rigidity::of_sheet(&sheet, false).unwrap();
    let zone = Zone::new(&Determinant::new(&rigidity).unwrap()).unwrap();
    let lines = ZeroLines::new(&zone).unwrap().refined(&zone, &rigidity);
    let line = &lines.lines[0].points;
    for (q, expected) in [([0.0; 2], 3), ([0.9, 1.7], 0), (line[line.len() / 3], 1)] {
        let found = ZeroModeCounts::at(&rigidity, q).unwrap();
        assert_eq!([found.zero_modes, found.self_stresses_opposite], [expected; 2], "{found:?}");
    }
}

/// Claim: a determinant that is zero along a line without a change of sign is said to be, however its cell is drawn, and
/// not to have no line of zeros. Source: singular values of the rigidity matrix: two vanish on a whole line.
#[test]
fn lines_without_change_of_sign_are_said() {
    let corners = "[[0.9093826531241356, 0.9388028165616769, 0.1285447097515281],
        [0.462756639357035, 1.2250788551444622, 0.19302343887066623],
        [0.16275663935703502, 0.1250788551444623, 0.19302343887066623],
        [1.162756639357035, 0.1250788551444623, 0.19302343887066623],
        [1.462756639357035, 1.2250788551444622, 0.19302343887066623],
        [0.6093826531241355, -0.1611971834383233, 0.1285447097515281]]";
    for second in ["[0.3, 1.1, 0.0]", "[1.3, 1.1, 0.0]"] {
        let fold = format!(
            "{{\"vertices_coords\": {corners}, \"faces_vertices\": [[0, 1, 2], [0, 3, 4], [5, 0, 2], [3, 0, 5]],
            \"foldwell:lattice\": [[1.0, 0.0, 0.0], {second}]}}"
        );
        let study = "[energy]\nbars = { stiffness = 1.0 }\n[[study]]\nname = \"b\"\nkind = \"bloch\"\ndraw = []";
        let sheet = "mesh = \"cell.fold\"\ndomain = \"torus\"";
        let ran = Scene::on(sheet, study).with("cell.fold", fold).ran();
        let found = ran.bloch("b");
        assert!(found.zero_lines.is_none(), "{second}: {:?}", found.zero_lines);
        let why = found.no_zero_lines.as_deref().unwrap_or_default();
        assert!(why.contains("touches zero along a line"), "{second}: {why}");
    }
}
