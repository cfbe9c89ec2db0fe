//! Runs of the program: files, messages and exit statuses.

use approx::abs_diff_eq;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};

use serde_json::Value;

fn meshes() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("meshes")
}

fn command(folder: &Path, words: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_foldwell"));
    command.current_dir(folder).args(words);
    command
}

fn foldwell(folder: &Path, words: &[&str]) -> Output {
    command(folder, words).output().expect("the binary starts")
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

fn json(path: &Path) -> Value {
    serde_json::from_str(&fs::read_to_string(path).expect("the file is there")).expect("it is JSON")
}

/// Returns the last row of a table of states, by column names.
fn last_row(path: &Path) -> BTreeMap<String, f64> {
    let text = fs::read_to_string(path).expect("the table is there");
    let lines: Vec<&str> = text.lines().collect();
    let values = lines[lines.len() - 1].split(',').map(|field| field.parse().unwrap_or(f64::NAN));
    lines[0].split(',').map(str::to_owned).zip(values).collect()
}

/// Returns a scene on the star cell, without drawings, with this energy and these studies.
fn star(cells: [usize; 2], domain: &str, energy: &str, studies: &str) -> String {
    let mesh = meshes().join("open-star.fold");
    format!(
        "[sheet]\nmesh = {:?}\ndomain = \"{domain}\"\ncells = {cells:?}\n[energy]\n{energy}\n{studies}\n",
        mesh.display().to_string()
    )
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
    let out = tempfile::tempdir().unwrap();
    let scenes: Vec<PathBuf> = fs::read_dir(meshes()).unwrap().map(|entry| entry.unwrap().path()).collect();
    let scenes: Vec<_> = scenes.iter().filter(|path| path.extension().is_some_and(|ending| ending == "toml")).collect();
    assert!(scenes.len() >= 12, "the scenes are there");
    for scene in scenes {
        let folder = out.path().join(scene.file_stem().unwrap());
        let words = ["run", scene.to_str().unwrap(), "--out", folder.to_str().unwrap(), "--quiet"];
        let output = foldwell(out.path(), &words);
        assert_eq!(output.status.code(), Some(0), "{}: {}", scene.display(), text(&output.stderr));
        assert!(output.stdout.is_empty() && output.stderr.is_empty(), "{}: --quiet says nothing", scene.display());
        if folder.join("sweep.csv").exists() {
            let sweep = json(&folder.join("sweep.json"));
            assert!(
                sweep["points"].as_u64().unwrap() > 1 && sweep["converged"] == sweep["points"],
                "{}",
                scene.display()
            );
            continue;
        }
        for study in json(&folder.join("summary.json"))["studies"].as_array().unwrap() {
            let name = study["name"].as_str().unwrap();
            assert_eq!(study["converged"], true, "{} {name}", scene.display());
            let written = |ending: &str| folder.join(format!("{name}.{ending}")).exists();
            let states = ["relax", "path", "trace", "surface", "bloch", "wells", "response"]
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
    let out = tempfile::tempdir().unwrap();
    for (k, tolerance) in [(0.01, 0.1), (0.001, 0.01), (-0.001, 0.01)] {
        let energy = format!(
            "bars = {{ stiffness = inf }}\ncreases = {{ stiffness = 1.0, rest = {{ mode = [0, {k}, 0], amplitude = 1 }} }}"
        );
        fs::write(out.path().join("roll.toml"), star([6, 6], "screw", &energy, &relax("rolled", ""))).unwrap();
        let output = foldwell(out.path(), &["run", "roll.toml"]);
        assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
        let row = last_row(&out.path().join("roll/rolled.csv"));
        let off = (row["curvature"] / k - 1.0).abs();
        assert!(off <= tolerance, "curvature {} for {k}", row["curvature"]);
        assert!(row["energy_total"] <= 1e3 * k.powi(4), "energy {}", row["energy_total"]);
        assert!(row["theta2"].abs() > 10.0 * row["theta1"].abs() && row["theta2"] > 0.0, "{row:?}");
    }
}

/// Claim: one crease drives a Miura-ori with rigid parallelograms, also if creases have no energy; the table has the
/// angles of all edges in either case. Source: its two fold angles satisfy `tan(a/2) = cos(sector) tan(b/2)` (M.
/// Schenk, S. D. Guest, PNAS 110, 3276 (2013)), here `sector` = 60 degrees. Tolerance: the effect of a residual of
/// 1e-12 on angles of order 1 if every constraint is redundant several times.
#[test]
fn one_crease_drives_the_miura_ori() {
    let out = tempfile::tempdir().unwrap();
    let scene = fs::read_to_string(meshes().join("miura-lock.toml")).unwrap();
    fs::copy(meshes().join("miura.fold"), out.path().join("miura.fold")).unwrap();
    for scene in [scene.clone(), scene.replace("creases =", "# creases =")] {
        fs::write(out.path().join("m.toml"), scene.replace("cells = [5, 5]", "cells = [3, 3]")).unwrap();
        let said = foldwell(out.path(), &["run", "m.toml"]);
        assert_eq!(said.status.code(), Some(0), "{}", text(&said.stdout));
        let row = last_row(&out.path().join("m/folded.csv"));
        let angles = row.iter().filter(|(name, _)| name.starts_with("fold_")).map(|(_, angle)| angle.abs());
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
    let out = tempfile::tempdir().unwrap();
    let tube = fs::read_to_string(meshes().join("tube.toml")).unwrap();
    fs::copy(meshes().join("open-star.fold"), out.path().join("open-star.fold")).unwrap();
    let asked = "check = [\"self-intersection\"]";
    assert!(tube.contains("cells = [6, 9]") && tube.contains(asked));
    let modes = "\n[[study]]\nname = \"modes\"\nkind = \"modes\"\neigenvalues = 1\ncheck = [\"self-intersection\"]\n";
    for (cells, check, crossing) in [("[6, 9]", asked, true), ("[6, 8]", asked, false), ("[6, 9]", "", false)] {
        let scene = tube.replace("[6, 9]", cells).replace(asked, check);
        fs::write(out.path().join("t.toml"), format!("{scene}{modes}")).unwrap();
        let said = foldwell(out.path(), &["run", "t.toml"]);
        assert_eq!(said.status.code(), Some(0), "{}", text(&said.stderr));
        let row = last_row(&out.path().join("t/rolled.csv"));
        assert!(abs_diff_eq!(row["theta2"], 0.758, epsilon = 1e-3), "{}", row["theta2"]);
        let expected = if check.is_empty() { f64::NAN } else { f64::from(u8::from(crossing)) };
        assert_eq!(row["self_intersecting"].to_bits(), expected.to_bits(), "{cells} {check}");
        let summary = json(&out.path().join("t/summary.json"))["studies"][0]["self_intersecting"].clone();
        assert_eq!(summary, if check.is_empty() { Value::Null } else { crossing.into() }, "{cells} {check}");
        assert_eq!(text(&said.stdout).contains("faces pass through each other"), crossing, "{cells} {check}");
        let [start, end] = [0, 1].map(|k| crossing_faces(&out.path().join(format!("t/rolled/rolled_000{k}.vtu"))));
        assert!(start.iter().all(|face| *face == 0), "the start is not rolled up");
        assert_eq!(end.contains(&1), crossing, "{cells} {check}");
        let middle = end.len() / 3..2 * end.len() / 3;
        assert!(end[middle].iter().all(|face| *face == 0), "only the ends cross");
        assert!(crossing_faces(&out.path().join("t/modes/modes_0000.vtu")).iter().all(|face| *face == 0));
    }
}

/// Claim: `--json` prints the summary and nothing else on standard output; without it a line for each study and the
/// folder are printed; `draw = []` writes tables only.
#[test]
fn what_a_run_says_and_writes() {
    let out = tempfile::tempdir().unwrap();
    fs::write(out.path().join("a.toml"), star([2, 2], "patch", RIGID, &relax("one", ""))).unwrap();
    let said = foldwell(out.path(), &["run", "a.toml", "--json", "--threads", "1"]);
    let printed: Value = serde_json::from_slice(&said.stdout).expect("JSON and nothing else");
    assert_eq!((said.status.code(), printed), (Some(0), json(&out.path().join("a/summary.json"))));
    assert!(said.stderr.is_empty(), "quiet in a pipe: {}", text(&said.stderr));
    let said = text(&foldwell(out.path(), &["run", "a.toml", "--out", "b"]).stdout);
    assert!(said.starts_with("one (relax): energy ") && said.ends_with("files in b\n"), "{said}");
    let mut names: Vec<String> = files(&out.path().join("b")).into_keys().collect();
    names.sort();
    assert_eq!(names, ["one.csv", "summary.json"]);
}

/// Claim: a saddle is left, and standard output says so. A flat sheet that is compressed in its plane has no force out of the plane:
/// it is unstable under a force a hundred times the stiffness of the creases, which are of length 1 and more, and stable under one
/// as large as that stiffness.
#[test]
fn a_saddle_is_left_and_called_so() {
    let out = tempfile::tempdir().unwrap();
    for (name, force, unstable) in [("strongly", -1.0, true), ("weakly", -0.01, false)] {
        let scene = format!(
            "[sheet]\nmesh = {:?}\ncells = [2, 2]\n[energy]\nbars = {{ stiffness = 1e4 }}\n\
             creases = {{ stiffness = 1e-2 }}\n[[pin]]\nvertex = 0\ncell = [0, 0]\naxes = \"xyz\"\n\
             [[pin]]\nvertex = 0\ncell = [1, 0]\naxes = \"yz\"\n[[pin]]\nvertex = 0\ncell = [0, 1]\naxes = \"z\"\n\
             [[load]]\nvertex = 0\ncell = [1, 0]\nforce = [{force:?}, 0.0, 0.0]\n{}",
            meshes().join("open-flat.fold"),
            relax("flat", "")
        );
        fs::write(out.path().join(format!("{name}.toml")), scene).unwrap();
        let said = text(&foldwell(out.path(), &["run", &format!("{name}.toml")]).stdout);
        let summary = json(&out.path().join(name).join("summary.json"));
        let study = &summary["studies"][0];
        let flat = study["routes"][0]["negative_eigenvalues"].as_u64().unwrap();
        assert_eq!((said.contains(", by way of saddle"), flat > 0), (unstable, unstable), "{flat}: {said}");
        assert_eq!(study["negative_eigenvalues"], 0, "{said}");
    }
}

/// Claim: a study that does not converge gives status 1; the others are computed, its partial results are on disk, and
/// its reason is in the summary. A study that starts from it fails as well, with that reason.
#[test]
fn a_failed_study_is_reported() {
    let out = tempfile::tempdir().unwrap();
    let mesh = Path::new(env!("CARGO_MANIFEST_DIR")).join("meshes/degree-four.fold");
    let lock = |vertex: usize, angle: f64| format!("[[lock]]\ncrease = [0, {vertex}, 0, 0]\nangle = {angle:?}\n");
    let locked = format!(
        "[sheet]\nmesh = {mesh:?}\n[energy]\nbars = {{ stiffness = inf }}\ncreases = {{ stiffness = 1.0 }}\n{}{}{}",
        lock(1, 2.0),
        lock(2, -2.0),
        lock(3, 0.5)
    );
    let studies =
        [relax("held", ""), relax("after", "start = \"held\""), relax("free", "start = { random = 0.1, seed = 1 }")];
    fs::write(out.path().join("a.toml"), locked + &studies.concat()).unwrap();
    let said = foldwell(out.path(), &["run", "a.toml"]);
    assert_eq!(said.status.code(), Some(1), "{}", text(&said.stdout));
    let summary = json(&out.path().join("a/summary.json"));
    let of = |study: usize, key: &str| summary["studies"][study][key].clone();
    assert_eq!((of(0, "converged"), of(1, "converged")), (false.into(), false.into()));
    assert!(of(0, "reason").as_str().unwrap().contains("cannot be met"), "{summary}");
    assert!(of(1, "reason").as_str().unwrap().contains("did not converge"), "{summary}");
    assert_eq!(of(2, "name"), "free");
    assert!(out.path().join("a/held.csv").exists());
}

/// Claim: malformed input gives status 2 and writes nothing; a destination that cannot be written gives status 3. A
/// file with the name of the folder stops every user, also one who may write everywhere.
#[test]
fn what_is_wrong_has_its_status() {
    let out = tempfile::tempdir().unwrap();
    let wrong = ["[[study]]\nname = \"t\"\nkind = \"trace\"", "[[lock]]\ncrease = [0, 1, 7, 0]"];
    let starts = relax("v", "start = \"none.vtu\"");
    for wrong in wrong.into_iter().chain([starts.as_str()]) {
        fs::write(out.path().join("a.toml"), star([2, 2], "patch", RIGID, &(relax("one", "") + wrong))).unwrap();
        let said = foldwell(out.path(), &["run", "a.toml"]);
        assert_eq!((said.status.code(), said.stdout.len()), (Some(2), 0), "{wrong}: {}", text(&said.stderr));
        assert!(!out.path().join("a").exists(), "{wrong}: nothing is written");
    }
    fs::write(out.path().join("b.toml"), star([2, 2], "patch", RIGID, &relax("one", ""))).unwrap();
    fs::write(out.path().join("file"), "").unwrap();
    let said = foldwell(out.path(), &["run", "b.toml", "--out", "file/below"]);
    assert_eq!(said.status.code(), Some(3), "{}", text(&said.stderr));
    assert!(text(&said.stderr).contains("file/below"), "{}", text(&said.stderr));
}

/// Returns all files below a folder.
fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut found = BTreeMap::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        if path.is_dir() {
            found.extend(files(&path).into_iter().map(|(below, bytes)| (format!("{name}/{below}"), bytes)));
        } else {
            found.insert(name, fs::read(&path).unwrap());
        }
    }
    found
}

/// Returns the same without the times in the summary.
fn timeless(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut files = files(folder);
    let summary = text(&files["summary.json"]);
    let kept = summary.lines().filter(|line| !line.trim_start().starts_with("\"seconds\""));
    let kept = kept.map(|line| format!("{line}\n")).collect::<String>();
    files.insert("summary.json".into(), kept.into_bytes());
    files
}

/// Returns a scene of studies that start from each other, long enough to be stopped after the first.
fn long_scene() -> String {
    let studies = [
        relax("first", "start = { random = 0.05, seed = 3 }").replace("draw = []\n", ""),
        relax("second", "start = \"first\""),
        "[[study]]\nname = \"modes\"\nkind = \"modes\"\neigenvalues = 4\n".to_owned(),
        relax("third", "start = { random = 0.06, seed = 4 }"),
        relax("fourth", "start = \"third\""),
    ];
    star([8, 8], "patch", RIGID, &studies.concat())
}

/// Whether the first study of a run is in its summary.
fn first_is_done(out: &Path) -> bool {
    fs::read_to_string(out.join("summary.json")).is_ok_and(|summary| summary.contains("\"name\": \"first\""))
}

/// Starts a run and sends it a signal as soon as its first study is done.
fn stopped(folder: &Path, out: &str, signal: &str) -> Child {
    let mut child = command(folder, &["run", "a.toml", "--out", out]).stdout(Stdio::null()).spawn().expect("it starts");
    let patience = Instant::now();
    while !first_is_done(&folder.join(out)) && child.try_wait().unwrap().is_none() {
        assert!(patience.elapsed() < Duration::from_secs(300), "the first study takes too long");
        std::thread::sleep(Duration::from_millis(1));
    }
    let id = child.id().to_string();
    Command::new("kill").args([signal, &id]).status().expect("there is a program to send signals");
    child
}

/// Claim: a run that is killed after its first study and resumed leaves the same bytes as an undisturbed one, except
/// for times: also if a study starts from one that was kept, and if nothing is drawn.
#[test]
#[cfg(unix)]
fn a_killed_run_is_resumed_exactly() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("a.toml"), long_scene()).unwrap();
    let ended = stopped(folder.path(), "killed", "-KILL").wait().unwrap();
    assert_eq!(ended.code(), None, "it was killed before it ended");
    let before = json(&folder.path().join("killed/summary.json"));
    let done = before["studies"].as_array().unwrap().len();
    assert!((1..5).contains(&done), "{done} studies were done");
    let said = foldwell(folder.path(), &["run", "a.toml", "--out", "killed", "--resume"]);
    assert_eq!(said.status.code(), Some(0), "{}", text(&said.stderr));
    assert_eq!(text(&said.stdout).matches("(kept)").count(), done, "{}", text(&said.stdout));
    foldwell(folder.path(), &["run", "a.toml", "--out", "whole"]);
    let (resumed, whole) = (timeless(&folder.path().join("killed")), timeless(&folder.path().join("whole")));
    assert_eq!(resumed.keys().collect::<Vec<_>>(), whole.keys().collect::<Vec<_>>());
    for (name, bytes) in &whole {
        assert!(resumed[name] == *bytes, "{name} is another one after the resumption");
    }
    let seconds = &json(&folder.path().join("killed/summary.json"))["studies"][0]["seconds"];
    assert_eq!(*seconds, before["studies"][0]["seconds"], "the first study was not computed again");
}

/// Claim: Ctrl-C ends a run with status 130, with its finished studies complete on disk.
#[test]
#[cfg(unix)]
fn an_interrupted_run_keeps_what_is_done() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("a.toml"), long_scene()).unwrap();
    let ended = stopped(folder.path(), "cut", "-INT").wait().unwrap();
    assert_eq!(ended.code(), Some(130));
    let out = folder.path().join("cut");
    let summary = json(&out.join("summary.json"));
    assert_eq!((&summary["studies"][0]["name"], &summary["studies"][0]["converged"]), (&"first".into(), &true.into()));
    assert!(out.join("first.csv").exists() && out.join("first/first_0001.vtu").exists());
    assert!(files(&out).keys().all(|name| !name.ends_with(".part")));
    let said = foldwell(folder.path(), &["run", "a.toml", "--out", "cut", "--resume"]);
    assert_eq!(said.status.code(), Some(0), "{}", text(&said.stdout));
    assert!(text(&said.stdout).lines().next().unwrap().ends_with("(kept)"), "{}", text(&said.stdout));
}

/// Claim: Ctrl-C ends a study of modes, which is reported as not converged with its reason; earlier results are
/// complete, later studies are not started. The iteration for hundreds of eigenpairs takes far longer than a signal.
#[test]
#[cfg(unix)]
fn modes_are_interrupted() {
    let folder = tempfile::tempdir().unwrap();
    let modes = "[[study]]\nname = \"modes\"\nkind = \"modes\"\neigenvalues = 200\ndraw = []\n";
    let studies = relax("first", "") + modes + &relax("last", "");
    fs::write(folder.path().join("a.toml"), star([20, 20], "patch", RIGID, &studies)).unwrap();
    let ended = stopped(folder.path(), "cut", "-INT").wait().unwrap();
    assert_eq!(ended.code(), Some(130));
    let out = folder.path().join("cut");
    let summary = json(&out.join("summary.json"));
    let studies = summary["studies"].as_array().unwrap();
    let ends: Vec<_> = studies.iter().map(|study| (&study["name"], &study["converged"], &study["reason"])).collect();
    assert_eq!(ends.len(), 2, "{ends:?}");
    assert_eq!((ends[0].0, ends[0].1), (&"first".into(), &true.into()));
    assert_eq!(ends[1], (&"modes".into(), &false.into(), &"interrupted".into()));
    assert!(out.join("first.csv").exists() && !out.join("modes.csv").exists());
}

/// Claim: no result is kept if the scene, or a file that it names, has changed; and none without `--resume`.
#[test]
fn another_scene_keeps_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let scene = folder.path().join("a.toml");
    let mesh = folder.path().join("star.fold");
    fs::copy(meshes().join("open-star.fold"), &mesh).unwrap();
    let old = star([2, 2], "patch", RIGID, &relax("one", ""));
    let old = old.replace(&format!("{:?}", meshes().join("open-star.fold").display().to_string()), "\"star.fold\"");
    fs::write(&scene, &old).unwrap();
    let kept = |words: &[&str]| text(&foldwell(folder.path(), words).stdout).matches("(kept)").count();
    let resume = ["run", "a.toml", "--resume"];
    assert_eq!([kept(&resume), kept(&resume), kept(&["run", "a.toml"]), kept(&resume)], [0, 1, 0, 1]);
    fs::write(&scene, old.replace("0.06", "0.05")).unwrap();
    assert_eq!([kept(&resume), kept(&resume)], [0, 1]);
    fs::write(&mesh, fs::read_to_string(&mesh).unwrap() + "\n").unwrap();
    assert_eq!([kept(&resume), kept(&resume)], [0, 1]);
    fs::remove_file(folder.path().join("a/one.csv")).unwrap();
    assert_eq!(kept(&resume), 0);
}

/// Claim: with both engines there is a row for every state, with residuals and the distance from the exact kinematics
/// for every relaxation, that is for all states but the drawn one; the largest distance is in the summary.
#[test]
fn engines_are_compared() {
    let out = tempfile::tempdir().unwrap();
    let scene = meshes().join("star-engines.toml");
    let output = foldwell(out.path(), &["run", scene.to_str().unwrap(), "--out", "run", "--quiet"]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    let folder = out.path().join("run");
    let branches = json(&folder.join("summary.json"))["studies"][0]["branches"].as_array().unwrap().clone();
    let table = fs::read_to_string(folder.join("both.csv")).unwrap();
    let header: Vec<&str> = table.lines().next().unwrap().split(',').collect();
    let column = |name: &str| header.iter().position(|column| *column == name).unwrap();
    let at = ["branch", "sign", "step", "residual_force", "error_to_kinematic"].map(column);
    let rows: Vec<[Option<f64>; 5]> =
        table.lines().skip(1).map(|line| at.map(|k| line.split(',').nth(k).unwrap().parse().ok())).collect();
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
