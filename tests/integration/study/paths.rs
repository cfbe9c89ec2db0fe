//! Driven paths: limit points, second states and events of structures with closed forms.
//!
//! Sources: the two-bar truss of von Mises (ZAMM 3, 1923), whose load is `F(z) = -2 EA/L0 (l - L0) z / l` at height `z`
//! with `l^2 = w^2 + z^2`; the drum of Kresling's pattern, whose bars have the lengths `sqrt(h^2 + 2 - 2 cos t)` and
//! `sqrt(h^2 + 2 - 2 cos(t - pi/3))` at height `h` and twist `t`, minimised over the twist.

use foldwell::run::{RunOptions, run_scene};
use foldwell::study::StudyResult;
use foldwell::study::path::{PathBranchSummary, PathSummary};
use std::collections::HashMap;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

/// A run of a scene of `meshes`.
struct Run {
    folder: tempfile::TempDir,
    results: HashMap<String, PathSummary>,
}

impl Run {
    /// Runs a scene of the repository after replacing words of it.
    fn of(scene: &str, replaced: &[(&str, &str)]) -> Self {
        let meshes = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("meshes");
        let folder = tempfile::tempdir().unwrap();
        for mesh in ["two-bars.fold", "drum.fold"] {
            std::fs::copy(meshes.join(mesh), folder.path().join(mesh)).unwrap();
        }
        let mut text = std::fs::read_to_string(meshes.join(scene)).unwrap();
        for (old, new) in replaced {
            assert!(text.contains(old), "{old}");
            text = text.replace(old, new);
        }
        std::fs::write(folder.path().join("s.toml"), text).unwrap();
        Self::again(folder)
    }

    fn again(folder: tempfile::TempDir) -> Self {
        let options = RunOptions { out: Some(folder.path().join("out")), ..RunOptions::default() };
        let report = run_scene(&folder.path().join("s.toml"), &options, &|_| ControlFlow::Continue(())).unwrap();
        let mut results = HashMap::new();
        for study in report.summary.studies {
            assert!(study.converged, "{}: {:?}", study.name, study.reason);
            if let Some(StudyResult::Path(path)) = study.result {
                results.insert(study.name, path);
            }
        }
        Self { folder, results }
    }

    fn branch(&self, study: &str) -> &PathBranchSummary {
        &self.results[study].branches[0]
    }

    fn file(&self, name: &str) -> PathBuf {
        self.folder.path().join("out").join(name)
    }

    /// Returns the rows of a table by the names of its columns.
    fn table(&self, study: &str) -> Vec<HashMap<String, String>> {
        rows(&self.file(&format!("{study}.csv")))
    }
}

fn rows(path: &Path) -> Vec<HashMap<String, String>> {
    let text = std::fs::read_to_string(path).unwrap();
    let mut lines = text.lines();
    let header: Vec<&str> = lines.next().unwrap().split(',').collect();
    let row =
        |line: &str| header.iter().map(|name| (*name).to_owned()).zip(line.split(',').map(str::to_owned)).collect();
    lines.map(row).collect()
}

fn number(row: &HashMap<String, String>, column: &str) -> f64 {
    row[column].parse().unwrap_or(f64::NAN)
}

/// Returns the drives and reactions of the events of a kind.
fn events(branch: &PathBranchSummary, kind: &str) -> Vec<[f64; 2]> {
    let kinds = branch.events.iter().filter(|event| event.event == kind);
    kinds.map(|event| [event.drive.unwrap(), event.reaction]).collect()
}

/// Height, and force `dE/dz`, of the limit points of two bars with half span 1, height 0.3 and EA = 1.
const LIMIT: [f64; 2] = [0.170_711_647_439_495, 9.530_291_997_895e-3];

/// The force `dE/dz` of the two bars at height `z`.
fn force(z: f64) -> f64 {
    let (l, l0) = (z.hypot(1.0), 0.3_f64.hypot(1.0));
    2.0 / l0 * (l - l0) * z / l
}

/// Claim: two bars that are pushed through have their limit loads where the closed form has them, every state lies on
/// the closed form, and the path arrives. Tolerance: limit points are located to 1e-10; states balance to 1e-12 of the largest force.
#[test]
fn two_bars_are_pushed_through() {
    let run = Run::of("two-bars-push.toml", &[]);
    let branch = run.branch("pushed");
    assert_eq!(branch.end, "arrived");
    assert!(branch.stable, "a single vertex that is held has no unstable state");
    let found = events(branch, "limit-load");
    assert_eq!(found.len(), 2, "{found:?}");
    for ([drive, reaction], side) in found.iter().zip([1.0, -1.0]) {
        assert!((0.3 + drive - side * LIMIT[0]).abs() < 1e-10, "{drive}");
        assert!((reaction + side * LIMIT[1]).abs() < 1e-11, "{reaction}");
    }
    let table = run.table("pushed");
    for row in &table {
        let z = 0.3 + number(row, "drive");
        assert!((number(row, "reaction") - force(z)).abs() < 1e-11, "{row:?}");
        assert!((number(row, "work") - number(row, "energy_total")).abs() < 1e-8 * LIMIT[1], "{row:?}");
    }
    let last = table.last().unwrap();
    assert!((number(last, "drive") + 0.7).abs() < 1e-12);
}

/// Claim: two bars under a growing load lose stability at the limit load, are unstable between the two limit points, and
/// go on to the load that was asked for. Source and tolerances as above; the load points down, so that the factor is
/// `-dE/dz` and its conjugate is the height's fall.
#[test]
fn two_bars_under_a_load_snap_through() {
    let run = Run::of("two-bars-load.toml", &[]);
    let branch = run.branch("loaded");
    assert_eq!(branch.end, "arrived");
    assert!(!branch.stable);
    let found = events(branch, "limit-load");
    assert_eq!(found.len(), 2, "{found:?}");
    for ([factor, _], side) in found.iter().zip([1.0, -1.0]) {
        assert!((factor - side * LIMIT[1]).abs() < 1e-11, "{factor}");
    }
    let table = run.table("loaded");
    let limits: Vec<usize> = (0..table.len()).filter(|&k| table[k]["event"] == "limit-load").collect();
    for (k, row) in table.iter().enumerate().filter(|(_, row)| row["event"].is_empty()) {
        let between = (limits[0]..limits[1]).contains(&k);
        assert_eq!(row["negative_eigenvalues"], if between { "1" } else { "0" }, "{k}");
    }
}

/// Height below the drawn 1.2, and force, of the limit points of the drum, from the two numbers of the closed form in 40
/// digits; and its second state.
const DRUM: [[f64; 2]; 2] =
    [[1.145_092_671_426_46 - 1.2, -1.015_608_266_287_35e-3], [0.962_532_976_931_361 - 1.2, 8.030_698_430_453_93e-4]];
const SECOND_STATE: f64 = 0.877_968_604 - 1.2;

/// Claim: a drum whose lid turns freely has its limit points and its second state without energy where the closed form
/// has them. Tolerance: the digits of the source, nine of heights and eight of forces; 1.4e-6 beside the second state the
/// force is that distance times a stiffness of 0.017, and the energy half of both together.
#[test]
fn a_drum_is_crushed() {
    let run = Run::of("drum-path.toml", &[("to = -0.4", &format!("to = {SECOND_STATE}"))]);
    let branch = run.branch("crush");
    assert_eq!(branch.end, "arrived");
    let found = events(branch, "limit-load");
    assert_eq!(found.len(), 2, "{found:?}");
    for ([drive, reaction], [height, force]) in found.iter().zip(DRUM) {
        assert!((drive - height).abs() < 1e-10, "{drive} {height}");
        assert!((reaction - force).abs() < 1e-13, "{reaction} {force}");
    }
    let last = run.table("crush").pop().unwrap();
    assert!(number(&last, "energy_total").abs() < 1e-16 && number(&last, "reaction").abs() < 1e-10, "{last:?}");
}

/// Claim: a path ends exactly at a stop, with an event of its own.
#[test]
fn a_path_stops() {
    let run = Run::of("two-bars-push.toml", &[("max_step = 0.05", "max_step = 0.05\nstop = { arc_length = 0.31 }")]);
    let branch = run.branch("pushed");
    assert_eq!(branch.end, "stop");
    let last = branch.events.last().unwrap();
    assert!(last.event == "stop" && (last.arc_length - 0.31).abs() < 1e-9, "{last:?}");
}

/// Claim: a relaxation that starts where a path ended finds the second state of the drum, in which no bar is strained:
/// released from near it, the energy vanishes.
#[test]
fn a_relaxation_starts_from_a_path() {
    let relax = "\n[[study]]\nname = \"released\"\nkind = \"relax\"\nstart = \"crush\"\n";
    let run = Run::of(
        "drum-path.toml",
        &[("to = -0.4", "to = -0.33"), ("max_step = 0.05", &format!("max_step = 0.05{relax}"))],
    );
    let last = rows(&run.file("released.csv")).pop().unwrap();
    assert!(number(&last, "energy_total").abs() < 1e-15, "{last:?}");
}

/// Claim: a path goes on from where another one ended: its drive counts from there, and both together do the work of one
/// path all the way.
#[test]
fn a_path_goes_on() {
    let more = "\n[[study]]\nname = \"on\"\nkind = \"path\"\nstart = \"pushed\"\n";
    let run = Run::of(
        "two-bars-push.toml",
        &[("to = -0.7", "to = -0.35"), ("max_step = 0.05", &format!("max_step = 0.05{more}"))],
    );
    let (first, second) = (run.table("pushed"), run.table("on"));
    let [a, b] = [first.last().unwrap(), second.first().unwrap()];
    assert!(number(b, "drive") == 0.0 && (number(b, "reaction") - number(a, "reaction")).abs() < 1e-12, "{b:?}");
    let last = second.last().unwrap();
    assert!((number(last, "reaction") - force(-0.4)).abs() < 1e-11, "{last:?}");
}

/// Claim: the files of a path are those that its chapter lists: a row for each state, pictures of events and ends with
/// the numbers of their rows, and the columns in their order.
#[test]
fn files_of_a_path() {
    let run = Run::of("two-bars-push.toml", &[("kind = \"path\"", "kind = \"path\"\ncheck = [\"self-intersection\"]")]);
    let header = std::fs::read_to_string(run.file("pushed.csv")).unwrap();
    let expected = "branch,step,arc_length,drive,reaction,work,energy_bars,energy_creases,energy_facets,energy_total,\
                    residual_force,residual_length,negative_eigenvalues,event,self_intersecting,state,fold_0_1_0_0,";
    assert!(header.starts_with(expected), "{header}");
    let table = run.table("pushed");
    assert_eq!(table.len(), run.branch("pushed").steps);
    let numbers: Vec<String> = (0..table.len()).map(|row| row.to_string()).collect();
    assert!(table.iter().map(|row| &row["state"]).eq(&numbers), "the column `state` numbers the rows");
    assert_eq!(run.branch("pushed").self_intersecting, Some(false));
    let series = std::fs::read_to_string(run.file("pushed.pvd")).unwrap();
    for (row, _) in
        table.iter().enumerate().filter(|(row, state)| *row + 1 == table.len() || !state["event"].is_empty())
    {
        assert!(series.contains(&format!("timestep=\"{row}.0\"")), "{row}: {series}");
        assert!(run.file(&format!("pushed/pushed_{row:04}.vtu")).exists(), "{row}");
    }
    for picture in ["pushed.svg", "pushed-reaction.svg"] {
        assert!(run.file(picture).exists(), "{picture}");
    }
}

/// Claim: stiffness is driven to exactly rigid bars, where a state of the truss at rest stays as it is.
#[test]
fn stiffness_is_driven_to_rigid() {
    let drive = [("vertices = \"apex\"\naxis = \"z\"\nto = -0.7", "stiffness = \"bars\"\nto = inf")];
    let run = Run::of("two-bars-push.toml", &drive);
    let branch = run.branch("pushed");
    assert_eq!((branch.end.as_str(), branch.drive), ("arrived", None));
    let last = run.table("pushed").pop().unwrap();
    assert!(last["drive"] == "inf" && number(&last, "energy_total").abs() < 1e-20, "{last:?}");
}
