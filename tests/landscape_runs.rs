//! Landscapes as users run them: files, resuming, refusals.
#![allow(clippy::unwrap_used)] // in helpers of tests as in tests

mod common;

use foldwell::output::summary::{StudyResult, StudySummary};
use foldwell::run::{RunOptions, run_scene};
use std::fs;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};

const MAP: &str = "modes = [[1, 1, 0]]\namplitudes = [0.001]\nmap = { amplitude = 0.01, rings = 3 }";

fn scene(folder: &Path, sheet: &str, energy: &str, study: &str) -> PathBuf {
    let meshes = Path::new(env!("CARGO_MANIFEST_DIR")).join("meshes");
    for mesh in ["open-star.fold", "star-wave.fold"] {
        fs::copy(meshes.join(mesh), folder.join(mesh)).unwrap();
    }
    let text =
        format!("[sheet]\n{sheet}\n[energy]\n{energy}\n[[study]]\nname = \"a\"\nkind = \"landscape\"\n{study}\n");
    fs::write(folder.join("scene.toml"), text).unwrap();
    folder.join("scene.toml")
}

const PATCH: &str = "mesh = \"open-star.fold\"\ndomain = \"patch\"\ncells = [3, 3]";
const TORUS: &str = "mesh = \"star-wave.fold\"\ndomain = \"torus\"\ncells = [5, 5]";
const RIGID: &str = "bars = { stiffness = inf }\ncreases = { stiffness = 1.0 }";
const SOFT: &str = "bars = { stiffness = 1e3 }\ncreases = { stiffness = 1.0 }";

fn run(scene: &Path, out: &Path, (threads, resume): (usize, bool), most_steps: usize) -> StudySummary {
    let options = RunOptions { out: Some(out.into()), threads: Some(threads), resume };
    let seen = AtomicUsize::new(0);
    let observer = |_: &_| {
        let go_on = seen.fetch_add(1, Ordering::Relaxed) < most_steps;
        if go_on { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
    };
    run_scene(scene, &options, &observer).unwrap().summary.studies.remove(0)
}

/// Claim: a map has a sample for every direction and its zeros on the exact cone; one that was interrupted goes on where it stopped and ends
/// with the same bytes, with another number of threads too.
#[test]
fn maps_go_on_where_they_stopped() {
    let folder = tempfile::tempdir().unwrap();
    let scene = scene(folder.path(), PATCH, RIGID, MAP);
    let [whole, parts] = ["whole", "parts"].map(|name| folder.path().join(name));
    let found = run(&scene, &whole, (2, false), usize::MAX);
    let Some(StudyResult::Landscape(landscape)) = found.result else { panic!("{:?}", found.reason) };
    let map = landscape.map.unwrap();
    assert!(found.converged && map.samples == 62 && map.failed == 0);
    assert!(map.cone_points == 192 && map.cone_distance.unwrap() <= 1e-6, "{map:?}");

    let interrupted = run(&scene, &parts, (1, false), 40);
    assert!(!interrupted.converged);
    let lines = |folder: &Path| fs::read_to_string(folder.join("a-map.csv")).unwrap().lines().count();
    let (done, all) = (lines(&parts), lines(&whole));
    assert!(1 < done && done < all, "{done} of {all}");
    let resumed = run(&scene, &parts, (1, true), usize::MAX);
    assert!(resumed.converged);
    for file in ["a.csv", "a-map.csv", "a.svg", "a-map.svg", "a.pvd", "a/a_map.vtp"] {
        assert_eq!(fs::read(whole.join(file)).unwrap(), fs::read(parts.join(file)).unwrap(), "{file}");
    }
}

/// Claim: a wave on a torus is named, relaxed and predicted; its summary says which wave, and no curvature.
#[test]
fn waves_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let study = "modes = [{ wave = [2, 3] }]\namplitudes = [0.001, 0.0005]";
    let found = run(&scene(folder.path(), TORUS, SOFT, study), &folder.path().join("out"), (1, false), usize::MAX);
    let Some(StudyResult::Landscape(landscape)) = found.result else { panic!("{:?}", found.reason) };
    let mode = &landscape.modes[0];
    assert!(found.converged && mode.wave == Some([2, 3]) && mode.mode.is_none() && mode.defect.is_none());
    assert!((mode.exponent.unwrap() - 6.0).abs() <= 0.05, "{mode:?}");
    assert_eq!(mode.samples.iter().map(|sample| sample.amplitude).collect::<Vec<_>>(), [0.0005, 0.001]);
}

/// Claim: a mode may be named by its rates, and is then the one that curvatures name.
#[test]
fn modes_by_rates() {
    let folder = tempfile::tempdir().unwrap();
    let both = "modes = [[1, 1, 0], { rates = \"mode.csv\" }]\namplitudes = [0.001]";
    let path = scene(folder.path(), PATCH, RIGID, both);
    let sheet = foldwell::sheet::fold::read(&folder.path().join("open-star.fold")).unwrap();
    let rates = foldwell::kinematics::folding_modes(&sheet).unwrap().named([1.0, 1.0, 0.0]).unwrap();
    let row = |(edge, rate): (&foldwell::sheet::Edge, &f64)| {
        let key = &edge.key;
        format!("{},{},{},{},{rate:?}\n", key.i, key.j, key.shift[0], key.shift[1])
    };
    let rows: String = sheet.edges.iter().zip(&rates).map(row).collect();
    fs::write(folder.path().join("mode.csv"), format!("i,j,n1,n2,rate\n{rows}")).unwrap();
    let found = run(&path, &folder.path().join("out"), (1, false), usize::MAX);
    let Some(StudyResult::Landscape(landscape)) = found.result else { panic!("{:?}", found.reason) };
    let [one, other] = [0, 1].map(|k| landscape.modes[k].samples[0].energy.unwrap());
    assert!((one / other - 1.0).abs() <= 1e-9, "{one:e} {other:e}");
    let tensor = landscape.modes[1].mode.unwrap();
    assert!(tensor.iter().zip([1.0, 1.0, 0.0]).all(|(a, b): (&f64, f64)| (a - b).abs() <= 1e-12), "{tensor:?}");
}

/// Claim: what a landscape cannot be of is refused with its reason, before anything is written.
#[test]
fn refusals() {
    let cases = [
        (PATCH, RIGID, "modes = [{ wave = [1, 2] }]\namplitudes = [0.1]", "a patch has no waves"),
        (TORUS, SOFT, "modes = [[1, 1, 0]]\namplitudes = [0.1]", "curvatures name no modes of a torus"),
        (TORUS, SOFT, "modes = [{ wave = [1, 0] }]\namplitudes = [0.1]", "no zero mode goes [1, 0] times round"),
        (TORUS, RIGID, "modes = [{ wave = [2, 3] }]\namplitudes = [0.1]", "rigid bars forbid them"),
        (
            TORUS,
            SOFT,
            "modes = [{ wave = [2, 3] }]\namplitudes = [0.1]\nmap = { amplitude = 0.1 }",
            "curvatures name no modes",
        ),
        (
            PATCH,
            RIGID,
            "modes = [{ wave = [1, 2], rates = \"a.csv\" }]\namplitudes = [0.1]",
            "rates and a wave at once",
        ),
        (PATCH, RIGID, "modes = [[1, 0, 0]]\namplitudes = [0.1]\nmap = { amplitude = -1 }", "the number is -1"),
        (PATCH, "bars = { stiffness = 1.0 }", "modes = [[1, 0, 0]]\namplitudes = [0.1]", "bars and creases"),
    ];
    for (sheet, energy, study, expected) in cases {
        common::assert_refused(|folder| scene(folder, sheet, energy, study), expected);
    }
}
