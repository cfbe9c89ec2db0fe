//! Linear buckling against Euler loads of a column of links, an octahedron written out by hand, and branch points of paths.
//!
//! Source: a column of `n` stiff links of length `a`, hinged to each other with springs `c` and held at its ends, buckles at
//! the loads `2 c (1 - cos(m pi / n)) / a` (S. P. Timoshenko and J. M. Gere, "Theory of elastic stability", 1961, 2.10, for
//! links that are the column's finite differences).

use crate::common::Scene;
use foldwell::analysis::modes::{ModesError, buckling};
use foldwell::math::Vec3;
use foldwell::model::OwnTerm;
use foldwell::sheet::fold;
use foldwell::{Assembly, RIGID, relax};
use nalgebra::{DMatrix, SymmetricEigen};
use std::f64::consts::PI;

/// Links of the column.
const LINKS: usize = 8;
/// Their length, and their width.
const SIDES: [f64; 2] = [0.5, 1.0];

/// A column of links, hinged along their widths, pressed at its end with a force of `load`, in these units of length and
/// force.
fn column([bars, facets]: [f64; 2], load: f64, unit: f64) -> Assembly {
    let [a, width] = SIDES.map(|side| side * unit);
    let points: Vec<[f64; 3]> = (0..=LINKS).flat_map(|k| [0.0, width].map(|y| [a * k as f64, y, 0.0])).collect();
    let faces: Vec<[usize; 4]> = (0..LINKS).map(|k| [2 * k, 2 * k + 2, 2 * k + 3, 2 * k + 1]).collect();
    let sheet =
        fold::parse(&format!("{{\"vertices_coords\": {points:?}, \"faces_vertices\": {faces:?}}}"), "c").unwrap();
    let last = 2 * LINKS;
    let held = Assembly::patch(sheet, [1, 1]).bars(bars).creases(1.0).facets(facets).pin(0, [0, 0], [true; 3]);
    let held = held.pin(1, [0, 0], [true, false, true]);
    let held = held.pin(last, [0, 0], [false, false, true]).pin(last + 1, [0, 0], [false, false, true]);
    let force = [-0.5 * load, 0.0, 0.0];
    held.load(last, [0, 0], force).load(last + 1, [0, 0], force).build().unwrap()
}

/// The Euler loads of the column. The stiffness of a crease is one per length, so that `c` is its width.
fn euler(mode: usize, unit: f64) -> f64 {
    2.0 * SIDES[1] * unit / (SIDES[0] * unit) * (1.0 - (PI * mode as f64 / LINKS as f64).cos())
}

/// Claim: a column of links has the Euler loads, with rigid bars and with ones that are stiff, drawn without loads and
/// relaxed under a part of the first, in other units; with pressed bars the loads are as much larger as the strain. Tolerance:
/// 1e-9 for rigid bars; for others four times the strain at the load.
#[test]
fn a_column_has_its_euler_loads() {
    for (bars, unit) in [(RIGID, 1.0), (RIGID, 1e3), (1e8, 1.0), (1e12, 1.0), (1e5, 1.0), (1e8, 1e-2)] {
        // panels of softer bars are sheared by a load, and hinge lines that are not parallel block the first mode
        for start in [false, true].into_iter().filter(|start| !start || bars > 1e7) {
            let assembly = column([bars, RIGID], 0.2, unit);
            let state = start.then(|| relax(&assembly).unwrap().configuration);
            let found = buckling(&assembly, state.as_ref(), 4, &mut || true).unwrap();
            assert_eq!((found.factors.len(), found.vectors.len()), (4, 4));
            for (k, factor) in found.factors.iter().enumerate() {
                let expected = euler(k + 1, unit);
                let tolerance = 1e-9 + 4.0 * expected / bars;
                let off = (0.2 * factor / expected - 1.0).abs();
                assert!(off < tolerance, "EA {bars:e}, unit {unit}, start {start}: {} {expected}", 0.2 * factor);
            }
            // the first mode is half a wave of the heights
            let heights: Vec<f64> = (0..=LINKS).map(|k| found.vectors[0][6 * k + 2]).collect();
            let middle = heights[LINKS / 2];
            for (k, height) in heights.iter().enumerate() {
                let wave = (PI * k as f64 / LINKS as f64).sin();
                assert!((height / middle - wave).abs() < 1e-6, "unit {unit}: {heights:?}");
            }
        }
    }
}

/// Claim: seen from states on the way there the critical load of a column of soft bars approaches the branch point of its
/// path, which is found without any linearization: from a third of the distance three times as well, since the motion up to
/// there is left out. Tolerance: a factor of one and a half on the three, for higher orders; a thousandth of the load, a tenth
/// of the strain of the bars, which is 0.015.
#[test]
fn critical_loads_approach_branch_points() {
    let scene = "[sheet]\nmesh = \"column.fold\"\n[energy]\nbars = { stiffness = 20 }\ncreases = { stiffness = 1 }\nfacets = { stiffness = 10 }\n[[pin]]\nvertex = 0\n\
                 [[pin]]\nvertex = 1\naxes = \"xz\"\n[[pin]]\nvertices = [16, 17]\naxes = \"z\"\n[[load]]\nvertices = [16, 17]\n\
                 force = [-0.5, 0, 0]\n[[drive]]\nname = \"load\"\nload = true\nto = 0.4\n[[study]]\nname = \"pressed\"\nkind = \"path\"\n\
                 draw = []\n";
    let points: Vec<[f64; 3]> = (0..=LINKS).flat_map(|k| [0.0, 1.0].map(|y| [0.5 * k as f64, y, 0.0])).collect();
    let faces: Vec<[usize; 4]> = (0..LINKS).map(|k| [2 * k, 2 * k + 2, 2 * k + 3, 2 * k + 1]).collect();
    let mesh = format!("{{\"vertices_coords\": {points:?}, \"faces_vertices\": {faces:?}}}");
    let ran = Scene::new(scene).with("column.fold", mesh).converged();
    let events = &ran.path("pressed").branches[0].events;
    let exact = events.iter().find(|event| event.event == "branch-point").and_then(|event| event.drive).unwrap();
    let error = |part: f64| {
        let assembly = column([20.0, 10.0], part * exact, 1.0);
        let state = relax(&assembly).unwrap().configuration;
        exact * (part * buckling(&assembly, Some(&state), 1, &mut || true).unwrap().factors[0] - 1.0)
    };
    let [near, far] = [0.9, 0.7].map(error);
    let ratio = far.abs() / near.abs();
    assert!(near.abs() < 1e-3 * exact && (2.0..4.5).contains(&ratio), "{exact}: {near} {far}");
}

/// Vertices of an octahedron, of which the first three are held: of no symmetry, and of that of a triangle.
const GENERIC: [[f64; 3]; 6] =
    [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [-1.0, 0.1, 0.0], [0.0, -1.1, 0.2], [0.1, 0.0, -1.2]];
const SYMMETRIC: [[f64; 3]; 6] =
    [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [-1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, -1.0]];
/// Faces of both, with normals outwards.
const FACES: [[usize; 3]; 8] = [[0, 1, 2], [1, 3, 2], [3, 4, 2], [4, 0, 2], [1, 0, 5], [3, 1, 5], [4, 3, 5], [0, 4, 5]];

/// The critical pressures of an octahedron of bars, ascending, relative to this pressure from inside, by the matrices written
/// out by hand: `EA/L0 d d^T` for the stiffness of a bar, `N (1 - d d^T) / L0` for the geometric stiffness, and the second
/// derivatives of the volume, by differences, which are exact for a cubic.
fn critical_pressures(octahedron: [[f64; 3]; 6], pressure: f64) -> Vec<f64> {
    let points = octahedron.map(Vec3::from);
    let mut bars: Vec<[usize; 2]> = FACES.iter().flat_map(|[a, b, c]| [[*a, *b], [*b, *c], [*c, *a]]).collect();
    bars.iter_mut().for_each(|bar| bar.sort_unstable());
    bars.sort_unstable();
    bars.dedup();
    let volume = |x: &[f64]| {
        let at = |v: usize| if v < 3 { points[v] } else { Vec3::from_column_slice(&x[3 * v - 9..3 * v - 6]) };
        FACES.iter().map(|[a, b, c]| at(*a).cross(&at(*b)).dot(&at(*c)) / 6.0).sum::<f64>()
    };
    let free: Vec<f64> = points[3..].iter().flat_map(|p| [p.x, p.y, p.z]).collect();
    let moved = |steps: &[(usize, f64)]| {
        let mut x = free.clone();
        steps.iter().for_each(|(k, step)| x[*k] += step);
        volume(&x)
    };
    let slope = |k: usize| (moved(&[(k, 1.0)]) - moved(&[(k, -1.0)])) / 2.0;
    let bend = |j: usize, k: usize| {
        let corner = |a: f64, b: f64| moved(&[(j, a), (k, b)]);
        -pressure * (corner(1.0, 1.0) - corner(1.0, -1.0) - corner(-1.0, 1.0) + corner(-1.0, -1.0)) / 4.0
    };
    let put = |matrix: &mut DMatrix<f64>, [a, b]: [usize; 2], block: nalgebra::Matrix3<f64>| {
        for (row, column, sign) in [(a, a, 1.0), (b, b, 1.0), (a, b, -1.0), (b, a, -1.0)] {
            if row >= 3 && column >= 3 {
                let mut at = matrix.view_mut((3 * row - 9, 3 * column - 9), (3, 3));
                at += block * sign;
            }
        }
    };
    let direction = |[a, b]: [usize; 2]| (points[b] - points[a]).normalize();
    let length = |[a, b]: [usize; 2]| (points[b] - points[a]).norm();
    let mut stiffness = DMatrix::zeros(9, 9);
    bars.iter().for_each(|&bar| put(&mut stiffness, bar, direction(bar) * direction(bar).transpose() / length(bar)));
    let load = pressure * nalgebra::DVector::from_fn(9, |k, _| slope(k));
    let response = stiffness.clone().lu().solve(&load).unwrap();
    let at = |v: usize| if v < 3 { Vec3::zeros() } else { response.fixed_rows::<3>(3 * v - 9).into() };
    let mut growth = DMatrix::from_fn(9, 9, bend);
    for &bar in &bars {
        let tension = direction(bar).dot(&(at(bar[1]) - at(bar[0]))) / length(bar);
        let across = nalgebra::Matrix3::identity() - direction(bar) * direction(bar).transpose();
        put(&mut growth, bar, across * tension / length(bar));
    }
    let root = SymmetricEigen::new(stiffness);
    let scaled = DMatrix::from_fn(9, 9, |row, k| root.eigenvectors[(row, k)] / root.eigenvalues[k].sqrt());
    let mut values: Vec<f64> = (scaled.transpose() * growth * scaled).symmetric_eigenvalues().iter().copied().collect();
    values.sort_by(f64::total_cmp);
    values.iter().filter(|value| **value < -1e-12).map(|value| -value.recip()).collect()
}

/// Claim: an octahedron of bars under pressure from outside and from inside, three of its vertices held, has the critical
/// pressures of matrices written out by hand, however many are asked for; of one that two motions share both are there.
/// Tolerance: 1e-8, rounding of the differences.
#[test]
fn pressure_has_a_stiffness_of_its_own() {
    for (octahedron, pressure) in [(GENERIC, -1.0), (GENERIC, 1.0), (SYMMETRIC, -1.0), (SYMMETRIC, 1.0)] {
        let expected = critical_pressures(octahedron, pressure);
        let mesh = format!("{{\"vertices_coords\": {octahedron:?}, \"faces_vertices\": {FACES:?}}}");
        let held = Assembly::patch(fold::parse(&mesh, "octahedron").unwrap(), [1, 1]).bars(1.0);
        let held = (0..3).fold(held, |held, vertex| held.pin(vertex, [0, 0], [true; 3])).build().unwrap();
        let pressed = held.with_own_term(OwnTerm::pressure(&held, "", pressure, |_| true).unwrap());
        for wanted in 1..=9 {
            let found = buckling(&pressed, None, wanted, &mut || true).unwrap().factors;
            let last = expected[wanted.min(expected.len()) - 1];
            let count = expected.iter().filter(|factor| **factor < last * (1.0 + 1e-7)).count();
            assert_eq!(found.len(), count, "{wanted} of {expected:?}: {found:?}");
            for (found, expected) in found.iter().zip(&expected) {
                assert!((found - expected).abs() < 1e-8 * expected, "{found} {expected}");
            }
        }
    }
}

/// Claim: what is not loaded, not held, no equilibrium or beyond its critical load has no critical factors, and says so;
/// loads that pull give none. Source: the column.
#[test]
fn what_cannot_buckle_says_so() {
    let none = |assembly: &Assembly| buckling(assembly, None, 2, &mut || true);
    let straight = column([1e4, RIGID], 0.0, 1.0);
    assert!(matches!(none(&straight), Err(ModesError::Loads(_))), "a load of zero is none");
    assert_eq!(none(&column([1e4, RIGID], -0.2, 1.0)).unwrap().factors, Vec::<f64>::new(), "it is pulled");
    let over = column([1e4, RIGID], 2.0 * euler(1, 1.0), 1.0);
    let bent = relax(&over).unwrap().configuration;
    let state = foldwell::model::Configuration { coordinates: over.drawn().coordinates.clone(), ..bent };
    assert!(matches!(buckling(&over, Some(&state), 2, &mut || true), Err(ModesError::NotStable { .. })));
    assert!(matches!(buckling(&column([1e4, RIGID], 0.2, 1.0), None, 2, &mut || false), Err(ModesError::Interrupted)));
}

/// Claim: a scene asks for the factors, which stand in the summary, a table and pictures; without loads it is refused.
#[test]
fn scenes_ask_for_critical_loads() {
    let ran = Scene::of("column-buckling").converged();
    let table = ran.out.table("buckled-buckling.csv");
    let load = table.at(0, "factor") * 0.2;
    assert!((load - euler(1, 1.0)).abs() < 1e-6, "{load}");
    let modes = ran.out.json("summary.json")["studies"][0]["critical_factors"].clone();
    assert_eq!(modes.as_array().map(Vec::len), Some(3), "{}", ran.out.text("summary.json"));
    for file in ["buckled-buckling.svg", "buckled-buckling.pvd", "buckled/buckled_buckling_0002.vtu"] {
        assert!(ran.out.has(file), "{file}");
    }
    let no_load = "[energy]\ncreases = { stiffness = 1 }\n[[study]]\nname = \"b\"\nkind = \"modes\"\nbuckling = 2\n";
    Scene::on("generate = { pattern = \"miura\" }\ndomain = \"patch\"", no_load).refused("no loads under which");
}

/// Claim: critical factors that depend on the self stress of redundant rigid bars are refused, and bars of a stiffness have
/// them. Source: a plate of four triangles, one self stress; with bars of EA = 1e8 its least factor is 1.454258 (dense
/// Hessians by differences).
#[test]
fn factors_that_depend_on_a_self_stress_are_refused() {
    let scene = |bars: &str| {
        let pins = "[[pin]]\nvertex = 0\n[[pin]]\nvertex = 1\naxes = \"yz\"\n[[pin]]\nvertex = 3\naxes = \"z\"\n";
        let force = "0.8376105968386142, 0.5462677805469224, 0.0]\n";
        let minus = "-0.8376105968386142, -0.5462677805469224, 0.0]\n";
        let loads = format!("[[load]]\nvertex = 0\nforce = [{force}[[load]]\nvertex = 2\nforce = [{minus}");
        let energy = format!("[energy]\nbars = {{ stiffness = {bars} }}\ncreases = {{ stiffness = 1.0 }}\n");
        let study = "[[study]]\nname = \"b\"\nkind = \"modes\"\nbuckling = 1\ndraw = []";
        Scene::on("mesh = \"cases/plate.fold\"", &format!("{energy}{pins}{loads}{study}"))
    };
    let stiff = scene("1e8").converged();
    assert!((stiff.out.table("b-buckling.csv").at(0, "factor") - 1.454258).abs() < 1e-5);
    let rigid = scene("inf").ran();
    let said = rigid.json().to_string();
    assert!(said.contains("depend on which self stress"), "{said}");
}

/// Claim: what presses a rigid part turns with it: a plate on a hinge of stiffness `c`, pressed towards the hinge at the
/// distance `a`, falls over at the load `c / a`, with its end as a part and without. Source: the pendulum that stands on its
/// head. Tolerance: 1e-12, of rounding, as all of the plate is rigid.
#[test]
fn loads_turn_with_parts() {
    let points = [[-1.0, 0.0], [-1.0, 1.0], [0.0, 0.0], [0.0, 1.0], [1.0, 0.0], [1.0, 1.0], [1.5, 0.5]]
        .map(|[x, y]| [x, y, 0.0]);
    let sheet = format!("{{\"vertices_coords\": {points:?}, \"faces_vertices\": [[0, 2, 3, 1], [2, 4, 6, 5, 3]]}}");
    for with_part in [false, true] {
        let sheet = fold::parse(&sheet, "plate").unwrap();
        let built = Assembly::patch(sheet, [1, 1]).bars(RIGID).creases(0.3).load(6, [0, 0], [-0.1, 0.0, 0.0]);
        let held = (0..4).fold(built, |built, vertex| built.pin(vertex, [0, 0], [true; 3]));
        let part = [4, 5, 6].map(|vertex| (vertex, [0, 0]));
        let assembly = if with_part { held.part(part, [true; 6]) } else { held }.build().unwrap();
        let found = buckling(&assembly, None, 1, &mut || true).unwrap();
        let load = 0.1 * found.factors[0];
        assert!((load - 0.3 / 1.5).abs() <= 1e-12, "with part {with_part}: {load}");
    }
}
