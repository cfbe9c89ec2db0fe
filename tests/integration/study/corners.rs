//! Paths over corners of laws, where stiffness jumps.
//!
//! Source: a pyramid of bars of `EA = 1` on a ring of radius 1 whose strain is `-0.02` has the length `l = 0.98 L` and
//! bears `N 0.02 z / l` at the height `z` of its apex. Behind that corner the bars have 0.02 of their stiffness. A pyramid
//! of height 1/2 then bears less, so that its load is largest there; one of height 5/2 bears more, but its apex is no
//! longer stable across the axis, where bars of tension `t` and stiffness `k` have `(t / l) (1 - 1/(2 l^2)) + k / (2 l^2 L)`
//! each: two eigenvalues change their sign.

use crate::common::Scene;
use foldwell::math::Vec3;
use std::f64::consts::TAU;

/// The law with the corner at a strain of -0.02, as one of two stiffnesses and as a formula.
const LAWS: [&str; 2] = [
    "kind = \"bilinear\", ratio = 0.02, at = [-0.02, 0.05]",
    "kind = \"formula\", force = \"k*(0.51*(m - m0) + 0.49*(abs(m - 0.98*m0) - 0.02*m0))\"",
];

/// Returns a pyramid of bars of this law that its load presses down and up again, and the load at the corner.
fn pyramid(law: &str, bars: usize, height: f64, max_step: f64, keys: &str) -> (Scene, f64) {
    let ring = (0..bars).map(|k| {
        let (sin, cos) = (0.3 + TAU * k as f64 / bars as f64).sin_cos();
        [cos, sin, 0.0]
    });
    let points: Vec<[f64; 3]> = std::iter::once([0.0, 0.0, height]).chain(ring).collect();
    let edges: Vec<[usize; 2]> = (1..=bars).map(|k| [0, k]).collect();
    let pins: Vec<usize> = (1..=bars).collect();
    let mesh = format!("{{\"vertices_coords\": {points:?}, \"faces_vertices\": [], \"edges_vertices\": {edges:?}}}");
    let text = format!(
        "[energy]\nbars = {{ stiffness = 1.0, law = {{ {law} }} }}\n\
         [[pin]]\nvertices = {pins:?}\n[[load]]\nvertex = 0\nforce = [0.0, 0.0, -1.0]\n\
         [[drive]]\nname = \"load\"\nload = true\nto = 0.4\n\
         [[study]]\nname = \"p\"\nkind = \"path\"\ndraw = []\nmax_step = {max_step:?}\n{keys}"
    );
    let length = 0.98 * Vec3::new(1.0, 0.0, height).norm();
    let load = 0.02 * bars as f64 * (length * length - 1.0).sqrt() / length;
    (Scene::on("mesh = \"pyramid.fold\"", &text).with("pyramid.fold", mesh), load)
}

/// Claim: the largest load at a corner is found whatever the longest step, and the pyramid snaps there; before or after it
/// two eigenvalues vanish at the same corner. Tolerance: 1e-9, to which a sign change is located.
#[test]
fn a_load_is_largest_at_a_corner() {
    for (law, max_step) in LAWS.into_iter().flat_map(|law| [0.02, 0.05, 0.1, 0.2].map(|step| (law, step))) {
        let (scene, load) = pyramid(law, 3, 0.5, max_step, "snap = true");
        let ran = scene.converged();
        let events = &ran.path("p").branches[0].events;
        let events: Vec<_> = events.iter().filter(|event| event.event != "branch-point").collect();
        let [limit, snap] = events[..] else { panic!("{max_step}: {events:?}") };
        assert_eq!([&limit.event[..], &snap.event], ["limit-load", "snap"], "{law}, {max_step}");
        let drive = limit.drive.unwrap();
        assert!((drive - load).abs() <= 1e-9, "{law}, {max_step}: {drive} for {load}");
    }
}

/// Claim: the branch points at the corner, on the way down and on the way up, are found whatever the longest step, with
/// two eigenvalues. Tolerance: 1e-9, as above.
#[test]
fn branch_points_at_a_corner_do_not_depend_on_the_step() {
    for max_step in [0.011, 0.05, 0.1, 0.2] {
        let (scene, load) = pyramid(LAWS[0], 5, 2.5, max_step, "");
        let ran = scene.ran();
        let events = &ran.path("p").branches[0].events;
        let points = events.iter().filter(|event| event.event == "branch-point");
        let found: Vec<(f64, Option<usize>)> = points.map(|event| (event.drive.unwrap(), event.multiplicity)).collect();
        let [down, up] = found[..] else { panic!("{max_step}: {found:?}") };
        assert!(down.1 == Some(2) && up.1 == Some(2), "{max_step}: {found:?}");
        assert!((down.0 - load).abs() <= 1e-9 && (up.0 + load).abs() <= 1e-9, "{max_step}: {found:?} for {load}");
    }
}

/// Claim: `stop = { states = n }` ends a branch with so many states, also where a located event falls into its last step.
/// Exact.
#[test]
fn a_branch_ends_with_the_states_asked_for() {
    for states in 2..=12 {
        let (scene, _) = pyramid(LAWS[0], 3, 0.5, 0.2, &format!("stop = {{ states = {states} }}"));
        assert_eq!(scene.converged().path("p").branches[0].steps, states);
    }
}

/// Claim: the path of a dome whose creases yield a corner each keeps to its curve whatever the longest step: it arrives, and
/// has no branch point, since the dome has no symmetry. Source: an independent arc-length continuation, by which the
/// reaction is first largest at the corner at -0.508362 and the curve arrives. Tolerance: 2e-6, the distance in which two
/// creases of the dome pass their corners.
#[test]
fn paths_keep_to_their_curve_over_corners() {
    let text = "[energy]\nbars = { stiffness = 1.0 }\n\
                creases = { stiffness = 0.01, law = { kind = \"bilinear\", ratio = 0.2, at = 0.1 } }\n\
                [[pin]]\nvertices = [7, 8, 9, 10, 11, 12]\n\
                [[drive]]\nname = \"apex\"\nvertices = [0]\naxis = \"z\"\nto = -1.2\n\
                [[study]]\nname = \"p\"\nkind = \"path\"\ndraw = []\nmax_step = ";
    for max_step in [0.015, 0.03, 0.05, 0.1, 0.15] {
        let ran = Scene::on("mesh = \"cases/dome-of-six.fold\"", &format!("{text}{max_step}")).ran();
        let branch = &ran.path("p").branches[0];
        assert_eq!(branch.end, "arrived", "{max_step}: {:?}", branch.events);
        let points = branch.events.iter().filter(|event| event.event == "branch-point").count();
        let drives: Vec<f64> = branch.events.iter().filter_map(|event| event.drive).collect();
        let passes = |value: f64| drives.iter().any(|drive| (drive - value).abs() <= 2e-6);
        assert_eq!(points, 0, "{max_step}: {:?}", branch.events);
        assert!([-0.508362, -0.924175, -0.979584].into_iter().all(passes), "{max_step}: {drives:?}");
    }
}

/// A saddle of twelve cables of `EA = 10` between eight supports, drawn without force and turned by an angle about the axis
/// of x, and a scene that pulls at three of its four joints.
fn net(angle: f64, load: [f64; 3], to: f64) -> Scene {
    let turned = |[x, y, z]: [f64; 3]| {
        let (sin, cos) = angle.sin_cos();
        [x, cos * y - sin * z, sin * y + cos * z]
    };
    let (low, high) =
        ([[1.0, 0.0], [2.0, 0.0], [1.0, 3.0], [2.0, 3.0]], [[0.0, 1.0], [3.0, 1.0], [0.0, 2.0], [3.0, 2.0]]);
    let joints = [[1.0, 1.0], [2.0, 1.0], [1.0, 2.0], [2.0, 2.0]];
    let at = |places: [[f64; 2]; 4], z: f64| places.map(|[x, y]| turned([x, y, z]));
    let points = [at(joints, 0.0), at(low, -0.3), at(high, 0.3)].concat();
    let edges = [[0, 1], [1, 3], [3, 2], [2, 0], [4, 0], [5, 1], [2, 6], [3, 7], [8, 0], [1, 9], [10, 2], [3, 11]];
    let mesh = format!("{{\"vertices_coords\": {points:?}, \"faces_vertices\": [], \"edges_vertices\": {edges:?}}}");
    let text = format!(
        "[energy]\nbars = {{ stiffness = 10.0, law = {{ kind = \"bilinear\", ratio = 0.0, at = [0.0, inf] }} }}\n\
         [[pin]]\nvertices = [4, 5, 6, 7, 8, 9, 10, 11]\n[[load]]\nvertices = [0, 1, 2]\nforce = {:?}\n\
         [[drive]]\nname = \"load\"\nload = true\nto = {to:?}\n[[study]]\nname = \"p\"\nkind = \"path\"\ndraw = []\n",
        turned(load)
    );
    Scene::on("mesh = \"net.fold\"", &text).with("net.fold", mesh)
}

/// Claim: the path of cables drawn without force, whose load grows with the third power of the way, sets out towards the load
/// that is asked for, however the net is drawn, and leads to the minimum of its energy, which is convex. Source: that minimum
/// by the BFGS method of SciPy, from five starts: energies of the cables. Tolerance: 1e-8, as good as its energies are.
#[test]
fn nets_without_force() {
    let down = [0.0, 0.0, -1.0];
    let aslant = [0.3, 0.1, -1.0];
    let cases = [
        (down, 0.3, 0.0793596878),
        (down, -0.2, 0.0423563865),
        (aslant, 0.2, 0.0423782151),
        (aslant, -0.2, 0.0451460995),
        (aslant, 0.3, 0.0793472284),
    ];
    for ((load, to, energy), angle) in cases.into_iter().flat_map(|case| [0.0, 0.7, 2.0].map(|angle| (case, angle))) {
        let ran = net(angle, load, to).converged();
        assert!(ran.path("p").branches[0].events.is_empty(), "{load:?}, {to}: {:?}", ran.path("p").branches[0].events);
        let found = ran.out.table("p.csv").last("energy_bars");
        assert!((found - energy).abs() <= 1e-8, "{load:?}, {to}, {angle}: {found} for {energy}");
    }
}
