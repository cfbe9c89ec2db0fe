//! Answers of which nothing was measured: they say so, and no maximum over nothing stands in them as a zero.
#![allow(clippy::unwrap_used)] // in helpers of tests as in tests

use foldwell::run::{RunOptions, run_scene};
use serde_json::Value;
use std::ops::ControlFlow;
use std::path::Path;

/// The studies in the summary of a scene with the star cell on a screw.
fn studies(locks: &str, studies: &str) -> Value {
    let folder = tempfile::tempdir().unwrap();
    let mesh = Path::new(env!("CARGO_MANIFEST_DIR")).join("meshes/open-star.fold");
    std::fs::copy(mesh, folder.path().join("cell.fold")).unwrap();
    let scene = folder.path().join("scene.toml");
    std::fs::write(&scene, format!("[sheet]\nmesh = \"cell.fold\"\ndomain = \"screw\"\n{locks}{studies}")).unwrap();
    let options = RunOptions { out: Some(folder.path().join("out")), ..RunOptions::default() };
    let report = run_scene(&scene, &options, &|_| ControlFlow::Continue(())).unwrap();
    serde_json::from_str::<Value>(&report.summary.to_json()).unwrap()["studies"].take()
}

const BRANCHES: &str = "[[study]]\nname = \"b\"\nkind = \"branches\"\n";
const BOTH: &str = "[[study]]\nname = \"b\"\nkind = \"branches\"\n[[study]]\nname = \"t\"\nkind = \"trace\"\n";

/// Claim: where a lock leaves no direction of folding, that is established (all complex solutions are counted and none is real), and the
/// residuals and errors of the rays and trajectories that do not exist are null. Source: with some edges locked the star cell has no
/// real branch (theory of the trajectories of one lock), of 2 complex solutions.
#[test]
fn residuals_of_nothing_are_null() {
    let edges = foldwell::sheet::fold::read(&Path::new(env!("CARGO_MANIFEST_DIR")).join("meshes/open-star.fold"));
    let keys: Vec<_> = edges.unwrap().edges.iter().map(|edge| edge.key).collect();
    let lock = |k: usize| {
        let key = &keys[k];
        format!("[[lock]]\ncrease = [{}, {}, {}, {}]\n", key.i, key.j, key.shift[0], key.shift[1])
    };
    let unfoldable = (0..keys.len()).find(|&k| studies(&lock(k), BRANCHES)[0]["real_rays"] == 0).unwrap();
    let found = studies(&lock(unfoldable), BOTH);
    let (branches, trace) = (&found[0], &found[1]);
    assert_eq!((&branches["directions"], &branches["complex_solutions"]), (&"listed".into(), &2.into()));
    let entry = &trace["branches"][0];
    assert_eq!((&trace["converged"], &entry["end"]), (&true.into(), &"no-real-branch".into()));
    for value in [&branches["error"], &trace["error"], &entry["max_residual"], &entry["error_to_kinematic"]] {
        assert!(value.is_null(), "{found}");
    }
}

/// Claim: a trace of a cell that folds along infinitely many directions fails and says why; it is not called unfoldable.
#[test]
fn a_continuum_is_not_called_absent() {
    let found = studies("", BOTH);
    assert_eq!((&found[0]["directions"], &found[1]["converged"]), (&"continuum".into(), &false.into()));
    assert!(found[1]["reason"].as_str().unwrap().contains("infinitely many directions"), "{found}");
}
