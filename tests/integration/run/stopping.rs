//! Runs that are asked to stop: they end with the finished results on disk, and the current study is interrupted, not
//! failed.
//!
//! No test here measures time; `cargo bench --bench stopping` prints it.

use foldwell::run::{Ledger, RunOptions, read_scene, run};
use serde_json::Value;
use std::fs;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::mpsc::channel;

fn scene(folder: &Path, cells: [usize; 2], studies: &str) -> PathBuf {
    let mesh = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("meshes/open-star.fold");
    let text = format!(
        "[sheet]\nmesh = {:?}\ncells = {cells:?}\n[energy]\nbars = {{ stiffness = inf }}\n\
         creases = {{ stiffness = 1, rest = {{ mode = [0, 0.05, 0], amplitude = 1 }} }}\n{studies}",
        mesh.display().to_string()
    );
    let path = folder.join("scene.toml");
    fs::write(&path, text).unwrap();
    path
}

/// Returns name, whether it converged, and reason of every study in the summary.
fn studies(out: &Path) -> Vec<(String, bool, Option<String>)> {
    let summary: Value = serde_json::from_str(&fs::read_to_string(out.join("summary.json")).unwrap()).unwrap();
    let text = |value: &Value| value.as_str().map(str::to_owned);
    let one =
        |study: &Value| (text(&study["name"]).unwrap(), study["converged"].as_bool().unwrap(), text(&study["reason"]));
    summary["studies"].as_array().unwrap().iter().map(one).collect()
}

const THREE: &str = "[[study]]\nname = \"first\"\nkind = \"relax\"\n[[study]]\nname = \"second\"\nkind = \"relax\"\n\
    [[study]]\nname = \"third\"\nkind = \"relax\"\n";

/// Claim: while the second of three studies hangs in a step, closing the ledger leaves a summary with the first study,
/// complete, and the second, interrupted; this summary stays whatever the run still does. If the ledger were not
/// closed, the run that continues would overwrite it with the summary of all three.
#[test]
fn a_closed_ledger_is_the_last_word() {
    let folder = tempfile::tempdir().unwrap();
    let path = scene(folder.path(), [2, 2], THREE);
    let out = folder.path().join("out");
    let options = RunOptions { out: Some(out.clone()), ..RunOptions::default() };
    let ledger = Ledger::default();
    let (hangs, hung) = channel();
    let (go, gone) = channel::<()>();
    let gone = std::sync::Mutex::new(gone);
    let observer = move |step: &foldwell::run::Progress| {
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
    let resumed = RunOptions { out: Some(out.clone()), resume: true, ..RunOptions::default() };
    let scene = folder.path().join("scene.toml");
    let whole = foldwell::run::run_scene(&scene, &resumed, &|_| ControlFlow::Continue(())).unwrap();
    assert_eq!(whole.kept, ["first"]);
    assert!(whole.summary.converged());
}

/// Claim: a run that is ended before it has written anything leaves nothing.
#[test]
fn before_anything_is_written_nothing_is() {
    assert_eq!(Ledger::default().close(true).unwrap(), None);
}

/// Claim: every kind of study that the observer stops, at its first step or later, is interrupted and not failed.
#[test]
fn every_kind_is_interrupted() {
    let meshes = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("meshes");
    for (name, steps) in [
        ("star.toml", 1),
        ("star-trace.toml", 3),
        ("star-engines.toml", 40),
        ("star-surface.toml", 3),
        ("star-landscape.toml", 2),
        ("star-wells.toml", 3),
        ("miura-spectrum.toml", 1),
    ] {
        let folder = tempfile::tempdir().unwrap();
        let options = RunOptions { out: Some(folder.path().into()), ..RunOptions::default() };
        let left = std::sync::atomic::AtomicI64::new(steps);
        let observer = |_: &foldwell::run::Progress| match left.fetch_sub(1, std::sync::atomic::Ordering::Relaxed) {
            2.. => ControlFlow::Continue(()),
            _ => ControlFlow::Break(()),
        };
        let report = foldwell::run::run_scene(&meshes.join(name), &options, &observer).unwrap();
        let last = report.summary.studies.last().unwrap();
        assert!(report.interrupted && !last.converged, "{name}");
        assert_eq!(last.reason.as_deref(), Some("interrupted"), "{name}");
        let text = fs::read_to_string(folder.path().join("summary.json")).unwrap();
        assert!(!text.replace(' ', "").contains("\"end\":\"failed\""), "{name}: {text}");
    }
}

/// Sends Ctrl-C after this time from the start of the program; returns its exit status.
#[cfg(unix)]
fn interrupted_after(folder: &Path, milliseconds: u64) -> Option<i32> {
    use std::process::{Command, Stdio};
    let mut program = Command::new(env!("CARGO_BIN_EXE_foldwell"));
    program.current_dir(folder).args(["run", "scene.toml", "--out", "out", "--quiet"]).stderr(Stdio::null());
    let mut child = program.spawn().unwrap();
    std::thread::sleep(std::time::Duration::from_millis(milliseconds));
    assert!(Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap().success());
    child.wait().unwrap().code()
}

/// Claim: Ctrl-C while the sheet is still being built ends the program with status 130 and writes nothing. A run that
/// first built all of it, millions of vertices, would leave a summary.
#[test]
#[cfg(unix)]
fn building_is_interrupted() {
    let folder = tempfile::tempdir().unwrap();
    scene(folder.path(), [1, 1_000_000], "[[study]]\nname = \"a\"\nkind = \"modes\"\n");
    assert_eq!(interrupted_after(folder.path(), 1500), Some(130));
    assert!(!folder.path().join("out").exists());
}

/// Claim: Ctrl-C in the middle of a grid of 256,000,000 wavenumbers ends the program with status 130, with the study
/// interrupted.
#[test]
#[cfg(unix)]
fn a_grid_is_interrupted() {
    let folder = tempfile::tempdir().unwrap();
    scene(folder.path(), [1, 1], "[[study]]\nname = \"a\"\nkind = \"bloch\"\ngrid = [16000, 16000]\n");
    assert_eq!(interrupted_after(folder.path(), 3000), Some(130));
    assert_eq!(studies(&folder.path().join("out")), [("a".to_owned(), false, Some("interrupted".to_owned()))]);
    let parts = fs::read_dir(folder.path().join("out"))
        .unwrap()
        .filter(|entry| entry.as_ref().unwrap().path().extension().is_some_and(|ending| ending == "part"));
    assert_eq!(parts.count(), 0, "no draft and no claim is left");
}
