//! Trajectories of tubes: the seam that slips, the tube that opens, and the closed tube that does not move.

use crate::common::{Scene, mesh};
use foldwell::analysis::along::relax_along;
use foldwell::analysis::modes::modes;
use foldwell::analysis::relax::relax;
use foldwell::analysis::trace::{Stop, TraceError, TraceOptions, Traced, trace};
use foldwell::kinematics::tube::Condition;
use foldwell::kinematics::{Closure, Embedding, KinematicsError, Shape, Tube};
use foldwell::math::Vec3;
use foldwell::sheet::generate::Random;
use foldwell::sheet::{Corner, Seam, SeamKept, Sheet};
use foldwell::solver::Options;
use foldwell::solver::continuation::End;
use foldwell::{Assembly, Pattern, RIGID, Roll, generate, rolled_up};
use nalgebra::Matrix3;
use std::f64::consts::TAU;

const TURN: SeamKept = SeamKept { turn: true, rise: false };
const RISE: SeamKept = SeamKept { turn: false, rise: true };

/// Returns a random cell and the reference cell with their seams.
fn cells() -> Vec<(Sheet, [i32; 2])> {
    let random = generate(&Pattern::Random(Random { seed: 3, size: [2, 3], ..Random::default() })).unwrap();
    vec![(mesh("open-star"), [1, 8]), (mesh("open-star"), [0, 7]), (random, [0, 8])]
}

fn case(sheet: &Sheet, roll: Roll) -> Assembly {
    Assembly::tube(sheet.clone(), roll, [1, 1]).bars(RIGID).creases(1.0).build().unwrap()
}

/// Follows the motion of a tube both ways for a length in fold angles.
fn both_ways(case: &Assembly, length: f64) -> [Traced; 2] {
    let stop = Stop { arc_length: Some(length), ..Stop::default() };
    let options = TraceOptions { max_step: 0.25, tolerance: 3e-14, branch: None, stop };
    let found = trace(case, &options, None, &mut |_, _| true).unwrap();
    assert_eq!(found.iter().map(|one| one.branch).collect::<Vec<_>>(), [(0, 1), (0, -1)]);
    found.try_into().unwrap()
}

/// Returns the roll of a state, made anew from its fold angles: the cell placed by its faces, its axis along z.
fn roll_at(sheet: &Sheet, seam: [i32; 2], kept: SeamKept, angles: &[f64]) -> Roll {
    let Shape { positions, screw, .. } = Shape::at(&Embedding::new(sheet).unwrap(), angles).unwrap();
    let seam = Seam::new(seam).unwrap();
    let [n1, n2] = seam.lattice_vector().map(f64::from);
    let sign = 1f64.copysign(n1 * screw.theta[0] + n2 * screw.theta[1]);
    let z = screw.axis.unwrap() * sign;
    let centre = screw.towards_axis() / screw.towards_axis().norm_squared();
    let x = -centre.normalize();
    let rotation = Matrix3::from_rows(&[x.transpose(), z.cross(&x).transpose(), z.transpose()]);
    let placed = positions.iter().flat_map(|p| <[f64; 3]>::from(rotation * (p - centre)));
    let [strand, row] = seam.basis();
    let of = |[a, b]: [i32; 2], each: [f64; 2]| sign * (f64::from(a) * each[0] + f64::from(b) * each[1]);
    let each = if kept.rise { screw.theta } else { screw.rise() };
    let free = (!kept.is_closed()).then(|| of(strand, each));
    let coordinates = placed.chain([of(row, screw.theta), of(row, screw.rise())]).chain(free).collect();
    Roll { seam, kept, coordinates, angles: angles.to_vec() }
}

/// Claim: with the turn of the seam kept there are two trajectories. Every state closes, its seam turns by `2 pi`, and
/// the rise moves the way of the sign. Tolerances: those required.
#[test]
fn the_seam_slips_both_ways() {
    for (sheet, seam) in cells() {
        let roll = rolled_up(&sheet, seam, TURN, true).unwrap();
        let (closure, tube) = (Closure::of_cell(&sheet).unwrap(), Tube::new(&sheet, seam).unwrap());
        for one in both_ways(&case(&sheet, roll.clone()), 0.6) {
            assert_eq!(one.end, End::Length);
            let mut rises = Vec::new();
            for state in &one.states {
                assert!(closure.residual(&state.angles).amax() <= 1e-13 && state.residual <= 1e-13);
                let (shape, place) = (state.shape.as_ref().unwrap(), state.seam.unwrap());
                let turn = f64::from(seam[0]) * shape.theta[0] + f64::from(seam[1]) * shape.theta[1];
                assert!((turn.abs() - TAU).abs() <= 1e-12 && (place.turn - TAU).abs() <= 1e-12, "{turn}");
                assert_eq!(tube.motions(&state.angles, &[Condition::Turn], &[]).unwrap().ncols(), 1);
                rises.push(f64::from(one.branch.1) * place.rise);
            }
            assert!(rises.is_sorted() && rises[0].abs() <= 1e-13, "{seam:?}: {rises:?}");
            assert!(rises[rises.len() - 1] > 0.5, "{rises:?}");
        }
    }
}

/// Claim: with the rise of the seam kept its turn passes `2 pi` in the way of the sign, and the seam ends at the height
/// where it began. Tolerance: the required one.
#[test]
fn the_tube_opens_both_ways() {
    for (sheet, seam) in cells() {
        let roll = rolled_up(&sheet, seam, RISE, true).unwrap();
        for one in both_ways(&case(&sheet, roll), 0.4) {
            let places: Vec<_> = one.states.iter().map(|state| state.seam.unwrap()).collect();
            assert!(places.iter().all(|place| place.rise.abs() <= 1e-12), "{seam:?}: {places:?}");
            let turns: Vec<f64> = places.iter().map(|place| f64::from(one.branch.1) * (place.turn - TAU)).collect();
            assert!(turns.is_sorted() && turns[0].abs() <= 1e-12 && turns[turns.len() - 1] > 0.1, "{turns:?}");
        }
    }
}

/// Claim: the states are tubes of the drawn bars, by the lengths of bars, which share no equation with fold angles.
/// Placed by its screw motions, every edge keeps its length; the copy at the end of the seam is the same cell, moved
/// along the axis by the rise; and a model of rigid bars that starts there is at rest in lengths. Its bars have one
/// motion, none if both conditions are kept. Tolerances: the required one; of the copy, rounding after some ten cells.
#[test]
fn states_are_tubes_of_the_drawn_bars() {
    for (sheet, seam) in cells() {
        let roll = rolled_up(&sheet, seam, TURN, true).unwrap();
        let embedding = Embedding::new(&sheet).unwrap();
        for one in both_ways(&case(&sheet, roll), 0.6) {
            let state = one.states.last().unwrap();
            let Shape { positions, screw, .. } = Shape::at(&embedding, &state.angles).unwrap();
            let at = |Corner { vertex, shift }| screw.motion(shift).apply(&positions[vertex]);
            for edge in &sheet.edges {
                let [length, drawn] = [
                    (at(edge.key.ends()[1]) - at(edge.key.ends()[0])).norm(),
                    (sheet.position(edge.key.ends()[1]) - sheet.position(edge.key.ends()[0])).norm(),
                ];
                assert!((length - drawn).abs() <= 1e-12, "{seam:?}: {length} for {drawn}");
            }
            let place = state.seam.unwrap();
            for (vertex, position) in positions.iter().enumerate() {
                let moved = at(Corner { vertex, shift: seam }) - position;
                assert!((moved - place.rise * place.axis).norm() <= 1e-12 * (1.0 + place.rise.abs()), "{moved}");
            }
            let slipped = case(&sheet, roll_at(&sheet, seam, TURN, &state.angles));
            let relaxed = relax(&slipped).unwrap();
            assert!(slipped.has_drawn_lengths() && relaxed.residual_length <= 1e-12);
            let counted = modes(&slipped, 0, &mut || true).unwrap().seam.unwrap();
            assert_eq!([counted.free, counted.turn, counted.rise, counted.both], [2, 1, 1, 0], "{seam:?}");
        }
    }
}

/// Claim: relaxations of rigid bars with one crease locked meet the trajectory, also where a lattice rotation passes a
/// half turn (seam (1, 8) at arc length 6.246). Tolerance: 1e-9 of relaxations, whose equations are others.
#[test]
fn relaxed_tubes_meet_the_trajectory() {
    let sheet = mesh("open-star");
    let tube = case(&sheet, rolled_up(&sheet, [1, 8], TURN, true).unwrap());
    let [up, _] = both_ways(&tube, 6.8);
    let thetas: Vec<f64> = up.states.iter().map(|state| state.shape.as_ref().unwrap().theta[0]).collect();
    assert!(thetas.iter().any(|theta| *theta > 3.1) && up.end == End::Length);
    let relaxed = relax_along(&tube, Options::default(), &up, &mut |_| true);
    assert_eq!(relaxed.failure, None);
    assert!(relaxed.error().unwrap() <= 1e-9, "{:?}", relaxed.error());
    // past the half turn the seam still turns once, and its rise goes on without a jump
    let places: Vec<_> = up.states.iter().map(|state| (state.arc_length, state.seam.unwrap())).collect();
    assert!(places.iter().all(|(_, place)| (place.turn - TAU).abs() <= 1e-12));
    assert!(places.windows(2).all(|pair| (pair[1].1.rise - pair[0].1.rise).abs() <= 12.0 * (pair[1].0 - pair[0].0)));
}

/// Claim: a closed tube has no trajectory, and neither has a slipping one with a crease locked: both are rigid,
/// established by a rank. A tube without conditions has two motions, which are refused with their number.
#[test]
fn rigid_tubes_and_tubes_with_two_motions() {
    let sheet = mesh("open-star");
    let options = TraceOptions { max_step: 0.25, tolerance: 3e-14, branch: None, stop: Stop::default() };
    let go = |tube: &Assembly| trace(tube, &options, None, &mut |_, _| true);
    let roll = |kept| rolled_up(&sheet, [1, 8], kept, true).unwrap();
    assert!(go(&case(&sheet, roll(SeamKept::BOTH))).unwrap().is_empty());
    let tube = |kept| Assembly::tube(sheet.clone(), roll(kept), [1, 1]).bars(RIGID).creases(1.0);
    let locked = tube(TURN).lock(sheet.edges[0].key, None).build().unwrap();
    assert!(go(&locked).unwrap().is_empty());
    let free = SeamKept { turn: false, rise: false };
    let error = go(&case(&sheet, roll(free))).unwrap_err();
    assert!(matches!(error, TraceError::MotionsOfTube { motions: 2, closed: false }), "{error}");
    assert!(error.to_string().contains("lock 1 crease"), "{error}");
    let one = tube(free).lock(sheet.edges[0].key, None).build().unwrap();
    assert!(matches!(go(&one), Err(TraceError::MotionsOfTube { motions: 1, closed: false })));
    let patch = KinematicsError::NoLattice;
    assert_eq!(Tube::new(&mesh("helical-tube"), [0, 7]).unwrap_err(), patch);
}

/// Claim: scenes say all this. A rigid tube has the end `no-real-branch` and exit status 0; the table has the seam,
/// whose turn is kept, also on a tube that its mesh draws; Poisson's ratios and a lock at another angle are refused
/// with the reason.
#[test]
fn scenes_of_slipping_tubes() {
    let scene = |mesh: &str, sheet: &str, study: &str| {
        let study = format!("[[study]]\nname = \"a\"\nkind = \"trace\"\ndraw = []\n{study}");
        Scene::on(&format!("mesh = \"{mesh}\"\ndomain = \"tube\"\n{sheet}"), &study)
    };
    let star = "seam = [0, 7]\nclosing = \"turn\"";
    let stop = "stop = { arc_length = 0.2 }";
    for (mesh, sheet, study, expected) in [
        ("open-star.fold", star, "response = \"bending\"", "rolled up are not known"),
        ("open-star.fold", star, "[[lock]]\ncrease = [0, 1, 0, 0]\nangle = 0.5", "a lock holds a crease at 0.5"),
    ] {
        scene(mesh, sheet, study).refused(expected);
    }
    let closed = scene("open-star.fold", "seam = [0, 7]", "").converged().json();
    assert!(closed.to_string().contains("no-real-branch"), "{closed}");
    for (mesh, sheet) in [("open-star.fold", star), ("kresling-cell.fold", "seam = [6, 0]\nclosing = \"turn\"")] {
        let table = scene(mesh, sheet, stop).converged().out.table("a.csv");
        assert_eq!(table.header[table.place("seam_turn") + 1], "seam_rise");
        assert!(table.column("seam_turn").iter().all(|turn| (turn - TAU).abs() <= 1e-12));
    }
}

/// Returns the arc length at which a trajectory passes a closed tube with these fold angles, modulo whole turns.
fn passes(one: &Traced, angles: &[f64]) -> Option<f64> {
    let off = |a: f64, b: f64| (a - b - TAU * ((a - b) / TAU).round()).abs();
    let same = |found: &[f64]| found.iter().zip(angles).map(|(a, b)| off(*a, *b)).fold(0.0, f64::max) <= 1e-8;
    one.closed_tubes.iter().find(|state| same(&state.angles)).map(|state| state.arc_length)
}

/// Claim: where a slipping seam has no rise again the tube is closed. Its cell at the end of the seam is the first one
/// again, no motion keeps both conditions, rigid bars closed both ways are at rest there, and seen from there the tube
/// of the beginning is a closed tube at the same arc length. Tolerances: arc lengths to 1e-9 of 20, angles to that over
/// the rate of the rise; copies as above.
#[test]
fn closed_tubes_on_the_way() {
    let (sheet, seam) = (mesh("open-star"), [1, 8]);
    let roll = rolled_up(&sheet, seam, TURN, true).unwrap();
    let [forth, back] = both_ways(&case(&sheet, roll.clone()), 24.0);
    assert!(forth.closed_tubes.is_empty());
    let lengths: Vec<f64> = back.closed_tubes.iter().map(|state| state.arc_length).collect();
    assert!(lengths.len() == 2 && lengths.is_sorted() && (lengths[0] - 8.8068).abs() < 1e-3, "{lengths:?}");
    let tube = Tube::new(&sheet, seam).unwrap();
    for state in &back.closed_tubes {
        let Shape { positions, screw, .. } = Shape::at(&Embedding::new(&sheet).unwrap(), &state.angles).unwrap();
        let apart = |p: &Vec3| (screw.motion(seam).apply(p) - p).norm();
        assert!(positions.iter().map(apart).fold(0.0, f64::max) <= 1e-9);
        assert_eq!(tube.motions(&state.angles, &[Condition::Turn, Condition::Rise], &[]).unwrap().ncols(), 0);
        let relaxed = relax(&case(&sheet, roll_at(&sheet, seam, SeamKept::BOTH, &state.angles))).unwrap();
        assert!(relaxed.iterations <= 2 && relaxed.residual_length <= 1e-12, "{} steps", relaxed.iterations);
        let from_there = both_ways(&case(&sheet, roll_at(&sheet, seam, TURN, &state.angles)), 24.0);
        let seen: Vec<f64> = from_there.iter().filter_map(|one| passes(one, &roll.angles)).collect();
        assert!(seen.len() == 1 && (seen[0] - state.arc_length).abs() <= 1e-9 * 20.0, "{seen:?} {}", state.arc_length);
    }
}
