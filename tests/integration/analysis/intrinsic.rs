//! Relaxation in fold angles against relaxation in the positions of the vertices, which shares no equation with it but
//! the springs.

use crate::common::{Scene, Testing, distance, mesh, patch};
use foldwell::analysis::relax::{IntrinsicFailure, Method, RelaxError, RelaxOptions, Relaxed, relax_from};
use foldwell::kinematics::folding_modes;
use foldwell::math::Vec3;
use foldwell::model::intrinsic::Unsupported;
use foldwell::model::{Assembly, Gauge, RIGID, Terms};
use foldwell::numerics::parallel::Threads;
use serde_json::Value;

fn relaxed(assembly: &Assembly, terms: &Terms, method: Method) -> Result<Relaxed, Box<RelaxError>> {
    let model = assembly.model_of(terms, Gauge::Held);
    relax_from(&model, model.start(), RelaxOptions { method, ..RelaxOptions::default() }, &mut |_| true)
}

/// Terms whose creases rest as one mode of rigid folding with these curvatures asks, the same in every cell.
fn along_mode(assembly: &Assembly, curvature: [f64; 3], bars: f64) -> Terms {
    let rates = folding_modes(assembly.sheet()).unwrap().named(curvature).unwrap();
    let angles = assembly.tiling().edges.iter().zip(assembly.drawn_angles());
    Terms::bars_and_creases(bars, 1.0, angles.map(|(edge, angle)| angle + rates[edge.edge]).collect())
}

/// The method in fold angles ends in a minimum after at most `most` steps. Returns whether it is the one that moved
/// vertices find; if not, it is lower.
fn agree(assembly: &Assembly, terms: &Terms, most: usize, what: &str) -> bool {
    let intrinsic = relaxed(assembly, terms, Method::Intrinsic).unwrap();
    let vertices = relaxed(assembly, terms, Method::Vertices).unwrap();
    assert_eq!(intrinsic.intrinsic_failure, None, "{what}");
    assert!(intrinsic.history[0].intrinsic && !vertices.history.iter().any(|step| step.intrinsic), "{what}");
    assert!(intrinsic.iterations <= most, "{what}: {} steps", intrinsic.iterations);
    assert!(intrinsic.residual_force <= 1e-11 && intrinsic.residual_length <= 1e-12, "{what}: {intrinsic:?}");
    assert_eq!(intrinsic.negative_eigenvalues, Some(0), "{what}");
    let [found, expected] = [&intrinsic, &vertices].map(|relaxed| relaxed.state.total());
    if found < (1.0 - 1e-3) * expected {
        println!("{what}: {found}, moved vertices end in {expected}");
        return false;
    }
    assert!((found - expected).abs() <= 1e-9 * expected, "{what}: {found} and {expected}");
    let angles = distance(&intrinsic.state.fold_angle, &vertices.state.fold_angle);
    assert!(angles <= 1e-6, "{what}: fold angles differ by {angle:e}", angle = angles);
    let forces = distance(&intrinsic.state.tension, &vertices.state.tension);
    let largest = vertices.state.tension.iter().fold(0.0f64, |most, t| most.max(t.abs()));
    assert!(forces <= 1e-5 * largest, "{what}: tensions differ by {forces:e} of {largest:e}");
    true
}

/// Claim: rest angles along one mode, the same in every cell, are relaxed in at most 15 steps (20 for the amplitude
/// 0.2) at every size and stiffness, to the energy that moving vertices finds (theory, section 10). Tolerance: energies
/// to 1e-9, as stated there; angles and tensions as far as residuals of 1e-12 determine them. In one of 40 cases (12
/// cells, [0.05, -0.05, 0], bars 1e2) there are two minima, and that of the fold angles is lower.
#[test]
fn modes_at_every_stiffness() {
    let mut others = 0;
    for curvature in [[0.0, 0.05, 0.0], [0.0, 0.2, 0.0], [0.05, 0.05, 0.0], [0.05, -0.05, 0.0], [0.2, 0.2, 0.0]] {
        let most = if curvature.contains(&0.2) { 20 } else { 15 };
        for cells in [4, 12] {
            let assembly = patch("open-star", [cells; 2]);
            for bars in [1e2, 1e4, 1e8, RIGID] {
                let terms = along_mode(&assembly, curvature, bars);
                let what = format!("{curvature:?}, {cells} cells, bars {bars:e}");
                others += usize::from(!agree(&assembly, &terms, most, &what));
            }
        }
    }
    assert_eq!(others, 1);
}

/// Claim: the number of steps does not grow with the patch: from 12 to 36 cells a side it is larger by at most two, and
/// with vertices moved it more than doubles. Source: theory, section 10.
#[test]
fn steps_do_not_grow_with_the_patch() {
    let steps = |cells: usize, method| {
        let assembly = patch("open-star", [cells; 2]);
        relaxed(&assembly, &along_mode(&assembly, [0.0, 0.05, 0.0], RIGID), method).unwrap().iterations
    };
    let [small, large] = [12, 36].map(|cells| steps(cells, Method::Intrinsic));
    assert!(large <= small + 2, "{small} and {large}");
    let [small, large] = [12, 36].map(|cells| steps(cells, Method::Vertices));
    assert!(large >= 2 * small, "{small} and {large}");
}

/// Claim: random rest angles, openings, soft and rigid facets and locks, soft and rigid bars: the minimum is that of
/// moved vertices. Tolerance: as above.
#[test]
fn openings_facets_and_locks() {
    let star = patch("open-star", [6, 5]);
    let soft = |assembly: &Assembly, bars: f64, rest: Vec<f64>| Terms {
        facets: assembly.facets(2.0),
        ..Terms::bars_and_creases(bars, 1.0, rest)
    };
    let random = Terms::bars_and_creases(RIGID, 1.0, star.rest_per_hinge(0.1, 1));
    assert!(agree(&star, &random, 20, "random rest angles"));
    let locked = (0..star.edges()).find(|&edge| star.tiling().edges[edge].hinge().is_some()).unwrap();
    let lock = vec![(locked, star.drawn_angles()[locked] + 0.05)];
    let terms = Terms { locks: lock, ..Terms::bars_and_creases(RIGID, 1.0, star.rest_per_hinge(0.05, 2)) };
    assert!(agree(&star, &terms, 20, "a lock"));
    let kirigami = patch("kirigami", [5, 5]);
    for bars in [1e3, RIGID] {
        let random = soft(&kirigami, bars, kirigami.rest_per_hinge(0.05, 3));
        assert!(agree(&kirigami, &random, 20, &format!("openings, bars {bars:e}")));
    }
    let rigid = Terms { facets: kirigami.facets(RIGID), ..soft(&kirigami, RIGID, kirigami.rest_per_hinge(0.02, 4)) };
    let found = relaxed(&kirigami, &rigid, Method::Intrinsic).unwrap();
    let expected = relaxed(&kirigami, &rigid, Method::Vertices).unwrap();
    assert!((found.state.total() - expected.state.total()).abs() <= 1e-9 * expected.state.total());
}

/// Claim: a strip of 2 x 300 cells, which moved vertices do not relax within their steps, is relaxed in at most 15
/// steps in fold angles after one in positions.
#[test]
fn a_long_strip() {
    let strip = patch("open-star", [2, 300]);
    let found = relaxed(&strip, &along_mode(&strip, [0.0, 0.05, 0.0], RIGID), Method::Auto).unwrap();
    assert!(found.iterations <= 16 && found.history.iter().any(|step| step.intrinsic), "{} steps", found.iterations);
    assert!(found.residual_force <= 1e-10 && found.negative_eigenvalues == Some(0), "{:e}", found.residual_force);
}

/// Claim: where fold angles cannot be the unknowns, the reason is said and positions are used: flat vertices and rigid
/// quadrilaterals make the closure dependent, pins that hold the shape act on positions, a torus is no patch.
#[test]
fn what_has_no_form_in_fold_angles() {
    let flat = patch("open-flat", [4, 4]);
    let found =
        relaxed(&flat, &Terms::bars_and_creases(RIGID, 1.0, vec![0.3; flat.edges()]), Method::Intrinsic).unwrap();
    assert!(matches!(found.intrinsic_failure, Some(IntrinsicFailure::Solver(_))), "{:?}", found.intrinsic_failure);
    assert!(found.branch_choice.is_some_and(|choice| choice.soft_bars) && found.negative_eigenvalues == Some(0));
    let miura = patch("miura", [4, 4]);
    let terms = Terms { facets: miura.facets(RIGID), ..Terms::bars_and_creases(RIGID, 1.0, vec![0.9; miura.edges()]) };
    let [found, expected] =
        [Method::Intrinsic, Method::Vertices].map(|method| relaxed(&miura, &terms, method).unwrap());
    assert!(matches!(found.intrinsic_failure, Some(IntrinsicFailure::Solver(_))), "{:?}", found.intrinsic_failure);
    assert!((found.state.total() - expected.state.total()).abs() <= 1e-9 * expected.state.total());
    let star = patch("open-star", [3, 3]);
    let creases = Terms::bars_and_creases(RIGID, 1.0, star.rest_per_hinge(0.05, 1));
    let pins = vec![(0, [true; 3]), (1, [true; 3])];
    let pinned = relaxed(&star, &Terms { pins, ..creases }, Method::Intrinsic).unwrap();
    assert_eq!(pinned.intrinsic_failure, Some(IntrinsicFailure::Unsupported(Unsupported::Pins)));
    let torus = Assembly::torus(mesh("open-star"), [2, 2]).build().unwrap();
    let creases = Terms::bars_and_creases(RIGID, 1.0, torus.rest_per_hinge(0.05, 1));
    let found = relaxed(&torus, &creases, Method::Intrinsic).unwrap();
    assert_eq!(found.intrinsic_failure, Some(IntrinsicFailure::Unsupported(Unsupported::Domain)));
}

/// Claim: pins that hold rigid motions alone leave the number of steps as that of a free patch, where moved vertices take
/// more than twice as many; the energy is the same, and pinned coordinates stay. With a load at the other corner,
/// towards which such a patch turns, it takes no more than 15. Tolerance: energies as for free patches, rounding of
/// coordinates.
#[test]
fn pins_of_rigid_motions() {
    let assembly = patch("open-star", [12, 12]);
    let whole = along_mode(&assembly, [0.0, 0.2, 0.0], RIGID);
    let free = relaxed(&assembly, &whole, Method::Auto).unwrap();
    assert!(free.history.iter().any(|step| step.intrinsic));
    let last = assembly.drawn().coordinates.len() / 3 - 1;
    let corner = vec![(0, [true; 3])];
    let three = vec![(0, [true; 3]), (last, [false, true, true]), (last / 2, [false, false, true])];
    for (name, pins) in [("corner", corner.clone()), ("three", three)] {
        let terms = Terms { pins: pins.clone(), ..whole.clone() };
        let found = relaxed(&assembly, &terms, Method::Auto).unwrap();
        let moved = relaxed(&assembly, &terms, Method::Vertices).unwrap();
        assert!(found.iterations <= free.iterations + 1, "{name}: {} for {}", found.iterations, free.iterations);
        assert!(moved.iterations > 2 * found.iterations, "{name}: {} by vertices", moved.iterations);
        let [expected, energy] = [&free, &found].map(|relaxed| relaxed.state.total());
        assert!((energy - expected).abs() <= 1e-9 * expected, "{name}: {energy} for {expected}");
        for (vertex, axes) in pins {
            for axis in (0..3).filter(|&axis| axes[axis]) {
                let place = [&found.state.coordinates, &assembly.drawn().coordinates].map(|all| all[3 * vertex + axis]);
                assert!((place[0] - place[1]).abs() <= 1e-12, "{name}: {place:?}");
            }
        }
    }
    let terms = Terms { pins: corner, loads: vec![(last, Vec3::new(0.0, 0.0, 1e-3))], ..whole };
    let loaded = relaxed(&assembly, &terms, Method::Auto).unwrap();
    assert!(loaded.iterations <= 15 && loaded.negative_eigenvalues == Some(0), "{}", loaded.iterations);
}

/// Claim: results have the same bits for any number of threads.
#[test]
fn same_bits_for_any_number_of_threads() {
    let assembly = patch("open-star", [24, 24]);
    let terms = along_mode(&assembly, [0.0, 0.05, 0.0], 1e4);
    let run = |threads| Threads::new(Some(threads)).install(|| relaxed(&assembly, &terms, Method::Auto).unwrap());
    let [one, two] = [run(1), run(2)];
    assert!(one.history[2].intrinsic && one.state.coordinates == two.state.coordinates && one.history == two.history);
}

/// Claim: a scene names the method, `summary.json` says of every step which unknowns it had, and why fold angles were
/// given up; a large patch takes them by itself, a small one does not; and a relaxation that starts from the result
/// stands still.
#[test]
fn scenes_name_the_method() {
    let scene = |cells: usize, studies: &str| {
        let scene = format!(
            "sheet = {{ mesh = \"open-star.fold\", cells = [{cells}, {cells}] }}\n\
             [energy]\nbars = {{ stiffness = inf }}\n\
             creases = {{ stiffness = 1.0, rest = {{ mode = [0.0, 0.05, 0.0], amplitude = 1.0 }} }}\n{studies}"
        );
        Scene::new(scene).program("--quiet").well().folder.studies()
    };
    let study = |name: &str, keys: &str| format!("[[study]]\nname = {name:?}\nkind = \"relax\"\ndraw = []\n{keys}\n");
    let small = scene(4, &[study("auto", ""), study("named", "method = \"intrinsic\"")].concat());
    assert_eq!(
        (&small[0]["history"][0]["method"], &small[1]["history"][0]["method"]),
        (&"vertices".into(), &"intrinsic".into())
    );
    let large = scene(
        16,
        &[study("auto", ""), study("again", "start = \"auto\""), study("moved", "method = \"vertices\"")].concat(),
    );
    let methods = |study: &Value| -> Vec<String> {
        study["history"].as_array().unwrap().iter().map(|row| row["method"].as_str().unwrap().to_owned()).collect()
    };
    // one step in positions, of which little can be taken, then fold angles from the start again
    assert_eq!(methods(&large[0])[..3], ["vertices", "vertices", "intrinsic"]);
    assert_eq!(methods(&large[0]).last().unwrap(), "vertices");
    assert_eq!(large[1]["iterations"], 0);
    assert!(methods(&large[2]).iter().all(|method| method == "vertices"));
    assert!(large.iter().all(|study| study["intrinsic_failure"].is_null()));
}
