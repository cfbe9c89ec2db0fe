//! Wells of trusses, which have no creases: told apart by where their joints are.

use crate::common::Scene;
use foldwell::analysis::relax::relax_from;
use foldwell::model::Gauge;
use foldwell::solver::Options;
use foldwell::study::wells::WellsSummary;
use serde_json::json;

/// The wells of a truss of bars of stiffness 1 with these joints and bars, and these further lines.
fn truss(joints: &[[f64; 3]], bars: &[[usize; 2]], lines: &str) -> Scene {
    let mesh = json!({
        "file_spec": 1.2, "vertices_coords": joints, "edges_vertices": bars, "faces_vertices": [],
    });
    let lines =
        format!("[energy]\nbars = {{ stiffness = 1.0 }}\n{lines}\n[[study]]\nname = \"wells\"\nkind = \"wells\"");
    Scene::on("mesh = \"truss.fold\"\ndomain = \"patch\"", &lines).with("truss.fold", mesh.to_string())
}

fn energies(found: &WellsSummary) -> Vec<f64> {
    found.wells.iter().map(|well| well.energy).collect()
}

const TRIANGLE: [[f64; 3]; 3] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.4, 0.8, 0.0]];
const ABOVE: [f64; 3] = [0.5, 0.3, 0.7];

/// Claim: a joint on three bars to fixed ones stands on either side of their plane, and two such joints make four
/// wells; all bars are at rest there. A free tetrahedron has two, which are mirror images, a free triangle one. Source:
/// distances to three points, or all distances of four, determine a point but for a reflection. Tolerance: rounding.
#[test]
fn joints_stand_on_either_side() {
    let base = [[0, 3], [1, 3], [2, 3]];
    let other = [0.3, 0.2, -0.9];
    let pins = "[[pin]]\nvertices = [0, 1, 2]";
    let joints = [&TRIANGLE[..], &[ABOVE, other]].concat();
    let both = [&base[..], &[[0, 4], [1, 4], [2, 4]]].concat();
    let sides = [[0, 1], [1, 2], [0, 2]];
    let tetrahedron = [&sides[..], &base].concat();
    let cases = [
        (truss(&joints[..4], &base, pins), 2),
        (truss(&joints, &both, pins), 4),
        (truss(&joints[..4], &tetrahedron, ""), 2),
        (truss(&TRIANGLE, &sides, ""), 1),
    ];
    for (k, (scene, count)) in cases.into_iter().enumerate() {
        let ran = scene.converged();
        let found = energies(ran.wells("wells"));
        assert!(found.len() == count && found.iter().all(|energy| *energy < 1e-20), "{k}: {found:?}");
    }
}

/// Claim: under a load von Mises's truss, a joint on four bars over a square, has the two wells of its closed form.
/// Source: `E(z) = 2 (l - l0)^2/l0 + F (z - h)`, `l^2 = 1 + z^2`, minimized by golden sections. Tolerance: of its
/// energies, rounding.
#[test]
fn a_loaded_truss_has_two_wells() {
    const HEIGHT: f64 = 0.6;
    const FORCE: f64 = 0.005;
    let energy = |z: f64| {
        let (length, rest) = (1.0f64.hypot(z), 1.0f64.hypot(HEIGHT));
        2.0 * (length - rest).powi(2) / rest + FORCE * (z - HEIGHT)
    };
    let least = |mut low: f64, mut high: f64| {
        for _ in 0..100 {
            let [a, b] = [low + 0.382 * (high - low), high - 0.382 * (high - low)];
            if energy(a) < energy(b) { high = b } else { low = a }
        }
        energy(low)
    };
    let expected = [least(-0.9, -0.3), least(0.3, 0.9)];
    let joints = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, HEIGHT]];
    let lines = format!("[[pin]]\nvertices = [0, 1, 2, 3]\n[[load]]\nvertices = [4]\nforce = [0, 0, -{FORCE}]");
    let ran = truss(&joints, &[[0, 4], [1, 4], [2, 4], [3, 4]], &lines).converged();
    let found = energies(ran.wells("wells"));
    assert!(found.len() == 2, "{found:?}");
    found
        .iter()
        .zip(expected)
        .for_each(|(found, expected)| assert!((found - expected).abs() <= 1e-12, "{found} {expected}"));
}

/// Claim: a joint beside a creased sheet stands on either side of its bars' ends, also where all fold angles are the
/// same. Source: as above, and creases at rest.
#[test]
fn joints_beside_creases_are_told_apart() {
    let mesh = json!({
        "file_spec": 1.2,
        "vertices_coords": [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], ABOVE],
        "edges_vertices": [[0, 1], [1, 2], [2, 3], [3, 0], [0, 2], [0, 4], [1, 4], [3, 4]],
        "faces_vertices": [[0, 1, 2], [0, 2, 3]],
    });
    let lines = "[energy]\nbars = { stiffness = 1.0 }\ncreases = { stiffness = 0.1 }\n\
                 [[study]]\nname = \"wells\"\nkind = \"wells\"\nstarts = 16";
    let scene = Scene::on("mesh = \"sheet.fold\"\ndomain = \"patch\"", lines).with("sheet.fold", mesh.to_string());
    let ran = scene.converged();
    let found = energies(ran.wells("wells"));
    assert!(found.len() == 2 && found.iter().all(|energy| *energy < 1e-20), "{found:?}");
}

/// Claim: a chain that can swing has no isolated wells, and that is said. Source: three bars between fixed ends leave
/// two joints four motions, of which only turns about the axis of the ends are rigid.
#[test]
fn a_chain_has_no_isolated_wells() {
    let joints = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.1], [2.0, 0.0, 0.0], [2.9, 0.0, 0.1]];
    let ran = truss(&joints, &[[0, 1], [1, 2], [2, 3]], "[[pin]]\nvertices = [0, 3]").ran();
    let reason = ran.report.summary.studies[0].reason.clone().unwrap_or_default();
    assert!(reason.contains("have motions that cost nothing"), "{reason}");
}

/// Claim: a piece that hangs on another one by two springs moves at no cost, which is said; one that six springs hold has
/// isolated wells. Source: two springs at rest take two of the six motions of a piece, six in general position all of them.
#[test]
fn springs_that_leave_motions_have_no_isolated_wells() {
    let sheet = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.3]];
    let other = sheet.map(|[x, y, z]| [x + 0.2, y - 0.1, z + 1.0]);
    let vertices = [sheet, other].concat();
    let mesh = json!({
        "file_spec": 1.2, "vertices_coords": vertices,
        "faces_vertices": [[0, 1, 2], [1, 3, 2], [4, 5, 6], [5, 7, 6]],
    });
    let run = |springs: &[[usize; 2]]| {
        let spring = |ends: &[usize; 2]| format!("[[spring]]\nvertices = {ends:?}\nstiffness = 2.0\n");
        let lines = format!(
            "[energy]\nbars = {{ stiffness = 50.0 }}\ncreases = {{ stiffness = 1.0 }}\n[[pin]]\nvertices = [0, 1, 2]\n\
             {}[[study]]\nname = \"wells\"\nkind = \"wells\"\nstarts = 6\ndraw = []",
            springs.iter().map(spring).collect::<String>()
        );
        Scene::on("mesh = \"pieces.fold\"", &lines).with("pieces.fold", mesh.to_string()).ran()
    };
    let ran = run(&[[3, 4], [0, 5]]);
    let (study, count) = (ran.study("wells"), ran.wells("wells").wells.len());
    let said = format!("{count} of {count} wells have motions that cost nothing");
    assert!(!study.converged && study.reason.as_ref().is_some_and(|reason| reason.contains(&said)), "{study:?}");
    let held = run(&[[0, 4], [1, 4], [2, 4], [1, 5], [2, 5], [2, 6]]);
    assert!(held.study("wells").converged, "{:?}", held.study("wells"));
}

/// Claim: barriers, which are sought in fold angles, are refused without creases.
#[test]
fn barriers_of_trusses_are_refused() {
    let lines =
        "[energy]\nbars = { stiffness = 1.0 }\n[[study]]\nname = \"wells\"\nkind = \"wells\"\nbarriers = [[0, 1]]";
    let scene = Scene::on("mesh = \"two-bars.fold\"\ndomain = \"patch\"", lines);
    scene.refused("barriers and rigid wells are sought in fold angles of creases");
}

/// Claim: a free triangle of bars that is pressed to a line is no equilibrium, although what held it against rotations
/// now holds its joints: it opens to the triangle. Source: three lengths determine it. Tolerance: rounding.
#[test]
fn a_pressed_triangle_opens() {
    let assembly = truss(&TRIANGLE, &[[0, 1], [1, 2], [0, 2]], "").assembled().unwrap().1;
    let mut model = assembly.model(Gauge::Held);
    let mut pressed = model.configuration(&model.start(), None);
    pressed.coordinates = vec![0.13, -0.43, -0.26, 0.13, 1.77, -0.2600001, 0.13, 0.61, -0.2600003];
    let start = model.enter(&pressed);
    let relaxed = relax_from(&model, start, Options::default(), &mut |_| true).unwrap();
    assert!(
        relaxed.state.energy.iter().sum::<f64>() < 1e-20 && relaxed.negative_eigenvalues == Some(0),
        "{:?}",
        relaxed.state.energy
    );
}
