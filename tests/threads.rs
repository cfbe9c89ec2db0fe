//! `--threads` says how many threads there are.
#![allow(clippy::unwrap_used)] // tests, also their helpers, may fail
#![cfg(target_os = "linux")]

use foldwell::run::{RunOptions, run_scene};
use std::ops::ControlFlow;
use std::path::PathBuf;

/// Threads of this process, counted by the system.
fn threads() -> usize {
    std::fs::read_dir("/proc/self/task").unwrap().count()
}

/// Claim: with one thread no study starts another one. Pools of threads stay until a program ends, so that one that was started
/// anywhere is still there when it is counted. Homotopies with `2^n` paths are among these (branches), and systems beyond
/// the size from which elements are shared out.
#[test]
fn one_thread_is_one() {
    let before = threads();
    let meshes = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("meshes");
    for name in ["flat-branches", "star", "star-bloch", "star-landscape", "near-cross-wells", "miura-spectrum", "sag"] {
        let folder = tempfile::tempdir().unwrap();
        let options = RunOptions { out: Some(folder.path().into()), threads: Some(1), resume: false };
        let scene = meshes.join(format!("{name}.toml"));
        let report = run_scene(&scene, &options, &|_| ControlFlow::Continue(())).unwrap();
        assert!(report.summary.converged(), "{name}");
        assert_eq!(threads(), before, "{name}");
    }
}
