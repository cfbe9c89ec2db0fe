//! Runs of the program: files, messages and exit statuses.

use crate::common::{Folder, Said, Scene, mesh_folder, signal};
use approx::abs_diff_eq;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use serde_json::Value;

/// Returns a scene on the star cell, without drawings, with this energy and these studies.
fn star(cells: [usize; 2], domain: &str, energy: &str, studies: &str) -> Scene {
    Scene::new(format!(
        "[sheet]\nmesh = \"open-star.fold\"\ndomain = \"{domain}\"\ncells = {cells:?}\n[energy]\n{energy}\n{studies}\n"
    ))
}

fn relax(name: &str, more: &str) -> String {
    format!("[[study]]\nname = \"{name}\"\nkind = \"relax\"\ndraw = []\n{more}\n")
}

const RIGID: &str =
    "bars = { stiffness = inf }\ncreases = { stiffness = 1.0, rest = { mode = [0, 0.06, 0], amplitude = 1 } }";

/// Whether a study of a scene has `draw = []`.
fn tables_only(scene: &Path, name: &str) -> bool {
    let scene: toml::Table = fs::read_to_string(scene).unwrap().parse().unwrap();
    let study = scene["study"].as_array().unwrap().iter().find(|study| study["name"].as_str() == Some(name)).unwrap();
    study.get("draw").is_some_and(|ways| ways.as_array().is_some_and(Vec::is_empty))
}

/// Claim: every scene in `meshes/` runs to its end with status 0, and writes the documented files.
#[test]
fn every_scene_in_meshes_gives_its_answer() {
    let here = Folder::new();
    let scenes: Vec<PathBuf> = fs::read_dir(mesh_folder()).unwrap().map(|entry| entry.unwrap().path()).collect();
    let scenes: Vec<_> = scenes.iter().filter(|path| path.extension().is_some_and(|ending| ending == "toml")).collect();
    assert!(scenes.len() >= 12, "the scenes are there");
    for scene in scenes {
        let out = scene.file_stem().unwrap().to_str().unwrap();
        let said = here.program(&["run", scene.to_str().unwrap(), "--out", out, "--quiet"]).well();
        assert_eq!(said.all(), "", "{}: --quiet says nothing", scene.display());
        let folder = here.inner(out);
        if folder.has("sweep.csv") {
            let sweep = folder.json("sweep.json");
            assert!(
                sweep["points"].as_u64().unwrap() > 1 && sweep["converged"] == sweep["points"],
                "{}",
                scene.display()
            );
            continue;
        }
        for study in folder.studies() {
            let name = study["name"].as_str().unwrap();
            assert_eq!(study["converged"], true, "{} {name}", scene.display());
            let written = |ending: &str| folder.has(format!("{name}.{ending}"));
            let states = ["relax", "path", "fold", "trace", "surface", "bloch", "wells", "response"]
                .iter()
                .any(|kind| study["kind"] == *kind);
            let shown = states || study["eigenvalues"].as_array().is_some_and(|list| !list.is_empty());
            let landscape = study["kind"] == "landscape";
            let pictures = !tables_only(scene, name);
            assert!(written("csv"));
            assert_eq!(written("svg"), (shown || landscape) && pictures, "{} {name}", scene.display());
            assert_eq!(written("pvd"), (shown || study["map"].is_object()) && pictures, "{} {name}", scene.display());
        }
    }
}

/// Claim: rest angles along the mode [0, k, 0] roll one screw-periodic cell up to a cylinder of this curvature. Source:
/// the definition of a mode, `(k11 x^2 + k22 y^2 + 2 k12 x y)/2` towards the face normals, and theory.md 3: rank-one
/// modes fold rigidly, so the remaining energy is of fourth order. Tolerance: the mode is linear, so the error is of
/// second order in k: 10 % at k = 0.01, where the sheet has size 2; a tenth of it at a tenth of k.
#[test]
fn a_mode_rolls_the_sheet_to_its_curvature() {
    for (k, tolerance) in [(0.01, 0.1), (0.001, 0.01), (-0.001, 0.01)] {
        let energy = format!(
            "bars = {{ stiffness = inf }}\ncreases = {{ stiffness = 1.0, rest = {{ mode = [0, {k}, 0], amplitude = 1 }} }}"
        );
        let table = star([6, 6], "screw", &energy, &relax("rolled", "")).program("").well().folder.table("rolled.csv");
        let curvature = table.last("curvature");
        assert!((curvature / k - 1.0).abs() <= tolerance, "curvature {curvature} for {k}");
        assert!(table.last("energy_total") <= 1e3 * k.powi(4), "energy {}", table.last("energy_total"));
        let [theta1, theta2] = ["theta1", "theta2"].map(|name| table.last(name));
        assert!(theta2.abs() > 10.0 * theta1.abs() && theta2 > 0.0, "{theta1} {theta2}");
    }
}

/// Claim: one crease drives a Miura-ori with rigid parallelograms, also if creases have no energy; the table has the
/// angles of all edges in either case. Source: its two fold angles satisfy `tan(a/2) = cos(sector) tan(b/2)` (M.
/// Schenk, S. D. Guest, PNAS 110, 3276 (2013)), here `sector` = 60 degrees. Tolerance: the effect of a residual of
/// 1e-12 on angles of order 1 if every constraint is redundant several times.
#[test]
fn one_crease_drives_the_miura_ori() {
    let scene = Scene::of("miura-lock").replaced("cells = [5, 5]", "cells = [3, 3]");
    for scene in [scene.clone(), scene.replaced("creases =", "# creases =")] {
        let table = scene.program("").well().folder.table("folded.csv");
        let folds = table.header.iter().filter(|name| name.starts_with("fold_"));
        let angles = folds.map(|name| table.last(name).abs());
        let angles: Vec<f64> = angles.collect();
        let minor = 2.0 * (0.5 * f64::tan(0.6)).atan();
        for expected in [1.2, minor, 0.0] {
            let found = angles.iter().filter(|angle| (**angle - expected).abs() < 1e-9).count();
            assert_eq!(found, 4, "{expected}: {angles:?}");
        }
    }
}

/// Returns the array `self_intersecting` of a VTU file, on its triangles.
fn crossing_faces(path: &Path) -> Vec<u8> {
    let vtk = vtkio::Vtk::parse_xml(fs::read(path).unwrap().as_slice()).unwrap();
    let piece = vtkio::model::UnstructuredGridPiece::try_from(vtk.data).unwrap();
    let triangles = piece.cells.types.iter().filter(|kind| **kind == vtkio::model::CellType::Triangle).count();
    let array = piece.data.cell.iter().find_map(|attribute| match attribute {
        vtkio::model::Attribute::DataArray(array) if array.name == "self_intersecting" => array.data.cast_into::<u8>(),
        _ => None,
    });
    array.unwrap()[..triangles].to_vec()
}

/// Claim: `check = ["self-intersection"]` fills its column and its array, also in the drawing, and without it the
/// column is empty and the array 0. Source: the cell of `meshes/tube.toml` rotates by 0.758 from one cell to the next,
/// so that eight cells are less than a turn and nine more; the crossing triangles are at the ends, none in the middle.
#[test]
fn a_tube_that_goes_through_itself() {
    let asked = "check = [\"self-intersection\"]";
    let modes = "\n[[study]]\nname = \"modes\"\nkind = \"modes\"\neigenvalues = 1\ncheck = [\"self-intersection\"]\n";
    for (cells, check, crossing) in [("[6, 9]", asked, true), ("[6, 8]", asked, false), ("[6, 9]", "", false)] {
        let scene = Scene::of("tube").replaced("cells = [6, 9]", &format!("cells = {cells}")).replaced(asked, check);
        let said = scene.then(modes).program("").well();
        let (out, table) = (&said.folder, said.folder.table("rolled.csv"));
        assert!(abs_diff_eq!(table.last("theta2"), 0.758, epsilon = 1e-3), "{}", table.last("theta2"));
        let expected = if check.is_empty() { f64::NAN } else { f64::from(u8::from(crossing)) };
        assert_eq!(table.last("self_intersecting").to_bits(), expected.to_bits(), "{cells} {check}");
        let summary = out.studies()[0]["self_intersecting"].clone();
        assert_eq!(summary, if check.is_empty() { Value::Null } else { crossing.into() }, "{cells} {check}");
        assert_eq!(said.out.contains("faces pass through each other"), crossing, "{cells} {check}");
        let [start, end] = [0, 1].map(|k| crossing_faces(&out.file(format!("rolled/rolled_000{k}.vtu"))));
        assert!(start.iter().all(|face| *face == 0), "the start is not rolled up");
        assert_eq!(end.contains(&1), crossing, "{cells} {check}");
        let middle = end.len() / 3..2 * end.len() / 3;
        assert!(end[middle].iter().all(|face| *face == 0), "only the ends cross");
        assert!(crossing_faces(&out.file("modes/modes_0000.vtu")).iter().all(|face| *face == 0));
    }
}

/// Claim: `--json` prints the summary and nothing else on standard output; without it a line for each study and the
/// folder are printed; `draw = []` writes tables only.
#[test]
fn what_a_run_says_and_writes() {
    let folder = star([2, 2], "patch", RIGID, &relax("one", "")).placed();
    let said = folder.foldwell("run scene.toml --json --threads 1").well();
    assert_eq!(said.json(), folder.json("scene/summary.json"));
    assert!(said.err.is_empty(), "quiet in a pipe: {}", said.err);
    let said = folder.foldwell("run scene.toml --out b").out;
    assert!(said.starts_with("one (relax): energy ") && said.ends_with("files in b\n"), "{said}");
    assert_eq!(folder.inner("b").names(), ["one.csv", "summary.json"]);
}

/// Claim: a saddle is left, and standard output says so. A flat sheet that is compressed in its plane has no force out
/// of the plane: it is unstable under a force a hundred times the stiffness of the creases, which are of length 1 and
/// more, and stable under one as large as that stiffness.
#[test]
fn a_saddle_is_left_and_called_so() {
    for (force, unstable) in [(-1.0, true), (-0.01, false)] {
        let scene = format!(
            "[sheet]\nmesh = \"open-flat.fold\"\ncells = [2, 2]\n[energy]\nbars = {{ stiffness = 1e4 }}\n\
             creases = {{ stiffness = 1e-2 }}\n[[pin]]\nvertex = 0\ncell = [0, 0]\naxes = \"xyz\"\n\
             [[pin]]\nvertex = 0\ncell = [1, 0]\naxes = \"yz\"\n[[pin]]\nvertex = 0\ncell = [0, 1]\naxes = \"z\"\n\
             [[load]]\nvertex = 0\ncell = [1, 0]\nforce = [{force:?}, 0.0, 0.0]\n{}",
            relax("flat", "")
        );
        let said = Scene::new(scene).program("");
        let (study, said) = (&said.folder.studies()[0], said.out);
        let flat = study["routes"][0]["negative_eigenvalues"].as_u64().unwrap();
        assert_eq!((said.contains(", by way of saddle"), flat > 0), (unstable, unstable), "{flat}: {said}");
        assert_eq!(study["negative_eigenvalues"], 0, "{said}");
    }
}

/// Claim: a study that does not converge gives status 1; the others are computed, its partial results are on disk, and
/// its reason is in the summary. A study that starts from it fails as well, with that reason.
#[test]
fn a_failed_study_is_reported() {
    let lock = |vertex: usize, angle: f64| format!("[[lock]]\ncrease = [0, {vertex}, 0, 0]\nangle = {angle:?}\n");
    let locked = format!(
        "[sheet]\nmesh = \"degree-four.fold\"\n[energy]\nbars = {{ stiffness = inf }}\ncreases = {{ stiffness = 1.0 }}\n{}{}{}",
        lock(1, 2.0),
        lock(2, -2.0),
        lock(3, 0.5)
    );
    let studies =
        [relax("held", ""), relax("after", "start = \"held\""), relax("free", "start = { random = 0.1, seed = 1 }")];
    let out = Scene::new(locked + &studies.concat()).program("").ends(1).folder;
    let studies = out.studies();
    let of = |study: usize, key: &str| studies[study][key].clone();
    assert_eq!((of(0, "converged"), of(1, "converged")), (false.into(), false.into()));
    assert!(of(0, "reason").as_str().unwrap().contains("cannot be met"), "{studies:?}");
    assert!(of(1, "reason").as_str().unwrap().contains("did not converge"), "{studies:?}");
    assert_eq!(of(2, "name"), "free");
    assert!(out.has("held.csv"));
}

/// Claim: malformed input gives status 2 and writes nothing; a destination that cannot be written gives status 3. A
/// file with the name of the folder stops every user, also one who may write everywhere.
#[test]
fn what_is_wrong_has_its_status() {
    let wrong = ["[[study]]\nname = \"t\"\nkind = \"trace\"", "[[lock]]\ncrease = [0, 1, 7, 0]"];
    let starts = relax("v", "start = \"none.vtu\"");
    for wrong in wrong.into_iter().chain([starts.as_str()]) {
        let said = star([2, 2], "patch", RIGID, &(relax("one", "") + wrong)).program("").ends(2);
        assert_eq!(said.out, "", "{wrong}");
        assert!(!said.folder.path().exists(), "{wrong}: nothing is written");
    }
    let scene = star([2, 2], "patch", RIGID, &relax("one", "")).with("file", "").out("file/below");
    let said = scene.program("").ends(3);
    assert!(said.err.contains("file/below"), "{said:?}");
}

/// Returns a scene of studies that start from each other, long enough to be stopped after the first.
fn long_scene() -> Scene {
    let studies = [
        relax("first", "start = { random = 0.05, seed = 3 }").replace("draw = []\n", ""),
        relax("second", "start = \"first\""),
        "[[study]]\nname = \"modes\"\nkind = \"modes\"\neigenvalues = 4\n".to_owned(),
        relax("third", "start = { random = 0.06, seed = 4 }"),
        relax("fourth", "start = \"third\""),
    ];
    star([8, 8], "patch", RIGID, &studies.concat())
}

/// Starts a run into `out` and sends it a signal as soon as its first study is in the summary; returns how it ended.
fn stopped(scene: &Scene, name: &str) -> (Folder, Option<i32>) {
    let folder = scene.placed();
    let mut child = folder.command(&["run", "scene.toml", "--out", "out"]).spawn().expect("it starts");
    let done =
        || fs::read_to_string(folder.file("out/summary.json")).is_ok_and(|text| text.contains("\"name\": \"first\""));
    let patience = Instant::now();
    while !done() && child.try_wait().unwrap().is_none() {
        assert!(patience.elapsed() < Duration::from_secs(300), "the first study takes too long");
        std::thread::sleep(Duration::from_millis(1));
    }
    signal(&child, name);
    (folder.inner("out"), Said::last(child, &folder).status)
}

/// Claim: a run that is killed after its first study and resumed leaves the same bytes as an undisturbed one, except
/// for times: also if a study starts from one that was kept, and if nothing is drawn.
#[test]
#[cfg(unix)]
fn a_killed_run_is_resumed_exactly() {
    let scene = long_scene();
    let (killed, status) = stopped(&scene, "-KILL");
    assert_eq!(status, None, "it was killed before it ended");
    let before = killed.studies();
    assert!((1..5).contains(&before.len()), "{} studies were done", before.len());
    let said = scene.clone().resumed().program("").well();
    assert_eq!(said.out.matches("(kept)").count(), before.len(), "{}", said.out);
    killed.assert_same(&scene.out("whole").program("").folder, "after the resumption");
    assert_eq!(killed.studies()[0]["seconds"], before[0]["seconds"], "the first study was not computed again");
}

/// Claim: Ctrl-C ends a run with status 130, with its finished studies complete on disk.
#[test]
#[cfg(unix)]
fn an_interrupted_run_keeps_what_is_done() {
    let scene = long_scene();
    let (out, status) = stopped(&scene, "-INT");
    assert_eq!(status, Some(130));
    let first = &out.studies()[0];
    assert_eq!((&first["name"], &first["converged"]), (&"first".into(), &true.into()));
    assert!(out.has("first.csv") && out.has("first/first_0001.vtu"));
    assert!(out.files().keys().all(|name| name.extension().is_none_or(|ending| ending != "part")));
    let said = scene.resumed().program("").well().out;
    assert!(said.lines().next().unwrap().ends_with("(kept)"), "{said}");
}

/// Claim: Ctrl-C ends a study of modes, which is reported as not converged with its reason; earlier results are
/// complete, later studies are not started. The iteration for hundreds of eigenpairs takes far longer than a signal.
#[test]
#[cfg(unix)]
fn modes_are_interrupted() {
    let modes = "[[study]]\nname = \"modes\"\nkind = \"modes\"\neigenvalues = 200\ndraw = []\n";
    let studies = relax("first", "") + modes + &relax("last", "");
    let (out, status) = stopped(&star([20, 20], "patch", RIGID, &studies), "-INT");
    assert_eq!(status, Some(130));
    let studies = out.studies();
    let ends: Vec<_> = studies.iter().map(|study| (&study["name"], &study["converged"], &study["reason"])).collect();
    assert_eq!(ends.len(), 2, "{ends:?}");
    assert_eq!((ends[0].0, ends[0].1), (&"first".into(), &true.into()));
    assert_eq!(ends[1], (&"modes".into(), &false.into(), &"interrupted".into()));
    assert!(out.has("first.csv") && !out.has("modes.csv"));
}

/// Claim: no result is kept if the scene, or a file that it names, has changed; and none without `--resume`.
#[test]
fn another_scene_keeps_nothing() {
    let old = star([2, 2], "patch", RIGID, &relax("one", ""));
    let folder = old.placed();
    let kept = |scene: &Scene| scene.program("").out.matches("(kept)").count();
    let resumed = old.clone().resumed();
    assert_eq!([kept(&resumed), kept(&resumed), kept(&old), kept(&resumed)], [0, 1, 0, 1]);
    let changed = resumed.replaced("0.06", "0.05");
    assert_eq!([kept(&changed), kept(&changed)], [0, 1]);
    folder.write("open-star.fold", folder.text("open-star.fold") + "\n");
    assert_eq!([kept(&changed), kept(&changed)], [0, 1]);
    fs::remove_file(folder.file("out/one.csv")).unwrap();
    assert_eq!(kept(&changed), 0);
}

/// Claim: with both engines there is a row for every state, with residuals and the distance from the exact kinematics
/// for every relaxation, that is for all states but the drawn one; the largest distance is in the summary.
#[test]
fn engines_are_compared() {
    let out = Scene::of("star-engines").program("--quiet").well().folder;
    let branches = out.studies()[0]["branches"].as_array().unwrap().clone();
    let table = out.table("both.csv");
    let columns = ["branch", "sign", "step", "residual_force", "error_to_kinematic"];
    let row = |row: usize| columns.map(|column| table.field(row, column).parse().ok());
    let rows: Vec<[Option<f64>; 5]> = (0..table.len()).map(row).collect();
    for branch in &branches {
        let name = [branch["branch"].as_f64(), branch["sign"].as_f64()];
        let own: Vec<_> = rows.iter().filter(|row| row[..2] == name).collect();
        let steps = branch["steps"].as_u64().unwrap() as usize;
        assert_eq!(own.len(), steps + 1);
        let relaxed = |row: &[Option<f64>; 5]| row[3].is_some_and(|force| force <= 1e-12) && row[4].is_some();
        assert!(own.iter().enumerate().all(|(k, row)| relaxed(row) == (k > 0 && k < steps)));
        let largest = own.iter().filter_map(|row| row[4]).fold(0.0, f64::max);
        assert!(largest > 1e-6 && largest < 1e-3 && branch["error_to_kinematic"].as_f64() == Some(largest));
    }
    assert_eq!(branches.len(), 4);
}
