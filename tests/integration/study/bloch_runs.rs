//! The study `bloch`, from a scene to its files.

use approx::{abs_diff_eq, assert_abs_diff_eq};
use foldwell::analysis::bloch::{Decay, Determinant, Rigidity};
use foldwell::run::{RunError, RunOptions, RunReport, run_scene};
use foldwell::sheet::generate::{Pattern, Random, generate};
use foldwell::study::StudyResult;
use foldwell::study::bloch::BlochSummary;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

fn meshes() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("meshes")
}

fn cases() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/cases")
}

fn run(scene: &Path, out: &Path, resume: bool) -> Result<RunReport, RunError> {
    let options = RunOptions { out: Some(out.into()), resume, ..RunOptions::default() };
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

/// Claim: the scene of the reference cell writes all its files, its decay rates are the stored ones, and the
/// polarization is zero; a resumed run keeps the study, and its summary is read back.
#[test]
fn reference_cell() {
    let folder = tempfile::tempdir().unwrap();
    let report = run(&meshes().join("star-bloch.toml"), folder.path(), false).unwrap();
    let found = result(&report);
    assert!(
        report.summary.converged() && found.symmetry_error.unwrap() <= 1e-14 && found.pairing_error.unwrap() <= 1e-12
    );
    let decay = &found.decay[2];
    assert_eq!((decay.q1, decay.kappa2.len()), (0.9, 4));
    // the stored number, see tests/cases/open-star.json
    assert!(abs_diff_eq!(decay.kappa2[3], 0.137_712_570_259_862, epsilon = 1e-12), "{decay:?}");
    assert_eq!((found.polarization, found.order_at_origin, found.directions.len()), (Some([0.0, 0.0]), Some(4), 2));
    assert_eq!((found.zero_lines, found.lines[0].passes), (Some(1), 2));
    let positive: f64 = found.regions.iter().filter(|region| region.sign > 0).map(|region| region.fraction).sum();
    assert_abs_diff_eq!(positive, found.positive_fraction.unwrap(), epsilon = 0.01);
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

/// Claim: on the kirigami cell the study reports by how much the decay rates fail to pair; it has no zero lines.
#[test]
fn kirigami_cell() {
    let folder = tempfile::tempdir().unwrap();
    let report = run(&meshes().join("kirigami-bloch.toml"), folder.path(), false).unwrap();
    let found = result(&report);
    assert!(
        found.pairing_error.unwrap() > 0.1
            && found.symmetry_error.unwrap() > 0.1
            && found.imaginary_part.unwrap() > 0.1,
        "{found:?}"
    );
    assert_eq!((found.polarization, found.on_circle), (Some([0.5, 0.5]), Some([0.0, 0.0])));
    assert_eq!((found.zero_lines, found.positive_fraction, found.order_at_origin), (None, None, None));
}

/// Claim: a rigid polygon that is cut by the rim of the drawn cell is rigid like any other: the second kirigami scene
/// has a determinant, and the polarization that the scan of random cells found.
#[test]
fn polygons_cut_by_the_rim_are_rigid() {
    let folder = tempfile::tempdir().unwrap();
    let report = run(&meshes().join("kirigami-polarized-bloch.toml"), folder.path(), false).unwrap();
    assert_eq!((result(&report).polarization, result(&report).on_circle), (Some([-1.0, 1.5]), Some([0.0, 0.0])));
}

/// Claim: the scene of the cylinder gives modes of the rolled state: a determinant that vanishes to second order at `q
/// = 0` and at the rotation angles of the lattice to 1e-12 (theory, section 8), symmetric, with rates that pair; mode
/// shapes are velocities of the rolled cells; the rings are drawn; and a resumed run still has the state.
#[test]
fn cylinder() {
    let folder = tempfile::tempdir().unwrap();
    let report = run(&meshes().join("star-cylinder-bloch.toml"), folder.path(), false).unwrap();
    let Some(StudyResult::Bloch(found)) = &report.summary.studies[1].result else { panic!("{:?}", report.summary) };
    assert!(
        report.summary.converged() && found.symmetry_error.unwrap() <= 1e-12 && found.pairing_error.unwrap() <= 1e-9
    );
    println!("theta {:?}, from a zero {:e}", found.theta, found.theta_to_zero.unwrap());
    assert_eq!((found.order_at_origin, found.polarization), (Some(2), Some([0.0, 0.0])));
    assert!(found.theta.unwrap().iter().all(|theta| theta.abs() > 0.01));
    assert!(found.theta_to_zero.unwrap() <= 1e-12, "{:?}", found.theta_to_zero);
    let picture = std::fs::read_to_string(folder.path().join("modes.svg")).unwrap();
    assert_eq!(picture.matches("r=\"9\"").count(), 2);
    let points = |file: &str| foldwell::output::vtk::read_vtu(&folder.path().join(file)).unwrap().points;
    let [mode, rolled] = ["modes/modes_mode_0000.vtu", "rolled/rolled_0001.vtu"].map(points);
    let apart = mode.iter().zip(&rolled).map(|(a, b)| (a - b).norm()).fold(0.0, f64::max);
    assert!(mode.len() == rolled.len() && apart <= 1e-12, "{apart:e}");
    std::fs::remove_file(folder.path().join("modes.csv")).unwrap();
    let again = run(&meshes().join("star-cylinder-bloch.toml"), folder.path(), true).unwrap();
    assert_eq!(again.kept, ["rolled"]);
    assert_eq!(again.summary.studies[1].result, report.summary.studies[1].result);
}

/// Claim: on triangulated Miura-ori at `q1 = 0.5` all four roots are double, which the study reports; their rates are
/// those of the double zeros of the determinant (found separately, by elimination with 60 digits on the same mesh) and
/// pair. Tolerance: 1e-13, although a double root of the polynomial is known only to 4e-8.
#[test]
fn double_roots() {
    let folder = tempfile::tempdir().unwrap();
    let report = run(&cases().join("miura-double-roots.toml"), folder.path(), false).unwrap();
    let (found, decay) = (result(&report), &result(&report).decay[0]);
    assert_eq!((decay.multiplicity.as_slice(), found.ill_conditioned), ([2; 4].as_slice(), 0));
    let expected = 0.736_241_605_026_287_8;
    for (kappa, sign) in decay.kappa2.iter().zip([-1.0, -1.0, 1.0, 1.0]) {
        assert_abs_diff_eq!(*kappa, sign * expected, epsilon = 1e-13);
    }
    assert!(found.pairing_error.unwrap() <= 1e-13 && found.pairing_condition.unwrap() <= 1e3, "{found:?}");
}

/// Claim: the scene of the strip writes its two tables, its edge modes decay as predicted to 1e-6, and the scene of the
/// interface finds the three modes that the windings predict, with rates of the slowest that agree too.
#[test]
fn strips_and_interfaces() {
    let folder = tempfile::tempdir().unwrap();
    let report = run(&meshes().join("star-strip.toml"), folder.path(), false).unwrap();
    let strip = result(&report).strip.clone().unwrap();
    assert_eq!((strip.zero_modes, strip.self_stresses), (vec![4; 6], vec![0; 6]));
    assert_eq!((strip.compared, strip.unmatched, strip.interface_predicted.len()), (12, 0, 0));
    assert!(strip.error.unwrap() <= 1e-6, "{:?}", strip.error);
    assert_eq!(lines(&folder.path().join("modes-strip.csv")), 1 + 12);
    let counts = std::fs::read_to_string(folder.path().join("modes-modes.csv")).unwrap();
    assert!(counts.lines().nth(1).unwrap().starts_with("0.0,0.0,3,3,3,"), "{counts}");
    let report = run(&meshes().join("kirigami-interface.toml"), folder.path(), false).unwrap();
    let strip = result(&report).strip.clone().unwrap();
    assert_eq!((strip.interface_zero_modes, strip.interface_predicted), (vec![3; 3], vec![Some(3); 3]));
    assert_eq!((strip.interface_self_stresses, strip.unmatched), (vec![0; 3], 0));
    assert!(strip.error.unwrap() <= 1e-6, "{:?}", strip.error);
}

/// Claim: at `q1 = 0` the determinant has a root of multiplicity four at 1, where the matrix has three null vectors: it is found to
/// all digits, with its multiplicity. The coefficients alone know such roots to four digits, and where no root is known accurately
/// enough to be compared the pairing error is null instead of zero. Tolerance: rounding times the condition, below 1e3.
#[test]
fn fourfold_roots() {
    let folder = tempfile::tempdir().unwrap();
    let scene = folder.path().join("scene.toml");
    let text = "[sheet]\ngenerate = { pattern = \"random\" }\n[[study]]\nname = \"a\"\nkind = \"bloch\"\nq1 = [0]\ndraw = []\n";
    std::fs::write(&scene, text).unwrap();
    let report = run(&scene, &folder.path().join("out"), false).unwrap();
    let found = result(&report);
    assert!(found.ill_conditioned == 0 && found.decay[0].multiplicity == [4; 4], "{found:?}");
    assert!(found.decay[0].kappa2.iter().all(|kappa| kappa.abs() <= 1e-12) && found.pairing_error.unwrap() <= 1e-12);
    let rigidity = Rigidity::of_sheet(&generate(&Pattern::Random(Random::default())).unwrap(), false).unwrap();
    let alone = Decay::new(&Determinant::new(&rigidity).unwrap(), 0, 0.0).unwrap().pairing();
    assert!(alone.error.is_none() && alone.condition.is_none() && alone.left_out > 0, "{alone:?}");
}

/// Claim: on a triangulated eggbox the determinant touches zero on lines without changing its sign, which is said instead of a number of
/// lines; its roots are all double, and their rates pair. Tolerance: rounding times the largest condition of the roots, below 1e3.
#[test]
fn rates_without_zero_lines() {
    let folder = tempfile::tempdir().unwrap();
    let energy = "generate = { pattern = \"eggbox\" }\n[energy]\nfacets = { stiffness = 1.0 }";
    let report = run(&written(folder.path(), energy, ""), &folder.path().join("out"), false).unwrap();
    let found = result(&report);
    assert!(report.summary.converged() && found.zero_lines.is_none() && found.lines.is_empty(), "{found:?}");
    assert!(found.no_zero_lines.as_ref().unwrap().contains("could not be followed"), "{found:?}");
    assert!(found.pairing_error.unwrap() < 1e-12 && found.pairing_condition.unwrap() < 1e3, "{found:?}");
    let away = found.decay.iter().filter(|decay| decay.q1.abs() > 0.1);
    assert!(away.flat_map(|decay| &decay.multiplicity).all(|&count| count == 2), "{found:?}");
}

/// Writes a scene with a study of a sheet into a folder.
fn written(folder: &Path, sheet: &str, keys: &str) -> PathBuf {
    let path = folder.join("scene.toml");
    let text = format!("[sheet]\n{sheet}\n[[study]]\nname = \"a\"\nkind = \"bloch\"\ndraw = []\n{keys}\n");
    std::fs::write(&path, text).unwrap();
    path
}

/// Claim: strips that cannot be, and wavenumbers that are no numbers, are refused before anything is written.
#[test]
fn strips_that_cannot_be() {
    let folder = tempfile::tempdir().unwrap();
    let misfit = format!("strip = {{ cells = 20, other = '{}' }}", meshes().join("kirigami.fold").display());
    let cases = [
        ("strip = { cells = 4 }", "has no inside"),
        ("strip = { cells = 100000 }", "coordinates, more than"),
        ("strip = { cells = 20, width = 1 }", "width"),
        ("strip = { cells = 20, other = \"none.fold\" }", "none.fold"),
        (&misfit, "do not fit"),
        ("zero_modes_at = [[nan, 0]]", "the number is NaN"),
    ];
    for (keys, expected) in cases {
        let scene = written(folder.path(), "generate = { pattern = \"random\" }", keys);
        let out = folder.path().join("out");
        let error = run(&scene, &out, false).unwrap_err();
        assert_eq!(error.exit_status(), 2);
        assert!(error.to_string().contains(expected), "{error}");
        assert!(!out.exists());
    }
}

/// Claim: an impossible study is refused before anything is written.
#[test]
fn what_cannot_be_done() {
    let folder = tempfile::tempdir().unwrap();
    let scene = |sheet: &str, keys: &str| written(folder.path(), sheet, keys);
    let out = folder.path().join("out");
    let cases = [
        ("generate = { pattern = \"miura\" }", "", "conditions (bars and rigid facets)"),
        ("generate = { pattern = \"kresling\" }", "", "without lattice vectors"),
        ("generate = { pattern = \"random\" }", "path = [[0, 0], [1, 0]]", "bands need an energy of springs"),
        ("generate = { pattern = \"random\" }", "density = {}", "bands need an energy of springs"),
        ("generate = { pattern = \"random\" }", "density = { bins = 0 }", "the number is 0"),
        ("generate = { pattern = \"random\" }", "modes = [[0.1, inf]]", "the number is inf"),
        ("generate = { pattern = \"random\" }", "q1 = [nan]", "the number is NaN"),
        ("generate = { pattern = \"random\" }", "grid = [0, 8]", "0"),
        ("generate = { pattern = \"random\" }", "modes = [[0.1]]", "the list has 1 values"),
        ("generate = { pattern = \"random\" }", "kappa = 1", "kappa"),
        ("generate = { pattern = \"random\" }", "start = \"rolled\"", "no earlier study is called"),
        (
            "generate = { pattern = \"random\" }",
            "start = { random = 0.1, seed = 1 }",
            "a state that an earlier study found",
        ),
        ("generate = { pattern = \"random\" }", "start = \"a.vtu\"", "a state that an earlier study found"),
    ];
    for (sheet, keys, expected) in cases {
        let error = run(&scene(sheet, keys), &out, false).unwrap_err();
        assert_eq!(error.exit_status(), 2);
        assert!(error.to_string().contains(expected), "{error}");
        assert!(!out.exists());
    }
}

/// Claim: a state that is not of one cell is refused, and bands of one with a lock; a state of springs has bands; a sheet without a determinant is a study that
/// failed, and polygons that bend have one.
#[test]
fn states_that_cannot_be_asked() {
    let folder = tempfile::tempdir().unwrap();
    let scene = |sheet: &str, keys: &str| written(folder.path(), sheet, keys);
    let out = folder.path().join("out");
    let relaxed = |domain: &str, keys: &str| {
        let energy = "[energy]\nbars = { stiffness = 100.0 }\ncreases = { stiffness = 1.0 }\n[[study]]\nname = \"r\"\nkind = \
                      \"relax\"\ntolerance = 1e-9";
        scene(&format!("generate = {{ pattern = \"random\" }}\n{domain}\n{energy}"), &format!("start = \"r\"\n{keys}"))
    };
    let cases = [
        ("domain = \"patch\"", "", "those of a state of one cell"),
        ("domain = \"torus\"\ncells = [2, 1]", "", "those of a state of one cell"),
        (
            "domain = \"torus\"",
            "path = [[0, 0], [1, 0]]\n[[lock]]\ncrease = [0, 1, 0, 0]",
            "bands need an energy of springs",
        ),
    ];
    for (domain, keys, expected) in cases {
        let error = run(&relaxed(domain, keys), &out, false).unwrap_err();
        assert!(error.exit_status() == 2 && error.to_string().contains(expected) && !out.exists(), "{error}");
    }
    let report = run(&relaxed("domain = \"torus\"", ""), &out, false).unwrap();
    let Some(StudyResult::Bloch(still)) = &report.summary.studies[1].result else { panic!("{:?}", report.summary) };
    assert_eq!((still.theta, still.order_at_origin), (Some([0.0; 2]), Some(4)));
    let report = run(&relaxed("domain = \"torus\"", "path = [[0, 0], [1, 0]]"), &out, false).unwrap();
    assert!(report.summary.converged() && out.join("a_bands.csv").exists(), "{:?}", report.summary.studies[1].reason);
    let report = run(&scene("generate = { pattern = \"random-developable\" }", ""), &out, false).unwrap();
    let reason = result(&report).no_determinant.as_ref().unwrap();
    assert!(report.summary.converged() && reason.contains("vanishes at all wavenumbers"), "{reason}");
    let bending = "generate = { pattern = \"miura\" }\n[energy]\nfacets = { stiffness = 1.0 }";
    let report = run(&scene(bending, ""), &out, false).unwrap();
    assert!(report.summary.converged(), "{:?}", report.summary.studies[0].reason);
    assert!(out.join("a.csv").exists() && !out.join("a.svg").exists() && !out.join("a.pvd").exists());
}
