//! Relaxations that start from an earlier result, and modes at the limits of possible requests.

use crate::common::{Folder, Scene, Testing, patch};
use approx::{assert_abs_diff_eq, assert_relative_eq};
use foldwell::analysis::modes::{SPARSE_EIGENVALUES, decomposed_dense};
use foldwell::analysis::restored;
use foldwell::analysis::state::State;
use foldwell::model::Terms;
use foldwell::model::{Configuration, Gauge};
use foldwell::solver::Problem;
use serde_json::Value;
use std::f64::consts::TAU;
use std::fs;

/// Runs a scene into a folder of this name; returns its studies.
fn studies(folder: &Folder, name: &str, scene: &str) -> Vec<Value> {
    folder.scene(scene).named(name).out(name).program("").well().folder.studies()
}

fn relaxation(name: &str, start: &str) -> String {
    format!("[[study]]\nname = \"{name}\"\nkind = \"relax\"\ndraw = [\"vtk\"]\nstart = {start}\n")
}

/// Returns a scene with a mesh of the repository.
fn scene(mesh: &str, sheet: &str, rest: &str, study: &str) -> String {
    format!("[sheet]\nmesh = \"{mesh}\"\n{sheet}\n{rest}\n{study}")
}

/// Checks that the second relaxation is the first one again, without a step, and that its table begins with it.
fn stands_still(folder: &Folder, name: &str, (first, second): (&Value, &Value)) {
    assert!(first["iterations"].as_u64().unwrap() > 0, "{name}: there was nothing to relax");
    assert_eq!(second["iterations"], 0, "{name}: {second}");
    assert_eq!(second["negative_eigenvalues"], first["negative_eigenvalues"], "{name}");
    assert_eq!(second["history"].as_array().unwrap().len(), 1, "{name}");
    let table = folder.table(&format!("{name}/{}.csv", second["name"].as_str().unwrap()));
    for term in ["bars", "creases", "facets", "total"] {
        let Some(energy) = first["energy"][term].as_f64() else { continue };
        let scale = first["energy"]["total"].as_f64().unwrap();
        let again = second["energy"][term].as_f64().unwrap();
        assert_abs_diff_eq!(again, energy, epsilon = 1e-11 * scale);
        assert_abs_diff_eq!(table.at(0, &format!("energy_{term}")), energy, epsilon = 1e-11 * scale);
    }
    let [force, length] = ["residual_force", "residual_length"].map(|key| second[key].as_f64().unwrap());
    assert!(force <= 1e-12 && length <= 1e-12, "{name}: {force:e} {length:e}");
}

/// Returns the cases to relax: mesh, domain and energy.
fn cases() -> Vec<(&'static str, &'static str, String)> {
    let star = "open-star.fold";
    let energy = |bars: &str, creases: &str, more: &str| {
        format!(
            "[energy]\nbars = {{ stiffness = {bars} }}\n\
             creases = {{ stiffness = {creases}, rest = {{ mode = [0, 0.06, 0], amplitude = 1 }} }}\n{more}"
        )
    };
    let held = "[[pin]]\nvertex = 0\n[[pin]]\nvertex = 1\n[[pin]]\nvertex = 2\n[[load]]\nvertex = 3\ncell = [1, 1]\nforce = [0.0, 0.0, 0.01]\n";
    let lock = "[[lock]]\ncrease = [0, 1, 0, 0]\n";
    let patch = "cells = [2, 2]";
    let free = "domain = \"torus\"\ncells = [2, 2]\nlattice = \"free\"";
    let fixed = "domain = \"torus\"\ncells = [2, 2]\nlattice = \"fixed\"";
    vec![
        (star, patch, energy("1e3", "1.0", "")),
        (star, patch, energy("inf", "1.0", "")),
        (star, patch, energy("1e3", "1.0", held)),
        (star, patch, energy("inf", "1.0", held)),
        (star, patch, energy("1e3", "1.0", lock)),
        // creases so stiff that they are treated with tensions
        (star, patch, energy("1.0", "2e4", "")),
        (star, free, energy("1e3", "1.0", "")),
        (star, fixed, energy("1e3", "1.0", "")),
        (star, "domain = \"screw\"", energy("inf", "1.0", "")),
        (star, "domain = \"screw\"", energy("1e3", "1.0", "")),
        // rigid polygons, with finite and with rigid bars
        ("quad-cell.fold", patch, energy("1e3", "1.0", "").replace("{ mode = [0, 0.06, 0], amplitude = 1 }", "0.2")),
        ("quad-cell.fold", patch, energy("inf", "1.0", "").replace("{ mode = [0, 0.06, 0], amplitude = 1 }", "0.2")),
    ]
}

/// Claim: a relaxation that starts from an equilibrium of an earlier study takes no step, finds the same energies and
/// the same stability, and its table begins with them: on all domains, for finite and rigid bars, with pins, loads,
/// locks and rigid polygons. Tolerance: energies to 1e-11 of the total; the residuals allow 1e-12 of the forces.
#[test]
fn a_restarted_equilibrium_takes_no_step() {
    let folder = Folder::new();
    for (k, (mesh, sheet, rest)) in cases().iter().enumerate() {
        let both = relaxation("a", "\"drawn\"") + &relaxation("b", "\"a\"");
        let found = studies(&folder, &format!("s{k}"), &scene(mesh, sheet, rest, &both));
        stands_still(&folder, &format!("s{k}"), (&found[0], &found[1]));
    }
}

/// Claim: the same from a VTU file of the earlier run if the points determine the state: on patches.
#[test]
fn a_restart_from_a_file_takes_no_step() {
    let folder = Folder::new();
    for (k, (mesh, sheet, rest)) in cases().iter().enumerate().filter(|(_, case)| case.1.starts_with("cells")) {
        let first = studies(&folder, &format!("v{k}"), &scene(mesh, sheet, rest, &relaxation("a", "\"drawn\"")));
        let file = format!("\"v{k}/a/a_0001.vtu\"");
        let second = studies(&folder, &format!("w{k}"), &scene(mesh, sheet, rest, &relaxation("b", &file)));
        stands_still(&folder, &format!("w{k}"), (&first[0], &second[0]));
    }
}

/// Claim: a resumed run starts a later study as the whole run would have: its table is the same to the last byte.
#[test]
fn a_resumed_restart_is_the_same() {
    let folder = Folder::new();
    let (mesh, sheet, rest) = &cases()[2];
    let both = relaxation("a", "\"drawn\"") + &relaxation("b", "\"a\"");
    studies(&folder, "r", &scene(mesh, sheet, rest, &both));
    let whole = folder.bytes("r/b.csv");
    fs::remove_file(folder.file("r/b.csv")).unwrap();
    let said = folder.foldwell("run r.toml --resume").out;
    assert_eq!(said.matches("(kept)").count(), 1, "{said}");
    assert!(said.contains("0 iterations"), "{said}");
    assert!(folder.bytes("r/b.csv") == whole, "another table");
}

/// Claim: a saddle from a file without forces is found again: no step, one negative eigenvalue, and the energy of its
/// bars in the first row. Source: `drum-pass.vtu`, the pass between the two states of a drum, whose bars have 8.085e-5
/// by their lengths only.
#[test]
fn a_saddle_stays_where_it_is() {
    let folder = Folder::new();
    let energy = "[energy]\nbars = { stiffness = 1.0 }\ncreases = { stiffness = 1e-6 }";
    let study = relaxation("r", "\"cases/drum-pass.vtu\"");
    let found = &studies(&folder, "p", &scene("cases/drum.fold", "", energy, &study))[0];
    assert_eq!((&found["iterations"], &found["negative_eigenvalues"]), (&0.into(), &1.into()), "{found}");
    let table = folder.table("p/r.csv");
    assert_relative_eq!(table.at(0, "energy_bars"), 8.085e-5, max_relative = 1e-4);
    assert_relative_eq!(table.at(0, "energy_total"), found["energy"]["total"].as_f64().unwrap(), max_relative = 1e-12);
}

/// Claim: fold angles beyond pi are restored from a file, and angles that the file does not have are left unchanged.
#[test]
fn windings_come_back() {
    let case = patch("open-star", [2, 2]);
    let terms = Terms::bars_and_creases(1e3, 1.0, case.drawn_angles().to_vec());
    let mut model = case.model_of(&terms, Gauge::Held);
    let hinge = case.drawn_angles().iter().position(|angle| !angle.is_nan()).unwrap();
    let mut given = vec![f64::NAN; case.edges()];
    given[hinge] = case.drawn_angles()[hinge] + TAU;
    let angles = restored::angles(&model, &given);
    let x = model.enter(&Configuration::new(case.drawn().coordinates.clone(), angles, None)).x;
    let tension = vec![0.0; model.layout().stiff.len()];
    let state = State::new(&model, &x, &tension);
    for (edge, angle) in case.drawn_angles().iter().enumerate().filter(|(_, angle)| !angle.is_nan()) {
        let expected = if edge == hinge { angle + TAU } else { *angle };
        assert_abs_diff_eq!(state.fold_angle[edge], expected, epsilon = 1e-14);
    }
}

/// Claim: the energy of a state is that of all its edges. Source: each element belongs to one edge.
#[test]
fn all_terms_are_in_the_total() {
    let case = patch("quad-cell", [2, 2]);
    let lock = case.drawn_angles().iter().position(|angle| !angle.is_nan()).unwrap();
    let terms = Terms::bars_and_creases(1e3, 1.0, case.rest_per_hinge(0.05, 1));
    let terms = Terms { facets: case.facets(2.0), locks: vec![(lock, case.drawn_angles()[lock])], ..terms };
    let state = case.relax(&terms).unwrap().state;
    assert!(state.energy_bars > 0.0 && state.energy_creases > 0.0 && state.energy_facets > 0.0);
    assert_relative_eq!(state.total(), state.energy.iter().sum::<f64>(), max_relative = 1e-13);
}

/// Claim: a rigidity matrix of rank 0 is a valid result, without a gap. Source: with all vertices pinned there are no
/// columns; with one vertex on a torus with fixed lattice, all bars connect it to its copies and cannot change: 3
/// motions, and every one of its 3 bars a self stress.
#[test]
fn rank_zero_is_an_answer() {
    let folder = Folder::new();
    let modes = "[[study]]\nname = \"m\"\nkind = \"modes\"\neigenvalues = 2\n";
    let pins: String = (0..4).map(|vertex| format!("[[pin]]\nvertex = {vertex}\n")).collect();
    let energy = "[energy]\nbars = { stiffness = inf }\ncreases = { stiffness = 1 }";
    let held = scene("open-star.fold", "", &format!("{energy}\n{pins}"), &modes.replace("eigenvalues = 2\n", ""));
    let found = &studies(&folder, "held", &held)[0];
    assert_eq!((&found["zero_modes"], &found["rigid_motions"]), (&0.into(), &0.into()));
    assert!(found["gap"].is_null() && found["error"].is_null() && found["converged"] == true, "{found}");
    let one = "[sheet]\ngenerate = { pattern = \"random\", size = [1, 1], seed = 4 }\ndomain = \"torus\"\nlattice = \"fixed\"\n";
    let found = &studies(&folder, "one", &format!("{one}{energy}\n{modes}"))[0];
    assert_eq!((&found["zero_modes"], &found["self_stresses"]), (&3.into(), &3.into()));
    assert!(found["gap"].is_null() && found["converged"] == true, "{found}");
}

/// Claim: if more eigenvalues are requested than exist, the library returns the existing ones, just above the size that
/// is always decomposed dense; if neither method can give as many as requested the scene is refused with the bound, before
/// anything is written.
#[test]
fn too_many_eigenvalues() {
    let case = patch("open-star", [10, 11]);
    let terms = Terms::bars_and_creases(f64::INFINITY, 1.0, case.drawn_angles().to_vec());
    let found = case.modes_of(&terms, 1000).unwrap();
    assert_eq!(found.eigenvalues.len(), found.zero_modes);
    assert!(decomposed_dense(1320, 3000, 3000).unwrap() && !decomposed_dense(1320, 24, 1320).unwrap());
    assert!(!decomposed_dense(4800, SPARSE_EIGENVALUES, 4800).unwrap());
    let modes = "[[study]]\nname = \"m\"\nkind = \"modes\"\neigenvalues = 1000\n";
    let energy = "[energy]\nbars = { stiffness = 1e3 }\ncreases = { stiffness = 1 }";
    let said = Scene::new(scene("open-star.fold", "cells = [20, 20]", energy, modes)).program("");
    let said = said.refused("1000 eigenvalues").refused("256").refused("scene.toml:");
    assert!(!said.folder.path().exists());
}

/// Claim: a sheet in two pieces has the rigid motions of both, and its bars and its vertices agree about the rest.
/// Source: two copies of a pair of triangles, far apart: each has 6 rigid motions and one fold.
#[test]
fn a_sheet_in_two_pieces() {
    let folder = Folder::new();
    let square = |x: f64| [[x, 0.0, 0.0], [x + 1.0, 0.0, 0.0], [x + 1.0, 1.0, 0.0], [x, 1.0, 0.1]];
    let coordinates = [square(0.0), square(5.0)].concat();
    let mesh = serde_json::json!({
        "file_spec": 1.2, "vertices_coords": coordinates,
        "faces_vertices": [[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7]],
    });
    folder.write("two.fold", mesh.to_string());
    let scene = "[sheet]\nmesh = \"two.fold\"\n[[study]]\nname = \"m\"\nkind = \"modes\"\n";
    let found = &studies(&folder, "two", scene)[0];
    let counts =
        ["zero_modes", "rigid_motions", "folding_modes", "self_stresses"].map(|key| found[key].as_u64().unwrap());
    assert_eq!(counts, [14, 12, 2, 0]);
    let said = folder.foldwell("run two.toml").out;
    let info = folder.foldwell("info two.fold").out;
    assert!(info.contains("pieces                 2\n"), "info counts the pieces");
    assert!(said.contains("14 zero modes, of which 12 are rigid; 0 self stresses; 2 folding modes"), "{said}");
}
