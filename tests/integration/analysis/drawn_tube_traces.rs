//! Trajectories of tubes that their mesh draws rolled up, one cell repeated by screw motions.

use crate::common::mesh;
use foldwell::analysis::along::relax_along;
use foldwell::analysis::trace::{Stop, TraceOptions, Traced, trace};
use foldwell::math::Vec3;
use foldwell::sheet::{Corner, ScrewLattice, SeamKept, Sheet, fold};
use foldwell::solver::Options;
use foldwell::solver::continuation::End;
use foldwell::{Assembly, RIGID, Roll, rolled_up};
use nalgebra::{SMatrix, SVector};
use std::f64::consts::TAU;

const TURN: SeamKept = SeamKept { turn: true, rise: false };
const RISE: SeamKept = SeamKept { turn: false, rise: true };
/// Edges of a cell with one vertex and two triangles: the cell in which they end.
const EDGES: [[i32; 2]; 3] = [[1, 0], [0, 1], [1, -1]];

fn case(sheet: &Sheet, seam: [i32; 2], kept: SeamKept) -> Assembly {
    let roll = Roll::as_drawn(sheet, seam, kept).unwrap();
    Assembly::tube(sheet.clone(), roll, [1, 1]).bars(RIGID).creases(1.0).build().unwrap()
}

/// Follows the motion of a tube both ways for a length in fold angles.
fn both_ways(case: &Assembly, length: f64) -> [Traced; 2] {
    let stop = Stop { arc_length: Some(length), ..Stop::default() };
    let options = TraceOptions { max_step: 0.1, tolerance: 3e-14, branch: None, stop };
    let found = trace(case, &options, None, &mut |_, _| true).unwrap();
    assert!(found.iter().all(|one| one.end == End::Length));
    found.try_into().unwrap()
}

/// Returns a cell with one vertex at radius 1, and the triangles of `kresling-cell.fold`.
fn one_vertex(turn_degrees: [f64; 2], rise: [f64; 2]) -> Sheet {
    let mut sheet = mesh("kresling-cell");
    sheet.screws = Some(ScrewLattice { turn: turn_degrees.map(f64::to_radians), rise });
    sheet
}

/// Largest difference of two lists of angles, modulo whole turns.
fn apart(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b - TAU * ((a - b) / TAU).round()).abs()).fold(0.0, f64::max)
}

/// A tube whose vertices all lie on one cylinder: its curvature, and for both lattice motions the length along the
/// circle and the translation along the axis. It is regular where the cylinder becomes a plane.
type OnCylinder = SVector<f64, 5>;

/// Returns the chord on a circle of this curvature to the end of an arc, relative to the length of the arc, and its
/// derivative with half the angle of the arc.
fn chord(half: f64) -> [f64; 2] {
    if half.abs() < 1e-3 {
        let square = half * half;
        return [1.0 - square / 6.0 + square * square / 120.0, -half / 3.0 + half * square / 30.0];
    }
    [half.sin() / half, (half.cos() - half.sin() / half) / half]
}

/// Returns the vertex of a cell.
fn vertex(at: &OnCylinder, [m, n]: [i32; 2]) -> Vec3 {
    let (m, n) = (f64::from(m), f64::from(n));
    let (arc, height) = (m * at[1] + n * at[2], m * at[3] + n * at[4]);
    let half = at[0] * arc / 2.0;
    let length = arc * chord(half)[0];
    Vec3::new(length * half.cos(), length * half.sin(), height)
}

/// Returns the fold angles at the three edges, valleys positive: of two faces with the edge from `a` to `b`, `c` to its
/// left and `d` to its right.
fn angles(at: &OnCylinder) -> [f64; 3] {
    let edges =
        [([0, 0], [1, 0], [0, 1], [1, -1]), ([0, 0], [0, 1], [-1, 1], [1, 0]), ([0, 1], [1, 0], [1, 1], [0, 0])];
    edges.map(|(a, b, c, d)| {
        let [a, b, c, d] = [a, b, c, d].map(|cell| vertex(at, cell));
        let (left, right) = ((b - a).cross(&(c - a)), (d - a).cross(&(b - a)));
        let sine = left.cross(&right).norm().copysign((d - a).dot(&left));
        sine.atan2(left.dot(&right))
    })
}

/// Finds the tube on a cylinder with these lengths of the three edges whose seam has this turn and rise, by Newton's
/// method from a tube near by.
fn on_cylinder(near: OnCylinder, lengths: [f64; 3], seam: [i32; 2], [turn, rise]: [f64; 2]) -> OnCylinder {
    let mut at = near;
    for _ in 0..30 {
        let (mut values, mut rates) = (OnCylinder::zeros(), SMatrix::<f64, 5, 5>::zeros());
        for (row, (edge, length)) in EDGES.iter().zip(lengths).enumerate() {
            let [m, n] = edge.map(f64::from);
            let (arc, height) = (m * at[1] + n * at[2], m * at[3] + n * at[4]);
            let half = at[0] * arc / 2.0;
            let [ratio, slope] = chord(half);
            values[row] = arc * arc * ratio * ratio + height * height - length * length;
            let by_arc = 2.0 * arc * ratio * (ratio + half * slope);
            let by_curvature = arc * arc * arc * ratio * slope;
            rates.set_row(row, &[by_curvature, m * by_arc, n * by_arc, 2.0 * m * height, 2.0 * n * height].into());
        }
        let [m, n] = seam.map(f64::from);
        let arc = m * at[1] + n * at[2];
        values[3] = at[0] * arc - turn;
        values[4] = m * at[3] + n * at[4] - rise;
        rates.set_row(3, &[arc, m * at[0], n * at[0], 0.0, 0.0].into());
        rates.set_row(4, &[0.0, 0.0, 0.0, m, n].into());
        at -= rates.lu().solve(&values).unwrap();
        if values.amax() < 1e-14 {
            return at;
        }
    }
    panic!("no tube on a cylinder at turn {turn} and rise {rise}");
}

/// Claim: one vertex and its copies lie on a cylinder, and three lengths, a closing condition and the place of the seam
/// determine it: radius, turns and translations solve five equations in closed form, which know no fold angle. The
/// traced states have the fold angles of these tubes, both ways, on Kresling's tube and on cells drawn with turns of
/// more than a half turn, with several strands, and towards the faces or away from them; opening, they pass the plane.
/// Tolerance: a thousand times the rounding of the residual.
#[test]
fn vertices_on_a_cylinder() {
    let tubes = [
        (one_vertex([60.0, 30.0], [0.0, 0.8]), [6, 0], TURN, 2.0),
        (one_vertex([60.0, 30.0], [0.0, 0.8]), [6, 0], RISE, 2.0),
        (one_vertex([-60.0, 25.0], [0.1, 0.9]), [-6, 0], TURN, 1.0),
        (one_vertex([-150.0, 220.0], [0.3, -0.2]), [2, 3], TURN, 0.4),
        (one_vertex([-150.0, 220.0], [0.3, -0.2]), [2, 3], RISE, 0.4),
        (one_vertex([70.0, 37.5], [0.15, -0.6]), [3, 4], TURN, 0.8),
        (one_vertex([70.0, 37.5], [0.4, -0.3]), [3, 4], RISE, 0.8),
    ];
    for (sheet, seam, kept, length) in tubes {
        let screws = sheet.screws.unwrap();
        let lengths =
            EDGES.map(|shift| (sheet.position(Corner { vertex: 0, shift }) - sheet.position(Corner::home(0))).norm());
        let order = EDGES.map(|shift| sheet.edges.iter().position(|edge| edge.key.shift == shift).unwrap());
        for one in both_ways(&case(&sheet, seam, kept), length) {
            let mut at = OnCylinder::from([1.0, screws.turn[0], screws.turn[1], screws.rise[0], screws.rise[1]]);
            let first = one.states[0].seam.unwrap();
            for state in &one.states {
                let place = state.seam.map_or([0.0; 2], |seam| [seam.turn, seam.rise]);
                assert!(
                    if kept.turn { (place[0] - TAU).abs() } else { place[1].abs() } <= 1e-12,
                    "{seam:?}: {place:?}"
                );
                at = on_cylinder(at, lengths, seam, place);
                let traced = order.map(|edge| state.angles[edge]);
                assert!(apart(&traced, &angles(&at)) <= 1e-12, "{seam:?}: {traced:?} and {:?}", angles(&at));
            }
            let second = one.states[1].seam.unwrap();
            let grown = if kept.turn { second.rise - first.rise } else { second.turn - first.turn };
            assert!(grown * f64::from(one.branch.1) > 0.0);
        }
    }
}

/// Returns the cell of a tube, drawn where the tube has it and repeated by the tube's screw motions, as a file has it.
fn drawn_as(sheet: &Sheet, roll: &Roll) -> Sheet {
    let (x, seam) = (&roll.coordinates, roll.seam);
    let (strand_turn, motion) = (TAU / f64::from(seam.strands()), 3 * sheet.vertices.len());
    let [row_turn, row_rise] = [x[motion], x[motion + 1]];
    let steps = [[1, 0], [0, 1]].map(|cell| seam.place(cell).map(f64::from));
    let turn = steps.map(|[strand, row]| strand * strand_turn + row * row_turn);
    let rise = steps.map(|[_, row]| row * row_rise);
    let mut drawn = sheet.clone();
    drawn.vertices = x.chunks(3).take(sheet.vertices.len()).map(|p| Vec3::new(p[0], p[1], p[2])).collect();
    drawn.lattice = None;
    drawn.screws = Some(ScrewLattice { turn, rise });
    fold::parse(&fold::write(&drawn), "drawn.fold").unwrap()
}

/// Claim: a periodic sheet rolled up to a tube and the same tube drawn in a file have the same trajectories: the same
/// fold angles at the end, and closed tubes at the same arc lengths. Rigid bars, which know nothing of the kinematics,
/// are at rest along the drawn one. Tolerance: for arc lengths of 24 the error of a hundred steps.
#[test]
fn rolled_up_and_drawn() {
    let sheet = mesh("open-star");
    for (seam, kept, length) in [([1, 8], TURN, 24.0), ([0, 7], RISE, 1.0), ([1, 8], RISE, 0.8)] {
        let roll = rolled_up(&sheet, seam, kept, true).unwrap();
        let drawn = drawn_as(&sheet, &Roll { kept: SeamKept::BOTH, ..roll.clone() });
        assert!(drawn.lattice.is_none());
        let rolled = Assembly::tube(sheet.clone(), roll, [1, 1]).bars(RIGID).creases(1.0).build().unwrap();
        let case = case(&drawn, seam, kept);
        for (from_lattice, from_file) in both_ways(&rolled, length).iter().zip(both_ways(&case, length)) {
            assert_eq!(from_lattice.branch, from_file.branch);
            let ends = [from_lattice, &from_file].map(|one| &one.states.last().unwrap().angles);
            assert!(apart(ends[0], ends[1]) <= 1e-9, "{seam:?}: {:e}", apart(ends[0], ends[1]));
            let closed = [from_lattice, &from_file].map(|one| one.closed_tubes.iter().map(|state| state.arc_length));
            let [first, second] = closed.map(Iterator::collect::<Vec<_>>);
            assert_eq!(first.len(), second.len());
            assert!(first.iter().zip(&second).all(|(a, b)| (a - b).abs() <= 1e-9), "{first:?} and {second:?}");
            let relaxed = relax_along(&case, Options::default(), &from_file, &mut |_| true);
            assert!(relaxed.failure.is_none() && relaxed.error().unwrap() <= 1e-9, "{:?}", relaxed.failure);
        }
    }
}

/// Claim: it does not matter which side of a tube its file draws in front. Slipping, the tube becomes half as wide;
/// relaxations go along from every drawing, and end in the same energy. Tolerance: that of relaxations, for energies of
/// size 1.
#[test]
fn drawings_turned_about_the_axis() {
    let energies = [0.0, 0.4, 0.7, 1.2, 2.5].map(|turned: f64| {
        let mut sheet = one_vertex([60.0, 30.0], [0.0, 0.8]);
        sheet.vertices = vec![Vec3::new(turned.cos(), turned.sin(), 0.0)];
        let case = case(&sheet, [6, 0], TURN);
        both_ways(&case, 3.0).map(|one| {
            let relaxed = relax_along(&case, Options::default(), &one, &mut |_| true);
            assert!(relaxed.failure.is_none() && relaxed.error().unwrap() <= 1e-9, "{turned}: {:?}", relaxed.failure);
            relaxed.states.last().unwrap().relaxed.state.total()
        })
    });
    assert!(energies[0][0] > 0.1);
    for energy in energies {
        assert!((0..2).all(|way| (energy[way] - energies[0][way]).abs() <= 1e-9), "{energy:?}");
    }
}

/// Claim: the mirror image of a tube moves as the tube does: angles are opposite, and the rise of the reversed seam is.
#[test]
fn mirror_images() {
    let sheet = one_vertex([70.0, 37.5], [0.15, -0.6]);
    let mirrored = one_vertex([-70.0, -37.5], [0.15, -0.6]);
    let [up, down] = both_ways(&case(&sheet, [3, 4], TURN), 0.5);
    let [mirrored_up, mirrored_down] = both_ways(&case(&mirrored, [-3, -4], TURN), 0.5);
    for (one, image) in [(up, mirrored_down), (down, mirrored_up)] {
        let [end, image] = [one, image].map(|one| one.states.last().unwrap().clone());
        let opposite: Vec<f64> = image.angles.iter().map(|angle| -angle).collect();
        assert!(apart(&end.angles, &opposite) <= 1e-12);
        assert!((end.seam.unwrap().rise + image.seam.unwrap().rise).abs() <= 1e-12);
    }
}

/// Claim: a file whose tube closes to seven digits is traced from the tube that closes. Closed both ways, a tube is
/// rigid, and a tube of rigid panels is with either condition; this is established by a rank.
#[test]
fn drawings_that_miss_and_rigid_tubes() {
    let missed = one_vertex([60.0 + 1e-6, 30.0], [0.0, 0.8]);
    for one in both_ways(&case(&missed, [6, 0], TURN), 0.5) {
        assert!(one.states.iter().all(|state| (state.seam.unwrap().turn - TAU).abs() <= 1e-12));
        assert!(apart(&one.states[0].angles, &Roll::as_drawn(&missed, [6, 0], TURN).unwrap().angles) <= 1e-6);
    }
    let [kresling, miura] = ["kresling-cell", "helical-miura"].map(mesh);
    let rigid = [(&kresling, [6, 0], SeamKept::BOTH), (&miura, [1, 8], TURN), (&miura, [1, 8], RISE)];
    for (sheet, seam, kept) in rigid {
        let options = TraceOptions { max_step: 0.1, tolerance: 3e-14, branch: None, stop: Stop::default() };
        assert!(trace(&case(sheet, seam, kept), &options, None, &mut |_, _| true).unwrap().is_empty());
    }
}
