//! Paths that are interrupted, and go on from where they were.

use crate::common::{Folder, Ran, Scene, signal};
use foldwell::run::Progress;
use std::fs;
use std::ops::ControlFlow;
use std::process::Child;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;

/// Runs a scene and stops it at this state; returns the report and the number of states that were computed.
fn run(scene: &Scene, stop_at: usize) -> (Ran, usize) {
    let states = AtomicUsize::new(0);
    let observer = |progress: &Progress| {
        // states have residuals, and what is asked of them afterwards has none
        let now = states.fetch_add(usize::from(!progress.residual.is_nan()), Ordering::Relaxed);
        if now + 1 >= stop_at { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    };
    let ran = scene.observed(&observer).unwrap();
    (ran, states.into_inner())
}

/// A scene, what is replaced in it, and where it is stopped.
type Case<'a> = (&'a str, &'a [(&'a str, &'a str)], &'a [usize]);

/// Claim: a path that is stopped at any of its states, on any of its branches, and is resumed, has the files of one
/// that was not stopped, to the last byte; of its states none is computed twice. The paths: two branches that leave
/// another one and return, one under a growing load, and one with watched stops and self-intersections. Source: each
/// step is determined by the two states before it, which are kept with all their digits.
#[test]
fn an_interrupted_path_goes_on() {
    let stop = "stop = { crease_angle = { crease = [0, 6, 0, 0], angle = \"6 rad\" }, self_intersection = true }";
    let stops = ("max_step = 0.05", &*format!("max_step = 0.02\n{stop}\ncheck = [\"self-intersection\"]"));
    let cases: [Case; 3] =
        [("bellows", &[], &[1, 32, 33, 70]), ("two-bars-load", &[], &[2, 30]), ("drum-path", &[stops], &[1, 20])];
    for (name, replaced, interruptions) in cases {
        let scene = replaced.iter().fold(Scene::of(name), |scene, (old, new)| scene.replaced(old, new));
        let (whole, all) = run(&scene, usize::MAX);
        assert!(whole.report.summary.converged(), "{name}");
        for &stop in interruptions {
            let what = format!("{name}, stopped at {stop} of {all}");
            let scene = scene.clone().out(format!("stopped-{stop}"));
            let (ran, first) = run(&scene, stop);
            assert!(ran.report.interrupted && first == stop && stop < all, "{what}");
            let log = format!("{}.path.jsonl", ran.report.summary.studies[0].name);
            assert!(ran.out.has(&log), "{what}");
            let (ran, second) = run(&scene.resumed(), usize::MAX);
            assert!(ran.report.summary.converged() && !ran.out.has(&log), "{what}");
            assert!(first + second <= all, "{what}: {second} more were computed");
            ran.out.assert_same(&whole.out, &what);
        }
    }
}

/// Claim: the same where a crease is folded beyond pi before the path is stopped: its angle goes on from there, and not
/// from the one within a turn that the positions show.
#[test]
fn angles_beyond_pi_go_on() {
    let hinge = "{\"vertices_coords\": [[0, 0, 0], [0, 1, 0], [-1, 0.5, 0], [1, 0.5, 0]],\
                 \"faces_vertices\": [[0, 1, 2], [1, 0, 3]]}";
    let scene = Scene::new(
        "[sheet]\nmesh = \"hinge.fold\"\n[energy]\nbars = { stiffness = 10.0 }\ncreases = { stiffness = 1.0 }\n\
         [[lock]]\ncrease = [0, 1, 0, 0]\n[[drive]]\nname = \"d\"\nlock = [0, 1, 0, 0]\nto = \"340 deg\"\n\
         [[study]]\nname = \"turned\"\nkind = \"path\"\nmax_step = 0.1\n",
    );
    let scene = scene.with("hinge.fold", hinge);
    let (whole, all) = run(&scene.clone().out("whole"), usize::MAX);
    assert!(whole.report.summary.converged());
    let (_, first) = run(&scene, 3 * all / 4);
    let (ran, second) = run(&scene.resumed(), usize::MAX);
    assert!(ran.report.summary.converged() && first + second <= all, "{first} {second} {all}");
    let table = ran.out.text("turned.csv");
    let last: f64 = table.lines().last().unwrap().rsplit(',').find(|field| !field.is_empty()).unwrap().parse().unwrap();
    assert!((last - 340_f64.to_radians()).abs() < 1e-12, "{table}");
    ran.out.assert_same(&whole.out, "beyond pi");
}

/// Claim: the same if the run is interrupted twice, and if its log ends in the middle of a line, as where a computer
/// stops.
#[test]
fn a_torn_log_loses_one_step() {
    let scene = Scene::of("two-bars-load");
    let (whole, all) = run(&scene.clone().out("whole"), usize::MAX);
    run(&scene, 20);
    let (ran, _) = run(&scene.clone().resumed(), 20);
    let bytes = ran.out.bytes("loaded.path.jsonl");
    ran.out.write("loaded.path.jsonl", &bytes[..bytes.len() - 100]);
    let (ran, rest) = run(&scene.resumed(), usize::MAX);
    assert!((all - 42..=all - 38).contains(&rest), "{rest} of {all}");
    ran.out.assert_same(&whole.out, "torn");
}

/// Claim: a log of another scene is not used, also where a run of this one was interrupted before it began its own.
#[test]
fn a_log_of_another_scene_is_not_used() {
    let other = Scene::of("two-bars-load");
    let (stale, _) = run(&other, 20);
    let stale = stale.out.bytes("loaded.path.jsonl");
    let scene = other.replaced("title", "# another digest\ntitle");
    let (whole, all) = run(&scene.clone().out("whole"), usize::MAX);
    let (ran, _) = run(&scene, 1);
    ran.out.write("loaded.path.jsonl", stale);
    assert_eq!(run(&scene.resumed(), usize::MAX).1, all);
    ran.out.assert_same(&whole.out, "stale");
}

/// Claim: a log in which a line was lost, doubled or moved, or a digit was changed, is not used from there on: the
/// resumed run has the files of one that was not stopped. Without the check sums of its lines it had another table, and
/// said that all was well.
#[test]
fn a_damaged_log_is_used_up_to_the_damage() {
    let scene = Scene::of("two-bars-load");
    let (whole, all) = run(&scene.clone().out("whole"), usize::MAX);
    let kept = run(&scene, 20).0.out.text("loaded.path.jsonl");
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
        let scene = scene.clone().out(what);
        let (ran, _) = run(&scene, 20);
        ran.out.write("loaded.path.jsonl", damaged.join("\n") + "\n");
        let (_, rest) = run(&scene.resumed(), usize::MAX);
        assert!((all - 11..all).contains(&rest), "{what}: {rest} of {all}");
        ran.out.assert_same(&whole.out, what);
    }
}

/// Starts the program with a scene, and waits until the log of its path has 30 lines.
fn started(folder: &Folder, scene: &str, log: &str) -> Child {
    let lines = || fs::read(folder.file(log)).unwrap_or_default().iter().filter(|byte| **byte == b'\n').count();
    let mut child = folder.command(&["run", scene, "--quiet", "--out", "out"]).spawn().unwrap();
    while lines() < 30 && child.try_wait().unwrap().is_none() {
        std::thread::sleep(Duration::from_millis(1));
    }
    assert!(lines() >= 30, "it is on its way");
    child
}

/// Claim: a program that is killed in the middle of a path leaves what a resumed one goes on from, to the same files.
#[test]
fn a_killed_path_goes_on() {
    let scene = Scene::of("bellows").replaced("switch = true", "switch = true\nmax_step = 0.025");
    let whole = scene.clone().out("whole").program("--quiet").well().folder;
    let folder = scene.placed();
    let mut killed = started(&folder, "bellows.toml", "out/pressed.path.jsonl");
    killed.kill().unwrap();
    killed.wait().unwrap();
    assert!(!folder.has("out/pressed.csv"), "it was killed on its way");
    scene.resumed().program("--quiet").well().folder.assert_same(&whole, "killed");
}

/// Claim: while a run writes into a folder, another one of the same or of another scene, resumed or not, ends with
/// status 3 and a message that names the folder and the process, and changes no file. Killed, the first one keeps
/// nobody out.
#[test]
fn a_folder_has_one_run_at_a_time() {
    let folder = Folder::new();
    let other = Scene::of("drum-path").within(&folder);
    let scene = Scene::of("two-bars-load").within(&folder).replaced("max_step = 0.05", "max_step = 1e-3");
    scene.written();
    let out = folder.inner("out");
    let mut first = started(&folder, "two-bars-load.toml", "out/loaded.path.jsonl");
    // it stands still while the others try, so that what they change is seen
    signal(&first, "-STOP");
    // its threads stop one after the other
    let mut before = out.files();
    loop {
        std::thread::sleep(std::time::Duration::from_millis(100));
        let now = out.files();
        if now == before {
            break;
        }
        before = now;
    }
    for second in [&scene, &scene.clone().resumed(), &other] {
        let said = second.program("--quiet").ends(3);
        let named = format!("out: another run (process {}) is writing into this folder", first.id());
        assert!(said.err.contains(&named), "{said:?}");
        assert!(out.files() == before, "{said:?}");
    }
    first.kill().unwrap();
    first.wait().unwrap();
    scene.resumed().program("--quiet").well();
    assert!(!out.has("loaded.path.jsonl") && out.has("loaded.csv"));
}
