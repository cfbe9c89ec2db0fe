//! Events and branches of driven paths against group theory and closed forms: branch points beside limit points, double
//! branch points of symmetric domes, columns that stay straight, and free sheets that turn as they fold.
//!
//! Sources: a pyramid of N sides, radius 1 and height 2.5 with bars alone, pressed down at its apex, has a double
//! branch point where the stiffness of the apex across the axis vanishes: `(1 - l0/l) + l0/l / (2 l^2) = 0` for bars of
//! lengths `l` and `l0`, whatever N; by the symmetry of the polygon half branches leave along its 2N half axes of
//! reflection.

use crate::common::{Numbers, case_folder, turned};
use foldwell::analysis::path::{
    HalfBranches, PathBranch, PathEnd, PathEvent, PathOptions, PathPoint, PathStop, follow_path,
};
use foldwell::math::Vec3;
use foldwell::model::{Drive, Driven, TermKind};
use foldwell::sheet::{Sheet, fold};
use foldwell::{Assembly, RIGID, Rest, relax};
use nalgebra::{Rotation3, Vector3};
use std::f64::consts::{PI, TAU};

const APEX_HEIGHT: f64 = 2.5;
/// How far the apex of a pyramid is pressed where it can move to the side, from the root of `l^3 - l0 l^2 + l0/2` in 40
/// digits.
const DOUBLE_POINT: f64 = -0.238_938_539_819;

/// A sheet of these vertices and faces.
fn sheet(vertices: &[[f64; 3]], faces: &[Vec<usize>]) -> Sheet {
    let mesh = serde_json::json!({ "file_spec": 1.2, "vertices_coords": vertices, "faces_vertices": faces });
    fold::parse(&mesh.to_string(), "s.fold").unwrap()
}

/// A pyramid on pinned vertices, turned about its axis by this angle; bars alone.
fn pyramid(sides: usize, turn: f64, loaded: bool) -> Assembly {
    let corner = |k: usize| {
        let (sin, cos) = (turn + TAU * k as f64 / sides as f64).sin_cos();
        [cos, sin, 0.0]
    };
    let mut vertices: Vec<[f64; 3]> = (0..sides).map(corner).collect();
    vertices.push([0.0, 0.0, APEX_HEIGHT]);
    let faces: Vec<Vec<usize>> = (0..sides).map(|k| vec![sides, k, (k + 1) % sides]).collect();
    let mut builder = Assembly::patch(sheet(&vertices, &faces), [1, 1]).bars(1.0);
    for k in 0..sides {
        builder = builder.pin(k, [0, 0], [true; 3]);
    }
    if loaded {
        builder = builder.load(sides, [0, 0], [0.0, 0.0, -1.0]);
    }
    builder.build().unwrap()
}

/// Claim: a double branch point behind a simple one is in the same place for all lengths of steps: with long ones, states
/// beside it are found from nearer ones alone. Source: two eigenvalues of the Hessian that vanish there, -1.809088 to its
/// digits. Tolerance: 1e-6.
#[test]
fn double_points_stay_where_they_are() {
    let corner = |k: usize| [(TAU * k as f64 / 6.0).cos(), (TAU * k as f64 / 6.0).sin(), 0.0];
    let vertices: Vec<[f64; 3]> = [[0.0, 0.0, 0.5]].into_iter().chain((0..6).map(corner)).collect();
    let faces: Vec<Vec<usize>> = (0..6).map(|k| vec![0, 1 + k, 1 + (k + 1) % 6]).collect();
    let builder = Assembly::patch(sheet(&vertices, &faces), [1, 1]).bars(1.0).creases(1e-3);
    let builder = (1..7).fold(builder, |builder, vertex| builder.pin(vertex, [0, 0], [vertex <= 2, vertex == 1, true]));
    let drive = Drive { quantity: Driven::Vertices { vertices: vec![0], direction: Vec3::z() }, to: -2.5 };
    for max_step in [0.05, 0.15, 0.2] {
        let options = PathOptions { max_step, ..PathOptions::default() };
        let branch = followed(&builder.clone().build().unwrap(), &drive, &options).remove(0);
        let double = branch.points.iter().find(|point| point.branch_point.is_some_and(|known| known.multiplicity == 2));
        let drive = double.unwrap().drive;
        assert!((drive + 1.809088).abs() < 1e-6, "{max_step}: {drive}");
    }
}

fn apex(point: &PathPoint) -> Vec3 {
    let all = &point.state.coordinates;
    Vec3::from_column_slice(&all[all.len() - 3..])
}

fn followed(assembly: &Assembly, drive: &Drive, options: &PathOptions) -> Vec<PathBranch> {
    follow_path(assembly, drive, None, options, &mut |_, _| true).unwrap()
}

fn pressed(sides: usize, turn: f64) -> Vec<PathBranch> {
    let quantity = Driven::Vertices { vertices: vec![sides], direction: Vec3::z() };
    let stop = PathStop { arc_length: Some(0.4), ..PathStop::default() };
    let options = PathOptions { switch: true, stop, ..PathOptions::default() };
    followed(&pyramid(sides, turn, false), &Drive { quantity, to: -1.0 }, &options)
}

fn branch_points(branch: &PathBranch) -> Vec<&PathPoint> {
    branch.points.iter().filter(|point| point.event == Some(PathEvent::BranchPoint)).collect()
}

/// Checks that a branch point is double with 2N half branches, all of them found, and that as many branches leave, each
/// in one of the planes of reflection of the polygon, to all sides.
fn assert_star(branches: &[PathBranch], sides: usize, turn: f64, named: &str) {
    let known = branch_points(&branches[0])[0].branch_point.unwrap();
    assert_eq!(known.multiplicity, 2, "{named}");
    let all = 2 * sides;
    let counted = known.half_branches.map(|HalfBranches { found, expected, .. }| (found, expected));
    assert_eq!(counted, Some((all, Some(all))), "{named}");
    let mut directions: Vec<usize> = branches[1..]
        .iter()
        .map(|branch| {
            for point in &branch.points[1..] {
                let place = apex(point);
                let steps = (place.y.atan2(place.x) - turn) * all as f64 / TAU;
                let off = (steps - steps.round()).abs() * TAU / all as f64;
                assert!(off * place.x.hypot(place.y) <= 1e-4, "{named}: {off} at {place}");
            }
            let place = apex(&branch.points[1]);
            ((place.y.atan2(place.x) - turn) * all as f64 / TAU).round().rem_euclid(all as f64) as usize
        })
        .collect();
    directions.sort_unstable();
    assert_eq!(directions, (0..all).collect::<Vec<_>>(), "{named}");
    let points = branches.iter().map(|branch| branch_points(branch).len());
    assert!(points.into_iter().all(|count| count == 1), "{named}: other branch points");
}

/// Claim: the double branch point of pressed pyramids of 3 to 8 sides is where the closed form has it, and all its 2N
/// half branches are found and followed in the planes of reflection, whatever the turn about the axis. Tolerance: the
/// digits of the source; across the planes 1e-4, where a force of the tolerance moves the apex of the octagonal dome by
/// as much as soon as it is off the axis.
#[test]
fn all_half_branches_of_domes_are_found() {
    for (sides, turn) in [(3, 0.0), (4, 0.0), (4, TAU / 8.0), (4, 0.1), (5, 0.0), (6, 0.3), (7, 0.0), (8, 1.0)] {
        let branches = pressed(sides, turn);
        let drive = branch_points(&branches[0])[0].drive;
        assert!((drive - DOUBLE_POINT).abs() <= 2e-12, "{sides}: {drive}");
        assert_star(&branches, sides, turn, &format!("{sides} sides, turned by {turn}"));
    }
}

/// Claim: under a load the same branch point has the same branches. Sources and tolerances as above.
#[test]
fn all_half_branches_of_a_loaded_dome_are_found() {
    for turn in [0.0, 0.1] {
        let stop = PathStop { arc_length: Some(0.6), ..PathStop::default() };
        let options = PathOptions { switch: true, stop, ..PathOptions::default() };
        let branches = followed(&pyramid(4, turn, true), &Drive { quantity: Driven::Loads, to: 1.0 }, &options);
        let place = apex(branch_points(&branches[0])[0]);
        assert!((place.z - APEX_HEIGHT - DOUBLE_POINT).abs() <= 1e-10, "{place}");
        assert_star(&branches, 4, turn, &format!("loaded, turned by {turn}"));
    }
}

/// Claim: branches end where the drive or `stop` does, and list what `at` asks for, also beside their branch point, before
/// their first ordinary state: here 3e-5 and 6e-5 beyond the double point. Before, all eight ran on to eight times the
/// way. Tolerance: exact, and 1e-9, to which the stop is located.
#[test]
fn branches_end_with_the_drive_beside_their_branch_point() {
    let (quantity, to) = (Driven::Vertices { vertices: vec![4], direction: Vec3::z() }, DOUBLE_POINT - 6e-5);
    let beside = DOUBLE_POINT - 3e-5;
    let drive = |to| Drive { quantity: quantity.clone(), to };
    let options = PathOptions { switch: true, at: vec![beside], ..PathOptions::default() };
    let branches = followed(&pyramid(4, 0.3, false), &drive(to), &options);
    assert_eq!(branches.len(), 9);
    for branch in branches {
        let last = branch.points.last().unwrap();
        assert!(branch.end == PathEnd::Arrived && last.drive == to, "{:?} at {}", branch.end, last.drive);
        assert!(branch.points.iter().any(|point| point.drive == beside), "no state at {beside}");
    }
    let stop = PathStop { drive: Some(beside), ..PathStop::default() };
    let options = PathOptions { at: vec![], stop, ..options };
    let branches = followed(&pyramid(4, 0.3, false), &drive(-0.5), &options);
    assert_eq!(branches.len(), 9);
    for branch in branches {
        let last = branch.points.last().unwrap();
        assert!(
            branch.end == PathEnd::Stopped && (last.drive - beside).abs() <= 1e-9,
            "{:?} at {}",
            branch.end,
            last.drive
        );
    }
}

/// A dome of seven sides, of a ring of vertices and an apex within its pinned rim, turned about its axis by an angle,
/// under a load at the apex: bars and soft creases.
fn ringed_dome(turn: f64) -> Assembly {
    const SIDES: usize = 7;
    let corner = |k: f64, radius: f64, z: f64| {
        let (sin, cos) = (turn + TAU * k / SIDES as f64).sin_cos();
        [radius * cos, radius * sin, z]
    };
    let rim = (0..SIDES).map(|k| corner(k as f64, 1.0, 0.0));
    let ring = (0..SIDES).map(|k| corner(k as f64 + 0.5, 0.633, 0.4));
    let vertices: Vec<[f64; 3]> = rim.chain(ring).chain([[0.0, 0.0, 0.635]]).collect();
    let around = |k: usize| [k, (k + 1) % SIDES, SIDES + k, SIDES + (k + 1) % SIDES];
    let sectors = (0..SIDES).map(around);
    let faces: Vec<Vec<usize>> =
        sectors.flat_map(|[a, b, c, d]| [vec![a, b, c], vec![b, d, c], vec![c, d, 2 * SIDES]]).collect();
    let mut builder = Assembly::patch(sheet(&vertices, &faces), [1, 1]).bars(1.0).creases(1e-3);
    for k in 0..SIDES {
        builder = builder.pin(k, [0, 0], [true; 3]);
    }
    builder.load(2 * SIDES, [0, 0], [0.0, 0.0, -1.0]).build().unwrap()
}

/// Claim: all half branches of a double point are found where other branch points are as near as on a dome with a ring,
/// whatever the turn about the axis. Source: group theory, as above: 2N of N sides for every wave number, since N is
/// prime.
#[test]
fn all_half_branches_beside_other_branch_points_are_found() {
    for turn in [0.0, 1.0, 3.677] {
        let stop = PathStop { arc_length: Some(0.6), ..PathStop::default() };
        let options = PathOptions { switch: true, stop, ..PathOptions::default() };
        let branches = followed(&ringed_dome(turn), &Drive { quantity: Driven::Loads, to: 1.0 }, &options);
        let points = branch_points(&branches[0]);
        assert!(points.len() >= 2, "{turn}: {}", points.len());
        for known in points.into_iter().map(|point| point.branch_point.unwrap()) {
            let counted = known.half_branches.map(|HalfBranches { found, expected, .. }| (found, expected));
            assert_eq!((known.multiplicity, counted), (2, Some((14, Some(14)))), "{turn}");
        }
    }
}

/// The octagonal drum of Kresling's pattern whose upper vertices are pushed down by equal loads: radius, height and
/// twist 1, 1 and an eighth of a turn.
fn octagon() -> Assembly {
    let ring = |k: usize, turn: f64, z: f64| {
        let (sin, cos) = (TAU * (k as f64 + turn) / 8.0).sin_cos();
        [cos, sin, z]
    };
    let vertices: Vec<[f64; 3]> = (0..8).map(|k| ring(k, 0.0, 0.0)).chain((0..8).map(|k| ring(k, 1.0, 1.0))).collect();
    let faces: Vec<Vec<usize>> = (0..8)
        .flat_map(|k| {
            let next = (k + 1) % 8;
            [vec![k, next, 8 + next], vec![8 + next, 8 + k, k]]
        })
        .collect();
    let mut builder = Assembly::patch(sheet(&vertices, &faces), [1, 1]).bars(500.0).creases(0.001);
    for k in 0..8 {
        builder = builder.pin(k, [0, 0], [true; 3]).load(8 + k, [0, 0], [0.0, 0.0, -1.0]);
    }
    builder.build().unwrap()
}

/// Claim: the path of the loaded drum has the same branch points whatever the longest step, those beside limit points
/// too, and knows which are double. Source: those of the shortest step, of which -0.101516 and 0.115632 are also what
/// MERLIN's path of the same drum has. Tolerance: the digits of the source.
#[test]
fn branch_points_do_not_depend_on_the_step() {
    let assembly = octagon();
    let found = |max_step: f64| -> Vec<(f64, usize)> {
        let options = PathOptions { max_step, ..PathOptions::default() };
        let branches = followed(&assembly, &Drive { quantity: Driven::Loads, to: 1.0 }, &options);
        let points = branch_points(&branches[0]).into_iter();
        points.map(|point| (point.drive, point.branch_point.unwrap().multiplicity)).collect()
    };
    let fine = found(0.005);
    for (known, count) in [(-0.101_516, 2), (0.115_632, 2), (0.144_671, 1)] {
        let is_known = |found: &(f64, usize)| (found.0 - known).abs() <= 1e-6 && found.1 == count;
        assert!(fine.iter().any(is_known), "{known}: {fine:?}");
    }
    for max_step in [0.01, 0.015, 0.02, 0.03, 0.05, 0.07, 0.1] {
        let coarse = found(max_step);
        let same = |(a, b): (&(f64, usize), &(f64, usize))| (a.0 - b.0).abs() <= 1e-8 && a.1 == b.1;
        assert!(coarse.len() == fine.len() && coarse.iter().zip(&fine).all(same), "{max_step}: {coarse:?} {fine:?}");
    }
}

/// A column of rigid quadrilaterals of length 1/2 and width 1 between hinges, with rigid bars, pressed along its axis.
fn column(panels: usize) -> Assembly {
    let vertices: Vec<[f64; 3]> = (0..=panels).flat_map(|k| [0.0, 1.0].map(|y| [0.5 * k as f64, y, 0.0])).collect();
    let faces: Vec<Vec<usize>> = (0..panels).map(|k| [0, 2, 3, 1].map(|corner| 2 * k + corner).to_vec()).collect();
    let ends = [2 * panels, 2 * panels + 1];
    let mut builder = Assembly::patch(sheet(&vertices, &faces), [1, 1]).bars(RIGID).creases(1.0);
    for vertex in [0, 1] {
        builder = builder.pin(vertex, [0, 0], [true; 3]);
    }
    for vertex in ends {
        builder = builder.pin(vertex, [0, 0], [false, true, true]).load(vertex, [0, 0], [-0.5, 0.0, 0.0]);
    }
    builder.build().unwrap()
}

/// Claim: a straight column of eight rigid links has Euler's buckling loads for branch points, simple ones, and no
/// other event: its displacement, which is rounding error, has no extrema. Source: `2 c / a (1 - cos(m pi / 8))` of
/// links of length `a` between hinges of stiffness `c`. Tolerance: 1e-6, as rigid rows that nearly depend on each other
/// allow.
#[test]
fn a_straight_column_has_no_limit_points() {
    for max_step in [0.02, 0.1] {
        let options = PathOptions { max_step, ..PathOptions::default() };
        let branches = followed(&column(8), &Drive { quantity: Driven::Loads, to: 3.0 }, &options);
        let events: Vec<&PathPoint> = branches[0].points.iter().filter(|point| point.event.is_some()).collect();
        assert_eq!(events.len(), 3, "{max_step}: {:?}", events.iter().map(|e| (e.event, e.drive)).collect::<Vec<_>>());
        for (point, m) in events.iter().zip([1.0, 2.0, 3.0]) {
            let load = 4.0 * (1.0 - f64::cos(m * PI / 8.0));
            assert_eq!(point.branch_point.map(|known| (known.multiplicity, known.half_branches)), Some((1, None)));
            assert!((point.drive - load).abs() <= 1e-6, "{max_step}: {} {load}", point.drive);
        }
    }
}

/// A square with eight creases about its middle, valleys and mountains in turn, that folds towards flat.
fn eight_creases(turn: Option<Rotation3<f64>>, pinned: bool) -> Assembly {
    let around = [[1, 0], [1, 1], [0, 1], [-1, 1], [-1, 0], [-1, -1], [0, -1], [1, -1]];
    let vertices: Vec<[f64; 3]> =
        std::iter::once([0.0; 3]).chain(around.map(|[x, y]| [f64::from(x), f64::from(y), 0.0])).collect();
    let faces: Vec<Vec<usize>> = (1..=8).map(|k| vec![0, k, k % 8 + 1]).collect();
    let square = sheet(&vertices, &faces);
    let rest = |sheet: &Sheet| {
        let fold = |[i, j]: [usize; 2]| {
            if i.min(j) > 0 {
                0.0
            } else if i.max(j) % 2 == 1 {
                PI
            } else {
                -PI
            }
        };
        sheet.edges.iter().map(|edge| fold([edge.key.i, edge.key.j])).collect()
    };
    let rest = Rest::PerEdge(rest(&square));
    let square = turn.map_or(square.clone(), |turn| turned(square, turn.matrix()));
    let mut builder = Assembly::patch(square, [1, 1]).bars(1e4).creases(1.0).rest(rest);
    if pinned {
        for (vertex, axes) in [(0, [true; 3]), (1, [false, true, true]), (2, [false, false, true])] {
            builder = builder.pin(vertex, [0, 0], axes);
        }
    }
    builder.build().unwrap()
}

/// Claim: the path of a free sheet arrives where that of the same sheet arrives that pins hold in place, and that of a
/// turned one, without limit points on the way: rigid motions have no events. Source: energies and angles do not depend
/// on the place. Tolerance: states to 1e-12 of the forces.
#[test]
fn a_free_sheet_follows_the_path_of_a_pinned_one() {
    let turn = Rotation3::new(Vector3::new(0.4, -1.1, 0.7));
    let stop = PathStop { arc_length: Some(40.0), ..PathStop::default() };
    let options = PathOptions { stop, ..PathOptions::default() };
    let mut energies = vec![];
    for (turn, pinned) in [(None, true), (None, false), (Some(turn), false)] {
        let assembly = eight_creases(turn, pinned);
        let branch = followed(&assembly, &Drive { quantity: Driven::Rest, to: 1.0 }, &options).remove(0);
        assert_eq!(branch.end, PathEnd::Arrived, "pinned: {pinned}, {turn:?}");
        assert!(branch.points.iter().all(|point| point.event.is_none()), "pinned: {pinned}, {turn:?}");
        energies.push(branch.points.last().unwrap().state.total());
    }
    assert!(energies[1..].iter().all(|energy| (energy - energies[0]).abs() <= 1e-9 * energies[0]), "{energies:?}");
}

/// Claim: a path that begins in a relaxed state drives the stiffness of creases whose edges bars have stretched, since
/// stiffnesses are per drawn length; it begins with the energy of that state. Tolerance: rounding.
#[test]
fn a_stiffness_is_driven_from_a_relaxed_state() {
    let cell = fold::read(&case_folder().join("open-star.fold")).unwrap();
    let assembly = Assembly::torus(cell, [1, 1]).bars(30.0).creases(1.0).rest(Rest::Angle(0.3)).build().unwrap();
    let relaxed = relax(&assembly).unwrap();
    assert!(relaxed.state.energy_bars > 1e-3, "bars are strained: {}", relaxed.state.energy_bars);
    let drive = Drive { quantity: Driven::Stiffness(TermKind::Creases), to: 0.5 };
    let branches =
        follow_path(&assembly, &drive, Some(relaxed.configuration), &PathOptions::default(), &mut |_, _| true).unwrap();
    assert_eq!(branches[0].end, PathEnd::Arrived);
    let first = branches[0].points[0].state.total();
    assert!((first - relaxed.state.total()).abs() <= 1e-12 * first, "{first} {}", relaxed.state.total());
}

/// Claim: the loads under which flat plates of redundant bars buckle are the same for every stiffness of the bars, up
/// to exactly rigid ones, and for every step. Plates of 3 x 2 quadrilaterals with vertices at random, one side
/// pinned, the other one pushed. Source: bars of 1e6 to 1e10 have no choice of tensions. Tolerance: 1e-5, first order
/// in the softness and the rounding of stretches of 1e-10; 1e-8 between steps, to which branch points are located.
#[test]
fn plates_buckle_alike_at_every_stiffness() {
    for seed in 1..4 {
        let loads_by = |stiffness: f64, max_step: f64| {
            let load = Drive { quantity: Driven::Loads, to: 2.5 };
            let options = PathOptions { max_step, ..PathOptions::default() };
            let branches = followed(&braced_plate(seed, stiffness), &load, &options);
            assert_eq!(branches[0].end, PathEnd::Arrived, "seed {seed}, {stiffness:e}");
            branch_points(&branches[0]).iter().map(|point| point.drive).collect::<Vec<_>>()
        };
        let rigid = loads_by(RIGID, 0.05);
        assert!(rigid.len() >= 2, "{rigid:?}");
        for (stiffness, max_step, tolerance) in
            [(1e6, 0.05, 1e-5), (1e8, 0.05, 1e-5), (1e10, 0.05, 1e-5), (RIGID, 0.2, 1e-8), (RIGID, 0.01, 1e-8)]
        {
            let loads = loads_by(stiffness, max_step);
            let near = loads.iter().zip(&rigid).all(|(a, b)| (a / b - 1.0).abs() <= tolerance);
            assert!(
                near && loads.len() == rigid.len(),
                "seed {seed}, {stiffness:e}, {max_step}: {loads:?} and {rigid:?}"
            );
        }
    }
}

/// A flat plate of 3 x 2 quadrilaterals, each cut along its diagonal, whose inner vertices are moved at random; its left
/// side is pinned, and its right side, which stays in line with it, is pushed towards it.
fn braced_plate(seed: u64, bars: f64) -> Assembly {
    let mut numbers = Numbers::new(seed);
    let mut vertices = vec![];
    for j in 0..3 {
        for i in 0..4 {
            let mut moved = |inside: bool| if inside { numbers.within(0.2) } else { 0.0 };
            let inside = j == 1 && (1..3).contains(&i);
            vertices.push([f64::from(i) + moved(inside), 0.9 * f64::from(j) + moved(inside), 0.0]);
        }
    }
    let corners = (0..8).filter(|k| k % 4 < 3);
    let faces: Vec<Vec<usize>> = corners.flat_map(|k| [vec![k, k + 1, k + 5], vec![k, k + 5, k + 4]]).collect();
    let plate = Assembly::patch(sheet(&vertices, &faces), [1, 1]).bars(bars).creases(1.0).rest(Rest::Angle(0.0));
    let held = [0, 4, 8].map(|k| (k, [true; 3])).into_iter().chain([3, 7, 11].map(|k| (k, [false, true, true])));
    let plate = held.fold(plate, |plate, (vertex, axes)| plate.pin(vertex, [0, 0], axes));
    [3, 7, 11].into_iter().fold(plate, |plate, vertex| plate.load(vertex, [0, 0], [-1.0, 0.0, 0.0])).build().unwrap()
}
