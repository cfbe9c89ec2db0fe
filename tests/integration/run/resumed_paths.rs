//! Paths that are interrupted, and go on from where they were.

use foldwell::run::{Progress, RunOptions, RunReport, run_scene};
use serde_json::Value;
use std::collections::BTreeMap;
use std::fs;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;

/// Writes a scene of `meshes` with its meshes into a folder, with words of it replaced.
fn scene(folder: &Path, name: &str, replaced: &[(&str, &str)]) -> PathBuf {
    let meshes = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("meshes");
    for mesh in ["drum.fold", "kresling.fold", "two-bars.fold", "waterbomb-base.fold"] {
        fs::copy(meshes.join(mesh), folder.join(mesh)).unwrap();
    }
    let mut text = fs::read_to_string(meshes.join(format!("{name}.toml"))).unwrap();
    for (old, new) in replaced {
        assert!(text.contains(old), "{old}");
        text = text.replace(old, new);
    }
    let path = folder.join(format!("{name}.toml"));
    fs::write(&path, text).unwrap();
    path
}

/// Runs a scene and stops it at this state; returns the report and the number of states that were computed.
fn run(scene: &Path, out: &Path, resume: bool, stop_at: usize) -> (RunReport, usize) {
    let options = RunOptions { out: Some(out.into()), resume, ..RunOptions::default() };
    let states = AtomicUsize::new(0);
    let observer = |progress: &Progress| {
        // states have residuals, and what is asked of them afterwards has none
        let now = states.fetch_add(usize::from(!progress.residual.is_nan()), Ordering::Relaxed);
        if now + 1 >= stop_at { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    };
    let report = run_scene(scene, &options, &observer).unwrap();
    (report, states.into_inner())
}

/// Returns the files of a run by name, of the summary everything but computing times.
fn files(out: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut found = BTreeMap::new();
    let mut folders = vec![out.to_path_buf()];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().path()) {
            if entry.is_dir() {
                folders.push(entry);
                continue;
            }
            let mut bytes = fs::read(&entry).unwrap();
            if entry.ends_with("summary.json") {
                let mut summary: Value = serde_json::from_slice(&bytes).unwrap();
                let studies = summary["studies"].as_array_mut().unwrap();
                studies.iter_mut().for_each(|study| study["seconds"] = Value::Null);
                bytes = serde_json::to_vec(&summary).unwrap();
            }
            found.insert(entry.strip_prefix(out).unwrap().to_path_buf(), bytes);
        }
    }
    found
}

fn assert_same(found: &Path, expected: &Path, what: &str) {
    let (found, expected) = (files(found), files(expected));
    assert_eq!(found.keys().collect::<Vec<_>>(), expected.keys().collect::<Vec<_>>(), "{what}");
    for (name, bytes) in &expected {
        assert!(found[name] == *bytes, "{what}: {} differs", name.display());
    }
}

/// A scene, what is replaced in it, and where it is stopped.
type Case<'a> = (&'a str, &'a [(&'a str, &'a str)], &'a [usize]);

/// Claim: a path that is stopped at any of its states, on any of its branches, and is resumed, has the files of one that was
/// not stopped, to the last byte; of its states none is computed twice. The paths: two branches that leave another one and
/// return, one under a growing load, and one with watched stops and self-intersections. Source: each step is determined by the two states before
/// it, which are kept with all their digits.
#[test]
fn an_interrupted_path_goes_on() {
    let stop = "stop = { crease_angle = { crease = [0, 6, 0, 0], angle = \"6 rad\" }, self_intersection = true }";
    let stops = ("max_step = 0.05", &*format!("max_step = 0.02\n{stop}\ncheck = [\"self-intersection\"]"));
    let cases: [Case; 3] =
        [("bellows", &[], &[1, 32, 33, 70]), ("two-bars-load", &[], &[2, 30]), ("drum-path", &[stops], &[1, 20])];
    for (name, replaced, interruptions) in cases {
        let folder = tempfile::tempdir().unwrap();
        let scene = scene(folder.path(), name, replaced);
        let whole = folder.path().join("whole");
        let (report, all) = run(&scene, &whole, false, usize::MAX);
        assert!(report.summary.converged(), "{name}");
        for &stop in interruptions {
            let what = format!("{name}, stopped at {stop} of {all}");
            let out = folder.path().join(format!("stopped-{stop}"));
            let (report, first) = run(&scene, &out, false, stop);
            assert!(report.interrupted && first == stop && stop < all, "{what}");
            let log = out.join(format!("{}.path.jsonl", report.summary.studies[0].name));
            assert!(log.exists(), "{what}");
            let (report, second) = run(&scene, &out, true, usize::MAX);
            assert!(report.summary.converged() && !log.exists(), "{what}");
            assert!(first + second <= all, "{what}: {second} more were computed");
            assert_same(&out, &whole, &what);
        }
    }
}

/// Claim: the same where a crease is folded beyond pi before the path is stopped: its angle goes on from there, and not from
/// the one within a turn that the positions show.
#[test]
fn angles_beyond_pi_go_on() {
    let folder = tempfile::tempdir().unwrap();
    let hinge = "{\"vertices_coords\": [[0, 0, 0], [0, 1, 0], [-1, 0.5, 0], [1, 0.5, 0]],\
                 \"faces_vertices\": [[0, 1, 2], [1, 0, 3]]}";
    fs::write(folder.path().join("hinge.fold"), hinge).unwrap();
    let scene = folder.path().join("hinge.toml");
    fs::write(
        &scene,
        "[sheet]\nmesh = \"hinge.fold\"\n[energy]\nbars = { stiffness = 10.0 }\ncreases = { stiffness = 1.0 }\n\
         [[lock]]\ncrease = [0, 1, 0, 0]\n[[drive]]\nname = \"d\"\nlock = [0, 1, 0, 0]\nto = \"340 deg\"\n\
         [[study]]\nname = \"turned\"\nkind = \"path\"\nmax_step = 0.1\n",
    )
    .unwrap();
    let [whole, out] = ["whole", "out"].map(|name| folder.path().join(name));
    let (report, all) = run(&scene, &whole, false, usize::MAX);
    assert!(report.summary.converged());
    let (_, first) = run(&scene, &out, false, 3 * all / 4);
    let (report, second) = run(&scene, &out, true, usize::MAX);
    assert!(report.summary.converged() && first + second <= all, "{first} {second} {all}");
    let table = fs::read_to_string(out.join("turned.csv")).unwrap();
    let last: f64 = table.lines().last().unwrap().rsplit(',').find(|field| !field.is_empty()).unwrap().parse().unwrap();
    assert!((last - 340_f64.to_radians()).abs() < 1e-12, "{table}");
    assert_same(&out, &whole, "beyond pi");
}

/// Claim: the same if the run is interrupted twice, and if its log ends in the middle of a line, as where a computer stops.
#[test]
fn a_torn_log_loses_one_step() {
    let folder = tempfile::tempdir().unwrap();
    let scene = scene(folder.path(), "two-bars-load", &[]);
    let [whole, out] = ["whole", "out"].map(|name| folder.path().join(name));
    let (_, all) = run(&scene, &whole, false, usize::MAX);
    run(&scene, &out, false, 20);
    run(&scene, &out, true, 20);
    let log = out.join("loaded.path.jsonl");
    let bytes = fs::read(&log).unwrap();
    fs::write(&log, &bytes[..bytes.len() - 100]).unwrap();
    let (_, rest) = run(&scene, &out, true, usize::MAX);
    assert!((all - 42..=all - 38).contains(&rest), "{rest} of {all}");
    assert_same(&out, &whole, "torn");
}

/// Claim: a log of another scene is not used, also where a run of this one was interrupted before it began its own.
#[test]
fn a_log_of_another_scene_is_not_used() {
    let folder = tempfile::tempdir().unwrap();
    let other = scene(folder.path(), "two-bars-load", &[]);
    let [whole, out] = ["whole", "out"].map(|name| folder.path().join(name));
    run(&other, &out, false, 20);
    let log = out.join("loaded.path.jsonl");
    let stale = fs::read(&log).unwrap();
    let scene = scene(folder.path(), "two-bars-load", &[("title", "# another digest\ntitle")]);
    let (_, all) = run(&scene, &whole, false, usize::MAX);
    run(&scene, &out, false, 1);
    fs::write(&log, stale).unwrap();
    assert_eq!(run(&scene, &out, true, usize::MAX).1, all);
    assert_same(&out, &whole, "stale");
}

/// Claim: a log in which a line was lost, doubled or moved, or a digit was changed, is not used from there on: the
/// resumed run has the files of one that was not stopped. Without the check sums of its lines it had another table, and
/// said that all was well.
#[test]
fn a_damaged_log_is_used_up_to_the_damage() {
    let folder = tempfile::tempdir().unwrap();
    let scene = scene(folder.path(), "two-bars-load", &[]);
    let [whole, out] = ["whole", "out"].map(|name| folder.path().join(name));
    let (_, all) = run(&scene, &whole, false, usize::MAX);
    run(&scene, &out, false, 20);
    let log = out.join("loaded.path.jsonl");
    let kept = fs::read_to_string(&log).unwrap();
    let lines: Vec<&str> = kept.lines().collect();
    let lost = [&lines[..10], &lines[11..]].concat();
    let doubled = [&lines[..10], &lines[9..]].concat();
    let moved = [&lines[..10], &[lines[11], lines[10]], &lines[12..]].concat();
    let digit = lines[10].rfind(|letter: char| letter.is_ascii_digit()).unwrap();
    let changed = lines[10][..digit].to_owned() + "0" + &lines[10][digit + 1..];
    let changed_back = lines[10][..digit].to_owned() + "1" + &lines[10][digit + 1..];
    let changed = if changed == lines[10] { changed_back } else { changed };
    let changed = [&lines[..10], &[changed.as_str()], &lines[11..]].concat();
    for (what, damaged) in [("lost", lost), ("doubled", doubled), ("moved", moved), ("changed", changed)] {
        let stopped = folder.path().join(what);
        run(&scene, &stopped, false, 20);
        fs::write(stopped.join("loaded.path.jsonl"), damaged.join("\n") + "\n").unwrap();
        let (_, rest) = run(&scene, &stopped, true, usize::MAX);
        assert!((all - 11..all).contains(&rest), "{what}: {rest} of {all}");
        assert_same(&stopped, &whole, what);
    }
}

/// The program with a scene, a folder and more words, silent.
fn program(folder: &Path, scene: &Path, words: &[&str]) -> Command {
    let mut program = Command::new(env!("CARGO_BIN_EXE_foldwell"));
    program.current_dir(folder).args(["run", scene.to_str().unwrap(), "--quiet", "--out"]).args(words);
    program.stderr(Stdio::piped()).stdout(Stdio::null());
    program
}

/// Starts the program and waits until the log of its path has 30 lines.
fn started(mut program: Command, log: &Path) -> Child {
    let lines = || fs::read(log).unwrap_or_default().iter().filter(|byte| **byte == b'\n').count();
    let mut child = program.spawn().unwrap();
    while lines() < 30 && child.try_wait().unwrap().is_none() {
        std::thread::sleep(Duration::from_millis(1));
    }
    assert!(lines() >= 30, "it is on its way");
    child
}

/// Claim: a program that is killed in the middle of a path leaves what a resumed one goes on from, to the same files.
#[test]
fn a_killed_path_goes_on() {
    let folder = tempfile::tempdir().unwrap();
    let scene = scene(folder.path(), "bellows", &[("switch = true", "switch = true\nmax_step = 0.025")]);
    assert!(program(folder.path(), &scene, &["whole"]).status().unwrap().success());
    let mut killed = started(program(folder.path(), &scene, &["out"]), &folder.path().join("out/pressed.path.jsonl"));
    killed.kill().unwrap();
    killed.wait().unwrap();
    assert!(!folder.path().join("out/pressed.csv").exists(), "it was killed on its way");
    assert!(program(folder.path(), &scene, &["out", "--resume"]).status().unwrap().success());
    assert_same(&folder.path().join("out"), &folder.path().join("whole"), "killed");
}

/// Claim: while a run writes into a folder, another one of the same or of another scene, resumed or not, ends with
/// status 3 and a message that names the folder and the process, and changes no file. Killed, the first one keeps
/// nobody out.
#[test]
fn a_folder_has_one_run_at_a_time() {
    let folder = tempfile::tempdir().unwrap();
    let other = scene(folder.path(), "drum-path", &[]);
    let scene = scene(folder.path(), "two-bars-load", &[("max_step = 0.05", "max_step = 1e-3")]);
    let out = folder.path().join("out");
    let log = out.join("loaded.path.jsonl");
    let mut first = started(program(folder.path(), &scene, &["out"]), &log);
    // it stands still while the others try, so that what they change is seen
    let signal =
        |name: &str| assert!(Command::new("kill").args([name, &first.id().to_string()]).status().unwrap().success());
    signal("-STOP");
    // its threads stop one after the other
    let mut before = files(&out);
    loop {
        std::thread::sleep(std::time::Duration::from_millis(100));
        let now = files(&out);
        if now == before {
            break;
        }
        before = now;
    }
    for (scene, words) in [(&scene, &["out"][..]), (&scene, &["out", "--resume"]), (&other, &["out"])] {
        let second = program(folder.path(), scene, words).output().unwrap();
        let said = String::from_utf8_lossy(&second.stderr);
        assert_eq!(second.status.code(), Some(3), "{said}");
        let named = format!("out: another run (process {}) is writing into this folder", first.id());
        assert!(said.contains(&named), "{said}");
        assert!(files(&out) == before, "{words:?}");
    }
    first.kill().unwrap();
    first.wait().unwrap();
    assert!(program(folder.path(), &scene, &["out", "--resume"]).status().unwrap().success());
    assert!(!log.exists() && out.join("loaded.csv").exists());
}
