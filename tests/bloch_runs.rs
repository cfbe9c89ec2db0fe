//! The study `bloch` from a scene to its files.
#![allow(clippy::unwrap_used)] // tests, also their helpers, may fail

use foldwell::output::summary::{BlochSummary, StudyResult};
use foldwell::run::{RunError, RunOptions, RunReport, run_scene};
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

fn meshes() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("meshes")
}

fn run(scene: &Path, out: &Path, resume: bool) -> Result<RunReport, RunError> {
    let options = RunOptions { out: Some(out.into()), threads: None, resume };
    run_scene(scene, &options, &|_| ControlFlow::Continue(()))
}

fn result(report: &RunReport) -> &BlochSummary {
    match &report.summary.studies[0].result {
        Some(StudyResult::Bloch(bloch)) => bloch,
        other => panic!("{other:?}"),
    }
}

fn lines(path: &Path) -> usize {
    std::fs::read_to_string(path).unwrap().lines().count()
}

/// Claim: the scene of the reference cell writes all its files, its decay rates are the stored ones, nothing is
/// polarized; and a run that resumes keeps the study, so that its summary reads back.
#[test]
fn reference_cell() {
    let folder = tempfile::tempdir().unwrap();
    let report = run(&meshes().join("star-bloch.toml"), folder.path(), false).unwrap();
    let found = result(&report);
    assert!(report.summary.converged() && found.symmetry_error <= 1e-14 && found.pairing_error <= 1e-12);
    let decay = &found.decay[2];
    assert_eq!((decay.q1, decay.kappa2.len()), (0.9, 4));
    // the stored number, see tests/cases/open-star.json
    assert!((decay.kappa2[3] - 0.137_712_570_259_862).abs() <= 1e-12, "{decay:?}");
    assert_eq!((found.polarization, found.order_at_origin, found.directions.len()), ([0.0, 0.0], Some(4), 2));
    assert_eq!((found.zero_lines, found.lines[0].passes), (1, 2));
    let positive: f64 = found.regions.iter().filter(|region| region.sign > 0).map(|region| region.fraction).sum();
    assert!((positive - found.positive_fraction.unwrap()).abs() <= 0.01);
    let names = ["modes.csv", "modes_bands.csv", "modes.pvd", "modes.svg", "modes/modes_determinant.vti"];
    let pictures = ["modes/modes_zero_lines.vtp", "modes/modes_mode_0000.vtu", "modes/modes_mode_0001.vtu"];
    for name in names.iter().chain(&pictures) {
        assert!(folder.path().join(name).exists(), "{name}");
    }
    assert_eq!(
        (lines(&folder.path().join("modes.csv")), lines(&folder.path().join("modes_bands.csv"))),
        (1 + 7 * 4, 152)
    );
    let again = run(&meshes().join("star-bloch.toml"), folder.path(), true).unwrap();
    assert_eq!(again.kept, ["modes"]);
    assert_eq!(result(&again), found);
}

/// Claim: on the kirigami cell the same study says that rates do not pair, and by how much; it has no zero lines.
#[test]
fn kirigami_cell() {
    let folder = tempfile::tempdir().unwrap();
    let report = run(&meshes().join("kirigami-bloch.toml"), folder.path(), false).unwrap();
    let found = result(&report);
    assert!(found.pairing_error > 0.1 && found.symmetry_error > 0.1 && found.imaginary_part > 0.1, "{found:?}");
    assert_eq!((found.polarization, found.on_circle), ([0.5, 0.5], [0.0, 0.0]));
    assert_eq!((found.zero_lines, found.positive_fraction, found.order_at_origin), (0, None, None));
}

/// Claim: what cannot be done is refused before anything is written, and a sheet without a determinant is a study that
/// failed.
#[test]
fn what_cannot_be_done() {
    let folder = tempfile::tempdir().unwrap();
    let scene = |sheet: &str, keys: &str| {
        let path = folder.path().join("scene.toml");
        let text = format!("[sheet]\n{sheet}\n[[study]]\nname = \"a\"\nkind = \"bloch\"\ndraw = []\n{keys}\n");
        std::fs::write(&path, text).unwrap();
        path
    };
    let out = folder.path().join("out");
    let cases = [
        ("generate = { pattern = \"miura\" }", "", "conditions (bars and rigid facets)"),
        ("generate = { pattern = \"kresling\" }", "", "without lattice vectors"),
        ("generate = { pattern = \"random\" }", "path = [[0, 0], [1, 0]]", "bands need an energy of springs"),
        ("generate = { pattern = \"random\" }", "modes = [[0.1, inf]]", "the number is inf"),
        ("generate = { pattern = \"random\" }", "q1 = [nan]", "the number is NaN"),
    ];
    for (sheet, keys, expected) in cases {
        let error = run(&scene(sheet, keys), &out, false).unwrap_err();
        assert_eq!(error.exit_status(), 2);
        assert!(error.to_string().contains(expected), "{error}");
        assert!(!out.exists());
    }
    let report = run(&scene("generate = { pattern = \"random-developable\" }", ""), &out, false).unwrap();
    let study = &report.summary.studies[0];
    assert!(!study.converged && study.reason.as_ref().unwrap().contains("flat sheet"), "{study:?}");
    let bending = "generate = { pattern = \"miura\" }\n[energy]\nfacets = { stiffness = 1.0 }";
    let report = run(&scene(bending, ""), &out, false).unwrap();
    assert!(report.summary.converged(), "{:?}", report.summary.studies[0].reason);
    assert!(out.join("a.csv").exists() && !out.join("a.svg").exists() && !out.join("a.pvd").exists());
}
