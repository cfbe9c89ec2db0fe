//! Scenes of a call of `foldwell run`: several of them, from standard input, and with keys set on the command line.

use crate::common::{Folder, Said};
use std::fs;
use std::io::Write;
use std::process::Stdio;

const SCENE: &str = "[sheet]\ngenerate = { pattern = \"miura\" }\ncells = [2, 2]\n[energy]\nbars = { stiffness = inf }\n\
                     creases = { stiffness = 1.0, rest = \"flat\" }\n[[study]]\nname = \"relaxed\"\nkind = \"relax\"\n";

/// Runs the program with a scene on its standard input.
fn with_input(folder: &Folder, words: &[&str], input: &str) -> Said {
    let mut child = folder.command(words).stdin(Stdio::piped()).spawn().unwrap();
    child.stdin.take().unwrap().write_all(input.as_bytes()).unwrap();
    Said::last(child, folder)
}

/// Claim: setting a key gives the files of the scene that is edited so, byte by byte, and the summary names the
/// setting.
#[test]
fn a_set_key_is_an_edited_scene() {
    let edited = SCENE.replace("inf", "1e3").replace("[2, 2]", "[3, 2]");
    let folder = Folder::new().with("a.toml", SCENE).with("b.toml", edited);
    let set = ["run", "a.toml", "--set", "energy.bars.stiffness=1e3", "--set", "sheet.cells=[3, 2]"];
    folder.program(&set).well();
    folder.foldwell("run b.toml").well();
    assert_eq!(folder.bytes("a/relaxed.csv"), folder.bytes("b/relaxed.csv"));
    let summary = folder.json("a/summary.json");
    assert_eq!(summary["settings"], serde_json::json!(["energy.bars.stiffness=1e3", "sheet.cells=[3, 2]"]));
    let info = ["info", "a.toml", "--json", "--set", "sheet.cells=[3, 2]"];
    let info = folder.program(&info).json();
    assert_eq!(info["energy"]["cells"], serde_json::json!([3, 2]));
}

/// Claim: a setting that is none, or that makes the scene wrong, is refused with its place, and nothing is written.
#[test]
fn wrong_settings_are_refused() {
    let folder = Folder::new().with("a.toml", SCENE);
    for (setting, parts) in [
        ("energy.bars", ["sets no key", "energy.bars.stiffness=1e4"]),
        ("study.pulled.kind=trace", ["no element `pulled`", "there are `relaxed`"]),
        ("energy.bars.stiffness=-1", ["a.toml (keys set):5:", "the stiffness is -1"]),
        ("energy.bars.stifness=1", ["a.toml (keys set):5:", "unknown key `stifness`"]),
    ] {
        let said = folder.program(&["run", "a.toml", "--set", setting]);
        parts.into_iter().fold(said, |said, part| said.refused(part));
    }
    assert_eq!(folder.names(), ["a.toml"]);
}

/// Claim: a scene on standard input gives the tables of the same scene in a file, and its errors their place.
#[test]
fn standard_input_is_a_scene() {
    let folder = Folder::new().with("a.toml", SCENE);
    folder.foldwell("run a.toml").well();
    with_input(&folder, &["run", "-", "--out", "b"], SCENE).well();
    assert_eq!(folder.bytes("a/relaxed.csv"), folder.bytes("b/relaxed.csv"));
    with_input(&folder, &["run", "-"], "[sheet]\nmash = 3\n").refused("stdin:2:1: unknown key `mash`");
    assert_eq!(folder.names(), ["a", "a.toml", "b"]);
}

/// Claim: several scenes give the files that each gives alone, and as JSON the list of their summaries.
#[test]
fn several_scenes_are_each_as_alone() {
    let folder = Folder::new();
    for (name, fold) in [("a", "0.2"), ("b", "0.4")] {
        let text = SCENE.replace("\"miura\"", &format!("\"miura\", fold = {fold}"));
        folder.write(format!("{name}.toml"), text);
    }
    let summaries = folder.foldwell("run a.toml b.toml --out both --json").json();
    let scenes = summaries.as_array().unwrap().iter().map(|summary| summary["scene"].as_str().unwrap());
    assert_eq!(scenes.collect::<Vec<_>>(), ["a.toml", "b.toml"]);
    for name in ["a", "b"] {
        folder.foldwell(&format!("run {name}.toml")).well();
        folder.inner(name).assert_same(&folder.inner("both").inner(name), name);
    }
}

/// Claim: if one of several scenes is wrong, none of them is run; two scenes of one name would share a folder. A study
/// that fails in the first scene keeps the second from nothing, and decides the status.
#[test]
fn several_scenes_are_checked_first() {
    let misfit = format!("{SCENE}[[lock]]\ncrease = [0, 9, 0, 0]\n"); // only the sheet shows that there is no such crease
    let wrong = format!("{SCENE}start = \"other\"\n");
    let folder = Folder::new().with("a.toml", SCENE).with("wrong.toml", wrong).with("misfit.toml", misfit);
    fs::create_dir(folder.file("sub")).unwrap();
    folder.write("sub/a.toml", SCENE);
    for (words, part) in [
        ("run a.toml misfit.toml", "misfit.toml:11:10: the sheet has no crease [0, 9, 0, 0]"),
        ("run a.toml wrong.toml", "wrong.toml:10:9: no earlier study is called `other`"),
        ("run a.toml none.toml", "none.toml: cannot be read"),
        ("run a.toml sub/a.toml", "a.toml and sub/a.toml would write into the same folder, a"),
    ] {
        folder.foldwell(words).refused(part);
        assert_eq!(folder.names(), ["a.toml", "misfit.toml", "sub", "wrong.toml"]);
    }
    let hard = SCENE.replace("kind = \"relax\"", "kind = \"relax\"\ntolerance = 1e-300");
    folder.write("hard.toml", hard);
    folder.foldwell("run hard.toml a.toml").ends(1);
    assert!(folder.has("a/relaxed.csv"));
}

/// Claim: a scene takes its mesh from an OBJ file, periodic ones too, with the same answers to the last bit as from the
/// FOLD file of which it was made: tables and pictures are the same bytes. OBJ keeps all digits.
#[test]
fn meshes_in_obj_files() {
    let folder = Folder::new().with("a.fold", include_str!("../../../meshes/open-star.fold"));
    folder.foldwell("convert a.fold a.obj").well();
    for domain in ["patch", "screw", "torus"] {
        let files = ["fold", "obj"].map(|ending| {
            let scene = format!(
                "title = \"t\"\n[sheet]\nmesh = \"a.{ending}\"\ndomain = \"{domain}\"\n[energy]\nbars = {{ stiffness = 1e4 }}\n\
                 creases = {{ stiffness = 1.0, rest = 0.5 }}\n[[study]]\nname = \"r\"\nkind = \"relax\"\n"
            );
            let out = folder.scene(scene).out(ending).program("--quiet").well().folder;
            ["r.csv", "r/r_0001.vtu", "r.svg"].map(|file| out.bytes(file))
        });
        assert!(files[0] == files[1], "{domain}");
    }
}
