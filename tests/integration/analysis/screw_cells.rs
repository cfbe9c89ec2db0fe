//! Tubes that a file draws as one cell, repeated by screw motions about the z axis.

use crate::common::{Scene, mesh};
use foldwell::analysis::modes::modes;
use foldwell::analysis::relax::relax;
use foldwell::model::{AssemblyError, RestLengths, RollError, Stiffness};
use foldwell::sheet::generate::Kresling;
use foldwell::sheet::{Corner, EdgeKind, Info, SeamKept, Sheet, fold};
use foldwell::{Assembly, Pattern, RIGID, Rest, Roll, generate};
use std::f64::consts::TAU;

/// Sides of the hexagons, and storeys of the ring.
const SIDES: usize = 6;
const STOREYS: usize = 7;

/// Returns a ring of the pattern of `kresling-cell.fold`.
fn ring() -> Sheet {
    generate(&Pattern::Kresling(Kresling { sides: SIDES, levels: Some(STOREYS), ..Kresling::default() })).unwrap()
}

/// Returns the tube of the one cell, with soft bars and creases that want to be flat.
fn tube() -> Assembly {
    let sheet = mesh("kresling-cell");
    let roll = Roll::as_drawn(&sheet, [SIDES as i32, 0], SeamKept::BOTH).unwrap();
    Assembly::tube(sheet, roll, [SIDES, 1]).bars(1e3).creases(1.0).rest(Rest::Flat).build().unwrap()
}

/// Returns the edge of the cell whose copy is this edge of the ring: along a hexagon, or up to the next vertex, or the
/// one after that.
fn of_cell(cell: &Sheet, ends: [usize; 2]) -> usize {
    let [from, to] = ends.map(|v| [(v % SIDES) as i32, (v / SIDES) as i32]);
    let steps = [(to[0] - from[0] + 1).rem_euclid(SIDES as i32) - 1, to[1] - from[1]];
    let same = |shift: [i32; 2]| shift == steps || shift.map(|n| -n) == steps;
    cell.edges.iter().position(|edge| same(edge.key.shift)).unwrap_or_else(|| panic!("{ends:?}: {steps:?}"))
}

/// Claim: the cell of a Kresling tube draws the ring of the generator: every copy of its vertex is a vertex of the
/// ring, and edges and fold angles are those of the ring. Tolerance: rounding of a sine.
#[test]
fn cell_and_ring_are_drawn_alike() {
    let (cell, ring) = (mesh("kresling-cell"), ring());
    for (v, place) in ring.vertices.iter().enumerate() {
        let copy = cell.position(Corner { vertex: 0, shift: [(v % SIDES) as i32, (v / SIDES) as i32] });
        assert!((copy - place).norm() < 1e-13, "vertex {v}: {copy} and {place}");
    }
    let length = |sheet: &Sheet, k: usize| {
        let [i, j] = sheet.edges[k].key.ends().map(|end| sheet.position(end));
        (j - i).norm()
    };
    for (k, edge) in ring.edges.iter().enumerate() {
        let own = of_cell(&cell, [edge.key.i, edge.key.j]);
        assert!((length(&ring, k) - length(&cell, own)).abs() < 1e-13);
        if let Some(angle) = ring.drawn_angle(edge) {
            assert!((angle - cell.drawn_angle(&cell.edges[own]).unwrap()).abs() < 1e-13);
        }
    }
}

/// Claim: a relaxed tube of one Kresling cell is an equilibrium of the ring built from it, whose model knows no screw
/// motion, and every edge has the energy of its copy. The ring has free ends, so its two outer rows of vertices at
/// either end are held where the tube has them. Tolerances: residuals of 1e-12 over the lowest stiffness of the ring,
/// which is 42.
#[test]
fn cell_and_ring_relax_alike() {
    let (case, mut sheet) = (tube(), ring());
    let found = relax(&case).unwrap();
    assert!(found.iterations > 1 && found.negative_eigenvalues == Some(0));
    let lengths = |sheet: &Sheet| -> Vec<f64> {
        let ends = sheet.edges.iter().map(|edge| edge.key.ends().map(|end| sheet.position(end)));
        ends.map(|[i, j]| (j - i).norm()).collect()
    };
    let rest = lengths(&sheet);
    let at = |v: usize| {
        let (x, turn) = (&found.state.coordinates, TAU * (v % SIDES) as f64 / SIDES as f64);
        // basis of the seam (6, 0): strands along the hexagon, rows up
        let (sin, cos) = (turn + (v / SIDES) as f64 * x[3]).sin_cos();
        [cos * x[0] - sin * x[1], sin * x[0] + cos * x[1], x[2] + (v / SIDES) as f64 * x[4]]
    };
    sheet.vertices = (0..sheet.vertices.len()).map(|v| at(v).into()).collect();
    // the stiffness of a hinge is per drawn length, and the ring is drawn as the tube relaxed
    let per_length = rest.iter().zip(lengths(&sheet)).map(|(rest, drawn)| rest / drawn).collect();
    let mut builder = Assembly::patch(sheet.clone(), [1, 1]).bars(1e3).rest_lengths(RestLengths::PerEdge(rest));
    builder = builder.creases(Stiffness::PerEdge(per_length)).rest(Rest::Flat);
    let outer = |v: usize| v / SIDES < 2 || v / SIDES > STOREYS - 2;
    for v in (0..sheet.vertices.len()).filter(|v| outer(*v)) {
        builder = builder.pin(v, [0, 0], [true; 3]);
    }
    let settled = relax(&builder.build().unwrap()).unwrap();
    for (v, place) in sheet.vertices.iter().enumerate() {
        let moved = (0..3).map(|a| (settled.state.coordinates[3 * v + a] - place[a]).abs()).fold(0.0, f64::max);
        assert!(moved < 1e-13, "vertex {v} moved by {moved:e}");
    }
    for (k, edge) in sheet.edges.iter().enumerate().filter(|(_, edge)| sheet.drawn_angle(edge).is_some()) {
        let own = of_cell(case.sheet(), [edge.key.i, edge.key.j]);
        let energies = [settled.state.energy[k], found.state.energy[own]];
        assert!((energies[0] - energies[1]).abs() < 1e-13, "{energies:?}");
    }
}

/// Claim: a helical Miura-ori tube of rigid panels, of the kind of Feng, Plucinsky and James (Phys. Rev. E 101, 033002
/// (2020)), closes and is developable, its panels are flat, and it is rigid, as they find. Tolerance: rounding of the
/// file.
#[test]
fn helical_miura_closes_and_is_rigid() {
    let sheet = mesh("helical-miura");
    for edge in sheet.edges.iter().filter(|edge| edge.kind == EdgeKind::Facet) {
        assert!(sheet.drawn_angle(edge).unwrap().abs() < 1e-12);
    }
    assert!(Info::new(&sheet).largest_angle_defect < 1e-12);
    let seam = [1, 8];
    let there = sheet.position(Corner { vertex: 0, shift: seam });
    assert!((there - sheet.vertices[0]).norm() < 1e-13);
    let roll = Roll::as_drawn(&sheet, seam, SeamKept::BOTH).unwrap();
    let case = Assembly::tube(sheet, roll, [1, 4]).bars(RIGID).creases(1.0).build().unwrap();
    let found = modes(&case, 0, &mut || true).unwrap();
    assert_eq!((found.zero_modes, found.rigid_motions), (2, 2));
    assert!(found.gap.unwrap() > 1e6, "{:?}", found.gap);
    // without closing conditions it folds, as its flat pattern does; either of them holds it
    let motions = found.seam.unwrap();
    assert_eq!([motions.free, motions.turn, motions.rise, motions.both], [1, 0, 0, 0]);
}

/// Claim: screw motions survive writing and reading, bit by bit.
#[test]
fn screws_in_files() {
    for name in ["kresling-cell", "helical-miura"] {
        let sheet = mesh(name);
        assert!(sheet.screws.is_some() && sheet.lattice.is_none());
        assert_eq!(fold::parse(&fold::write(&sheet), name).unwrap(), sheet);
    }
    let text = fold::write(&mesh("kresling-cell"));
    for (wrong, expected) in [
        (text.replacen("60.0", "400.0", 1), "turns of -360 to 360"),
        (text.replacen("\"turn\"", "\"angle\"", 1), "two screw motions about z"),
        (text.replacen("60.0", "0.0", 1), "span an area"),
    ] {
        let error = fold::parse(&wrong, "wrong.fold").unwrap_err().to_string();
        assert!(error.contains(expected), "{error}");
    }
}

/// Claim: what needs lattice vectors refuses a cell that screw motions repeat, and seams that do not close are refused
/// with what they miss.
#[test]
fn what_a_screw_cell_is_not() {
    let sheet = mesh("kresling-cell");
    for builder in [Assembly::torus, Assembly::fixed_torus, Assembly::screw] {
        assert_eq!(builder(sheet.clone(), [1, 1]).build().unwrap_err(), AssemblyError::DrawnAsTube);
    }
    let open = Roll::as_drawn(&sheet, [5, 0], SeamKept::BOTH).unwrap_err();
    assert!(open.to_string().contains("turns by 300"), "{open}");
    assert_eq!(Roll::as_drawn(&sheet, [0, 0], SeamKept::BOTH).unwrap_err(), RollError::NoSeam);
    assert_eq!(Roll::as_drawn(&mesh("open-star"), [0, 8], SeamKept::BOTH).unwrap_err(), RollError::NoScrews);
}

/// Claim: scenes of a drawn tube that cannot be are refused before anything is written, and every kind of study on a
/// patch of its cells is refused or ends with an answer or a reason.
#[test]
fn scenes_of_screw_cells() {
    let scene = |keys: &str, study: &str| {
        let energy = "[energy]\nbars = { stiffness = 1e3 }\ncreases = { stiffness = 1.0 }\n";
        let study = format!("{energy}[[study]]\nname = \"a\"\ndraw = []\n{study}");
        Scene::on(&format!("mesh = \"kresling-cell.fold\"\n{keys}"), &study)
    };
    for (keys, expected) in [
        ("domain = \"torus\"", "drawn as a tube"),
        ("domain = \"screw\"", "drawn as a tube"),
        ("domain = \"tube\"", "without a seam"),
        ("domain = \"tube\"\nseam = [5, 0]", "turns by 300"),
        ("domain = \"tube\"\nseam = [6, 1]", "rises by 0.8"),
        ("domain = \"tube\"\nseam = [6, 0]\ninwards = true", "`inwards`"),
    ] {
        scene(keys, "kind = \"modes\"").refused(expected);
    }
    for kind in ["relax", "modes", "branches", "surface", "landscape", "bloch", "wells", "response", "trace"] {
        match scene("cells = [3, 2]", &format!("kind = \"{kind}\"")).tried() {
            Ok(ran) => {
                let study = ran.study("a");
                assert!(study.converged == study.reason.is_none(), "{kind}: {study:?}");
                println!("{kind}: {:?}", study.reason);
            }
            Err(error) => {
                assert_eq!(error.exit_status(), 2, "{kind}: {error}");
                println!("{kind}: {error}");
            }
        }
    }
}
