//! The files of a run: they contain every element of the model once, and none is lost, outdated or overwritten.

use crate::common::{Folder, mesh_folder};
use approx::{assert_abs_diff_eq, assert_relative_eq};
use foldwell::output::vtk::read_vtu;
use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};
use vtkio::model::{Attribute, DataSet, UnstructuredGridPiece, Vtk};

/// Runs a scene into `out`; returns the summary and what is said.
fn run(folder: &Folder, scene: &str, words: &str) -> (Value, String) {
    let said = folder.scene(scene).program(words).well();
    (said.folder.json("summary.json"), said.all())
}

/// Returns the message for a scene that is refused with status 2.
fn refused(folder: &Folder, scene: &str, out: &str) -> String {
    let said = folder.scene(scene).out(out).program("").ends(2).err;
    said.split_whitespace().collect::<Vec<_>>().join(" ")
}

fn sheet(domain: &str, cells: [usize; 2]) -> String {
    format!("[sheet]\nmesh = \"open-star.fold\"\n{domain}\ncells = {cells:?}\n[energy]\nbars = {{ stiffness = 1e3 }}\n")
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

/// Claim: every face and every edge of the model is in a file once, with its energy: the star cell has 8 triangles and
/// 12 edges, and the energies of the lines add up to that of the summary, on a screw for each cell that is shown. On
/// narrow tori most faces cross the seam. No two points coincide in the drawn state. Tolerance: the rounding error of a
/// sum of a few hundred numbers.
#[test]
fn every_element_is_in_the_file_once() {
    let tori = [("domain = \"torus\"\nlattice = \"free\"", 1), ("domain = \"torus\"\nlattice = \"fixed\"", 1)];
    for ((domain, copies), cells) in tori.into_iter().zip([[4, 4], [1, 2]]).chain([(("domain = \"screw\"", 6), [2, 3])])
    {
        let folder = Folder::new();
        let rest = creases("{ mode = [0.3, 0.3, 0.0], amplitude = 1.0 }");
        let scene = sheet(domain, cells) + &rest + &study("relaxed", "kind = \"relax\"");
        let (summary, _) = run(&folder, &scene, "");
        let file = folder.file("out/relaxed/relaxed_0001.vtu");
        let (mesh, count) = (read_vtu(&file).unwrap(), cells[0] * cells[1]);
        assert_eq!((mesh.triangles.len(), mesh.lines.len()), (8 * count, 12 * count), "{domain}");
        let energy = f64::from(copies) * summary["studies"][0]["energy"]["total"].as_f64().unwrap();
        let sum: f64 = on_lines(&file, "energy").iter().filter(|energy| energy.is_finite()).sum();
        assert!(energy > 0.0);
        assert_relative_eq!(sum, energy, max_relative = 1e-9);
        let drawn = read_vtu(&folder.file("out/relaxed/relaxed_0000.vtu")).unwrap();
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
    let folder = Folder::new();
    let torus = sheet("domain = \"torus\"\nlattice = \"fixed\"", [2, 2]) + &creases("\"flat\"");
    let (first, _) = run(&folder, &(torus.clone() + &study("relaxed", "kind = \"relax\"")), "");
    let file = folder.file("out/relaxed/relaxed_0001.vtu");
    assert!(read_vtu(&file).unwrap().points.len() > 16);
    fs::copy(&file, folder.file("start.vtu")).unwrap();
    let again = study("again", "kind = \"relax\"\nstart = \"start.vtu\"");
    let (second, _) = run(&folder, &(torus + &again), "");
    let energy = |summary: &Value| summary["studies"][0]["energy"]["total"].as_f64().unwrap();
    assert_relative_eq!(energy(&first), energy(&second), max_relative = 1e-9);
    let history = second["studies"][0]["history"].as_array().unwrap().len();
    assert!(history < first["studies"][0]["history"].as_array().unwrap().len(), "{history}");
}

/// Claim: a run that would overwrite a file that its scene reads is refused before it writes anything: a table, the
/// mesh, a start, or the scene, also through links and folders with several names.
#[test]
fn files_that_are_read_are_not_overwritten() {
    let folder = Folder::new();
    let path = |name: &str| folder.file(name);
    fs::copy(mesh_folder().join("star-wells-rest.csv"), path("a.csv")).unwrap();
    fs::copy(mesh_folder().join("open-star.fold"), path("open-star.fold")).unwrap();
    fs::create_dir(path("a")).unwrap();
    let files = || folder.files().into_keys().filter(|name| !name.ends_with("scene.toml")).count();
    let from_table = sheet("domain = \"screw\"", [2, 2]) + &creases("{ file = \"a.csv\" }");
    let scene = from_table + &study("a", "kind = \"relax\"");
    let before = files();
    for out in [".", "a/..", folder.path().to_str().unwrap()] {
        let said = refused(&folder, &scene, out);
        assert!(said.contains("study `a` would overwrite a.csv"), "{said}");
    }
    assert_eq!(files(), before, "nothing is written");
    assert_eq!(folder.text("a.csv"), include_str!("../../../meshes/star-wells-rest.csv"));
    let patch = sheet("domain = \"patch\"", [1, 1]) + &creases("\"drawn\"");
    run(&folder, &(patch.clone() + &study("a", "kind = \"relax\"")), "");
    let again = study("a", "kind = \"relax\"\nstart = \"out/a/a_0001.vtu\"");
    let said = refused(&folder, &(patch.clone() + &again), "out");
    assert!(said.contains("would overwrite out/a/a_0001.vtu"), "{said}");
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink(path("out"), path("link")).unwrap();
        let again = again.replace("out/", "link/");
        assert!(refused(&folder, &(patch.clone() + &again), "out").contains("would overwrite"));
        fs::rename(path("out/a/a_0001.vtu"), path("kept.vtu")).unwrap();
        std::os::unix::fs::symlink(path("kept.vtu"), path("out/a/a_0001.vtu")).unwrap();
        assert!(refused(&folder, &(patch.clone() + &again), "out").contains("would overwrite"));
        // a study that writes none of these files may read them
        run(&folder, &(patch + &again.replace("name = \"a\"", "name = \"b\"")), "");
    }
}

/// Claim: studies whose files would have the same names, and names too long for files, are refused before anything is
/// computed.
#[test]
fn names_do_not_collide() {
    let folder = Folder::new();
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
            let said = refused(&folder, &(sheet.clone() + &studies), "out");
            assert!(said.contains(&format!("would both write `{file}`")), "{said}");
        }
    }
    assert!(refused(&folder, &(sheet.clone() + &relax(&"n".repeat(201))), "out").contains("201 characters"));
    assert!(!folder.has("out"));
    run(&folder, &(sheet + &relax(&"n".repeat(200)) + &relax("a-map") + &relax("a")), "");
}

/// Claim: a resumed run computes a study again if one of its files is missing, empty, cut or changed, or if its entry
/// in the summary cannot be read, and then the folder is restored byte by byte; complete files are kept.
#[test]
fn a_resumed_run_makes_broken_files_good() {
    let folder = Folder::new();
    let modes = study("modes", "kind = \"modes\"\neigenvalues = 3");
    let scene = sheet("domain = \"patch\"", [1, 1]) + &creases("0.3") + &study("a", "kind = \"relax\"") + &modes;
    run(&folder, &scene, "");
    let out = folder.inner("out");
    let whole = out.files();
    let (_, said) = run(&folder, &scene, "--resume");
    assert_eq!(said.matches("kept").count(), 2, "{said}");
    let files: Vec<&PathBuf> = whole.keys().filter(|path| !path.ends_with("summary.json")).collect();
    assert!(files.len() > 8);
    for (k, file) in files.iter().enumerate() {
        let (bytes, path) = (out.bytes(file), out.file(file));
        match k % 4 {
            0 => fs::remove_file(path).unwrap(),
            1 => fs::write(path, "").unwrap(),
            2 => fs::write(path, &bytes[..bytes.len() - 1]).unwrap(),
            _ => fs::write(path, [&bytes[1..], &bytes[..1]].concat()).unwrap(),
        }
        let (_, said) = run(&folder, &scene, "--resume");
        assert_eq!(said.matches("kept").count(), 1, "{}: {said}", file.display());
        assert_eq!(out.files(), whole, "{}", file.display());
    }
    let mut without = out.json("summary.json");
    *without.pointer_mut("/studies/0/energy/total").unwrap() = Value::Null;
    out.write("summary.json", without.to_string());
    let (_, said) = run(&folder, &scene, "--resume");
    assert_eq!(said.matches("kept").count(), 1, "{said}");
    assert_eq!(out.files(), whole);
}

/// Claim: the drawings of an earlier run that this run does not make are removed, and nothing else: files of other
/// studies, of the user, and folders that are not empty stay.
#[test]
fn old_pictures_go() {
    let folder = Folder::new();
    let scene = |draw: &str| {
        let draw = format!("kind = \"relax\"\n{draw}");
        sheet("domain = \"patch\"", [1, 1]) + &creases("0.3") + &study("a", &draw) + &study("a-map", "kind = \"relax\"")
    };
    run(&folder, &scene(""), "");
    let out = folder.inner("out");
    for name in ["a/notes.txt", "a.txt", "a/b_0000.vtu", "a/a_1.vtu"] {
        out.write(name, "mine");
    }
    out.write("a/a_0007.vtu", "of a longer series");
    out.write("a-strain.svg", "of a trajectory");
    let there = |name: &str| out.has(name);
    run(&folder, &scene("draw = [\"vtk\"]"), "");
    assert!(
        there("a.pvd") && there("a/a_0001.vtu") && !there("a/a_0007.vtu") && !there("a.svg") && !there("a-strain.svg")
    );
    run(&folder, &scene("draw = []"), "");
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
    let folder = Folder::new();
    let studies: String = (0..300).map(|k| study(&format!("s{k}"), "kind = \"relax\"\ndraw = []")).collect();
    let scene = sheet("domain = \"patch\"", [1, 1]) + &creases("\"drawn\"") + &studies;
    let names = |summary: &Value| -> Vec<String> {
        let studies = summary["studies"].as_array().unwrap();
        studies.iter().map(|study| study["name"].as_str().unwrap().to_owned()).collect()
    };
    let expected: Vec<String> = (0..300).map(|k| format!("s{k}")).collect();
    assert_eq!(names(&run(&folder, &scene, "--quiet").0), expected);
    for k in (0..300).step_by(7) {
        fs::remove_file(folder.file(format!("out/s{k}.csv"))).unwrap();
    }
    let (summary, _) = run(&folder, &scene, "--resume --quiet");
    assert_eq!(names(&summary), expected);
    assert_abs_diff_eq!(summary["studies"][0]["energy"]["total"].as_f64().unwrap(), 0.0, epsilon = 1e-20);
}
