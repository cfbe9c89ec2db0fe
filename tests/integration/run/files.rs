//! The files of a run: they contain every element of the model once, and none is lost, outdated or overwritten.

use approx::{assert_abs_diff_eq, assert_relative_eq};
use foldwell::output::vtk::read_vtu;
use serde_json::Value;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use vtkio::model::{Attribute, DataSet, UnstructuredGridPiece, Vtk};

fn meshes() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("meshes")
}

fn foldwell(folder: &Path, words: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_foldwell")).current_dir(folder).args(words).output().unwrap()
}

/// Runs a scene into `out`; returns the summary and the standard output.
fn run(folder: &Path, scene: &str, more: &[&str]) -> (Value, String) {
    fs::write(folder.join("scene.toml"), scene).unwrap();
    let ran = foldwell(folder, &[&["run", "scene.toml", "--out", "out"], more].concat());
    let said = String::from_utf8_lossy(&[ran.stdout, ran.stderr].concat()).into_owned();
    assert_eq!(ran.status.code(), Some(0), "{said}");
    (serde_json::from_slice(&fs::read(folder.join("out/summary.json")).unwrap()).unwrap(), said)
}

/// Returns the message for a scene that is refused with status 2.
fn refused(folder: &Path, scene: &str, out: &str) -> String {
    fs::write(folder.join("scene.toml"), scene).unwrap();
    let ran = foldwell(folder, &["run", "scene.toml", "--out", out]);
    let said = String::from_utf8_lossy(&ran.stderr).into_owned();
    assert_eq!(ran.status.code(), Some(2), "{said}");
    said.split_whitespace().collect::<Vec<_>>().join(" ")
}

fn sheet(domain: &str, cells: [usize; 2]) -> String {
    let mesh = meshes().join("open-star.fold").display().to_string();
    format!("[sheet]\nmesh = {mesh:?}\n{domain}\ncells = {cells:?}\n[energy]\nbars = {{ stiffness = 1e3 }}\n")
}

fn creases(rest: &str) -> String {
    format!("creases = {{ stiffness = 1.0, rest = {rest} }}\n")
}

fn study(name: &str, more: &str) -> String {
    format!("[[study]]\nname = \"{name}\"\n{more}\n")
}

/// Returns the values on the lines of an array of a file; lines come after triangles.
fn on_lines(path: &Path, name: &str) -> Vec<f64> {
    let vtk = Vtk::parse_xml(&fs::read(path).unwrap()[..]).unwrap();
    let DataSet::UnstructuredGrid { .. } = &vtk.data else { panic!("a grid") };
    let piece = UnstructuredGridPiece::try_from(vtk.data).unwrap();
    let array = piece.data.cell.iter().find_map(|attribute| match attribute {
        Attribute::DataArray(array) if array.name == name => array.data.cast_into::<f64>(),
        _ => None,
    });
    array.unwrap().split_off(read_vtu(path).unwrap().triangles.len())
}

/// Returns names and bytes of all files below a folder, without the times in the summary.
fn contents(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut found = BTreeMap::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            found.extend(contents(&path));
        } else {
            let bytes = fs::read(&path).unwrap();
            let lines = bytes.split_inclusive(|byte| *byte == b'\n');
            let kept = lines.filter(|line| !line.windows(9).any(|word| word == b"\"seconds\""));
            found.insert(path.clone(), kept.flatten().copied().collect());
        }
    }
    found
}

/// Claim: every face and every edge of the model is in a file once, with its energy: the star cell has 8 triangles and
/// 12 edges, and the energies of the lines add up to that of the summary, on a screw for each cell that is shown. On
/// narrow tori most faces cross the seam. No two points coincide in the drawn state. Tolerance: the rounding error of a
/// sum of a few hundred numbers.
#[test]
fn every_element_is_in_the_file_once() {
    let tori = [("domain = \"torus\"\nlattice = \"free\"", 1), ("domain = \"torus\"\nlattice = \"fixed\"", 1)];
    for ((domain, copies), cells) in tori.into_iter().zip([[4, 4], [1, 2]]).chain([(("domain = \"screw\"", 6), [2, 3])])
    {
        let folder = tempfile::tempdir().unwrap();
        let rest = creases("{ mode = [0.3, 0.3, 0.0], amplitude = 1.0 }");
        let scene = sheet(domain, cells) + &rest + &study("relaxed", "kind = \"relax\"");
        let (summary, _) = run(folder.path(), &scene, &[]);
        let file = folder.path().join("out/relaxed/relaxed_0001.vtu");
        let (mesh, count) = (read_vtu(&file).unwrap(), cells[0] * cells[1]);
        assert_eq!((mesh.triangles.len(), mesh.lines.len()), (8 * count, 12 * count), "{domain}");
        let energy = f64::from(copies) * summary["studies"][0]["energy"]["total"].as_f64().unwrap();
        let sum: f64 = on_lines(&file, "energy").iter().filter(|energy| energy.is_finite()).sum();
        assert!(energy > 0.0);
        assert_relative_eq!(sum, energy, max_relative = 1e-9);
        let drawn = read_vtu(&folder.path().join("out/relaxed/relaxed_0000.vtu")).unwrap();
        let mut edges = on_lines(&file, "edge");
        edges.sort_by(f64::total_cmp);
        assert_eq!(edges, (0..12 * count).map(|k| (k / count) as f64).collect::<Vec<_>>());
        for (k, a) in drawn.points.iter().enumerate() {
            assert!(drawn.points[..k].iter().all(|b| (a - b).norm() > 1e-6), "{domain}: point {k}");
        }
        // every line must belong to a face
        let beside = |line: &[usize; 2]| mesh.triangles.iter().any(|face| line.iter().all(|end| face.contains(end)));
        assert!(mesh.lines.iter().all(beside), "{domain}");
    }
}

/// Claim: the file of a torus with fixed lattice is a valid start, with the images not counted as unknowns, and so is a
/// file without images, as written by earlier versions.
#[test]
fn a_torus_starts_from_its_picture() {
    let folder = tempfile::tempdir().unwrap();
    let torus = sheet("domain = \"torus\"\nlattice = \"fixed\"", [2, 2]) + &creases("\"flat\"");
    let (first, _) = run(folder.path(), &(torus.clone() + &study("relaxed", "kind = \"relax\"")), &[]);
    let file = folder.path().join("out/relaxed/relaxed_0001.vtu");
    assert!(read_vtu(&file).unwrap().points.len() > 16);
    fs::copy(&file, folder.path().join("start.vtu")).unwrap();
    let again = study("again", "kind = \"relax\"\nstart = \"start.vtu\"");
    let (second, _) = run(folder.path(), &(torus + &again), &[]);
    let energy = |summary: &Value| summary["studies"][0]["energy"]["total"].as_f64().unwrap();
    assert_relative_eq!(energy(&first), energy(&second), max_relative = 1e-9);
    let history = second["studies"][0]["history"].as_array().unwrap().len();
    assert!(history < first["studies"][0]["history"].as_array().unwrap().len(), "{history}");
}

/// Claim: a run that would overwrite a file that its scene reads is refused before it writes anything: a table, the
/// mesh, a start, or the scene, also through links and folders with several names.
#[test]
fn files_that_are_read_are_not_overwritten() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    fs::copy(meshes().join("star-wells-rest.csv"), path("a.csv")).unwrap();
    fs::create_dir(path("a")).unwrap();
    let files = |folder: &Path| contents(folder).into_keys().filter(|name| !name.ends_with("scene.toml")).count();
    let from_table = sheet("domain = \"screw\"", [2, 2]) + &creases("{ file = \"a.csv\" }");
    let scene = from_table + &study("a", "kind = \"relax\"");
    let before = files(folder.path());
    for out in [".", "a/..", folder.path().to_str().unwrap()] {
        let said = refused(folder.path(), &scene, out);
        assert!(said.contains("study `a` would overwrite a.csv"), "{said}");
    }
    assert_eq!(files(folder.path()), before, "nothing is written");
    assert_eq!(fs::read(path("a.csv")).unwrap(), fs::read(meshes().join("star-wells-rest.csv")).unwrap());
    let patch = sheet("domain = \"patch\"", [1, 1]) + &creases("\"drawn\"");
    run(folder.path(), &(patch.clone() + &study("a", "kind = \"relax\"")), &[]);
    let again = study("a", "kind = \"relax\"\nstart = \"out/a/a_0001.vtu\"");
    let said = refused(folder.path(), &(patch.clone() + &again), "out");
    assert!(said.contains("would overwrite out/a/a_0001.vtu"), "{said}");
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink(path("out"), path("link")).unwrap();
        let again = again.replace("out/", "link/");
        assert!(refused(folder.path(), &(patch.clone() + &again), "out").contains("would overwrite"));
        fs::rename(path("out/a/a_0001.vtu"), path("kept.vtu")).unwrap();
        std::os::unix::fs::symlink(path("kept.vtu"), path("out/a/a_0001.vtu")).unwrap();
        assert!(refused(folder.path(), &(patch.clone() + &again), "out").contains("would overwrite"));
        // a study that writes none of these files may read them
        run(folder.path(), &(patch + &again.replace("name = \"a\"", "name = \"b\"")), &[]);
    }
}

/// Claim: studies whose files would have the same names, and names too long for files, are refused before anything is
/// computed.
#[test]
fn names_do_not_collide() {
    let folder = tempfile::tempdir().unwrap();
    let sheet = sheet("domain = \"screw\"", [1, 1]) + &creases("\"drawn\"");
    let relax = |name: &str| study(name, "kind = \"relax\"");
    let map = "kind = \"landscape\"\nmodes = [[1, 0, 0]]\namplitudes = [0.01]\nmap = { amplitude = 0.01, rings = 3 }";
    let cases = [
        ("a-map", study("a", map), "a-map.csv"),
        ("a-strain", study("a", "kind = \"trace\""), "a-strain.svg"),
        ("a-barriers", study("a", "kind = \"wells\""), "a-barriers.csv"),
        ("a_bands", study("a", "kind = \"bloch\"\npath = [[0, 0], [1, 1]]"), "a_bands.csv"),
        ("Loop", relax("loop"), "loop.csv"),
    ];
    for (name, other, file) in cases {
        for studies in [relax(name) + &other, other.clone() + &relax(name)] {
            let said = refused(folder.path(), &(sheet.clone() + &studies), "out");
            assert!(said.contains(&format!("would both write `{file}`")), "{said}");
        }
    }
    assert!(refused(folder.path(), &(sheet.clone() + &relax(&"n".repeat(201))), "out").contains("201 characters"));
    assert!(!folder.path().join("out").exists());
    run(folder.path(), &(sheet + &relax(&"n".repeat(200)) + &relax("a-map") + &relax("a")), &[]);
}

/// Claim: a resumed run computes a study again if one of its files is missing, empty, cut or changed, or if its entry
/// in the summary cannot be read, and then the folder is restored byte by byte; complete files are kept.
#[test]
fn a_resumed_run_makes_broken_files_good() {
    let folder = tempfile::tempdir().unwrap();
    let modes = study("modes", "kind = \"modes\"\neigenvalues = 3");
    let scene = sheet("domain = \"patch\"", [1, 1]) + &creases("0.3") + &study("a", "kind = \"relax\"") + &modes;
    run(folder.path(), &scene, &[]);
    let out = folder.path().join("out");
    let whole = contents(&out);
    let (_, said) = run(folder.path(), &scene, &["--resume"]);
    assert_eq!(said.matches("kept").count(), 2, "{said}");
    let files: Vec<&PathBuf> = whole.keys().filter(|path| !path.ends_with("summary.json")).collect();
    assert!(files.len() > 8);
    for (k, file) in files.iter().enumerate() {
        let bytes = fs::read(file).unwrap();
        match k % 4 {
            0 => fs::remove_file(file).unwrap(),
            1 => fs::write(file, "").unwrap(),
            2 => fs::write(file, &bytes[..bytes.len() - 1]).unwrap(),
            _ => fs::write(file, [&bytes[1..], &bytes[..1]].concat()).unwrap(),
        }
        let (_, said) = run(folder.path(), &scene, &["--resume"]);
        assert_eq!(said.matches("kept").count(), 1, "{}: {said}", file.display());
        assert_eq!(contents(&out), whole, "{}", file.display());
    }
    let summary = out.join("summary.json");
    let mut without: Value = serde_json::from_str(&fs::read_to_string(&summary).unwrap()).unwrap();
    *without.pointer_mut("/studies/0/energy/total").unwrap() = Value::Null;
    fs::write(&summary, without.to_string()).unwrap();
    let (_, said) = run(folder.path(), &scene, &["--resume"]);
    assert_eq!(said.matches("kept").count(), 1, "{said}");
    assert_eq!(contents(&out), whole);
}

/// Claim: the drawings of an earlier run that this run does not make are removed, and nothing else: files of other
/// studies, of the user, and folders that are not empty stay.
#[test]
fn old_pictures_go() {
    let folder = tempfile::tempdir().unwrap();
    let scene = |draw: &str| {
        let draw = format!("kind = \"relax\"\n{draw}");
        sheet("domain = \"patch\"", [1, 1]) + &creases("0.3") + &study("a", &draw) + &study("a-map", "kind = \"relax\"")
    };
    run(folder.path(), &scene(""), &[]);
    let out = folder.path().join("out");
    for name in ["a/notes.txt", "a.txt", "a/b_0000.vtu", "a/a_1.vtu"] {
        fs::write(out.join(name), "mine").unwrap();
    }
    fs::write(out.join("a/a_0007.vtu"), "of a longer series").unwrap();
    fs::write(out.join("a-strain.svg"), "of a trajectory").unwrap();
    let there = |name: &str| out.join(name).exists();
    run(folder.path(), &scene("draw = [\"vtk\"]"), &[]);
    assert!(
        there("a.pvd") && there("a/a_0001.vtu") && !there("a/a_0007.vtu") && !there("a.svg") && !there("a-strain.svg")
    );
    run(folder.path(), &scene("draw = []"), &[]);
    assert!(there("a.csv") && !there("a.pvd") && !there("a/a_0000.vtu") && !there("a/a_0001.vtu"));
    for name in ["a/notes.txt", "a.txt", "a/b_0000.vtu", "a/a_1.vtu", "a-map.csv", "a-map.svg", "a-map/a-map_0001.vtu"]
    {
        assert!(there(name), "{name}");
    }
}

/// Claim: with many studies the summary is not written after each of them, and at the end it has all of them in their
/// order, also if some were kept. 300 studies represent more; the bound on time is wide, from 0.02 s for a study that
/// is already relaxed.
#[test]
fn many_studies_are_all_in_the_summary() {
    let folder = tempfile::tempdir().unwrap();
    let studies: String = (0..300).map(|k| study(&format!("s{k}"), "kind = \"relax\"\ndraw = []")).collect();
    let scene = sheet("domain = \"patch\"", [1, 1]) + &creases("\"drawn\"") + &studies;
    let names = |summary: &Value| -> Vec<String> {
        let studies = summary["studies"].as_array().unwrap();
        studies.iter().map(|study| study["name"].as_str().unwrap().to_owned()).collect()
    };
    let expected: Vec<String> = (0..300).map(|k| format!("s{k}")).collect();
    assert_eq!(names(&run(folder.path(), &scene, &["--quiet"]).0), expected);
    for k in (0..300).step_by(7) {
        fs::remove_file(folder.path().join(format!("out/s{k}.csv"))).unwrap();
    }
    let (summary, _) = run(folder.path(), &scene, &["--resume", "--quiet"]);
    assert_eq!(names(&summary), expected);
    assert_abs_diff_eq!(summary["studies"][0]["energy"]["total"].as_f64().unwrap(), 0.0, epsilon = 1e-20);
}
