//! Trajectories of rigid folding compared with an independent program and closed forms.

use crate::common::{self, on};
use approx::{abs_diff_eq, assert_abs_diff_eq};
use foldwell::analysis::branches::branches;
use foldwell::analysis::trace::{Stop, TraceOptions, Traced, trace};
use foldwell::kinematics::{Embedding, Shape, drawn_fold_angles};
use foldwell::model::{Boundary, Hinges, Terms};
use foldwell::sheet::{EdgeKey, Sheet};
use foldwell::solver::continuation::End;
use serde_json::Value;

const REFERENCE: &str = include_str!("../../cases/open-star.json");

fn edge(sheet: &Sheet, [i, j, n1, n2]: [i64; 4]) -> usize {
    let key = EdgeKey { i: i as usize, j: j as usize, shift: [n1 as i32, n2 as i32], round: 0 };
    sheet.edges.iter().position(|edge| edge.key == key).unwrap()
}

/// Follows the sheet with these edges locked.
fn run(sheet: &Sheet, locks: &[usize], stop: Stop, branch: Option<usize>) -> Vec<Traced> {
    let drawn = on(sheet.clone(), [1, 1], Boundary::Screw);
    let locks = locks.iter().map(|&edge| (edge, drawn.drawn_angles()[edge])).collect();
    let options = TraceOptions { max_step: 0.25, tolerance: 3e-14, branch, stop };
    trace(&drawn.with_terms(Terms { locks, ..Terms::default() }), &options, None, &mut |_, _| true).unwrap()
}

fn star() -> (Sheet, usize, Value) {
    let sheet = common::mesh("open-star");
    let held = edge(&sheet, [0, 1, 0, 0]);
    (sheet, held, serde_json::from_str(REFERENCE).unwrap())
}

/// Returns the indices of the sheet's edges in the reference's list.
fn places(sheet: &Sheet, reference: &Value) -> Vec<usize> {
    let named = |key: &EdgeKey| serde_json::json!([key.i, key.j, key.shift[0], key.shift[1]]);
    let list = reference["edge_list"].as_array().unwrap();
    sheet.edges.iter().map(|edge| list.iter().position(|entry| *entry == named(&edge.key)).unwrap()).collect()
}

/// Claim: the four trajectories of the reference cell with edge (0, 1, 0, 0) locked close after 9.9314250 and
/// 50.2037156, each loop from both of its ends, which are rays of the same sign of curvature; they arrive along a ray,
/// not smoothly. Closure, commuting rotations and bar lengths hold to 1e-13 along the whole way. Lengths within 1e-6:
/// the digits that the independent program gives.
#[test]
fn loops_of_open_star() {
    let (sheet, held, reference) = star();
    let places = places(&sheet, &reference);
    let found = run(&sheet, &[held], Stop::default(), None);
    assert_eq!(found.len(), 4);
    for one in &found {
        let direction = &one.states[0].rates;
        let same = |entry: &&Value| {
            let start: f64 = places.iter().zip(direction).map(|(&k, d)| entry["start"][k].as_f64().unwrap() * d).sum();
            start > 0.999
        };
        let expected = reference["loops"].as_array().unwrap().iter().find(same).unwrap();
        let End::Closed(back) = &one.end else { panic!("{:?}", one.end) };
        let length = expected["arc_length"].as_f64().unwrap();
        println!(
            "{:?} -> {:?}: {} ({:e}), {} states, {} corrections",
            one.branch,
            one.ends_at,
            back.arc_length,
            back.arc_length - length,
            one.states.len(),
            one.corrections
        );
        assert!(abs_diff_eq!(back.arc_length, length, epsilon = 1e-6), "{} for {length}", back.arc_length);
        let end = one.ends_at.expect("it arrives along a ray");
        let other = found.iter().find(|other| other.branch == end).unwrap();
        assert_eq!(other.ends_at, Some(one.branch), "the loop seen from its other end");
        assert!(end != one.branch);
        for state in &one.states {
            let shape = state.shape.as_ref().unwrap();
            assert!(state.residual <= 1e-13 && shape.compatibility <= 1e-13, "{:?}", shape.compatibility);
        }
    }
}

/// Claim: states that an independent program stored on these trajectories are reproduced: at the given angle of the
/// given crease all fold angles, curvature, rotation angles and strain agree to 1e-9; and curvatures have the same sign
/// for the single state, without its trajectory.
#[test]
fn stored_states_are_met() {
    let (sheet, held, reference) = star();
    let places = places(&sheet, &reference);
    for state in reference["states"].as_array().unwrap() {
        let mark: [i64; 4] = serde_json::from_value(state["mark"].clone()).unwrap();
        let angle = state["mark_angle"].as_f64().unwrap();
        let stop = Stop { crease_angle: Some((edge(&sheet, mark), angle)), ..Stop::default() };
        let numbers = |name: &str| -> Vec<f64> { serde_json::from_value(state[name].clone()).unwrap() };
        let angles: Vec<f64> = places.iter().map(|&k| numbers("fold_angles")[k]).collect();
        let close = |a: &[f64], b: &[f64]| a.iter().zip(b).all(|(a, b)| abs_diff_eq!(a, b, epsilon = 1e-9));
        let met = run(&sheet, &[held], stop, None).into_iter().any(|one| {
            let last = one.states.last().unwrap();
            let shape = last.shape.as_ref().unwrap();
            close(&last.angles, &angles)
                && abs_diff_eq!(shape.curvature, state["kappa"].as_f64().unwrap(), epsilon = 1e-9)
                && close(&shape.theta, &numbers("theta"))
                && close(&shape.strain, &numbers("strain"))
        });
        assert!(met, "{state}");
        let single = Shape::at(&Embedding::new(&sheet).unwrap(), &angles).unwrap();
        assert_abs_diff_eq!(single.curvature, state["kappa"].as_f64().unwrap(), epsilon = 1e-9);
    }
}

/// Claim: a stop is also met near the drawn state, where branches cross and no correction converges: a curvature, an
/// arc length or a crease's change of 1e-12 to 1e-8 ends every trajectory there and not at the end of the first step,
/// 1e-2. Tolerance 1e-10: ten times that to which stops are located.
#[test]
fn stops_next_to_the_start_are_met() {
    let (sheet, held, _) = star();
    let moving = edge(&sheet, [2, 3, 0, 0]);
    let drawn = drawn_fold_angles(&sheet)[moving];
    for size in [1e-12, 1e-9, 2e-9, 1e-8] {
        let curvature = Stop { curvature: Some(size), ..Stop::default() };
        let all = run(&sheet, &[held], curvature, None);
        assert_eq!(all.len(), 4);
        for one in all {
            let last = one.states.last().unwrap();
            assert!(matches!(one.end, End::Stopped { .. }), "{:?}", one.end);
            assert_abs_diff_eq!(last.shape.as_ref().unwrap().curvature.abs(), size, epsilon = 1e-10);
        }
        for one in run(&sheet, &[held], Stop { arc_length: Some(size), ..Stop::default() }, None) {
            assert_eq!((&one.end, one.states.last().unwrap().arc_length), (&End::Length, size));
        }
        let crease = Stop { crease_angle: Some((moving, drawn + size)), arc_length: Some(0.1), ..Stop::default() };
        let met = run(&sheet, &[held], crease, None).into_iter().filter(|one| matches!(one.end, End::Stopped { .. }));
        let met: Vec<Traced> = met.collect();
        assert_eq!(met.len(), 2, "on each branch the angle grows one way");
        met.iter().for_each(|one| {
            assert_abs_diff_eq!(one.states.last().unwrap().angles[moving], drawn + size, epsilon = 1e-10);
        });
    }
}

/// Claim: along both loops of the reference cell the curvature has one sign from the first state to the last except for
/// the drawn one, and never passes zero between: a sign from the volume between sheet and axis would change on the long
/// loop where the sheet turns inside out, at curvatures of 1.7. No tolerance: only signs are compared.
#[test]
fn curvature_keeps_its_sign() {
    let (sheet, held, _) = star();
    for one in run(&sheet, &[held], Stop::default(), None) {
        let kappa: Vec<f64> = one.states.iter().map(|state| state.shape.as_ref().unwrap().curvature).collect();
        let inner = &kappa[1..kappa.len() - 1];
        assert!(inner.iter().all(|k| k.signum() == inner[0].signum() && *k != 0.0), "{:?}: {kappa:?}", one.branch);
    }
}

/// The product of a step along a tube with a side of its cross-section, which folding keeps.
const ALONG: f64 = 0.35;

/// Returns the corners of a tube of parallelograms whose cross-section is a rhombus with half an angle `half` between
/// its sides: rings of four corners along a zigzag. All sides have length 1.
///
/// With sides `u, v = (cos, +-sin, 0)` of the rhombus and steps `e, e' = (+-p, 0, q)` of the zigzag, the lengths and
/// the angles of the parallelograms stay the same as long as `e . u = p cos(half)` and `p^2 + q^2 = 1` do (T. Tachi and
/// K. Miura, "Rigid-foldable cylinders and cells", Journal of the IASS 53 (2012) 217-226).
fn tube(rings: usize, half: f64) -> Vec<[f64; 3]> {
    let (sin, cos) = half.sin_cos();
    let p = ALONG / cos;
    let q = (1.0 - p * p).sqrt();
    let corner = |k: usize| [[0.0, 0.0], [cos, sin], [2.0 * cos, 0.0], [cos, -sin]][k % 4];
    let place = |k: usize| {
        let ([x, y], ring) = (corner(k), k / 4);
        [x + p * (ring % 2) as f64, y, q * ring as f64]
    };
    (0..4 * rings).map(place).collect()
}

/// Claim: a finite tube of rigid parallelograms, which has an opening beside its outer rim, folds along one branch,
/// both ways; each state is that of the closed form, in the distances of all its 28 corners, with that of one diagonal
/// of its rhombus given. Tolerance 1e-11: closure to 3e-14 over the smallest singular value, along seven rings.
#[test]
fn a_finite_tube_folds_as_in_closed_form() {
    let (rings, drawn) = (7, 0.6);
    let side = |ring: usize, k: usize| [0, 1, 5, 4].map(|at| 4 * (ring + at / 4) + (k + at % 4) % 4);
    let faces: Vec<[usize; 4]> = (0..4 * (rings - 1)).map(|face| side(face / 4, face % 4)).collect();
    let text = format!(r#"{{"vertices_coords": {:?}, "faces_vertices": {faces:?}}}"#, tube(rings, drawn));
    let sheet = foldwell::sheet::fold::parse(&text, "tube.fold").unwrap();
    let facets = Some(Hinges { stiffness: f64::INFINITY.into(), rest: vec![0.0; sheet.edges.len()] });
    let case = on(sheet.clone(), [1, 1], Boundary::Patch).with_terms(Terms { facets, ..Terms::default() });
    let found = branches(&case).unwrap();
    assert_eq!((found.modes, found.quadrics, found.rays.rays.len()), (1, 0, 2));
    let stop = Stop { arc_length: Some(2.0), ..Stop::default() };
    let options = TraceOptions { max_step: 0.25, tolerance: 3e-14, branch: None, stop };
    let traced = trace(&case, &options, None, &mut |_, _| true).unwrap();
    let embedding = Embedding::new(&sheet).unwrap();
    let apart = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt();
    let mut widths = Vec::new();
    for state in traced.iter().flat_map(|one| &one.states) {
        let placed: Vec<[f64; 3]> = embedding.place(&state.angles).positions.into_iter().map(Into::into).collect();
        let width = 0.5 * apart(&placed[1], &placed[3]);
        let closed = tube(rings, width.asin());
        for (i, j) in (0..placed.len()).flat_map(|j| (0..j).map(move |i| (i, j))) {
            assert_abs_diff_eq!(apart(&placed[i], &placed[j]), apart(&closed[i], &closed[j]), epsilon = 1e-11);
        }
        widths.push(width);
    }
    let [least, most] = [f64::min, f64::max].map(|pick| widths.iter().copied().reduce(pick).unwrap());
    assert!(traced.len() == 2 && widths.len() > 10 && least < 0.45 && most > 0.65, "{least} to {most}");
}
