//! Cells of few vertices and of high symmetry in many drawings: what is counted and measured belongs to the sheet, not
//! to its lattice vectors, its orientation, its unit of length, the numbers of its vertices or the cells in which faces
//! are drawn.
//!
//! The cells are triangular lattices in which each class of vertices modulo a sublattice has its own height: one
//! vertex, in which every crease passes straight through; two, a corrugation; three, the hexagonal eggbox (p3m1, or p3
//! with three heights); four, the kagome lattice with raised hexagons (p6m); seven, the snub hexagonal tiling 3.3.3.3.6
//! with raised hexagons (p6). Beside them snub squares with raised squares (p4g), pyramids on squares, and an eggbox.

use crate::common::{Numbers, Scene, mesh};
use foldwell::analysis::bloch::{BlochError, Decay, Determinant, Rigidity, SurveyOptions, survey};
use foldwell::analysis::branches::branches;
use foldwell::analysis::modes::modes;
use foldwell::analysis::response::{NoRatio, Response, response};
use foldwell::math::{Vec3, rotation};
use foldwell::model::{Assembly, RIGID};
use foldwell::sheet::build::{Drawing, build};
use foldwell::sheet::generate::Eggbox;
use foldwell::sheet::{Pattern, Sheet, fold, generate};
use foldwell::study::bloch::BlochSummary;
use std::f64::consts::{FRAC_PI_4, PI};

/// Triangles of points, and the vectors that repeat them.
#[derive(Clone)]
struct Cell {
    triangles: Vec<[Vec3; 3]>,
    lattice: [Vec3; 2],
}

/// Another drawing of a cell: a turn, a unit of length, and new lattice vectors as combinations of the old ones.
struct Change {
    turn: Vec3,
    unit: f64,
    lattice: [[i32; 2]; 2],
    seed: u64,
}

fn combined([l1, l2]: &[Vec3; 2], [n1, n2]: [i32; 2]) -> Vec3 {
    l1 * f64::from(n1) + l2 * f64::from(n2)
}

/// Returns the triangular lattice on `e1` and `e2` with one height for each of its classes modulo the sublattice of the
/// rows; the class of a point is the index of the first of `cosets` that differs from it by a vector of the sublattice.
fn raised([e1, e2]: [Vec3; 2], rows: [[i32; 2]; 2], cosets: &[[i32; 2]], heights: &[f64]) -> Cell {
    let determinant = rows[0][0] * rows[1][1] - rows[0][1] * rows[1][0];
    assert_eq!(determinant as usize, cosets.len());
    let class = |p: [i32; 2]| {
        let in_sublattice = |c: &[i32; 2]| {
            let d = [p[0] - c[0], p[1] - c[1]];
            let parts = [d[0] * rows[1][1] - d[1] * rows[1][0], d[1] * rows[0][0] - d[0] * rows[0][1]];
            parts.iter().all(|part| part % determinant == 0)
        };
        cosets.iter().position(in_sublattice).unwrap()
    };
    let point = |p: [i32; 2]| combined(&[e1, e2], p) + Vec3::z() * heights[class(p)];
    let around = |p: &[i32; 2]| {
        let at = |by: [i32; 2]| point([p[0] + by[0], p[1] + by[1]]);
        [[at([0, 0]), at([1, 0]), at([1, 1])], [at([0, 0]), at([1, 1]), at([0, 1])]]
    };
    let triangles = cosets.iter().flat_map(around).collect();
    Cell { triangles, lattice: rows.map(|row| combined(&[e1, e2], row)) }
}

/// Two sides of a regular triangle, in the lattice of which `[1, 1]` is an edge too.
fn regular() -> [Vec3; 2] {
    [Vec3::x(), Vec3::new(-0.5, 0.75f64.sqrt(), 0.0)]
}

fn one_vertex(sides: [Vec3; 2]) -> Cell {
    raised(sides, [[1, 0], [0, 1]], &[[0, 0]], &[0.0])
}

fn corrugation(height: f64) -> Cell {
    raised(regular(), [[2, 0], [0, 1]], &[[0, 0], [1, 0]], &[0.0, height])
}

fn hexagonal_eggbox(heights: [f64; 3]) -> Cell {
    raised(regular(), [[2, 1], [1, 2]], &[[0, 0], [1, 0], [2, 0]], &heights)
}

fn kagome(heights: [f64; 4]) -> Cell {
    raised(regular(), [[2, 0], [0, 2]], &[[0, 0], [1, 0], [1, 1], [0, 1]], &heights)
}

fn snub_hexagonal(height: f64) -> Cell {
    let cosets: Vec<[i32; 2]> = (0..7).map(|k| [k, 0]).collect();
    let mut heights = [0.0; 7];
    heights[0] = height;
    raised(regular(), [[3, 1], [-1, 2]], &cosets, &heights)
}

/// Snub squares, or pyramids on the squares of a chessboard, with these heights of the middles of the squares.
fn squares(angle: f64, heights: [f64; 2]) -> Cell {
    // two squares of side 1, turned by opposite angles against the lattice, share corners
    let side = 2.0 * angle.cos();
    let lattice = [Vec3::x() * side, Vec3::y() * side];
    let corner = |k: i32, turn: f64| {
        let (sin, cos) = (turn + PI / 2.0 * f64::from(k)).sin_cos();
        Vec3::new(cos, sin, 0.0) * 0.5f64.sqrt()
    };
    let middle = 0.5 * (lattice[0] + lattice[1]);
    let first =
        (0..4).map(|k| [Vec3::z() * heights[0], corner(k, FRAC_PI_4 + angle), corner(k + 1, FRAC_PI_4 + angle)]);
    let second = (0..4).map(|k| {
        let turn = FRAC_PI_4 - angle;
        [middle + Vec3::z() * heights[1], middle + corner(k, turn), middle + corner(k + 1, turn)]
    });
    let mut triangles: Vec<[Vec3; 3]> = first.chain(second).collect();
    let corners: Vec<Vec3> = (0..4).map(|k| corner(k, FRAC_PI_4 + angle)).collect();
    triangles.extend(between(&corners, &lattice));
    Cell { triangles, lattice }
}

/// Returns one of each class of regular triangles of side 1 between copies of these points.
fn between(points: &[Vec3], lattice: &[Vec3; 2]) -> Vec<[Vec3; 3]> {
    let shifts = || (-2..=2).flat_map(|n1| (-2..=2).map(move |n2| [n1, n2]));
    let copies: Vec<Vec3> = shifts().flat_map(|n| points.iter().map(move |p| p + combined(lattice, n))).collect();
    let near = |a: &Vec3, b: &Vec3| ((a - b).norm() - 1.0).abs() < 1e-9;
    let mut found: Vec<[Vec3; 3]> = Vec::new();
    for a in points {
        for b in copies.iter().filter(|b| near(a, b)) {
            for c in copies.iter().filter(|c| near(a, c) && near(b, c) && (b - a).cross(&(*c - a)).z > 0.0) {
                let middle = |t: &[Vec3; 3]| (t[0] + t[1] + t[2]) / 3.0;
                let new = [*a, *b, *c];
                let same =
                    |t: &[Vec3; 3]| shifts().any(|n| (middle(t) + combined(lattice, n) - middle(&new)).norm() < 1e-9);
                if !found.iter().any(same) {
                    found.push(new);
                }
            }
        }
    }
    found
}

fn of_sheet(sheet: &Sheet) -> Cell {
    let triangles = sheet.triangles.iter().map(|face| face.corners.map(|corner| sheet.position(corner))).collect();
    Cell { triangles, lattice: sheet.lattice.unwrap() }
}

impl Cell {
    /// Draws the cell in another way: every face in some cell of its own, faces and vertices in any order.
    fn drawn(&self, change: &Change) -> Sheet {
        let (mut numbers, turn) = (Numbers::new(change.seed), rotation::exp(&change.turn));
        let mut pick = |below: usize| ((0.5 + 0.5 * numbers.within(1.0)) * below as f64) as usize % below;
        let mut faces = self.triangles.clone();
        let (mut coords, mut drawn): (Vec<Vec3>, Vec<Vec<usize>>) = (Vec::new(), Vec::new());
        while !faces.is_empty() {
            let face = faces.swap_remove(pick(faces.len()));
            let by = combined(&self.lattice, [pick(3) as i32 - 1, pick(3) as i32 - 1]);
            let first = pick(3);
            let mut number = |k: usize| {
                let place = face[(first + k) % 3] + by;
                let known = coords.iter().position(|p: &Vec3| (p - place).norm() < 1e-9);
                known.unwrap_or_else(|| {
                    coords.push(place);
                    coords.len() - 1
                })
            };
            drawn.push((0..3).map(&mut number).collect());
        }
        let map = |p: Vec3| turn * p * change.unit;
        let lattice = change.lattice.map(|row| map(combined(&self.lattice, row)));
        let coords = coords.into_iter().map(map).collect();
        build(&Drawing { coords, faces: drawn, lattice: Some(lattice), ..Drawing::default() }).unwrap()
    }
}

/// The drawings in which every cell is looked at, the first as it is.
fn changes() -> Vec<Change> {
    let unit = [[1, 0], [0, 1]];
    let mut all = vec![Change { turn: Vec3::zeros(), unit: 1.0, lattice: unit, seed: 1 }];
    let bases = [unit, [[1, 1], [0, 1]], [[2, 1], [1, 1]], [[0, 1], [-1, 0]], [[1, -2], [0, 1]], [[-1, 0], [0, -1]]];
    for (k, lattice) in bases.into_iter().enumerate() {
        let mut numbers = Numbers::new(7 + k as u64);
        let turn = Vec3::from_fn(|_, _| numbers.within(2.0));
        all.push(Change { turn, unit: [1.0, 1e-3, 40.0, 1e4, 1e-6, 1.0][k], lattice, seed: 11 + k as u64 });
    }
    all
}

/// Cells with their names.
fn cells() -> Vec<(&'static str, Cell)> {
    let mut numbers = Numbers::new(3);
    let mut near = |side: Vec3| side + Vec3::new(numbers.within(0.3), numbers.within(0.3), 0.0);
    let [e1, e2] = regular();
    let oblique = [near(e1), near(e2)];
    let other = [near(e1), near(e2)];
    vec![
        ("one vertex, square", one_vertex([Vec3::x(), Vec3::y()])),
        ("one vertex, (1, 0), (.3, 1)", one_vertex([Vec3::x(), Vec3::new(0.3, 1.0, 0.0)])),
        ("one vertex, regular", one_vertex(regular())),
        ("one vertex, oblique", one_vertex(oblique)),
        ("two vertices, flat", raised(other, [[2, 0], [0, 1]], &[[0, 0], [1, 0]], &[0.0, 0.0])),
        ("corrugation", corrugation(0.4)),
        ("hexagonal eggbox", hexagonal_eggbox([0.0, 0.3, -0.3])),
        ("p3 eggbox", hexagonal_eggbox([0.0, 0.5, 0.1])),
        ("kagome", kagome([0.0, 0.0, 0.0, 0.4])),
        ("kagome, four heights", kagome([0.0, 0.2, -0.3, 0.4])),
        ("snub hexagonal", snub_hexagonal(0.35)),
        ("snub hexagonal, flat", snub_hexagonal(0.0)),
        ("snub squares up and up", squares(PI / 12.0, [0.3, 0.3])),
        ("snub squares up and down", squares(PI / 12.0, [0.3, -0.3])),
        ("eggbox", of_sheet(&generate(&Pattern::Eggbox(Eggbox::default())).unwrap())),
        ("Miura-ori", of_sheet(&mesh("miura"))),
    ]
}

fn responds(sheet: Sheet) -> Response {
    response(&Assembly::torus(sheet, [1, 1]).bars(RIGID).build().unwrap()).unwrap()
}

/// Returns the ratios in the plane and of bending along a direction of the cell as it is.
fn ratios(found: &Response, change: &Change, direction: f64) -> [Result<f64, NoRatio>; 2] {
    let [l1, l2] = found.lattice.chords.map(Vec3::from);
    let along = rotation::exp(&change.turn) * Vec3::new(direction.cos(), direction.sin(), 0.0);
    let across = l1.cross(&l2).normalize().cross(&l1.normalize());
    let angle = along.dot(&across).atan2(along.dot(&l1.normalize()));
    let poisson = found.poisson.as_ref().unwrap();
    [poisson.in_plane.ratio(angle), poisson.bending.ratio(angle)]
}

/// Claim: the number of linear modes, the ranks of their table and of its curvatures, the number of self stresses, the
/// relation of the two ratios and both ratios in every direction, or the reason for which there is none, are the same
/// in all drawings of a cell. Eight directions over half a turn, those of an eighth of a turn among them, along which
/// the square eggbox has neither strain nor ratio. A flat cell has two more modes than vertices, which bend it in all
/// three ways, and no ratio at all. Source: linear algebra. Tolerance 1e-8 relative to the square of the ratio, since a
/// ratio is a quotient whose divisor may be small.
#[test]
fn responses_belong_to_the_sheet() {
    for (name, cell) in cells() {
        let all = changes();
        let first = responds(cell.drawn(&all[0]));
        let counts = |found: &Response| {
            let relation = found.poisson.as_ref().unwrap().relation.opposite();
            (found.modes.len(), found.table.rank, found.table.curvatures, found.stresses.len(), relation)
        };
        if cell.triangles.iter().flatten().all(|p| p.z == 0.0) {
            let vertices = cell.triangles.len() / 2;
            assert_eq!(counts(&first), (vertices + 2, 3, 3, vertices + 2, None), "{name}");
            assert_eq!(ratios(&first, &all[0], 0.3), [Err(NoRatio::NoTensor), Err(NoRatio::Any)], "{name}");
        }
        for change in &all[1..] {
            let found = responds(cell.drawn(change));
            assert_eq!(counts(&found), counts(&first), "{name}, {:?}", change.lattice);
            for k in 0..8 {
                let direction = PI * f64::from(k) / 8.0;
                for (a, b) in ratios(&first, &all[0], direction).into_iter().zip(ratios(&found, change, direction)) {
                    match (a, b) {
                        (Ok(a), Ok(b)) => assert!((a - b).abs() <= 1e-8 * (1.0 + a * a), "{name}, {k}: {a} {b}"),
                        (a, b) => assert_eq!(a.err(), b.err(), "{name}, {k}, {:?}: {a:?} {b:?}", change.lattice),
                    }
                }
            }
        }
    }
}

/// Claim: along a diagonal the square eggbox has neither strain nor curvature without twist, and no ratio, also where a
/// lattice vector is a diagonal; along the sides of its squares its ratios are 1 and -1. Tolerance: rounding.
#[test]
fn an_eggbox_has_no_ratio_along_its_diagonals() {
    let cell = of_sheet(&generate(&Pattern::Eggbox(Eggbox::default())).unwrap());
    for lattice in [[[1, 0], [0, 1]], [[1, 1], [0, 1]], [[1, 1], [-1, 0]]] {
        let change = Change { turn: Vec3::new(0.3, -0.2, 1.0), unit: 3.0, lattice, seed: 5 };
        let found = responds(cell.drawn(&change));
        for diagonal in [FRAC_PI_4, 3.0 * FRAC_PI_4] {
            assert_eq!(ratios(&found, &change, diagonal), [Err(NoRatio::NothingAlong), Err(NoRatio::Any)]);
        }
        let [in_plane, bending] = ratios(&found, &change, 0.0).map(Result::unwrap);
        assert!((in_plane - 1.0).abs() <= 1e-12 && (bending + 1.0).abs() <= 1e-12, "{in_plane} {bending}");
    }
}

/// Claim: a cell of one vertex, in which every crease passes straight through, folds along each of its three families
/// of lines: three folding modes, as many self stresses on a torus of fixed lattice, and one quadric, a cone of real
/// directions. Source: each family by itself stays a cylinder, and a flat cell has two modes more than vertices.
#[test]
fn one_vertex_folds_along_three_families() {
    for (name, cell) in cells().into_iter().filter(|(name, _)| name.starts_with("one")) {
        for change in changes() {
            let sheet = cell.drawn(&change);
            let torus = Assembly::fixed_torus(sheet.clone(), [1, 1]).bars(RIGID).build().unwrap();
            let found = modes(&torus, 0, &mut || true).unwrap();
            assert_eq!((found.folding_modes, found.self_stresses), (Some(3), 3), "{name}");
            let found = branches(&Assembly::screw(sheet, [1, 1]).bars(RIGID).build().unwrap()).unwrap();
            let [positive, negative, zero] = found.signature.unwrap();
            assert_eq!((found.modes, found.quadrics, zero), (3, 1, 0), "{name}");
            assert!(positive.min(negative) == 1 && positive.max(negative) == 2, "{name}: {:?}", found.signature);
        }
    }
}

/// Claim: the determinant of flat cells, of the hexagonal eggbox with heights 0, h and -h, of raised hexagons in a flat
/// ring of triangles and of raised snub squares vanishes at all wavenumbers, in every drawing, and the error says so
/// with the number of zero modes; that of the other cells does not. Source: across a flat cell every vertex moves
/// freely, so that it has as many zero modes as vertices; of the others singular values of an independent program are
/// 1e-16 at every wavenumber.
#[test]
fn determinants_vanish_in_every_drawing() {
    let expected = |name: &str, vertices: usize| match name {
        _ if name.starts_with("one") || name.ends_with("flat") => vertices,
        "hexagonal eggbox" => 1,
        "snub hexagonal" => 3,
        _ if name.starts_with("snub squares") => 2,
        _ => 0,
    };
    for (name, cell) in cells() {
        for change in changes() {
            let rigidity = Rigidity::of_sheet(&cell.drawn(&change), false).unwrap();
            let zero_modes = match Determinant::new(&rigidity) {
                Err(BlochError::Vanishes { compared: 4, zero_modes }) => zero_modes,
                Err(error) => panic!("{name}: {error}"),
                Ok(_) => 0,
            };
            assert_eq!(zero_modes, expected(name, rigidity.vertices), "{name}, {:?}", change.lattice);
        }
    }
}

/// Claim: the determinant of the raised kagome lattice is `(z1 - 1)^2 (z2 - 1)^2 (z1 - z2)^2` over a monomial, so that
/// at a wavenumber `q1` all its roots are double and on the unit circle, although the matrix has one null vector at
/// each; where `q1` is 0 it vanishes for all `z2`; it has one sign over the whole zone (which one, the order of the
/// rows says), and the pairs add up to nothing. Tolerance: the condition of a double root, 1e3 at most here, times
/// rounding.
#[test]
fn kagome_roots_are_double() {
    for change in changes() {
        let rigidity = Rigidity::of_sheet(&kagome([0.0, 0.0, 0.0, 0.4]).drawn(&change), false).unwrap();
        let determinant = Determinant::new(&rigidity).unwrap();
        for q1 in [0.7, 1.3, 2.9] {
            let decay = Decay::new(&determinant, 0, q1).unwrap().refined(&determinant, &rigidity);
            assert!(!decay.roots.is_empty() && !decay.vanishes);
            for root in &decay.roots {
                assert!(root.multiplicity >= 2 && root.multiplicity % 2 == 0 && root.on_circle(), "{q1}: {root:?}");
                assert!(root.kappa().abs() <= 1e-11, "{q1}, {:?}: {root:?}", change.lattice);
            }
            assert!(decay.pairing().error.unwrap() <= 1e-11 && decay.pairing().left_out == 0);
        }
        let options = SurveyOptions { averaged: 8, wavenumbers: vec![], ..SurveyOptions::default() };
        let found = survey(&rigidity, &options, &mut |_| true).unwrap();
        let (zone, _) = found.real.unwrap();
        let positive = zone.positive_fraction([256, 256]);
        assert!(positive == 0.0 || positive == 1.0, "{:?}: {positive}", change.lattice);
        assert_eq!(found.polarization.polarization, [0.0, 0.0]);
    }
    let plain = Rigidity::of_sheet(&kagome([0.0, 0.0, 0.0, 0.4]).drawn(&changes()[0]), false).unwrap();
    let there = Decay::new(&Determinant::new(&plain).unwrap(), 0, 0.0).unwrap();
    assert!(there.vanishes && there.roots.is_empty());
}

/// Runs a study `bloch` of a cell with these further keys.
fn bloch(cell: &Cell, keys: &str) -> (BlochSummary, [usize; 3]) {
    let mass = if keys.contains("path") { "mass = { vertex = 1.0 }\n" } else { "" };
    let scene = format!(
        "{mass}[sheet]\nmesh = \"cell.fold\"\ndomain = \"torus\"\n[energy]\nbars = {{ stiffness = 50.0 }}\n\
         creases = {{ stiffness = 1.0 }}\n[[study]]\nname = \"b\"\nkind = \"bloch\"\n{keys}\n"
    );
    let scene = Scene::new(scene).with("cell.fold", fold::write(&cell.drawn(&changes()[2])));
    let ran = scene.converged();
    let rows = |name: &str| if ran.out.has(name) { ran.out.text(name).lines().count() } else { 0 };
    (ran.bloch("b").clone(), ["b-modes.csv", "b_bands.csv", "b-strip.csv"].map(rows))
}

/// Claim: where the determinant vanishes at all wavenumbers, bands, counts of zero modes and the zero modes of a strip,
/// which need none, are given, and what is read off it is null or empty with the reason; at a `q1` at which it vanishes
/// for every `z2` the other wavenumbers keep their roots.
#[test]
fn bands_and_counts_need_no_determinant() {
    let keys = "q1 = [0.4]\npath = [[0.3, 0.1], [3.0, 1.0]]\nzero_modes_at = [[0.0, 0.0], [0.5, 0.7]]\n";
    for cell in [hexagonal_eggbox([0.0, 0.3, -0.3]), one_vertex(regular()), snub_hexagonal(0.0)] {
        let (found, [counts, bands, _]) = bloch(&cell, keys);
        assert!(found.no_determinant.unwrap().contains("vanishes at all wavenumbers"));
        assert_eq!((found.polarization, found.zero_lines, found.positive_fraction), (None, None, None));
        assert!(found.decay.is_empty() && found.determinant.is_empty() && found.symmetry_error.is_none());
        assert!(counts == 3 && bands > 50, "{counts} {bands}");
    }
    let strip = format!("{keys}strip = {{ cells = 10 }}\n");
    let (found, [_, _, rates]) = bloch(&hexagonal_eggbox([0.0, 0.3, -0.3]), &strip);
    let strip = found.strip.unwrap();
    assert!(strip.zero_modes.iter().all(|count| *count > 0) && strip.compared == 0 && rates == 1);
    let (found, _) = bloch(&kagome([0.0, 0.0, 0.0, 0.4]), "q1 = [0.0, 1.3]\ndraw = []\n");
    assert!(found.no_determinant.is_none() && found.polarization == Some([0.0, 0.0]));
    let vanishing: Vec<bool> = found.decay.iter().map(|decay| decay.vanishes).collect();
    assert_eq!((vanishing, found.decay[1].multiplicity.len() > 1), (vec![true, false], true));
}
