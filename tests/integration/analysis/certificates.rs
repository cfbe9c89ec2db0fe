//! What a relaxation certifies: that it is in equilibrium, and how many negative eigenvalues it has on what rigid terms
//! leave free.

use crate::common::{Numbers, Testing, eigenvalues, jacobian, linearized, mesh, on};
use foldwell::RIGID;
use foldwell::analysis::path::{PathEnd, PathEvent, PathOptions, follow_path};
use foldwell::analysis::relax::{Relaxed, relax_from};
use foldwell::analysis::wells::starts::{Outcome, Starts, relax_around};
use foldwell::math::Vec3;
use foldwell::model::{Assembly, Boundary, Drive, Driven, Gauge, Hinges, Model, Rest, Terms};
use foldwell::numerics::DenseMatrix;
use foldwell::sheet::generate::Hypar;
use foldwell::sheet::{self, Corner, Sheet, fold};
use foldwell::solver::{Equilibrium, Failure, Options, Problem, minimize};
use foldwell::{Pattern, generate, relax};
use std::f64::consts::PI;

/// The sheet of a FOLD file with this text.
fn read(text: &str) -> Sheet {
    fold::parse(text, "sheet.fold").unwrap()
}

/// A strip of rectangles, 0.5 long and 1 wide, in the plane.
fn strip(rectangles: usize) -> Sheet {
    let vertices = (0..=rectangles).flat_map(|k| [0.0, 1.0].map(|y| format!("[{}, {y}, 0]", 0.5 * k as f64)));
    let faces = (0..rectangles).map(|k| format!("[{}, {}, {}, {}]", 2 * k, 2 * k + 2, 2 * k + 3, 2 * k + 1));
    let [vertices, faces] = [vertices.collect::<Vec<_>>(), faces.collect()].map(|list| list.join(", "));
    let text = format!("{{\"file_spec\": 1.2, \"vertices_coords\": [{vertices}], \"faces_vertices\": [{faces}]}}");
    read(&text)
}

/// A strip hinged at both ends and pressed along its length by a load on its far end, which a guide keeps on its line.
fn column(rectangles: usize, [bars, facets]: [f64; 2], load: f64) -> (Assembly, Terms) {
    let case = on(strip(rectangles), [1, 1], Boundary::Patch);
    let last = 2 * rectangles;
    let pins = [0, 1].map(|v| (v, [true; 3])).into_iter().chain([last, last + 1].map(|v| (v, [false, true, true])));
    let loads = [last, last + 1].map(|v| (v, Vec3::new(-load / 2.0, 0.0, 0.0))).to_vec();
    let rest = vec![0.0; case.drawn_angles().len()];
    let facets = Some(Hinges { stiffness: facets.into(), rest: rest.clone() });
    (case, Terms { facets, pins: pins.collect(), loads, ..Terms::bars_and_creases(bars, 1.0, rest) })
}

fn pressed(rectangles: usize, stiffness: [f64; 2], load: f64) -> (Assembly, Terms, Relaxed) {
    let (case, terms) = column(rectangles, stiffness, load);
    let found = case.relax(&terms).unwrap();
    (case, terms, found)
}

/// Negative eigenvalues on the null space of the rigid rows, by a singular value decomposition of nalgebra; `None`
/// where a singular value is neither rounding error nor clearly above it.
fn projected(model: &Model, found: &Equilibrium) -> Option<usize> {
    let at = linearized(model, &found.x, &found.tension);
    let (rows, mut whole) = (jacobian(model, &at), at.pattern().to_dense(&at.hessian));
    let unknowns = rows.ncols();
    let is_rigid = |row: &usize| model.compliance()[*row] == 0.0;
    for row in (0..rows.nrows()).filter(|row| !is_rigid(row)) {
        whole += rows.row(row).transpose() * rows.row(row) / model.compliance()[row];
    }
    let rigid: Vec<usize> = (0..rows.nrows()).filter(is_rigid).collect();
    let rigid = rows.select_rows(&rigid);
    // a square matrix has all right singular vectors
    let mut square = DenseMatrix::zeros(rigid.nrows().max(unknowns), unknowns);
    square.rows_mut(0, rigid.nrows()).copy_from(&rigid);
    let found = square.svd(false, true);
    let vectors = found.v_t.unwrap();
    let largest = found.singular_values.amax();
    if found.singular_values.iter().any(|value| (1e-12..1e-9).contains(&(value / largest))) {
        return None;
    }
    let null: Vec<usize> = (0..unknowns).filter(|&k| found.singular_values[k] <= 1e-11 * largest).collect();
    let basis = vectors.select_rows(&null).transpose();
    Some(eigenvalues(basis.transpose() * whole * &basis).iter().filter(|value| **value < -1e-9).count())
}

/// Claim: a column of eight rectangles loses stability at the loads of a dense projection on the null space of its
/// rigid facets, 1.172258 (bars that stretch, EA 1e3, rigid facets); of the Hessian with stiff facets, 0.3049041 (1e6),
/// 0.3082243 (1e7) and 0.3527343 (1e8); and with rigid bars at Euler's loads of linked rods,
/// `2 c / a (1 - cos(m pi / 8))`. Panels that bars let shear have hinges that are not parallel, so that facets block
/// the first mode, by gradients that are all but dependent. Source: dense projections with analytic gradients in other
/// software, Timoshenko and Gere for the rods. Tolerance: the loads of the former are given to seven digits; for the
/// rods, rounding errors of the Hessian's entries, 1e-12 of which counts as zero.
#[test]
fn columns_buckle() {
    // beyond the critical load the straight column is a saddle, which is left
    let negative = |stiffness, load| pressed(8, stiffness, load).2.routes[0].negative_eigenvalues;
    let stretching = [(RIGID, 1.172_258), (1e6, 0.304_904_1), (1e7, 0.308_224_3), (1e8, 0.352_734_3)];
    for (facets, critical) in stretching {
        let around = [1.0 - 1e-6, 1.0 + 1e-6].map(|part| negative([1e3, facets], part * critical));
        assert_eq!(around, [Some(0), Some(1)], "facets {facets:e}");
    }
    for mode in 1..4 {
        let critical = 4.0 * (1.0 - f64::cos(f64::from(mode) * PI / 8.0));
        let around = [1.0 - 1e-9, 1.0 + 1e-9].map(|part| negative([RIGID, RIGID], part * critical));
        assert_eq!(around, [mode as usize - 1, mode as usize].map(Some), "mode {mode}");
    }
}

/// Claim: columns of random lengths, stiffnesses and loads have as many negative eigenvalues as a dense projection
/// counts, also those of more unknowns than are decomposed at once, whose bounds meet or not.
#[test]
fn negative_eigenvalues_are_those_of_a_projection() {
    let mut numbers = Numbers::new(1);
    let (mut unstable, mut cases) = (0, 0);
    for rectangles in [3, 5, 8, 13, 21, 34, 55] {
        for facets in [1e5, 1e7, 1e9, RIGID] {
            let bars = 10f64.powf(3.5 + numbers.within(1.0));
            let load = 4.0 * (1 + cases % 4) as f64 * (PI / rectangles as f64).powi(2) * (1.0 + numbers.within(0.8));
            let (case, terms) = column(rectangles, [bars, facets], load);
            let mut model = case.model_of(&terms, Gauge::Held);
            let start = model.start();
            let found = minimize(&mut model, start, Options::default(), &mut |_| true).unwrap();
            let expected = projected(&model, &found);
            let counted = found.negative_eigenvalues;
            let what = format!("{rectangles} rectangles, bars {bars:e}, facets {facets:e}, load {load}: {expected:?}");
            // between rounding errors and errors of the state nobody can tell whether a gradient depends on the others
            let Some(expected) = expected else { continue };
            assert_eq!(counted, Some(expected), "{what}");
            unstable += usize::from(expected > 0);
            cases += 1;
        }
    }
    println!("{cases} cases, {unstable} unstable");
    assert!(unstable >= 15 && unstable < cases);
}

/// Relaxes the pleated hyperbolic paraboloid of ten pleats, folded to a fraction by its letters.
fn hypar(bars: f64, fraction: f64) -> Result<Relaxed, Failure> {
    let sheet = generate(&Pattern::Hypar(Hypar { pleats: 10, ..Hypar::default() })).unwrap();
    let builder = Assembly::patch(sheet, [1, 1]).bars(bars).facets(5.0).creases(1.0);
    relax(&builder.rest(Rest::Assigned(fraction)).build().unwrap()).map_err(|error| error.failure)
}

/// Claim: the paraboloid reaches the energies of a loop of thirty lines that bounds every step by the change of fold
/// angles and the heights of triangles, on the same energy function, in other software; L-BFGS with warm starts finds
/// the last one too. All but the third need no other way than Newton's method in positions: without the bounds the
/// first ends at a collapsed triangle. Where bars are so soft that the model has no minimum with triangles, the
/// triangle is named. Tolerance: ten digits are given.
#[test]
fn steps_that_are_short_lead_to_equilibria() {
    let reached = [
        (1e3, 0.85, 537.212_072_3),
        (1e3, 0.9, 626.789_705),
        (1e3, 0.95, 724.074_000_8),
        (1e3, 1.0, 829.089_753_6),
        (1e4, 0.45, 158.288_794_4),
        (1e4, 1.0, 1_106.211_568_1),
    ];
    for (bars, fraction, energy) in reached {
        let found = hypar(bars, fraction).unwrap();
        assert!((found.state.total() / energy - 1.0).abs() < 1e-9, "{bars:e}, {fraction}: {}", found.state.total());
        assert!(found.residual_force <= 1e-12 && found.negative_eigenvalues == Some(0));
        assert!(fraction == 0.95 || found.routes.len() == 1, "{bars:e}, {fraction}: {:?}", found.routes);
    }
    let failed = hypar(1e2, 1.0).unwrap_err();
    assert!(matches!(failed, Failure::Collapsed(triangle) if triangle.quality < 1e-6), "{failed}");
}

/// Claim: pieces of a sheet come to rest each for itself, without pins and with pins on one of them only: two copies
/// side by side have twice the energy of one, by soft and by rigid bars. Tolerance: that of two relaxations.
#[test]
fn pieces_relax_each_for_itself() {
    for bars in [1e4, RIGID] {
        let of = |copies: usize, pinned: bool| {
            let case = on(bird_feet(copies), [1, 1], Boundary::Patch);
            let rest = case.assigned_angles().iter().map(|angle| 0.2 * angle).collect();
            let pins = if pinned { vec![(0, [true; 3])] } else { vec![] };
            case.relax(&Terms { pins, ..Terms::bars_and_creases(bars, 1.0, rest) }).unwrap().state.total()
        };
        let one = of(1, false);
        assert!(one > 1e-6, "{one:e}: nothing to relax");
        for (copies, pinned) in [(2, false), (2, true), (3, false)] {
            let together = of(copies, pinned);
            assert!((together / one - copies as f64).abs() < 1e-9, "{copies} copies, {pinned}: {together} and {one}");
        }
    }
}

/// Claim: two cells on one screw come to rest each for itself: they have twice the energy of one, after about as few
/// steps. Each can move about the axis and along it. Tolerance: that of two relaxations; steps of which the one takes
/// ten.
#[test]
fn pieces_on_a_screw_relax_each_for_itself() {
    let cell = mesh("open-star");
    let vertices =
        [Vec3::zeros(), Vec3::new(0.3, 0.2, 0.0)].map(|by| cell.vertices.iter().map(move |vertex| vertex + by));
    let further = |corner: &Corner| Corner { vertex: corner.vertex + cell.vertices.len(), ..*corner };
    let copies = cell.polygons.iter().map(|polygon| polygon.iter().map(further).collect());
    let polygons = cell.polygons.iter().cloned().chain(copies).collect();
    let pair = Sheet { vertices: vertices.into_iter().flatten().collect(), polygons, ..cell.clone() };
    let pair = sheet::build::build(&sheet::build::draw(&pair)).unwrap();
    for bars in [1e4, RIGID] {
        let [one, two] = [&cell, &pair].map(|sheet| {
            let builder = Assembly::screw(sheet.clone(), [1, 1]).bars(bars).creases(1.0);
            relax(&builder.rest(Rest::Angle(0.05)).build().unwrap()).unwrap()
        });
        let ratio = two.state.total() / one.state.total();
        assert!((ratio - 2.0).abs() < 1e-9, "{bars}: {ratio}");
        assert!(two.history.len() <= 20, "{bars}: {} and {} steps", one.history.len(), two.history.len());
    }
}

/// Copies, side by side, of a flat vertex with four creases: a square whose creases go to its corners, the first one a
/// mountain.
fn bird_feet(copies: usize) -> Sheet {
    let (mut vertices, mut faces, mut edges, mut letters) = (vec![], vec![], vec![], vec![]);
    for copy in 0..copies {
        let [at, shift] = [5 * copy, 3 * copy];
        for [x, y] in [[0.1, 0.2], [-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]] {
            vertices.push(format!("[{}, {y}, 0]", x + shift as f64));
        }
        for k in 0..4 {
            let [a, b] = [at + 1 + k, at + 1 + (k + 1) % 4];
            faces.push(format!("[{at}, {a}, {b}]"));
            edges.extend([format!("[{at}, {a}]"), format!("[{a}, {b}]")]);
            letters.extend([if k == 0 { "\"M\"" } else { "\"V\"" }.to_owned(), "\"B\"".to_owned()]);
        }
    }
    let [vertices, faces, edges, letters] = [vertices, faces, edges, letters].map(|list| list.join(", "));
    let text = format!(
        "{{\"file_spec\": 1.2, \"vertices_coords\": [{vertices}], \"faces_vertices\": [{faces}], \
         \"edges_vertices\": [{edges}], \"edges_assignment\": [{letters}]}}"
    );
    read(&text)
}

/// Claim: no well of a pyramid on pinned corners, of soft bars, is a state with a collapsed triangle, in which the apex
/// lies on the line of a base edge: there the forces of hinges grow as the reciprocal of a height and hid what was
/// unbalanced, so that random starts came to rest in such states. Every well that is listed is an equilibrium of bars
/// and hinges whose triangles have heights.
#[test]
fn wells_have_no_collapsed_triangles() {
    let corners =
        (0..4).map(|k| [0.1 + 0.5 * PI * f64::from(k)].map(|angle| format!("[{}, {}, 0]", angle.cos(), angle.sin())));
    let vertices = corners.map(|[corner]| corner).chain(["[0, 0, 1.5]".to_owned()]).collect::<Vec<_>>().join(", ");
    let faces = "[[4, 0, 1], [4, 1, 2], [4, 2, 3], [4, 3, 0]]";
    let sheet =
        read(&format!("{{\"file_spec\": 1.2, \"vertices_coords\": [{vertices}], \"faces_vertices\": {faces}}}"));
    let case = on(sheet, [1, 1], Boundary::Patch);
    let pins = (0..4).map(|vertex| (vertex, [true; 3])).collect();
    let pyramid = case.with_terms(Terms { pins, ..Terms::bars_and_creases(1.0, 0.02, case.drawn_angles().to_vec()) });
    let starts = Starts { count: 40, seed: 1, spread: 2.0, options: Options::default() };
    let outcomes = relax_around(&pyramid, None, &starts, &|| true);
    let wells: Vec<_> = outcomes
        .iter()
        .filter_map(|outcome| if let Outcome::Well(well) = outcome { Some(well) } else { None })
        .collect();
    assert!(wells.len() >= 20, "{}", wells.len());
    for well in wells {
        let apex = Vec3::from_column_slice(&well.relaxed.state.coordinates[12..15]);
        let points: Vec<Vec3> = well.relaxed.state.coordinates.chunks(3).map(Vec3::from_column_slice).collect();
        let height = |k: usize| {
            let (a, b) = (points[k], points[(k + 1) % 4]);
            (b - a).cross(&(apex - a)).norm() / (b - a).norm()
        };
        assert!((0..4).all(|k| height(k) > 1e-4), "{apex}, {}", well.energy);
    }
}

/// Claim: the tensions of a buckled column of rigid bars, which have one self stress, are those of least norm, the same
/// from every random start, and at most 0.22, as bars of stiffness 1e8 have them to within 0.05; and a column whose
/// sides are held more often than need be converges with rigid bars where bars of 1e8 do. Source: the relaxations with
/// bars of 1e8. Tolerance: that of the states.
#[test]
fn tensions_have_no_self_stress() {
    let buckled = |bars: f64, seed: u64, pins: Vec<(usize, [bool; 3])>| {
        let case = on(strip(8), [1, 1], Boundary::Patch);
        let loads = [16, 17].map(|v| (v, Vec3::new(-0.175, 0.0, 0.0))).to_vec();
        let terms = Terms {
            facets: case.facets(bars),
            pins,
            loads,
            ..Terms::bars_and_creases(bars, 1.0, vec![0.0; case.drawn_angles().len()])
        };
        let model = case.model_of(&terms, Gauge::Held);
        let mut numbers = Numbers::new(seed);
        let start: Vec<f64> = model.start().iter().map(|x| x + numbers.within(0.05)).collect();
        relax_from(&model, start, Options::default(), &mut |_| true).map_err(|error| error.failure)
    };
    let largest = |found: &Relaxed| {
        found.state.tension.iter().filter(|t| t.is_finite()).fold(0.0, |most: f64, t| most.max(t.abs()))
    };
    let pins = vec![(0, [true; 3]), (1, [true, false, true]), (16, [false, false, true]), (17, [false, false, true])];
    let stiff = largest(&buckled(1e8, 1, pins.clone()).unwrap());
    for seed in 1..4 {
        let found = buckled(RIGID, seed, pins.clone()).unwrap();
        let most = largest(&found);
        assert!((most - stiff).abs() < 0.05, "seed {seed}: {most} and {stiff}");
        assert!(found.residual_force <= 1e-12, "{}", found.residual_force);
    }
    let held = vec![(0, [true; 3]), (1, [true; 3]), (16, [false, true, true]), (17, [false, true, true])];
    let [soft, rigid] = [1e8, RIGID].map(|bars| buckled(bars, 3, held.clone()).unwrap());
    assert!(
        (rigid.state.total() - soft.state.total()).abs() < 1e-5,
        "{} and {}",
        rigid.state.total(),
        soft.state.total()
    );
}

/// A quadrilateral plate with a vertex inside: four triangles in a plane, whose eight bars have one self stress.
const PLATE: &str = include_str!("../../cases/plate.fold");

/// The plate with rigid bars, pressed along a diagonal.
fn plate(load: f64) -> Assembly {
    let case = on(read(PLATE), [1, 1], Boundary::Patch);
    let push = load * Vec3::new(0.8376105968386142, 0.5462677805469224, 0.0);
    let pins = vec![(0, [true; 3]), (1, [false, true, true]), (3, [false, false, true])];
    let rest = vec![0.0; case.drawn_angles().len()];
    case.with_terms(Terms { pins, loads: vec![(0, push), (2, -push)], ..Terms::bars_and_creases(RIGID, 1.0, rest) })
}

/// Claim: where rigid bars are redundant and another self stress would change the count of negative eigenvalues, there
/// is none, or 0, which proves a minimum, wherever the relaxation begins; without loads, and under small ones, the
/// flat plate is stable whatever the self stress. Source: at the load 1.8 the least stresses give one negative
/// eigenvalue and others none, while the plate's only real motions are stable up to 1.979 (quadric of the self stress,
/// by hand).
#[test]
fn a_count_depends_on_no_self_stress() {
    for (load, known) in [(0.0, true), (0.2, true), (1.8, false)] {
        let assembly = plate(load);
        for seed in 0..4 {
            let model = assembly.model(Gauge::Held);
            let mut numbers = Numbers::new(seed);
            let start = model.start().into_iter().map(|x| x + if seed > 0 { numbers.within(1e-4) } else { 0.0 });
            let found = relax_from(&model, start.collect::<Vec<f64>>(), Options::default(), &mut |_| true).unwrap();
            let count = found.negative_eigenvalues;
            assert!(count == Some(0) || (count.is_none() && !known), "load {load}, seed {seed}: {count:?}");
            assert_eq!(found.self_stresses, Some(1));
        }
    }
}

/// Claim: along a path too a count of negative eigenvalues that hangs on a self stress is not known: none is more than 0
/// below the load 1.979 up to which the plate's real motions are stable, although the least stresses let it go before.
/// Source: as above.
#[test]
fn counts_along_a_path_depend_on_no_self_stress() {
    let load = Drive { quantity: Driven::Loads, to: 1.9 };
    let branches = follow_path(&plate(1.0), &load, None, &PathOptions::default(), &mut |_, _| true).unwrap();
    let branch = &branches[0];
    assert_eq!(branch.end, PathEnd::Arrived);
    let let_go = branch.points.iter().find(|point| point.event == Some(PathEvent::BranchPoint)).unwrap().drive;
    for point in branch.points.iter().filter(|point| point.event.is_none()) {
        let expected = if point.drive < let_go { Some(0) } else { None };
        assert_eq!(point.negative_eigenvalues, expected, "{} and {let_go}", point.drive);
    }
}
