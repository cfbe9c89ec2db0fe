//! The branches of flat and folded cells: counted with multiplicity, continued to finite folds, or refused.

use crate::common::{Numbers, Scene, mesh, on};
use foldwell::analysis::trace::{self, TraceOptions};
use foldwell::kinematics::{Closure, Ray, Rays, RealDirections, SecondOrder, drawn_fold_angles};
use foldwell::model::Boundary;
use foldwell::numerics::DenseMatrix;
use foldwell::numerics::dense::{least_squares, null_space};
use foldwell::sheet::generate::RandomDevelopable;
use foldwell::sheet::{EdgeKey, Pattern, Sheet, generate};
use nalgebra::DVector;
use serde_json::Value;
use std::f64::consts::PI;

fn flat_cell(size: [usize; 2], seed: u64) -> Sheet {
    generate(&Pattern::RandomDevelopable(RandomDevelopable { size, seed, ..RandomDevelopable::default() })).unwrap()
}

/// A state with a locked edge: its closure, quadrics and rays.
struct Locked {
    closure: Closure,
    second_order: SecondOrder,
    rays: Rays,
}

fn locked(sheet: &Sheet, lock: usize) -> Locked {
    let closure = Closure::of_cell(sheet).unwrap().with_locked(&[lock]);
    let second_order = SecondOrder::new(&closure, &drawn_fold_angles(sheet)).unwrap();
    let rays = Rays::new(&second_order).unwrap_or_else(|error| panic!("{} lock {lock}: {error}", sheet.description));
    Locked { closure, second_order, rays }
}

/// Returns the directions of the edges around a vertex of a flat cell, as angles, with the edges.
fn around(sheet: &Sheet, vertex: usize) -> Vec<(f64, usize)> {
    let mut list = Vec::new();
    for (number, edge) in sheet.edges.iter().enumerate() {
        let [from, to] = edge.key.ends().map(|corner| sheet.position(corner));
        let along = to - from;
        if edge.key.i == vertex {
            list.push((along.y.atan2(along.x), number));
        }
        if edge.key.j == vertex {
            list.push(((-along.y).atan2(-along.x), number));
        }
    }
    list
}

/// Whether the lock touches a vertex of degree 4, or two creases of a vertex are collinear to 1e-4.
fn special(sheet: &Sheet, lock: usize) -> bool {
    (0..sheet.vertices.len()).any(|vertex| {
        let edges = around(sheet, vertex);
        let off = |a: f64, b: f64| ((a - b).abs() - PI).abs();
        let straight = edges.iter().any(|(a, _)| edges.iter().any(|(b, _)| off(*a, *b) <= 1e-4));
        straight || (edges.len() == 4 && edges.iter().any(|(_, edge)| *edge == lock))
    })
}

/// Claim: with one lock the cell of `open-flat.json` has 16 solutions for each of its 12 edges, with as many distinct
/// ones and real rays as an independent plain homotopy found.
#[test]
fn one_lock_on_the_flat_reference_cell() {
    let sheet = mesh("open-flat");
    let reference: Value = serde_json::from_str(include_str!("../../cases/open-flat.json")).unwrap();
    let table = reference["one_lock"].as_array().unwrap();
    assert_eq!(table.len(), 12);
    for row in table {
        let name: [i32; 4] = serde_json::from_value(row["lock"].clone()).unwrap();
        let key = EdgeKey { i: name[0] as usize, j: name[1] as usize, shift: [name[2], name[3]], round: 0 };
        let lock = sheet.edges.iter().position(|edge| edge.key == key).unwrap();
        let Rays { expected, complex_solutions, distinct, rays, .. } = locked(&sheet, lock).rays;
        let found = [expected, complex_solutions, distinct, rays.len()];
        let wanted = [16, 16, row["distinct"].as_u64().unwrap() as usize, row["real_rays"].as_u64().unwrap() as usize];
        assert_eq!((found, row["paths_finished"].as_u64()), (wanted, Some(16)), "lock {name:?}");
    }
}

/// Claim: with one lock the multiplicities add up to 2^Nv, for 100 random flat cells of 4 vertices and 6 cells of 6,
/// without losing a path; all solutions are simple unless the lock touches a vertex of degree 4 or creases are
/// collinear to 1e-4. If it touches such a vertex, three creases remain there with one motion, and its square: every
/// solution is at least double. Source: theory (Bezout).
#[test]
fn multiplicities_add_up() {
    let mut doubled = 0;
    let cells = (0..100).map(|seed| ([2, 2], seed)).chain((0..6).map(|seed| ([3, 2], seed)));
    for (size, seed) in cells {
        let sheet = flat_cell(size, seed);
        let lock = seed as usize % sheet.edges.len();
        let Locked { second_order, rays, .. } = locked(&sheet, lock);
        let vertices = sheet.vertices.len();
        assert_eq!((second_order.count(), second_order.quadrics.len()), (vertices + 1, vertices), "{size:?} {seed}");
        assert_eq!([rays.expected, rays.complex_solutions, rays.on_continua], [1 << vertices, 1 << vertices, 0]);
        if special(&sheet, lock) {
            doubled += usize::from(rays.distinct < rays.complex_solutions);
        } else {
            assert_eq!(rays.distinct, rays.complex_solutions, "{size:?} {seed}");
        }
    }
    assert!(doubled >= 3, "multiple solutions were among them: {doubled}");
}

/// Returns the angles nearest to `start` that close, with prescribed components along the columns of `fixed`, by the
/// Gauss-Newton method, and the largest entry of the residual.
fn closed(closure: &Closure, start: &[f64], fixed: &DenseMatrix) -> (Vec<f64>, f64) {
    let mut angles = start.to_vec();
    for _ in 0..30 {
        let residual = closure.residual(&angles);
        if residual.amax() <= 1e-15 {
            break;
        }
        let jacobian = closure.jacobian(&angles);
        let edges = closure.folding_edges();
        let (rows, kept) = (jacobian.nrows(), fixed.ncols());
        let matrix = DenseMatrix::from_fn(rows + kept, edges.len(), |row, column| {
            if row < rows { jacobian[(row, column)] } else { fixed[(edges[column], row - rows)] }
        });
        let right = DenseMatrix::from_fn(rows + kept, 1, |row, _| if row < rows { -residual[row] } else { 0.0 });
        let step = solve(&matrix, &right);
        edges.iter().zip(step.iter()).for_each(|(&edge, change)| angles[edge] += change);
    }
    let residual = closure.residual(&angles).amax();
    (angles, residual)
}

/// Solves least squares by orthogonal factorization, because near the flat state no rank is well defined.
fn solve(matrix: &DenseMatrix, right: &DenseMatrix) -> DenseMatrix {
    let factors = matrix.clone().qr();
    let parts = factors.q().transpose() * right;
    factors.r().solve_upper_triangular(&parts).unwrap()
}

/// Follows a ray until a fold angle has changed by `far`; returns the state and its residual there.
fn continued(locked: &Locked, start: &[f64], ray: &Ray, far: f64) -> Option<(Vec<f64>, f64)> {
    let mut at = start.to_vec();
    let mut direction = DVector::from_column_slice(&ray.direction);
    let mut step = 0.01;
    for _ in 0..200 {
        let guess: Vec<f64> = at.iter().zip(direction.iter()).map(|(angle, rate)| angle + step * rate).collect();
        let (found, residual) = closed(&locked.closure, &guess, &DenseMatrix::from_columns(&[direction.clone()]));
        let moved = DVector::from_iterator(at.len(), found.iter().zip(&at).map(|(a, b)| a - b));
        let good = residual <= 1e-12 && (&moved / step - &direction).norm() <= 0.3;
        if !good {
            step *= 0.5;
            if step < 1e-4 {
                return None;
            }
            continue;
        }
        at = found;
        direction = moved.normalize();
        step = (1.3 * step).min(0.03);
        if at.iter().zip(start).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) >= far {
            return Some((at, residual));
        }
    }
    None
}

/// Claim: every simple real ray is a branch: Newton steps on the closure only continue it until a fold angle has
/// changed by 0.2 rad, where it closes to 1e-12 and is still on its own side. Rays of the reference cells and of random
/// flat cells.
#[test]
fn simple_rays_extend_to_finite_folds() {
    let random = (0..6).map(|seed| (flat_cell([2, 2], seed), seed as usize));
    let sheets = [(mesh("open-flat"), 0), (mesh("open-flat"), 4), (mesh("open-star"), 0), (flat_cell([3, 2], 1), 0)];
    let mut followed = 0;
    for (sheet, lock) in sheets.into_iter().chain(random) {
        let (drawn, locked) = (drawn_fold_angles(&sheet), locked(&sheet, lock));
        for ray in locked.rays.rays.iter().filter(|ray| ray.multiplicity == 1) {
            let (folded, residual) = continued(&locked, &drawn, ray, 0.2).unwrap_or_else(|| {
                panic!("{} lock {lock}: branch {} sign {}", sheet.description, ray.branch, ray.sign)
            });
            assert!(residual <= 1e-12);
            let along: f64 = folded.iter().zip(&drawn).zip(&ray.direction).map(|((a, b), rate)| (a - b) * rate).sum();
            assert!(along > 0.1, "{along}");
            followed += 1;
        }
    }
    assert!(followed >= 100, "{followed}");
}

/// Claim: a direction that is not a solution does not extend: the least closure residual of angles with this linear
/// part grows as the square of the amplitude, with the obstruction as its coefficient. Tolerance 2%: the cubic terms at
/// amplitudes of 1e-3.
#[test]
fn other_directions_are_refused() {
    let mut numbers = Numbers::new(4);
    for (sheet, lock) in [(mesh("open-flat"), 0), (mesh("open-star"), 0), (flat_cell([2, 2], 3), 5)] {
        let drawn = drawn_fold_angles(&sheet);
        let Locked { closure, second_order, .. } = locked(&sheet, lock);
        let left = null_space(&closure.jacobian(&drawn).transpose()).unwrap().basis;
        for _ in 0..5 {
            let x = DVector::from_vec(numbers.many(second_order.count(), 1.0)).normalize();
            let obstruction =
                second_order.forms.iter().map(|form| (x.transpose() * form * &x)[0].powi(2)).sum::<f64>().sqrt();
            let defect = |amplitude: f64| {
                let start = DVector::from_column_slice(&drawn) + &second_order.modes * &x * amplitude;
                let correction = corrected(&closure, &drawn, start.as_slice());
                (left.transpose() * closure.residual(&correction)).norm() / (amplitude * amplitude)
            };
            for amplitude in [1e-2, 1e-3] {
                let relative = (defect(amplitude) / obstruction - 1.0).abs();
                assert!(obstruction > 1e-3 && relative <= 20.0 * amplitude, "{obstruction:e} {relative:e}");
            }
        }
    }
}

/// Returns the second-order correction that minimises the closure residual.
fn corrected(closure: &Closure, drawn: &[f64], start: &[f64]) -> Vec<f64> {
    let residual = closure.residual(start);
    let right = DenseMatrix::from_column_slice(residual.len(), 1, (-residual).as_slice());
    let step = least_squares(&closure.jacobian(drawn), &right).unwrap().solution;
    let mut angles = start.to_vec();
    closure.folding_edges().iter().zip(step.iter()).for_each(|(&edge, change)| angles[edge] += change);
    angles
}

/// Returns directions, in the order of the mesh, in which an independent program left open-star, and the curvature of
/// each.
fn rays_of_open_star() -> Vec<(Vec<f64>, f64)> {
    let sheet = mesh("open-star");
    let case: Value = serde_json::from_str(include_str!("../../cases/open-star.json")).unwrap();
    let names: Vec<[i32; 4]> = serde_json::from_value(case["edge_list"].clone()).unwrap();
    let place = |key: &EdgeKey| [key.i as i32, key.j as i32, key.shift[0], key.shift[1]];
    let at = |key: &EdgeKey| names.iter().position(|name| *name == place(key)).unwrap();
    let ray = |start: &Value| {
        let same = |state: &&Value| state["branch"] == start["branch"] && state["sign"] == start["sign"];
        let kappa = case["states"].as_array().unwrap().iter().find(same).unwrap()["kappa"].as_f64().unwrap();
        (sheet.edges.iter().map(|edge| start["start"][at(&edge.key)].as_f64().unwrap()).collect(), kappa)
    };
    case["loops"].as_array().unwrap().iter().map(ray).collect()
}

/// Claim: the study writes the documented files, for a flat cell and for a cell without real ray, and refuses a torus
/// and a lock at another angle. No real ray is a result: status 0.
#[test]
fn the_study() {
    let run = |domain: &str, mesh: &str, lock: &str| {
        let study = format!("[[lock]]\n{lock}\n[[study]]\nname = \"b\"\nkind = \"branches\"\n");
        let said = Scene::on(&format!("mesh = \"{mesh}\"\ndomain = \"{domain}\""), &study).program("--json");
        let table = if said.folder.has("b.csv") { said.folder.text("b.csv") } else { String::new() };
        (said.status, serde_json::from_str::<Value>(&said.out).unwrap_or_default(), table)
    };
    let (status, summary, table) = run("screw", "open-flat.fold", "crease = [0, 1, 0, 0]");
    let study = &summary["studies"][0];
    assert_eq!((status, &study["converged"]), (Some(0), &Value::from(true)));
    for (key, value) in [("complex_solutions", 16), ("distinct", 16), ("expected", 16), ("real_rays", 28)] {
        assert_eq!(study[key], value, "{key}");
    }
    assert_eq!((study["rays"].as_array().unwrap().len(), table.lines().count()), (28, 29));
    for pair in study["rays"].as_array().unwrap().chunks_exact(2) {
        let signs = [0, 1].map(|k: usize| pair[k]["curvature_sign"].as_i64().unwrap());
        assert!(signs[0] == -signs[1] && signs[0] != 0);
        assert_eq!(pair[0]["direction"].as_array().unwrap().len(), 12);
    }
    assert!(table.starts_with("branch,sign,multiplicity,curvature_sign,error,rate_0_1_0_0,"), "{table}");
    let (_, summary, _) = run("screw", "open-star.fold", "crease = [0, 1, 0, 0]");
    assert_eq!(summary["studies"][0]["signature"], serde_json::json!([1, 1, 0]));
    for (start, kappa) in rays_of_open_star() {
        let rays = summary["studies"][0]["rays"].as_array().unwrap();
        let along =
            |ray: &&Value| (0..12).map(|k| ray["direction"][k].as_f64().unwrap() * start[k]).sum::<f64>() > 1.0 - 1e-8;
        let ray = rays.iter().find(along).unwrap();
        assert_eq!(ray["curvature_sign"].as_i64().unwrap() as f64, kappa.signum());
    }
    let (status, summary, table) = run("screw", "miura.fold", "crease = [0, 1, 0, 0]");
    let study = &summary["studies"][0];
    assert_eq!(
        (status, &study["real_rays"], &study["converged"]),
        (Some(0), &Value::from(0), &Value::from(true)),
        "{study}"
    );
    assert_eq!(table.lines().count(), 1);
    assert_eq!(run("torus", "open-flat.fold", "crease = [0, 1, 0, 0]").0, Some(2));
    assert_eq!(run("screw", "open-flat.fold", "crease = [0, 1, 0, 0]\nangle = 0.1").0, Some(2));
}

/// Claim: an empty list of rays is reported as complete only if this is established. The folded cell of
/// `open-star.fold`, without locks, folds along a cone of directions (its quadric has signature (2, 1)), the flat one
/// of `open-flat.fold` along a curve of them: neither has an isolated ray, and `trace` refuses both instead of calling
/// them rigid. With a lock all solutions are points, and each is counted. Source: theory, second order; the cone of the
/// star is real because cylinders exist.
#[test]
fn no_ray_is_not_no_direction() {
    for name in ["open-star", "open-flat"] {
        let sheet = mesh(name);
        let angles = drawn_fold_angles(&sheet);
        let closure = Closure::of_cell(&sheet).unwrap();
        let free = Rays::new(&SecondOrder::new(&closure, &angles).unwrap()).unwrap();
        assert_eq!((free.rays.len(), free.directions), (0, RealDirections::Continuum), "{name}");
        let one = Rays::new(&SecondOrder::new(&closure.with_locked(&[0]), &angles).unwrap()).unwrap();
        assert_eq!(one.directions, RealDirections::Listed, "{name}");

        let cell = on(sheet, [1, 1], Boundary::Screw);
        let options = TraceOptions { max_step: 0.1, tolerance: 1e-13, branch: None, stop: trace::Stop::default() };
        let refused = trace::trace(&cell, &options, None, &mut |_, _| true);
        assert!(matches!(refused, Err(trace::TraceError::Continuum)), "{name}: {refused:?}");
    }
}

/// Claim: the only direction of the triangulated Miura-ori without locks, planar folding, is listed as the only one:
/// two of the three eigenvalues of its quadric have one sign and the third is zero (-0.125, -0.117, 0 in theory).
#[test]
fn a_single_direction_is_established() {
    let sheet = generate(&Pattern::Miura(foldwell::sheet::generate::Miura::default())).unwrap();
    let closure = Closure::of_cell(&sheet).unwrap();
    let rays = Rays::new(&SecondOrder::new(&closure, &drawn_fold_angles(&sheet)).unwrap()).unwrap();
    assert_eq!((rays.rays.len(), rays.directions), (2, RealDirections::Listed));
}
