//! Wells and barriers of sheets with rigid parts, guides and elements of different stiffness.
//!
//! Source of the closed forms: a drum of Kresling's pattern between rigid plates of six corners, whose bars have the
//! lengths `sqrt(h^2 + 2 - 2 cos t)` and `sqrt(h^2 + 2 - 2 cos(t - pi/3))` at height `h` and twist `t`. Its creases are
//! so soft (1e-12 of the bars) that they change no energy of bars by more than 1e-11.

use crate::common::{ForceCurve, Ran, Scene};
use approx::{abs_diff_eq, assert_relative_eq};
use foldwell::math::Vec3;
use foldwell::output::vtk::read_vtu;
use foldwell::study::wells::WellsSummary;
use std::f64::consts::FRAC_PI_3;

const HEIGHT: f64 = 1.2;
const TWIST: f64 = 1.9;

/// Height and twist of the second state of the drum, without energy, and energy of the unstable state between both, for
/// bars of EA = 1; the digits of the source.
const SECOND: [f64; 2] = [0.877_968_604, 2.288_790_20];
const UNSTABLE: f64 = 9.354_503_16e-5;

/// The lower plate of the drum held, the upper one free to move up and down and to turn about its axis.
const PLATES: &str = "[[part]]\nname = \"floor\"\nvertices = \"bottom\"\nfree = []\n\
                      [[part]]\nname = \"lid\"\nvertices = \"top\"\nfree = [\"z\", \"rz\"]\n";

/// Returns a scene of a mesh of `meshes` or `tests/cases`.
fn on(mesh: &str, rest: &str) -> Scene {
    Scene::on(&format!("mesh = \"{mesh}\""), rest)
}

/// Returns a scene of a mesh of its own.
fn on_own(mesh: &serde_json::Value, rest: &str) -> Scene {
    on("own.fold", rest).with("own.fold", mesh.to_string())
}

fn energies(found: &WellsSummary) -> Vec<f64> {
    found.wells.iter().map(|well| well.energy).collect()
}

/// Energy of the bars of the drum at a height and twist, with the stiffness of both sorts of bars, less the work of a
/// load on the lid.
fn energy([h, t]: [f64; 2], stiffness: [f64; 2], load: f64) -> f64 {
    let length = |h: f64, t: f64| (h * h + 2.0 - 2.0 * t.cos()).sqrt();
    let bar = |shift: f64| {
        let rest = length(HEIGHT, TWIST - shift);
        3.0 / rest * (length(h, t - shift) - rest).powi(2)
    };
    stiffness[0] * bar(0.0) + stiffness[1] * bar(FRAC_PI_3) - load * (h - HEIGHT)
}

/// The stationary state next to a height and twist, by Newton's method with central differences. The error of a
/// difference does not matter where it is zero to rounding.
fn stationary(mut at: [f64; 2], stiffness: [f64; 2], load: f64) -> [f64; 2] {
    let value = |dh: f64, dt: f64, at: [f64; 2]| energy([at[0] + dh, at[1] + dt], stiffness, load);
    for _ in 0..60 {
        let d = 1e-3;
        // fourth order, so that the state is found to 1e-11
        let first = |e: &dyn Fn(f64) -> f64| (8.0 * (e(d) - e(-d)) - (e(2.0 * d) - e(-2.0 * d))) / (12.0 * d);
        let g = [first(&|s| value(s, 0.0, at)), first(&|s| value(0.0, s, at))];
        let second = |e: &dyn Fn(f64) -> f64| (e(d) - 2.0 * e(0.0) + e(-d)) / (d * d);
        let [a, c] = [second(&|s| value(s, 0.0, at)), second(&|s| value(0.0, s, at))];
        let b = (value(d, d, at) - value(d, -d, at) - value(-d, d, at) + value(-d, -d, at)) / (4.0 * d * d);
        let det = a * c - b * b;
        at = [at[0] - (c * g[0] - b * g[1]) / det, at[1] - (a * g[1] - b * g[0]) / det];
    }
    at
}

/// Height and twist of the lid in a state of the wells: the first corners of both plates.
fn height_and_twist(ran: &Ran, state: usize) -> [f64; 2] {
    let points: Vec<Vec3> = read_vtu(&ran.out.file(format!("w/w_{state:04}.vtu"))).unwrap().points;
    let [below, above] = [points[0], points[6]];
    let twist = above.y.atan2(above.x) - below.y.atan2(below.x);
    [above.z - below.z, twist.rem_euclid(std::f64::consts::TAU)]
}

/// Claim: a drum between plates of which one turns freely has two wells within a radian of the drawn fold angles: the
/// drawn state and the second state of the closed form, without energy, and the pass between them is the unstable state
/// of the closed form, and that at which the path of the lid that is pressed down needs no force. Source: theory above,
/// digits of 40-digit arithmetic. Tolerance: the digits of the source; creases move states by 1e-12 over the stiffness
/// of bars, 1e-2; the path's energy is interpolated by a cubic between states 0.002 apart.
#[test]
fn a_drum_between_plates() {
    let scene = format!(
        "[energy]\nbars = {{ stiffness = 1.0 }}\ncreases = {{ stiffness = 1e-12 }}\n{PLATES}[[drive]]\nname = \"press\"\n\
         part = \"lid\"\naxis = \"z\"\nto = -0.2\n[[study]]\nname = \"w\"\nkind = \"wells\"\nspread = 1.0\n\
         barriers = [[0, 1]]\n[[study]]\nname = \"p\"\nkind = \"path\"\nmax_step = 0.01\n"
    );
    let ran = on("drum.fold", &scene).converged();
    let found = ran.wells("w");
    assert_eq!(found.wells.len(), 2, "{:?}", energies(found));
    assert_eq!((found.failed, found.wells[0].reached + found.wells[1].reached), (0, found.starts));
    assert!(found.wells.iter().all(|well| well.energy.abs() < 1e-11 && !well.self_intersecting), "{:?}", found.wells);
    let states = [0, 1].map(|well| height_and_twist(&ran, well));
    for (state, expected) in states.iter().zip([[HEIGHT, TWIST], SECOND]) {
        assert!((0..2).all(|k| abs_diff_eq!(state[k], expected[k], epsilon = 1e-8)), "{state:?} {expected:?}");
    }
    let pass = found.barriers[0].energy.unwrap();
    assert!(abs_diff_eq!(pass, UNSTABLE, epsilon = 1e-11), "{pass:e}");
    let path = ForceCurve::of(&ran.out.table("p.csv")).energy_without_force();
    assert_relative_eq!(pass, path, max_relative = 1e-8);
    let unstable = height_and_twist(&ran, 2);
    assert!(abs_diff_eq!(unstable[1], 2.0 * FRAC_PI_3, epsilon = 1e-8), "{unstable:?}");
}

/// Claim: bars of different stiffness, and a load on a rigid part, move wells and pass to where the closed form has
/// them; the stiffness may be given by FOLD assignments or for every edge. Source: stationary states of the closed
/// form, by Newton's method in height and twist. Tolerance: creases change energies by 1e-11.
#[test]
fn bars_of_two_sorts_and_a_load() {
    let by_sort = |[first, second]: [f64; 2]| {
        let row = |k: usize| format!("{},{},0,0,{first}\n{},{},0,0,{second}\n", k, k + 6, (k + 1) % 6, k + 6);
        let ring = |k: usize| format!("{},{},0,0,1\n{},{},0,0,1\n", k, (k + 1) % 6, k + 6, (k + 1) % 6 + 6);
        let rows: String = (0..6).map(|k| row(k) + &ring(k)).collect();
        format!("i,j,n1,n2,stiffness\n{rows}")
    };
    for (stiffness, load) in [([2.0, 0.5], 0.0), ([0.3, 5.0], -2e-4), ([1.0, 1.0], 3e-4)] {
        let pull = format!("[[load]]\nvertices = \"top\"\nforce = [0.0, 0.0, {:e}]\n", load / 6.0);
        let scene = format!(
            "[energy]\nbars = {{ stiffness = {{ file = \"bars.csv\" }} }}\ncreases = {{ stiffness = 1e-12 }}\n{PLATES}{}\
             [[study]]\nname = \"w\"\nkind = \"wells\"\nspread = 1.0\nbarriers = [[0, 1]]\n",
            if load == 0.0 { "" } else { &pull }
        );
        let ran = on("drum.fold", &scene).with("bars.csv", by_sort(stiffness)).converged();
        let found = ran.wells("w");
        let at = |near: [f64; 2]| energy(stationary(near, stiffness, load), stiffness, load);
        let mut expected = [at([HEIGHT, TWIST]), at(SECOND)];
        expected.sort_by(f64::total_cmp);
        let wells = energies(found);
        assert_eq!(wells.len(), 2, "{stiffness:?}: {wells:?}");
        assert!((0..2).all(|k| abs_diff_eq!(wells[k], expected[k], epsilon = 2e-11)), "{wells:?} {expected:?}");
        let (pass, expected) = (found.barriers[0].energy.unwrap(), at([1.055_483_23, 2.0 * FRAC_PI_3]));
        assert!(abs_diff_eq!(pass, expected, epsilon = 2e-11), "{stiffness:?} {load}: {pass:e} {expected:e}");
        assert_eq!(found.barriers[0].bars, Some(stiffness[0].max(stiffness[1])));
    }
}

/// Claim: a part that is held in all its motions is the same as pins of its vertices: for a pyramid on its base, wells,
/// counts of starts and the barrier are the same. Source: the same random numbers, and the same unknowns but for the
/// base. Tolerance: relaxations to 1e-12, passes to 1e-11 of the forces.
#[test]
fn a_held_part_is_pinned() {
    let energy = "[energy]\nbars = { stiffness = 1.0 }\ncreases = { stiffness = 1e-4 }\n";
    let study = "[[study]]\nname = \"w\"\nkind = \"wells\"\nstarts = 30\nbarriers = [[0, 1]]\n";
    let held =
        ["[[pin]]\nvertices = [1, 2, 3, 4]\n", "[[part]]\nname = \"base\"\nvertices = [1, 2, 3, 4]\nfree = []\n"];
    let ran = held.map(|held| on("cases/pyramid.fold", &format!("{energy}{held}{study}")).converged());
    let [pinned, part] = ran.each_ref().map(|ran| ran.wells("w"));
    assert_eq!((pinned.wells.len(), part.wells.len()), (2, 2));
    for (a, b) in pinned.wells.iter().zip(&part.wells) {
        assert!(a.reached == b.reached && abs_diff_eq!(a.energy, b.energy, epsilon = 1e-12), "{a:?} {b:?}");
    }
    assert_relative_eq!(pinned.barriers[0].energy.unwrap(), part.barriers[0].energy.unwrap(), max_relative = 1e-9);
}

/// Claim: guides are pins in other directions: the same pyramid turned by an angle about the y axis, whose apex rolls
/// on a plane that is turned with it, has the wells and the pass of the upright one whose apex is pinned along the
/// corresponding axis. A guide of a free sheet holds no shape. Tolerance: as above; positions are rounded when they are
/// turned.
#[test]
fn guides_are_pins_that_are_turned() {
    let pyramid: serde_json::Value = serde_json::from_str(include_str!("../../cases/pyramid.fold")).unwrap();
    let (sin, cos) = 0.4f64.sin_cos();
    let mut turned = pyramid.clone();
    for point in turned["vertices_coords"].as_array_mut().unwrap() {
        let [x, y, z] = [0, 1, 2].map(|k| point[k].as_f64().unwrap());
        *point = serde_json::json!([cos * x + sin * z, y, cos * z - sin * x]);
    }
    let energy =
        "[energy]\nbars = { stiffness = 1.0 }\ncreases = { stiffness = 1e-4 }\n[[pin]]\nvertices = [1, 2, 3, 4]\n";
    let study = "[[study]]\nname = \"w\"\nkind = \"wells\"\nstarts = 30\nbarriers = [[0, 1]]\n";
    let upright = format!("{energy}[[pin]]\nvertex = 0\naxes = \"x\"\n{study}");
    let leaning = format!("{energy}[[pin]]\nvertex = 0\nnormal = [{cos}, 0, {}]\n{study}", -sin);
    let ran = [on_own(&pyramid, &upright).converged(), on_own(&turned, &leaning).converged()];
    let [upright, leaning] = ran.each_ref().map(|ran| ran.wells("w"));
    assert_eq!((upright.wells.len(), leaning.wells.len()), (2, 2));
    for (a, b) in energies(upright).iter().zip(energies(leaning)) {
        assert!(abs_diff_eq!(*a, b, epsilon = 1e-12), "{a:e} {b:e}");
    }
    let [a, b] = [upright, leaning].map(|found| found.barriers[0].energy.unwrap());
    assert_relative_eq!(a, b, max_relative = 1e-9);
}

/// Claim: parts that are free change where a sheet lies, not what it is: a drum whose two plates both move freely has
/// the wells and the pass of the one that stands on its floor. Tolerance: passes to 1e-11 of the forces.
#[test]
fn free_plates() {
    let energy = "[energy]\nbars = { stiffness = 1.0 }\ncreases = { stiffness = 1e-6 }\n";
    let study = "[[study]]\nname = \"w\"\nkind = \"wells\"\nspread = 1.0\nstarts = 32\nbarriers = [[0, 1]]\n";
    let lid = "[[part]]\nname = \"lid\"\nvertices = \"top\"\n";
    let floor = "[[part]]\nname = \"floor\"\nvertices = \"bottom\"\n";
    let ran =
        ["", "free = []\n"].map(|held| on("drum.fold", &format!("{energy}{lid}{floor}{held}{study}")).converged());
    let [free, standing] = ran.each_ref().map(|ran| ran.wells("w"));
    let [a, b] = [free, standing].map(|found| (energies(found), found.barriers[0].energy.unwrap()));
    assert_eq!((a.0.len(), b.0.len()), (2, 2), "{a:?} {b:?}");
    assert!(a.0.iter().zip(&b.0).all(|(a, b)| abs_diff_eq!(*a, *b, epsilon = 1e-12)), "{a:?} {b:?}");
    assert_relative_eq!(a.1, b.1, max_relative = 1e-9);
}

/// Claim: the pass of a sheet with rigid parts starts again as what it is: a relaxation from its file takes no step or
/// one and keeps its energy, and a path from it begins without force, stable while the lid is held. Tolerance: 1e-12 of
/// energies; the pass is one to 1e-11 of the forces of its elements.
#[test]
fn a_pass_of_parts_starts_again() {
    let energy = format!("[energy]\nbars = {{ stiffness = 1.0 }}\ncreases = {{ stiffness = 1e-6 }}\n{PLATES}");
    let study = "[[study]]\nname = \"w\"\nkind = \"wells\"\nstarts = 64\nbarriers = [[0, 1]]\n";
    let ran = on("drum.fold", &format!("{energy}{study}")).converged();
    let found = ran.wells("w");
    let pass = found.barriers[0].energy.unwrap();
    let file = ran.out.file(format!("w/w_{:04}.vtu", found.wells.len())).display().to_string();
    let again = format!(
        "{energy}[[drive]]\nname = \"press\"\npart = \"lid\"\naxis = \"z\"\nto = -0.05\n[[study]]\nname = \"r\"\n\
         kind = \"relax\"\nstart = {file:?}\n[[study]]\nname = \"p\"\nkind = \"path\"\nstart = {file:?}\n"
    );
    let ran = on("drum.fold", &again).converged();
    let (relaxed, path) = (ran.relaxed("r"), ran.path("p"));
    assert!(relaxed.iterations <= 1 && relaxed.negative_eigenvalues == Some(1), "{relaxed:?}");
    assert_relative_eq!(relaxed.energy.total, pass, max_relative = 1e-12);
    assert!(path.branches[0].stable);
    let [drive, reaction, energy] = ForceCurve::of(&ran.out.table("p.csv")).states[0];
    assert!(drive == 0.0 && reaction.abs() < 1e-12, "{reaction:e}");
    assert_relative_eq!(energy, pass, max_relative = 1e-12);
}

/// Runs a study of wells of the drum between plates, with these stiffnesses of bars and creases.
fn drum(mesh: &serde_json::Value, [bars, creases]: [&str; 2]) -> WellsSummary {
    let scene = format!(
        "[energy]\nbars = {{ stiffness = {bars} }}\ncreases = {{ stiffness = {creases} }}\n{PLATES}[[study]]\n\
         name = \"w\"\nkind = \"wells\"\nstarts = 64\nbarriers = [[0, 1]]\n"
    );
    on_own(mesh, &scene).converged().wells("w").clone()
}

fn drum_mesh() -> serde_json::Value {
    serde_json::from_str(include_str!("../../../meshes/drum.fold")).unwrap()
}

/// Claim: equal stiffnesses in a table are one number, to the last bit; the unit of stiffness changes the unit of
/// energy and nothing else, exactly where it is a power of two. Source: no number of the computation has a unit of its
/// own.
#[test]
fn units_and_tables_of_stiffness() {
    let summary = |stiffness: [&str; 2]| {
        let found = drum(&drum_mesh(), stiffness);
        let wells: Vec<(u64, usize)> = found.wells.iter().map(|well| (well.energy.to_bits(), well.reached)).collect();
        (wells, found.barriers[0].energy.unwrap(), found.barriers[0].joins)
    };
    let plain = summary(["1.0", "1e-6"]);
    assert!(plain.0.len() >= 2);
    assert_eq!(plain, summary(["{ M = 1.0, V = 1.0, B = 1.0 }", "{ M = 1e-6, V = 1e-6 }"]));
    let uneven = |unit: f64| {
        let [bars, creases] = [[1.0, 0.25, 2.0], [1e-6, 4e-7, 0.0]].map(|each| each.map(|k| unit * k));
        let bars = format!("{{ M = {}, V = {}, B = {} }}", bars[0], bars[1], bars[2]);
        summary([&bars, &format!("{{ M = {}, V = {} }}", creases[0], creases[1])])
    };
    let (one, large) = (uneven(1.0), uneven(1024.0));
    assert_ne!(one.0, plain.0, "stiffness matters");
    for ((a, reached), (b, again)) in one.0.iter().zip(&large.0) {
        assert_eq!((1024.0 * f64::from_bits(*a), reached), (f64::from_bits(*b), again));
    }
    assert_eq!((one.0.len(), 1024.0 * one.1, one.2), (large.0.len(), large.1, large.2));
}

/// Claim: a sheet whose elements have different stiffness does not depend on the numbers of its vertices: wells and
/// barrier are the same when these are reversed. Tolerance: relaxations to 1e-12, passes to 1e-11 of the forces.
#[test]
fn numbers_of_vertices_mean_nothing() {
    let drawn = drum_mesh();
    let mut reversed = drawn.clone();
    reversed["vertices_coords"].as_array_mut().unwrap().reverse();
    let last = reversed["vertices_coords"].as_array().unwrap().len() as u64 - 1;
    let renumber = |list: &mut serde_json::Value| {
        list.as_array_mut().unwrap().iter_mut().for_each(|vertex| *vertex = (last - vertex.as_u64().unwrap()).into());
    };
    reversed["faces_vertices"].as_array_mut().unwrap().iter_mut().for_each(renumber);
    reversed["foldwell:names"].as_object_mut().unwrap().values_mut().for_each(renumber);
    let stiffness = ["{ M = 1.0, V = 0.25, B = 2.0 }", "{ M = 1e-6, V = 4e-7 }"];
    let [a, b] = [drawn, reversed].map(|mesh| drum(&mesh, stiffness));
    assert!(a.wells.len() >= 2 && b.wells.len() >= 2, "others pass through themselves, and few starts reach them");
    assert!(
        energies(&a)[..2].iter().zip(energies(&b)).all(|(a, b)| abs_diff_eq!(*a, b, epsilon = 1e-14)),
        "{a:?} {b:?}"
    );
    assert_relative_eq!(a.barriers[0].energy.unwrap(), b.barriers[0].energy.unwrap(), max_relative = 1e-9);
}

/// Claim: wells and pass of a sheet whose mountains, valleys and flat creases have different stiffness are those that
/// are found in fold angles alone, without bars, random starts and strings. Source: `analysis/wells/rigid`, which
/// shares no equation with bars. Tolerance: relaxations to 1e-12, passes to 1e-11 of the forces, closure to 1e-13.
#[test]
fn uneven_creases_in_fold_angles_alone() {
    let ran = on(
        "open-star.fold",
        "domain = \"screw\"\n[energy]\nbars = { stiffness = inf }\ncreases = { stiffness = { M = 1.0, V = 1.5, F = 0.8 }, \
         rest = { file = \"star-wells-rest.csv\" } }\n[[study]]\nname = \"w\"\nkind = \"wells\"\nspread = 1.0\nrigid = true\n\
         resolution = 40\nmax_curvature = 0.5\nbarriers = [[0, 1]]\n",
    )
    .converged();
    let found = ran.wells("w");
    let rigid = found.rigid.as_ref().unwrap();
    assert!(found.wells.len() == 3 && rigid.wells.len() >= 3, "{rigid:?}");
    for (k, well) in found.wells.iter().enumerate() {
        assert!(well.rigid == Some(k) && abs_diff_eq!(well.energy, rigid.wells[k], epsilon = 1e-10), "{well:?}");
    }
    let pass = rigid.passes.iter().find(|pass| pass.joins == [0, 1]).unwrap();
    assert!(!pass.singular);
    assert_relative_eq!(found.barriers[0].energy.unwrap(), pass.energy, max_relative = 1e-9);
}

/// Claim: wells of rigid states, which are sought in fold angles, are refused with parts and guides, which these do not
/// know.
#[test]
fn rigid_wells_know_no_parts() {
    let cases = ["[[part]]\nname = \"p\"\nvertices = [0, 1, 2]\n", "[[pin]]\nvertex = 0\nnormal = [0, 1, 1]\n"];
    for held in cases {
        let energy = "[energy]\nbars = { stiffness = inf }\ncreases = { stiffness = 1.0 }\n";
        let study = "[[study]]\nname = \"w\"\nkind = \"wells\"\nrigid = true\n";
        on("cases/pyramid.fold", &format!("{energy}{held}{study}")).refused("which pins, parts and loads do not know");
    }
}
