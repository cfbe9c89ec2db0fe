//! Runs that are asked to stop: they end with the finished results on disk, and the current study is interrupted, not
//! failed.
//!
//! No test here measures time; `cargo bench --bench stopping` prints it.

use crate::common::{Folder, Said, Scene, signal};
use foldwell::run::{Ledger, Progress, read_scene, run};
use serde_json::Value;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::channel;

fn scene(cells: [usize; 2], studies: &str) -> Scene {
    let energy = "[energy]\nbars = { stiffness = inf }\n\
                  creases = { stiffness = 1, rest = { mode = [0, 0.05, 0], amplitude = 1 } }\n";
    Scene::on(&format!("mesh = \"open-star.fold\"\ncells = {cells:?}"), &format!("{energy}{studies}"))
}

/// Returns name, whether it converged, and reason of every study in the summary.
fn studies(out: &Folder) -> Vec<(String, bool, Option<String>)> {
    let text = |value: &Value| value.as_str().map(str::to_owned);
    let one =
        |study: &Value| (text(&study["name"]).unwrap(), study["converged"].as_bool().unwrap(), text(&study["reason"]));
    out.studies().iter().map(one).collect()
}

/// Claim: the observer is told that all steps of a study are taken before its files are written, and nothing is lost where
/// it asks to stop then.
#[test]
fn results_are_told_before_they_are_written() {
    let scene = scene([2, 2], "[[study]]\nname = \"first\"\nkind = \"relax\"\n");
    let out = scene.folder().inner("out");
    let told = AtomicUsize::new(0);
    let observer = |progress: &Progress| {
        if !progress.all_taken() {
            return ControlFlow::Continue(());
        }
        assert!(!out.has("first.csv"), "it is not written yet");
        told.fetch_add(1, Ordering::Relaxed);
        ControlFlow::Break(())
    };
    let ran = scene.observed(&observer).unwrap();
    assert!(told.into_inner() > 0 && ran.report.summary.studies[0].converged);
    assert!(!ran.report.interrupted && ran.out.has("first.csv"));
}

const THREE: &str = "[[study]]\nname = \"first\"\nkind = \"relax\"\n[[study]]\nname = \"second\"\nkind = \"relax\"\n\
    [[study]]\nname = \"third\"\nkind = \"relax\"\n";

/// Claim: while the second of three studies hangs in a step, closing the ledger leaves a summary with the first study,
/// complete, and the second, interrupted; this summary stays whatever the run still does. If the ledger were not
/// closed, the run that continues would overwrite it with the summary of all three.
#[test]
fn a_closed_ledger_is_the_last_word() {
    let scene = scene([2, 2], THREE);
    let (path, options) = (scene.written(), scene.options());
    let out = scene.folder().inner("out");
    let ledger = Ledger::default();
    let (hangs, hung) = channel();
    let (go, gone) = channel::<()>();
    let gone = std::sync::Mutex::new(gone);
    let observer = move |step: &Progress| {
        if step.study == "second" && hangs.send(()).is_ok() {
            let _ = gone.lock().unwrap().recv(); // until the ledger is closed; at once afterwards
        }
        ControlFlow::Continue(())
    };
    let books = ledger.clone();
    let worker = std::thread::spawn(move || run(&read_scene(&path, &[])?, &options, &observer, &books));
    hung.recv().unwrap();
    let report = ledger.close(false).unwrap().unwrap();
    let expected = vec![("first".to_owned(), true, None), ("second".to_owned(), false, Some("interrupted".to_owned()))];
    assert!(report.interrupted && studies(&out) == expected, "{:?}", studies(&out));
    assert!(report.summary.studies[1].seconds > 0.0, "the time until then is that of the study");
    drop((go, hung));
    worker.join().unwrap().unwrap();
    assert_eq!(studies(&out), expected);
    let whole = scene.resumed().converged();
    assert_eq!(whole.report.kept, ["first"]);
}

/// Claim: a run that is ended before it has written anything leaves nothing.
#[test]
fn before_anything_is_written_nothing_is() {
    assert_eq!(Ledger::default().close(true).unwrap(), None);
}

/// Claim: every kind of study that the observer stops, at its first step or later, is interrupted and not failed.
#[test]
fn every_kind_is_interrupted() {
    for (name, steps) in [
        ("star", 1),
        ("star-trace", 3),
        ("star-engines", 40),
        ("star-surface", 3),
        ("star-landscape", 2),
        ("star-wells", 3),
        ("miura-spectrum", 1),
    ] {
        let ran = Scene::of(name).stopped_after(steps - 1).ran();
        let last = ran.report.summary.studies.last().unwrap();
        assert!(ran.report.interrupted && !last.converged, "{name}");
        assert_eq!(last.reason.as_deref(), Some("interrupted"), "{name}");
        let text = ran.out.text("summary.json");
        assert!(!text.replace(' ', "").contains("\"end\":\"failed\""), "{name}: {text}");
    }
}

/// Sends Ctrl-C after this time from the start of the program; returns its exit status.
#[cfg(unix)]
fn interrupted_after(folder: &Folder, milliseconds: u64) -> Option<i32> {
    let child = folder.command(&["run", "scene.toml", "--out", "out", "--quiet"]).spawn().unwrap();
    std::thread::sleep(std::time::Duration::from_millis(milliseconds));
    signal(&child, "-INT");
    Said::last(child, folder).status
}

/// Claim: Ctrl-C while the sheet is still being built ends the program with status 130 and writes nothing. A run that
/// first built all of it, millions of vertices, would leave a summary.
#[test]
#[cfg(unix)]
fn building_is_interrupted() {
    let folder = scene([1, 1_000_000], "[[study]]\nname = \"a\"\nkind = \"modes\"\n").placed();
    assert_eq!(interrupted_after(&folder, 1500), Some(130));
    assert!(!folder.has("out"));
}

/// Claim: Ctrl-C in the middle of a grid of 256,000,000 wavenumbers ends the program with status 130, with the study
/// interrupted.
#[test]
#[cfg(unix)]
fn a_grid_is_interrupted() {
    let folder = scene([1, 1], "[[study]]\nname = \"a\"\nkind = \"bloch\"\ngrid = [16000, 16000]\n").placed();
    assert_eq!(interrupted_after(&folder, 3000), Some(130));
    let out = folder.inner("out");
    assert_eq!(studies(&out), [("a".to_owned(), false, Some("interrupted".to_owned()))]);
    assert!(out.names().iter().all(|name| !name.ends_with(".part")), "no draft and no claim is left");
}
