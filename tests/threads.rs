//! `--threads` says how many threads there are.
#![allow(clippy::unwrap_used)] // tests, also their helpers, may fail
#![cfg(target_os = "linux")]

use foldwell::numerics::parallel::{Threads, map_with_state};
use foldwell::run::{RunOptions, run_scene};
use std::collections::BTreeSet;
use std::ops::ControlFlow;
use std::path::PathBuf;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

/// Threads of this process, counted by the system.
fn threads() -> usize {
    std::fs::read_dir("/proc/self/task").unwrap().count()
}

/// The most threads that there were at any step of a run, and at its end.
fn most_threads(scene: &str, threads_wanted: usize) -> usize {
    let folder = tempfile::tempdir().unwrap();
    let options =
        RunOptions { out: Some(folder.path().into()), threads: Some(threads_wanted), ..RunOptions::default() };
    let scene = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join(format!("meshes/{scene}.toml"));
    let most = AtomicUsize::new(0);
    let count = || _ = most.fetch_max(threads(), Ordering::Relaxed);
    let report = run_scene(&scene, &options, &|_| {
        count();
        ControlFlow::Continue(())
    });
    count();
    assert!(report.unwrap().summary.converged(), "{}", scene.display());
    most.into_inner()
}

/// The threads that take part in a loop over 200 pieces of work, by their names.
fn workers() -> BTreeSet<Option<String>> {
    let name = |_: &mut (), _| {
        thread::sleep(std::time::Duration::from_micros(200));
        thread::current().name().map(str::to_owned)
    };
    map_with_state(200, || (), name).into_iter().collect()
}

/// Claim: with one thread no study starts another one; with two some do, so that the count can say yes. A pool of the
/// run lives until the run ends, rayon's own until the program ends: they are counted at every step and at the end.
/// Homotopies with `2^n` paths are among these (branches), and systems beyond the size from which elements are shared
/// out. A loop stays where its caller is: outside of any pool on the calling thread, in a pool of rayon in that pool,
/// and two callers have two pools of their own. One test, since all threads of the process are counted.
#[test]
fn work_stays_on_the_threads_that_are_given() {
    let before = threads();
    for name in ["flat-branches", "star", "star-bloch", "star-landscape", "near-cross-wells", "miura-spectrum", "sag"] {
        assert_eq!(most_threads(name, 1), before, "{name}");
    }
    assert_eq!(workers(), [thread::current().name().map(str::to_owned)].into());
    assert_eq!(Threads::new(Some(1)).install(workers), workers());
    assert_eq!(threads(), before);
    assert_eq!(most_threads("near-cross-wells", 2), before + 2);

    let pool = |name: &'static str| {
        let named = move |number| format!("{name} {number}");
        rayon::ThreadPoolBuilder::new().num_threads(2).thread_name(named).build().unwrap()
    };
    let names = |name: &str| -> BTreeSet<_> { (0..2).map(|number| Some(format!("{name} {number}"))).collect() };
    let (first, second) = (pool("first"), pool("second"));
    thread::scope(|scope| {
        let found = [scope.spawn(|| first.install(workers)), scope.spawn(|| second.install(workers))];
        let [first, second] = found.map(|found| found.join().unwrap());
        assert!(first.is_subset(&names("first")) && second.is_subset(&names("second")), "{first:?} {second:?}");
    });
}
