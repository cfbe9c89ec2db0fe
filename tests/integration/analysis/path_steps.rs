//! Steps of paths: whatever the longest one, a path stays on its own curve of equilibria, passes states in which
//! triangles are nearly flat as the energy says, and misses no pair of events.
//!
//! Sources: minima followed in 400 increments of the drive by Newton's method with full eigenvalue decompositions, in
//! a program of its own (energies of four sheets); the energy of one hinge, `k l (phi - phi0)^2 / 2`.

use foldwell::analysis::path::{BranchPoint, PathBranch, PathEnd, PathEvent, PathOptions, PathPoint, follow_path};
use foldwell::math::Vec3;
use foldwell::model::{Builder, Drive, Driven, TermKind};
use foldwell::sheet::fold;
use foldwell::{Assembly, Rest};
use std::f64::consts::{PI, TAU};

const STEPS: [f64; 3] = [0.01, 0.05, 0.2];

/// A sheet with bars and creases of these stiffnesses that rest as drawn, some of its vertices pinned.
fn pinned(vertices: &[[f64; 3]], faces: &[[usize; 3]], [bars, creases]: [f64; 2], pins: &[usize]) -> Builder {
    let mesh = serde_json::json!({ "file_spec": 1.2, "vertices_coords": vertices, "faces_vertices": faces });
    let sheet = fold::parse(&mesh.to_string(), "s.fold").unwrap();
    let builder = Assembly::patch(sheet, [1, 1]).bars(bars).creases(creases).rest(Rest::Drawn);
    pins.iter().fold(builder, |builder, vertex| builder.pin(*vertex, [0, 0], [true; 3]))
}

fn followed(assembly: &Assembly, quantity: Driven, to: f64, max_step: f64) -> PathBranch {
    let options = PathOptions { max_step, ..PathOptions::default() };
    follow_path(assembly, &Drive { quantity, to }, None, &options, &mut |_, _| true).unwrap().swap_remove(0)
}

fn moved(vertex: usize, direction: [f64; 3]) -> Driven {
    Driven::Vertices { vertices: vec![vertex], direction: Vec3::from(direction).normalize() }
}

/// The driven values at events of a kind.
fn events(branch: &PathBranch, event: PathEvent) -> Vec<f64> {
    branch.points.iter().filter(|point| point.event == Some(event)).map(|point| point.drive).collect()
}

/// Checks that the energy grows by the work all the way, to this part of the largest one.
fn assert_conserved(branch: &PathBranch, part: f64, named: &str) {
    let largest = branch.points.iter().fold(0.0, |most, point| f64::max(most, point.work.abs()));
    for point in &branch.points {
        let off = point.state.total() - branch.points[0].state.total() - point.work;
        assert!(off.abs() <= part * largest, "{named}: {off:e} of {largest:e} at {}", point.drive);
    }
}

/// Vertices, faces, stiffness of the bars, pinned vertices, the drive and the energy at its end.
type Case = (&'static [[f64; 3]], &'static [[usize; 3]], f64, [usize; 3], (usize, [f64; 3], f64), f64);

/// Sheets that steps of 0.05 or 0.2 led to other equilibria, with their energies by the source.
const STIFF: [Case; 4] = [
    (
        &[
            [0.0, 0.866, 0.088],
            [0.688, 0.391, 0.024],
            [0.17, 0.336, 0.096],
            [0.102, 0.79, 0.045],
            [0.226, 0.617, 0.188],
            [0.552, 0.668, 0.009],
            [0.618, 0.862, 0.003],
        ],
        &[[2, 3, 0], [4, 2, 1], [5, 4, 1], [4, 3, 2], [6, 5, 1], [3, 6, 0], [6, 4, 5], [4, 6, 3]],
        1e6,
        [4, 3, 2],
        (0, [0.12, 0.32, 0.86], -0.357),
        109_811.477_1,
    ),
    (
        &[
            [0.266, 0.006, 0.048],
            [0.378, 0.742, -0.01],
            [0.65, 0.354, -0.06],
            [0.328, 0.788, -0.037],
            [0.692, 0.71, 0.204],
            [0.857, 0.914, 0.02],
        ],
        &[[2, 1, 0], [1, 3, 0], [3, 1, 5], [1, 4, 5], [4, 2, 5], [2, 4, 1]],
        1e6,
        [2, 4, 1],
        (0, [0.0, 0.0, 1.0], 0.829),
        196_841.889_5,
    ),
    (
        &[
            [0.991, 0.466, 0.122],
            [0.597, 0.257, -0.078],
            [0.167, 0.877, 0.221],
            [0.182, 0.259, 0.068],
            [0.836, 0.878, -0.07],
        ],
        &[[3, 1, 2], [1, 4, 2], [4, 1, 0]],
        1e6,
        [1, 4, 2],
        (0, [0.0, 1.0, 0.0], -0.342),
        92_623.629_92,
    ),
    (
        &[[0.789, 0.722, -0.112], [0.046, 0.329, -0.186], [0.262, 0.564, 0.037], [0.887, 0.306, -0.124]],
        &[[3, 2, 1], [0, 2, 3]],
        1e4,
        [0, 2, 3],
        (1, [0.0, 1.0, 0.0], -0.477),
        1_347.259_042,
    ),
];

/// Claim: sheets whose bars are 1e4 and 1e6 times as stiff as their creases, stretched by a vertex until they store
/// energies of that size, are stable and without branch points all the way, with the same energies for every longest
/// step. Steps of 0.05 and 0.2 led to other equilibria beside, of which one counted an eigenvalue too many. Tolerance:
/// the digits of the source; 1e-7 of the work, which is integrated, where a step to another curve changes it by more.
#[test]
fn stiff_sheets_go_one_way() {
    for (number, (vertices, faces, bars, pins, (vertex, direction, to), energy)) in STIFF.into_iter().enumerate() {
        let assembly = pinned(vertices, faces, [bars, 1.0], &pins).build().unwrap();
        for max_step in STEPS {
            let named = format!("case {number}, steps of {max_step}");
            let branch = followed(&assembly, moved(vertex, direction), to, max_step);
            assert_eq!(branch.end, PathEnd::Arrived, "{named}");
            let last = branch.points.last().unwrap();
            assert!((last.state.total() / energy - 1.0).abs() <= 1e-9, "{named}: {}", last.state.total());
            assert!((last.drive - to).abs() <= 1e-9, "{named}: {}", last.drive);
            assert!(branch.points.iter().all(|point| point.negative_eigenvalues == Some(0)), "{named}: unstable");
            assert!(events(&branch, PathEvent::BranchPoint).is_empty(), "{named}: branch points");
            assert_conserved(&branch, 1e-7, &named);
        }
    }
}

/// Claim: a triangle whose free vertex passes the hinge at a small height turns over, at the cost of the hinge's energy
/// and with one and the same largest force for every step; in the plane of the hinge it loses its height, and the path
/// ends there. Before, it went on with the energy of half a turn and no work. Tolerance: the height moves the largest
/// force little, which is located to 1e-9; work as above, its force a peak as narrow as the height.
#[test]
fn a_triangle_turns_over_at_the_cost_of_its_hinge() {
    let over = |height: f64, max_step: f64| {
        let vertices = [[0.0, 0.0, 0.0], [0.0, 1.0, 0.0], [-1.0, 0.5, 0.0], [1.0, 0.5, height]];
        let builder = pinned(&vertices, &[[0, 1, 2], [1, 0, 3]], [1.0, 0.01], &[0, 1, 2]);
        let assembly = builder.pin(3, [0, 0], [false, false, true]).build().unwrap();
        followed(&assembly, moved(3, [1.0, 0.0, 0.0]), -2.0, max_step)
    };
    for height in [1e-5f64, 1e-3] {
        let turn = PI - 2.0 * height.atan();
        let forces = STEPS.map(|max_step| {
            let branch = over(height, max_step);
            let last = branch.points.last().unwrap();
            assert_eq!(branch.end, PathEnd::Arrived, "{height} {max_step}");
            assert!((last.state.total() - 0.005 * turn * turn).abs() <= 1e-12, "{height} {max_step}");
            assert_conserved(&branch, 1e-7, &format!("{height} {max_step}"));
            branch.points.iter().fold(0.0, |most, point| f64::max(most, point.reaction.abs()))
        });
        assert!(forces.iter().all(|force| (force / forces[0] - 1.0).abs() <= 1e-6), "{height}: {forces:?}");
    }
    assert!(STEPS.iter().all(|max_step| over(0.0, *max_step).end == PathEnd::Failed));
}

/// Claim: a pyramid of three sides with creases that is pressed through its base has four double branch points on its
/// way, of which two lie within one step of 0.2: they are found for every step. Source: the values with steps of 0.01,
/// at which each is alone in its step. Tolerance: that to which a double zero of the stiffness is located.
#[test]
fn pairs_of_branch_points_in_a_step_are_found() {
    let corner = |k: usize| {
        let (sin, cos) = (TAU * k as f64 / 3.0).sin_cos();
        [cos, sin, 0.0]
    };
    let vertices = [[0.0, 0.0, 2.0], corner(0), corner(1), corner(2)];
    let assembly = pinned(&vertices, &[[0, 1, 2], [0, 2, 3], [0, 3, 1]], [1.0, 0.02], &[1, 2, 3]);
    let assembly = assembly.build().unwrap();
    let [fine, usual, coarse] = STEPS.map(|max_step| {
        let branch = followed(&assembly, moved(0, [0.0, 0.0, 1.0]), -4.4, max_step);
        assert_eq!(branch.end, PathEnd::Arrived);
        let double = |point: BranchPoint| point.multiplicity == 2;
        assert!(branch.points.iter().filter_map(|point| point.branch_point).all(double), "{max_step}");
        events(&branch, PathEvent::BranchPoint)
    });
    assert_eq!(fine.len(), 4, "{fine:?}");
    for found in [usual, coarse] {
        assert!(found.len() == 4 && fine.iter().zip(&found).all(|(a, b)| (a - b).abs() <= 1e-8), "{fine:?} {found:?}");
    }
}

/// Claim: a driven stiffness that turns back at a limit point ends where it began, for every step; before, it went on
/// to negative stiffness.
#[test]
fn a_driven_stiffness_ends_where_it_began() {
    let vertices =
        [[0.0716, 0.9231, 0.1652], [0.0357, 0.0875, -0.1802], [0.1257, 0.4777, 0.2029], [0.375, 0.1033, 0.1681]];
    let builder = pinned(&vertices, &[[3, 2, 1], [2, 0, 1], [0, 2, 3]], [1e4, 1.0], &[0, 2, 3]);
    let assembly = builder.rest(Rest::Angle(1.3507)).build().unwrap();
    for max_step in STEPS {
        let branch = followed(&assembly, Driven::Stiffness(TermKind::Creases), 20.0, max_step);
        assert_eq!((&branch.end, events(&branch, PathEvent::LimitLoad).len()), (&PathEnd::Returned, 1), "{max_step}");
        assert!((branch.points.last().unwrap().drive - 1.0).abs() <= 1e-9, "{max_step}");
    }
}

/// Claim: a sheet that is stretched until one of its triangles has no height ends there, stable and without events, for
/// every step. Before, it arrived with steps of 0.05 at another equilibrium, was lost with 0.2, and ended later with
/// 0.01. Tolerance: a last step that is refused is within 1e-6 of the collapse.
#[test]
fn paths_end_where_a_triangle_collapses() {
    let vertices = [
        [0.251, 0.651, 0.059],
        [0.495, 0.001, 0.299],
        [0.942, 0.341, 0.078],
        [0.276, 0.24, -0.133],
        [0.338, 0.51, -0.047],
        [0.822, 0.63, -0.146],
    ];
    let faces = [[4, 1, 2], [4, 5, 0], [5, 4, 2], [3, 4, 0], [4, 3, 1]];
    let assembly = pinned(&vertices, &faces, [1e6, 1.0], &[4, 1, 2]).build().unwrap();
    let ends = STEPS.map(|max_step| {
        let branch = followed(&assembly, moved(3, [0.34, 0.89, 0.11]), -0.998, max_step);
        assert_eq!(branch.end, PathEnd::Failed, "{max_step}");
        let is_plain = |point: &PathPoint| point.event.is_none() && point.negative_eigenvalues == Some(0);
        assert!(branch.points.iter().all(is_plain), "{max_step}");
        branch.points.last().unwrap().drive
    });
    assert!(ends.iter().all(|end| (end - ends[0]).abs() <= 1e-6), "{ends:?}");
}
