//! Pages to look at: `draw = ["html"]` in a study, and `foldwell view` for a whole run. What a browser makes of them is
//! checked by `.ci/check_view.mjs`.

use crate::common::{Folder, Scene};
use serde_json::Value;
use std::fs;

const SHEET: &str = "generate = { pattern = \"miura\", fold = 0.6 }\ndomain = \"patch\"\ncells = [2, 2]\n";
const RIGID: &str = "[energy]\nbars = { stiffness = inf }\ncreases = { stiffness = 1.0, rest = 0.3 }\n";

/// Returns the data of a page.
fn data(out: &Folder, page: &str) -> Value {
    let text = out.text(page);
    let (_, rest) = text.split_once("id=\"data\">").unwrap();
    serde_json::from_str(rest.split_once("</script>").unwrap().0).unwrap()
}

fn length(value: &Value) -> usize {
    value.as_array().map_or(0, Vec::len)
}

/// A star cell that folds along trajectories, and what the studies of it draw.
fn star(study: &str) -> Scene {
    let study = format!("[[lock]]\ncrease = [0, 1, 0, 0]\n[[study]]\nname = \"t\"\n{study}");
    Scene::on("mesh = \"open-star.fold\"\ndomain = \"screw\"", &study)
}

/// Claim: the page of a run has every study of the scene: those with states, those with a table or drawings only, one
/// that failed with its reason, and one without any file; each with as many states as it has VTU files.
#[test]
fn every_study_is_on_the_page() {
    let study = |name: &str, more: &str| format!("[[study]]\nname = \"{name}\"\n{more}\n");
    let scene = format!(
        "title = \"Everything\"\n[sheet]\n{SHEET}{RIGID}{}{}{}{}",
        study("relaxed", "kind = \"relax\""),
        study("spectrum", "kind = \"modes\"\neigenvalues = 8"),
        study("lost", "kind = \"relax\"\nstart = { random = 0.4, seed = 3 }\ntolerance = 1e-300"),
        study("plain", "kind = \"relax\"\ndraw = []"),
    );
    let scene = Scene::new(scene);
    let out = scene.program("--quiet").ends(1).folder;
    assert_eq!(scene.folder().foldwell("view out").well().out.trim(), "out/view.html");
    let page = data(&out, "view.html");
    assert_eq!(page["title"], "Everything");
    let studies = page["studies"].as_array().unwrap();
    let names: Vec<&str> = studies.iter().map(|study| study["name"].as_str().unwrap()).collect();
    assert_eq!(names, ["relaxed", "spectrum", "lost", "plain"]);
    for study in studies {
        let name = study["name"].as_str().unwrap();
        let pictures = if out.has(name) { out.inner(name).names().len() } else { 0 };
        assert_eq!(length(&study["sheet"]["states"]), pictures, "{name}");
        assert!(length(&study["tables"]) > 0, "{name}");
    }
    assert_eq!((studies[2]["converged"].as_bool(), studies[2]["reason"].is_string()), (Some(false), true));
    assert!(length(&studies[1]["sheet"]["states"]) > 6 && length(&studies[3]["sheet"]["states"]) == 0);
}

/// Claim: the page that a study writes and the page that is made from its files afterwards are the same bytes, also
/// when the scene is run again. Source: both are made by one writer from the same numbers; no tolerance.
#[test]
fn both_ways_make_the_same_page() {
    let scene =
        star("kind = \"trace\"\nbranch = 0\nstop = { arc_length = 1.0 }\ndraw = [\"vtk\", \"svg\", \"html\"]\n");
    let out = scene.program("--quiet").well().folder;
    let first = out.bytes("t.html");
    scene.folder().foldwell("view out").well();
    assert!(out.bytes("view.html") == first);
    assert!(scene.program("--quiet").well().folder.bytes("t.html") == first);
}

/// Claim: `draw = ["html"]` writes the page, the table and the summary, and no other file; a trajectory has its two
/// directions as one sequence that passes the drawn state once, each state beside its row; without `html` there is no
/// page, and the one of the earlier run is gone.
#[test]
fn a_page_alone() {
    let folder = Folder::new();
    let trace = |draw: &str| {
        let study = format!("kind = \"trace\"\nbranch = 0\nstop = {{ arc_length = 1.0 }}\ndraw = {draw}\n");
        star(&study).within(&folder)
    };
    let out = trace("[\"html\"]").program("--quiet").well().folder;
    assert_eq!(out.names(), ["summary.json", "t.csv", "t.html"]);
    let page = data(&out, "t.html");
    let (study, rows) = (&page["studies"][0], out.table("t.csv").len());
    let (states, sequences) = (&study["sheet"]["states"], &study["sheet"]["sequences"]);
    assert_eq!((length(states), length(sequences)), (rows, 1));
    assert_eq!(length(&sequences[0]["states"]), rows - 1);
    let in_order = states.as_array().unwrap().iter().enumerate().all(|(k, state)| state["row"] == k);
    assert!(in_order && length(&study["figures"]) == 2);
    trace("[]").program("--quiet").well();
    assert_eq!(out.names(), ["summary.json", "t.csv"]);
}

/// Claim: long trajectories have up to 200 states on a page and one beside each picture; the page has less than 5 MB.
/// Here: the longest trajectory of the reference cell, 414 states, on 6 x 6 cells.
#[test]
fn a_long_trajectory() {
    let out = star("kind = \"trace\"\nbranch = 0\ndraw = [\"html\"]\n").program("--quiet").well().folder;
    let bytes = out.bytes("t.html").len();
    let page = data(&out, "t.html");
    let sequences = page["studies"][0]["sheet"]["sequences"].as_array().unwrap();
    let most = sequences.iter().map(|sequence| length(&sequence["states"])).max();
    assert!(most > Some(100) && most <= Some(201) && bytes < 5_000_000, "{most:?} states, {bytes} bytes");
}

/// Claim: a title cannot end the data or begin a script: the page has as many scripts as one with a plain title, and
/// its data have the title as it was written.
#[test]
fn a_wild_title() {
    let scripts = |title: &str| {
        let scene = format!(
            "title = {title:?}\n[sheet]\n{SHEET}{RIGID}[[study]]\nname = \"a\"\nkind = \"relax\"\ndraw = [\"html\"]\n"
        );
        let out = Scene::new(scene).program("--quiet").well().folder;
        assert_eq!(data(&out, "a.html")["title"], title);
        out.text("a.html").matches("<script").count()
    };
    assert_eq!(scripts("</script><script>alert(1)</script></title><b>&"), scripts("plain"));
}

/// Claim: a folder that does not exist, one without a summary, and summaries that are no JSON, no object or of
/// something else are refused with status 2, a message that names the folder and what would be right, and no page; a
/// broken VTU file is named.
#[test]
fn folders_of_no_run() {
    let folder = Folder::new();
    let out = folder.inner("out");
    let refused = |expected: &str| {
        folder.foldwell("view out").refused(expected);
        assert!(!out.has("view.html"));
    };
    refused("out: not the folder of a run");
    fs::create_dir(out.path()).unwrap();
    refused("summary.json cannot be read");
    for (text, expected) in [
        ("", "summary.json:1:0"),
        ("{\n\"a\": }", "summary.json:2:6"),
        ("[]", "no list `studies`"),
        ("{}", "no list `studies`"),
    ] {
        out.write("summary.json", text);
        refused(expected);
        refused("the one with `summary.json`");
    }
    fs::remove_dir_all(out.path()).unwrap();
    let scene = format!("[sheet]\n{SHEET}{RIGID}[[study]]\nname = \"a\"\nkind = \"relax\"\n");
    folder.scene(scene).program("--quiet").well();
    out.write("a/a_0001.vtu", "<VTKFile");
    refused("a_0001.vtu");
}

/// Claim: names in a summary that lead out of the folder are not followed, a summary without titles or with studies
/// that are no tables still gives a page, and a page that would replace that of a study is refused.
#[test]
fn unusual_summaries() {
    let folder = Folder::new().with("secret.csv", "a,b\n1,2\n");
    let out = folder.inner("out");
    fs::create_dir(out.path()).unwrap();
    let summary = "{\"scene\": \"x.toml\", \"studies\": [3, {}, {\"name\": \"../secret\", \"kind\": \"relax\"}]}";
    out.write("summary.json", summary);
    folder.foldwell("view out").well();
    let page = data(&out, "view.html");
    assert_eq!((page["title"].as_str(), length(&page["studies"])), (Some("x.toml"), 2));
    assert!(page["studies"].as_array().unwrap().iter().all(|study| length(&study["tables"]) == 0));
    out.write("summary.json", "{\"studies\": [{\"name\": \"view\", \"kind\": \"relax\"}]}");
    folder.foldwell("view out").refused("the page of study `view`");
    folder.foldwell("view out -o other.html").well();
    assert!(folder.has("other.html"));
}
