//! Scenes of a call of `foldwell run`: several of them, from standard input, and with keys set on the command line.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::Output;

use assert_cmd::Command;

const SCENE: &str = "[sheet]\ngenerate = { pattern = \"miura\" }\ncells = [2, 2]\n[energy]\nbars = { stiffness = inf }\n\
                     creases = { stiffness = 1.0, rest = \"flat\" }\n[[study]]\nname = \"relaxed\"\nkind = \"relax\"\n";

fn foldwell(folder: &Path, words: &[&str], input: &str) -> Output {
    let mut command = Command::cargo_bin("foldwell").expect("the binary is built with its tests");
    command.current_dir(folder).args(words).write_stdin(input).output().expect("the binary starts")
}

fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// Returns the bytes of the files of a run, its summary left out, which has the time.
fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let names = ["relaxed.csv", "relaxed.svg", "relaxed/relaxed_0001.vtu"];
    names.map(|name| (name.to_owned(), fs::read(folder.join(name)).unwrap())).into_iter().collect()
}

fn folders(folder: &Path) -> Vec<String> {
    let mut names: Vec<_> =
        fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

/// Claim: setting a key gives the files of the scene that is edited so, byte by byte, and the summary names the setting.
#[test]
fn a_set_key_is_an_edited_scene() {
    let folder = tempfile::tempdir().unwrap();
    let edited = SCENE.replace("inf", "1e3").replace("[2, 2]", "[3, 2]");
    fs::write(folder.path().join("a.toml"), SCENE).unwrap();
    fs::write(folder.path().join("b.toml"), edited).unwrap();
    let set = ["run", "a.toml", "--set", "energy.bars.stiffness=1e3", "--set", "sheet.cells=[3, 2]"];
    assert!(foldwell(folder.path(), &set, "").status.success());
    assert!(foldwell(folder.path(), &["run", "b.toml"], "").status.success());
    assert_eq!(files(&folder.path().join("a"))["relaxed.csv"], files(&folder.path().join("b"))["relaxed.csv"]);
    let summary: serde_json::Value =
        serde_json::from_slice(&fs::read(folder.path().join("a/summary.json")).unwrap()).unwrap();
    assert_eq!(summary["settings"], serde_json::json!(["energy.bars.stiffness=1e3", "sheet.cells=[3, 2]"]));
    let info = ["info", "a.toml", "--json", "--set", "sheet.cells=[3, 2]"];
    let info: serde_json::Value = serde_json::from_slice(&foldwell(folder.path(), &info, "").stdout).unwrap();
    assert_eq!(info["energy"]["cells"], serde_json::json!([3, 2]));
}

/// Claim: a setting that is none, or that makes the scene wrong, is refused with its place, and nothing is written.
#[test]
fn wrong_settings_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("a.toml"), SCENE).unwrap();
    for (setting, parts) in [
        ("energy.bars", ["sets no key", "energy.bars.stiffness=1e4"]),
        ("study.pulled.kind=trace", ["no element `pulled`", "there are relaxed"]),
        ("energy.bars.stiffness=-1", ["a.toml (keys set):5:", "the stiffness is -1"]),
        ("energy.bars.stifness=1", ["a.toml (keys set):5:", "unknown key `stifness`"]),
    ] {
        let output = foldwell(folder.path(), &["run", "a.toml", "--set", setting], "");
        let message = said(&output);
        assert_eq!(output.status.code(), Some(2), "{setting}");
        assert!(parts.iter().all(|part| message.contains(part)), "{message}");
    }
    assert_eq!(folders(folder.path()), ["a.toml"]);
}

/// Claim: a scene on standard input gives the tables of the same scene in a file, and its errors their place.
#[test]
fn standard_input_is_a_scene() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("a.toml"), SCENE).unwrap();
    assert!(foldwell(folder.path(), &["run", "a.toml"], "").status.success());
    assert!(foldwell(folder.path(), &["run", "-", "--out", "b"], SCENE).status.success());
    assert_eq!(files(&folder.path().join("a"))["relaxed.csv"], files(&folder.path().join("b"))["relaxed.csv"]);
    let wrong = foldwell(folder.path(), &["run", "-"], "[sheet]\nmash = 3\n");
    assert_eq!(wrong.status.code(), Some(2));
    assert!(said(&wrong).contains("stdin:2:1: unknown key `mash`"), "{}", said(&wrong));
    assert_eq!(folders(folder.path()), ["a", "a.toml", "b"]);
}

/// Claim: several scenes give the files that each gives alone, and as JSON the list of their summaries.
#[test]
fn several_scenes_are_each_as_alone() {
    let folder = tempfile::tempdir().unwrap();
    for (name, fold) in [("a", "0.2"), ("b", "0.4")] {
        let text = SCENE.replace("\"miura\"", &format!("\"miura\", fold = {fold}"));
        fs::write(folder.path().join(format!("{name}.toml")), text).unwrap();
    }
    let output = foldwell(folder.path(), &["run", "a.toml", "b.toml", "--out", "both", "--json"], "");
    let summaries: Vec<serde_json::Value> = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(summaries.iter().map(|s| s["scene"].as_str().unwrap()).collect::<Vec<_>>(), ["a.toml", "b.toml"]);
    for name in ["a", "b"] {
        assert!(foldwell(folder.path(), &["run", &format!("{name}.toml")], "").status.success());
        assert_eq!(files(&folder.path().join(name)), files(&folder.path().join("both").join(name)), "{name}");
    }
}

/// Claim: if one of several scenes is wrong, none of them is run; two scenes of one name would share a folder. A study that
/// fails in the first scene keeps the second from nothing, and decides the status.
#[test]
fn several_scenes_are_checked_first() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    fs::create_dir(path.join("sub")).unwrap();
    fs::write(path.join("a.toml"), SCENE).unwrap();
    fs::write(path.join("sub/a.toml"), SCENE).unwrap();
    fs::write(path.join("wrong.toml"), format!("{SCENE}start = \"other\"\n")).unwrap();
    let misfit = format!("{SCENE}[[lock]]\ncrease = [0, 9, 0, 0]\n"); // only the sheet shows that there is no such crease
    fs::write(path.join("misfit.toml"), misfit).unwrap();
    for (words, part) in [
        (["run", "a.toml", "misfit.toml"], "misfit.toml:11:10: the sheet has no crease [0, 9, 0, 0]"),
        (["run", "a.toml", "wrong.toml"], "wrong.toml:10:9: no earlier study is called `other`"),
        (["run", "a.toml", "none.toml"], "none.toml: cannot be read"),
        (["run", "a.toml", "sub/a.toml"], "a.toml and sub/a.toml would write into the same folder, a"),
    ] {
        let output = foldwell(path, &words, "");
        assert_eq!(output.status.code(), Some(2), "{}", said(&output));
        assert!(said(&output).contains(part), "{}", said(&output));
        assert_eq!(folders(path), ["a.toml", "misfit.toml", "sub", "wrong.toml"]);
    }
    let hard = SCENE.replace("kind = \"relax\"", "kind = \"relax\"\ntolerance = 1e-300");
    fs::write(path.join("hard.toml"), hard).unwrap();
    let output = foldwell(path, &["run", "hard.toml", "a.toml"], "");
    assert_eq!(output.status.code(), Some(1), "{}", said(&output));
    assert!(path.join("a/relaxed.csv").exists());
}

/// Claim: a scene takes its mesh from an OBJ file, periodic ones too, with the same answers to the last bit as from the
/// FOLD file of which it was made: tables and pictures are the same bytes. OBJ keeps all digits.
#[test]
fn meshes_in_obj_files() {
    let folder = tempfile::tempdir().unwrap();
    let star = Path::new(env!("CARGO_MANIFEST_DIR")).join("meshes/open-star.fold");
    fs::copy(star, folder.path().join("a.fold")).unwrap();
    assert!(foldwell(folder.path(), &["convert", "a.fold", "a.obj"], "").status.success());
    for domain in ["patch", "screw", "torus"] {
        let files = ["fold", "obj"].map(|ending| {
            let scene = format!(
                "title = \"t\"\n[sheet]\nmesh = \"a.{ending}\"\ndomain = \"{domain}\"\n[energy]\nbars = {{ stiffness = 1e4 }}\n\
                 creases = {{ stiffness = 1.0, rest = 0.5 }}\n[[study]]\nname = \"r\"\nkind = \"relax\"\n"
            );
            fs::write(folder.path().join("s.toml"), scene).unwrap();
            let run = foldwell(folder.path(), &["run", "s.toml", "--out", ending, "--quiet"], "");
            assert!(run.status.success(), "{domain}: {}", said(&run));
            ["r.csv", "r/r_0001.vtu", "r.svg"].map(|file| fs::read(folder.path().join(ending).join(file)).unwrap())
        });
        assert!(files[0] == files[1], "{domain}");
    }
}
