//! Results for which nothing was measured: this is reported, and no maximum over an empty set appears as zero.

use crate::common::{Scene, mesh};
use foldwell::sheet::{Pattern, fold, generate};
use foldwell::study::modes::ModesSummary;
use foldwell::study::wells::{BarrierSummary, WellsSummary};
use foldwell::study::{StudyResult, StudySummary};
use serde_json::Value;

/// Returns the studies in the summary of a scene with the star cell on a screw.
fn studies(locks: &str, studies: &str) -> Value {
    Scene::on("mesh = \"open-star.fold\"\ndomain = \"screw\"", &format!("{locks}{studies}")).ran().json()
}

const BRANCHES: &str = "[[study]]\nname = \"b\"\nkind = \"branches\"\n";
const BOTH: &str = "[[study]]\nname = \"b\"\nkind = \"branches\"\n[[study]]\nname = \"t\"\nkind = \"trace\"\n";

/// Claim: if a lock leaves no direction of folding, this is established (all complex solutions are counted and none is
/// real), and the residuals and errors of rays and trajectories that do not exist are null. Source: with some edges
/// locked the star cell has no real branch (theory of the trajectories of one lock), of 2 complex solutions.
#[test]
fn residuals_of_nothing_are_null() {
    let keys: Vec<_> = mesh("open-star").edges.iter().map(|edge| edge.key).collect();
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

/// Claim: a trace of a cell that folds along infinitely many directions fails with this reason; the cell is not called
/// rigid.
#[test]
fn a_continuum_is_not_called_absent() {
    let found = studies("", BOTH);
    assert_eq!((&found[0]["directions"], &found[1]["converged"]), (&"continuum".into(), &false.into()));
    assert!(found[1]["reason"].as_str().unwrap().contains("infinitely many directions"), "{found}");
}

/// Returns the studies in the summary of a scene with a mesh of its own.
fn run(mesh: &str, text: &str) -> Value {
    Scene::new(text).with("cell.fold", mesh).ran().json()
}

/// Four faces around a vertex, the third of which passes through the first.
const THROUGH: &str = r#"{"file_spec": 1.2, "vertices_coords": [[0, 0, 0], [1, 0, 0], [0.17364818, 0.98480775, 0],
    [0.76604444, 0.64278761, -0.3], [0.5, -0.2, 1]],
    "faces_vertices": [[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 1]]}"#;

/// Claim: if faces pass through each other from the beginning, a trajectory reports this at arc length 0, not at the
/// state where they separate; stopping at the first crossing is refused. If self-intersection was not tested,
/// `self_intersecting` is null, not false. Source: the drawn face passes through another one by construction.
#[test]
fn a_drawn_state_that_passes_through_itself() {
    let text =
        |study: &str| format!("[sheet]\nmesh = \"cell.fold\"\n[[study]]\nname = \"t\"\nkind = \"trace\"\n{study}");
    let stop = "stop = { arc_length = 0.05 }\n";
    let found = run(THROUGH, &text(&format!("{stop}check = [\"self-intersection\"]\n")));
    let branches = found[0]["branches"].as_array().unwrap();
    assert!(!branches.is_empty() && found[0]["directions"] == "listed", "{found}");
    for branch in branches {
        assert_eq!(branch["first_self_intersection"]["arc_length"], 0.0, "{found}");
        assert_eq!(branch["self_intersecting"], true);
    }
    let unasked = run(THROUGH, &text(stop));
    assert!(unasked[0]["branches"][0]["self_intersecting"].is_null(), "{unasked}");
    let refused = run(THROUGH, &text("stop = { self_intersection = true }\n"));
    assert!(
        refused[0]["converged"] == false && refused[0]["reason"].as_str().unwrap().contains("already"),
        "{refused}"
    );
}

/// Claim: rigid wells of a surface that could not be followed everywhere, or that could not all be made exact, are not
/// a complete result, whatever their number. Source: `surface` reports that the surface of this cell is open, and
/// random cells have many such places; the wells themselves are found.
#[test]
fn wells_of_a_part_of_the_rigid_states() {
    let cell = foldwell::sheet::generate::Random { size: [2, 2], seed: 6, ..Default::default() };
    let cell = generate(&Pattern::Random(cell)).unwrap();
    let text = "[sheet]\nmesh = \"cell.fold\"\ndomain = \"screw\"\n[energy]\nbars = { stiffness = inf }\n\
        creases = { stiffness = 1.0, rest = \"flat\" }\n[[study]]\nname = \"w\"\nkind = \"wells\"\nstarts = 4\nrigid = true\ndraw = []\n";
    let found = run(&fold::write(&cell), text);
    let rigid = &found[0]["rigid"];
    assert!(
        !found[0]["wells"].as_array().unwrap().is_empty() && !rigid["wells"].as_array().unwrap().is_empty(),
        "{found}"
    );
    assert!(rigid["lost"].as_u64().unwrap() + rigid["open"].as_u64().unwrap() > 0, "{rigid}");
    assert!(found[0]["converged"] == false, "{found}");
    assert!(found[0]["reason"].as_str().unwrap().contains("may have other wells and passes"), "{found}");
}

/// Claim: the eggbox and a general cell of four parallelograms, whose rigid states are two surfaces that cross, have a
/// rigid well, and it is the one that relaxations of all vertices find, with creases that rest flat so that the energy
/// does not vanish. Tolerance: 1e-10 relative, that of relaxations to 1e-8 of force.
#[test]
fn rigid_wells_of_four_parallelograms() {
    for pattern in ["eggbox", "four-parallelogram"] {
        let text = "[sheet]\nmesh = \"cell.fold\"\ndomain = \"screw\"\n[energy]\nbars = { stiffness = inf }\n\
            creases = { stiffness = 1.0, rest = \"flat\" }\nfacets = { stiffness = 1.0 }\n[[study]]\nname = \"w\"\n\
            kind = \"wells\"\nstarts = 4\nrigid = true\nmax_curvature = 0.5\ndraw = []\n";
        let found = run(&fold::write(&mesh(pattern)), text);
        let energy = found[0]["wells"][0]["energy"].as_f64().unwrap();
        let rigid = found[0]["rigid"]["wells"][0].as_f64().unwrap();
        assert!(energy > 1.0 && (energy - rigid).abs() <= 1e-10 * energy, "{pattern}: {energy} {rigid}");
    }
}

/// Claim: zero lines that were not searched for, because the determinant is not real, are not counted as zero. Source:
/// an opening makes the coefficients of opposite powers differ.
#[test]
fn zero_lines_that_were_not_looked_for() {
    let text = "[sheet]\nmesh = \"cell.fold\"\n[[study]]\nname = \"b\"\nkind = \"bloch\"\ndraw = []\n";
    let found = run(&fold::write(&mesh("kirigami")), text);
    assert!(found[0]["converged"] == true && found[0]["zero_lines"].is_null(), "{found}");
    let closed = run(&fold::write(&mesh("open-star")), text);
    assert_eq!(closed[0]["zero_lines"], 1, "{closed}");
}

/// Claim: a fit of as many parameters as samples has no error estimate: it is null, not zero.
#[test]
fn errors_of_fits_without_spare_samples() {
    let landscape = |amplitudes: &str| {
        let text = format!(
            "[sheet]\nmesh = \"cell.fold\"\ndomain = \"patch\"\ncells = [2, 2]\n[energy]\nbars = {{ stiffness = inf }}\n\
             creases = {{ stiffness = 1.0 }}\n[[study]]\nname = \"l\"\nkind = \"landscape\"\nmodes = [[1.0, 1.0, 0.0]]\n\
             amplitudes = {amplitudes}\ndraw = []\n"
        );
        run(&fold::write(&mesh("open-star")), &text)[0]["modes"][0].take()
    };
    let two = landscape("[0.001, 0.002]");
    assert!(two["exponent"].is_number() && two["coefficient"].is_number(), "{two}");
    assert!(two["exponent_error"].is_null() && two["coefficient_error"].is_null(), "{two}");
    let four = landscape("[0.001, 0.0015, 0.002, 0.003]");
    assert!(four["exponent_error"].is_number() && four["coefficient_error"].is_number(), "{four}");
}

/// Claim: a torus of pieces that are not connected by edges has motions without folding; a landscape, whose modes are
/// given by fold rates, reports this and uses none of them. Source: a pair of triangles in every cell can rotate
/// freely.
#[test]
fn motions_that_no_fold_rate_names() {
    let islands = r#"{"file_spec": 1.2, "vertices_coords": [[0, 0, 0], [0.5, 0, 0.1], [0.5, 0.5, 0], [0, 0.5, 0.1]],
        "faces_vertices": [[0, 1, 2], [0, 2, 3]], "foldwell:lattice": [[1, 0, 0], [0, 1, 0]],
        "foldwell:holes": [[0, 1, 2, 3]]}"#;
    let text = "[sheet]\nmesh = \"cell.fold\"\ndomain = \"torus\"\ncells = [2, 1]\n[energy]\nbars = { stiffness = 1e4 }\n\
        creases = { stiffness = 1.0 }\n[[study]]\nname = \"l\"\nkind = \"landscape\"\nmodes = [{ wave = [1, 0] }]\n\
        amplitudes = [0.01]\n";
    Scene::new(text).with("cell.fold", islands).refused("turn no crease");
}

/// Claim: the console says what is not known or was not found.
#[test]
fn the_console_says_what_is_not_known() {
    let said = |result: StudyResult| {
        let (name, kind) = ("a".to_owned(), String::new());
        let (converged, seconds, result) = (true, 0.0, Some(result));
        StudySummary { name, kind, converged, seconds, error: None, reason: None, files: None, result }.sentence()
    };
    let modes = said(StudyResult::Modes(ModesSummary::default()));
    assert!(modes.contains("; folding modes unknown,"), "{modes}");
    let wells = WellsSummary { barriers: vec![BarrierSummary::default()], ..WellsSummary::default() };
    let wells = said(StudyResult::Wells(wells));
    assert!(wells.contains("; pass [0, 0] not found,"), "{wells}");
}
