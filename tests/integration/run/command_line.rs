//! The command line: exit statuses, and the contents of standard output and standard error.

use std::process::Output;

use assert_cmd::Command;

fn foldwell(folder: &std::path::Path, words: &str) -> Output {
    let mut command = Command::cargo_bin("foldwell").expect("the binary is built with its tests");
    command.current_dir(folder).args(words.split(' ')).output().expect("the binary starts")
}

/// A malformed scene gives status 2 and its position on standard error, nothing on standard output, and writes nothing.
#[test]
fn a_wrong_scene_writes_nothing() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("my-scene.toml"), "[sheet]\nmesh = \"a.fold\"\ncells = [0, 1]\n").unwrap();
    for words in ["run my-scene.toml", "run my-scene.toml --json --threads 2"] {
        let output = foldwell(folder.path(), words);
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!((output.status.code(), output.stdout.len()), (Some(2), 0));
        for part in ["my-scene.toml:3:9: there are 0 x 1 cells", "cells = [0, 1]", "help: expected at least 1"] {
            assert!(message.contains(part), "{message}");
        }
    }
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
}

/// A missing scene, and an invalid command line, are input errors.
#[test]
fn wrong_words_are_wrong_input() {
    let folder = tempfile::tempdir().unwrap();
    for words in [
        "run none.toml",
        "run",
        "fold",
        "run a.toml --threads 0",
        "new miura",
        "new miura --seed -o",
        "new mira --help",
    ] {
        let output = foldwell(folder.path(), words);
        assert_eq!(output.status.code(), Some(2), "{words}");
        assert!(!output.stderr.is_empty() && output.stdout.is_empty(), "{words}");
    }
}

/// A mesh instead of a scene, and a file that is neither, are refused with a remedy.
#[test]
fn files_of_the_wrong_kind() {
    let folder = tempfile::tempdir().unwrap();
    assert!(foldwell(folder.path(), "new miura -o m.fold").status.success());
    for (words, parts) in [
        ("run m.fold", ["m.fold: this is a mesh, not a scene", "under [sheet], mesh = \"m.fold\""]),
        ("info m", ["m: a file without an ending", "expected one of .fold, .obj, .vtu, .svg, .cp, .opx or .toml"]),
        (
            "convert m.fold m.dxf",
            ["m.dxf: files ending in `dxf` are not known here", "expected one of .fold, .obj, .vtu, .stl, .svg or .cp"],
        ),
    ] {
        let output = foldwell(folder.path(), words);
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{words}");
        assert!(parts.iter().all(|part| message.contains(part)), "{message}");
    }
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
}

/// The schema is JSON and the completions are a script, both on standard output.
#[test]
fn schema_and_completions() {
    let folder = tempfile::tempdir().unwrap();
    let schema = foldwell(folder.path(), "schema");
    let json: serde_json::Value = serde_json::from_slice(&schema.stdout).expect("the schema is JSON");
    assert_eq!((schema.status.code(), json["title"].as_str()), (Some(0), Some("foldwell scene")));
    let schema = foldwell(folder.path(), "schema summary");
    let json: serde_json::Value = serde_json::from_slice(&schema.stdout).expect("the schema is JSON");
    assert_eq!((schema.status.code(), json["title"].as_str()), (Some(0), Some("foldwell summary")));
    let script = foldwell(folder.path(), "completions bash");
    assert!(script.status.success() && String::from_utf8_lossy(&script.stdout).contains("_foldwell()"));
}

/// Claim: `new --help` lists every pattern, `new PATTERN --help` draws one and gives its parameters, wherever the word
/// stands; nothing is written.
#[test]
fn patterns_have_help() {
    let folder = tempfile::tempdir().unwrap();
    let said = |words: &str| {
        let output = foldwell(folder.path(), words);
        assert!(output.status.success() && output.stderr.is_empty(), "{words}");
        String::from_utf8(output.stdout).unwrap()
    };
    let all = said("new --help");
    assert!(foldwell::Pattern::names().all(|name| all.contains(&format!("  {name} "))), "{all}");
    assert!(all == said("new -h") && all == said("new"));
    let miura = said("new miura --help");
    for part in ["One cell of Miura-ori", "--sector ANGLE", "[default: 60 deg]", "Usage: foldwell new miura"] {
        assert!(miura.contains(part), "{miura}");
    }
    assert_eq!(miura, said("new miura --fold 3 --help -o a.fold"));
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
}

/// Claim: `info --edges` names every edge as the table of a run does, in the same order, with its length and the drawn angle
/// of the mesh; `--vertices` lists the coordinates. Source: a Miura-ori cell, whose sides are 1. Tolerance: rounding.
#[test]
fn elements_are_listed() {
    let folder = tempfile::tempdir().unwrap();
    let said = |words: &str| {
        let output = foldwell(folder.path(), words);
        assert!(output.status.success(), "{words}");
        String::from_utf8(output.stdout).unwrap()
    };
    said("new miura --fold 0.3 -o m.fold");
    std::fs::write(
        folder.path().join("m.toml"),
        "sheet = { mesh = \"m.fold\" }\nenergy = { bars = { stiffness = 1.0 }, creases = { stiffness = 1.0 } }\n\
         [[study]]\nname = \"a\"\nkind = \"relax\"\ndraw = []\n",
    )
    .unwrap();
    said("run m.toml");
    let table = std::fs::read_to_string(folder.path().join("m/a.csv")).unwrap();
    let columns: Vec<&str> =
        table.lines().next().unwrap().split(',').filter(|name| name.starts_with("fold_")).collect();
    let listed = said("info m.fold --edges");
    assert_eq!(listed, said("info m.toml --edges"));
    let mut lines = listed.lines();
    assert_eq!(lines.next(), Some("edge,i,j,n1,n2,kind,assignment,length,angle"));
    let rows: Vec<Vec<&str>> = lines.map(|line| line.split(',').collect()).collect();
    let names: Vec<String> = rows.iter().map(|row| format!("fold_{}", row[1..5].join("_"))).collect();
    assert_eq!(names, columns);
    for (number, row) in rows.iter().enumerate() {
        assert_eq!(row[0], number.to_string());
        let [length, angle] = [row[7], row[8]].map(|field| field.parse::<f64>().unwrap());
        let crease = row[5] == "crease";
        assert_eq!(crease, row[6] == "M" || row[6] == "V", "{row:?}");
        assert!(!crease || ((length - 1.0).abs() < 1e-14 && (angle > 0.0) == (row[6] == "V")), "{row:?}");
    }
    let vertices = said("info m.fold --vertices");
    assert!(vertices.starts_with("vertex,x,y,z\n0,0.0,0.0,0.0\n1,") && vertices.lines().count() == 5, "{vertices}");
    assert_eq!(foldwell(folder.path(), "info m.fold --edges --vertices").status.code(), Some(2));
}
