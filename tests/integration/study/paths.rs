//! Driven paths: limit points, second states and events of structures with closed forms.
//!
//! Sources: the two-bar truss of von Mises (ZAMM 3, 1923), whose load is `F(z) = -2 EA/L0 (l - L0) z / l` at height `z`
//! with `l^2 = w^2 + z^2`; the drum of Kresling's pattern, whose bars have the lengths `sqrt(h^2 + 2 - 2 cos t)` and
//! `sqrt(h^2 + 2 - 2 cos(t - pi/3))` at height `h` and twist `t`, minimised over the twist.

use crate::common::{Ran, Scene, Table};
use foldwell::study::path::PathBranchSummary;

/// Returns the only branch of a path.
fn branch<'a>(ran: &'a Ran, study: &str) -> &'a PathBranchSummary {
    &ran.path(study).branches[0]
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
/// the closed form, and the path arrives. Tolerance: limit points are located to 1e-10; states balance to 1e-12 of the
/// largest force.
#[test]
fn two_bars_are_pushed_through() {
    let ran = Scene::of("two-bars-push").converged();
    let branch = branch(&ran, "pushed");
    assert_eq!(branch.end, "arrived");
    assert!(branch.stable, "a single vertex that is held has no unstable state");
    let found = events(branch, "limit-load");
    assert_eq!(found.len(), 2, "{found:?}");
    for ([drive, reaction], side) in found.iter().zip([1.0, -1.0]) {
        assert!((0.3 + drive - side * LIMIT[0]).abs() < 1e-10, "{drive}");
        assert!((reaction + side * LIMIT[1]).abs() < 1e-11, "{reaction}");
    }
    let table = ran.out.table("pushed.csv");
    for row in 0..table.len() {
        let at = |column: &str| table.at(row, column);
        assert!((at("reaction") - force(0.3 + at("drive"))).abs() < 1e-11, "{:?}", table.rows[row]);
        assert!((at("work") - at("energy_total")).abs() < 1e-8 * LIMIT[1], "{:?}", table.rows[row]);
    }
    assert!((table.last("drive") + 0.7).abs() < 1e-12);
}

/// Claim: two bars under a growing load lose stability at the limit load, are unstable between the two limit points,
/// and go on to the load that was asked for. Source and tolerances as above; the load points down, so that the factor
/// is `-dE/dz` and its conjugate is the height's fall.
#[test]
fn two_bars_under_a_load_snap_through() {
    let ran = Scene::of("two-bars-load").converged();
    let branch = branch(&ran, "loaded");
    assert_eq!(branch.end, "arrived");
    assert!(!branch.stable);
    let found = events(branch, "limit-load");
    assert_eq!(found.len(), 2, "{found:?}");
    for ([factor, _], side) in found.iter().zip([1.0, -1.0]) {
        assert!((factor - side * LIMIT[1]).abs() < 1e-11, "{factor}");
    }
    let table = ran.out.table("loaded.csv");
    let limits: Vec<usize> = (0..table.len()).filter(|&k| table.field(k, "event") == "limit-load").collect();
    for k in (0..table.len()).filter(|&k| table.field(k, "event").is_empty()) {
        let between = (limits[0]..limits[1]).contains(&k);
        assert_eq!(table.field(k, "negative_eigenvalues"), if between { "1" } else { "0" }, "{k}");
    }
}

/// Height below the drawn 1.2, and force, of the limit points of the drum, from the two numbers of the closed form in
/// 40 digits; and its second state.
const DRUM: [[f64; 2]; 2] =
    [[1.145_092_671_426_46 - 1.2, -1.015_608_266_287_35e-3], [0.962_532_976_931_361 - 1.2, 8.030_698_430_453_93e-4]];
const SECOND_STATE: f64 = 0.877_968_604 - 1.2;

/// Claim: a drum whose lid turns freely has its limit points and its second state without energy where the closed form
/// has them. Tolerance: the digits of the source, nine of heights and eight of forces; 1.4e-6 beside the second state
/// the force is that distance times a stiffness of 0.017, and the energy half of both together.
#[test]
fn a_drum_is_crushed() {
    let ran = Scene::of("drum-path").replaced("to = -0.4", &format!("to = {SECOND_STATE}")).converged();
    let branch = branch(&ran, "crush");
    assert_eq!(branch.end, "arrived");
    let found = events(branch, "limit-load");
    assert_eq!(found.len(), 2, "{found:?}");
    for ([drive, reaction], [height, force]) in found.iter().zip(DRUM) {
        assert!((drive - height).abs() < 1e-10, "{drive} {height}");
        assert!((reaction - force).abs() < 1e-13, "{reaction} {force}");
    }
    let [energy, reaction] = ["energy_total", "reaction"].map(|column| ran.out.table("crush.csv").last(column));
    assert!(energy.abs() < 1e-16 && reaction.abs() < 1e-10, "{energy} {reaction}");
}

/// Claim: a path ends exactly at a stop, with an event of its own.
#[test]
fn a_path_stops() {
    let stop = "max_step = 0.05\nstop = { arc_length = 0.31 }";
    let ran = Scene::of("two-bars-push").replaced("max_step = 0.05", stop).converged();
    let branch = branch(&ran, "pushed");
    assert_eq!(branch.end, "stop");
    let last = branch.events.last().unwrap();
    assert!(last.event == "stop" && (last.arc_length - 0.31).abs() < 1e-9, "{last:?}");
}

/// Claim: a relaxation that starts where a path ended finds the second state of the drum, in which no bar is strained:
/// released from near it, the energy vanishes.
#[test]
fn a_relaxation_starts_from_a_path() {
    let relax = "\n[[study]]\nname = \"released\"\nkind = \"relax\"\nstart = \"crush\"\n";
    let scene = Scene::of("drum-path").replaced("to = -0.4", "to = -0.33");
    let ran = scene.replaced("max_step = 0.05", &format!("max_step = 0.05{relax}")).converged();
    let energy = ran.out.table("released.csv").last("energy_total");
    assert!(energy.abs() < 1e-15, "{energy}");
}

/// Claim: a path goes on from where another one ended: its drive counts from there, and both together do the work of
/// one path all the way.
#[test]
fn a_path_goes_on() {
    let more = "\n[[study]]\nname = \"on\"\nkind = \"path\"\nstart = \"pushed\"\n";
    let scene = Scene::of("two-bars-push").replaced("to = -0.7", "to = -0.35");
    let ran = scene.replaced("max_step = 0.05", &format!("max_step = 0.05{more}")).converged();
    let [first, second] = ["pushed.csv", "on.csv"].map(|name| ran.out.table(name));
    let begins = second.at(0, "reaction");
    assert!(second.at(0, "drive") == 0.0 && (begins - first.last("reaction")).abs() < 1e-12, "{begins}");
    assert!((second.last("reaction") - force(-0.4)).abs() < 1e-11, "{}", second.last("reaction"));
}

/// Claim: the files of a path are those that its chapter lists: a row for each state, pictures of events and ends with
/// the numbers of their rows, and the columns in their order.
#[test]
fn files_of_a_path() {
    let check = "kind = \"path\"\ncheck = [\"self-intersection\"]";
    let ran = Scene::of("two-bars-push").replaced("kind = \"path\"", check).converged();
    let header = ran.out.text("pushed.csv");
    let expected = "branch,step,arc_length,drive,reaction,work,energy_bars,energy_creases,energy_facets,energy_total,\
                    residual_force,residual_length,negative_eigenvalues,event,self_intersecting,state,fold_0_1_0_0,";
    assert!(header.starts_with(expected), "{header}");
    let table = ran.out.table("pushed.csv");
    assert_eq!(table.len(), branch(&ran, "pushed").steps);
    assert!((0..table.len()).all(|row| table.field(row, "state") == row.to_string()), "`state` numbers the rows");
    assert_eq!(branch(&ran, "pushed").self_intersecting, Some(false));
    let series = ran.out.text("pushed.pvd");
    let shown = |row: &usize| *row + 1 == table.len() || !table.field(*row, "event").is_empty();
    for row in (0..table.len()).filter(shown) {
        assert!(series.contains(&format!("timestep=\"{row}.0\"")), "{row}: {series}");
        assert!(ran.out.has(format!("pushed/pushed_{row:04}.vtu")), "{row}");
    }
    for picture in ["pushed.svg", "pushed-reaction.svg"] {
        assert!(ran.out.has(picture), "{picture}");
    }
}

/// Claim: a path has a row of its own at each listed value that it passes, exactly there, as often as it passes it, and
/// none at values that it does not reach; the other rows do not change. A probe follows the driven vertex, and the mean
/// of both ends of a bar that stays is zero. Source: the path without the list. Tolerance: rounding errors.
#[test]
fn listed_values_are_rows_and_probes_columns() {
    let plain = Scene::of("two-bars-push").converged().out.table("pushed.csv");
    let keys = "kind = \"path\"\nat = [0.0, -0.25, -0.5, -0.7]\nprobe = [{ name = \"top\", vertices = \"apex\", axis = \"z\" }, \
        { name = \"across\", vertices = \"apex\", axis = \"x\" }]";
    let listed = Scene::of("two-bars-push").replaced("kind = \"path\"", keys).converged().out.table("pushed.csv");
    let at = |value: f64| (0..listed.len()).filter(|&row| listed.at(row, "drive") == value).count();
    // the first and the last state are rows in any case
    assert_eq!([0.0, -0.25, -0.5, -0.7].map(at), [1, 1, 1, 1]);
    let others = (0..listed.len()).filter(|&row| ![-0.25, -0.5].contains(&listed.at(row, "drive")));
    let others: Vec<f64> = others.map(|row| listed.at(row, "drive")).collect();
    assert_eq!(others, (0..plain.len()).map(|row| plain.at(row, "drive")).collect::<Vec<f64>>());
    for row in 0..listed.len() {
        assert!(listed.at(row, "residual_force") <= 1e-12 && listed.field(row, "event").len() != 1);
        let [drive, top, across] = ["drive", "probe_top", "probe_across"].map(|column| listed.at(row, column));
        assert!((top - drive).abs() <= 1e-14 && across.abs() <= 1e-12, "row {row}: {drive} {top} {across}");
    }
    let twice = keys.replace("across\"", "top\"");
    Scene::of("two-bars-push").replaced("kind = \"path\"", &twice).refused("two probes have this name");
    let nobody = keys.replace("\"apex\", axis = \"x\"", "\"apexx\", axis = \"x\"");
    Scene::of("two-bars-push").replaced("kind = \"path\"", &nobody).refused("apexx");
}

/// Claim: a path ends exactly where its drive, a probe or its reaction has a value, with so many states, or at a limit
/// point. Source: the rows of the whole path; the reaction between two of its rows. Tolerance: rounding errors.
#[test]
fn paths_stop_at_what_an_experiment_reads() {
    let whole = Scene::of("two-bars-push").converged().out.table("pushed.csv");
    let probe = "probe = [{ name = \"top\", vertices = \"apex\", axis = \"z\" }]";
    let last = |stop: &str| {
        let keys = format!("kind = \"path\"\n{probe}\nstop = {{ {stop} }}");
        let ran = Scene::of("two-bars-push").replaced("kind = \"path\"", &keys).converged();
        assert_eq!(branch(&ran, "pushed").end, "stop", "{stop}");
        ran.out.table("pushed.csv")
    };
    assert!((last("drive = -0.21").last("drive") + 0.21).abs() <= 1e-12);
    assert!((last("displacement = { probe = \"top\", value = -0.33 }").last("probe_top") + 0.33).abs() <= 1e-12);
    let half = 0.5 * (whole.at(0, "reaction") + whole.at(2, "reaction"));
    assert!((last(&format!("reaction = {half:e}")).last("reaction") - half).abs() <= 1e-12);
    let few = last("states = 4");
    assert!(few.len() == 4 && few.last("drive") == whole.at(3, "drive"));
    let events = |table: &Table| (0..table.len()).filter(|&row| table.field(row, "event").starts_with("limit")).count();
    assert_eq!(events(&whole), 2);
    for count in [1, 2] {
        let found = last(&format!("limit_points = {count}"));
        assert!(events(&found) == count && found.field(found.len() - 1, "event").starts_with("limit"), "{count}");
    }
    // a path of rest angles has no events where its reaction is extreme, and these do not count
    let folding = Scene::of("resch-fold").replaced("kind = \"fold\"", "kind = \"fold\"\nstop = { limit_points = 1 }");
    assert_eq!(branch(&folding.converged(), "folding").end, "arrived");
    let refused = |stop: &str, said: &str| {
        let keys = format!("kind = \"path\"\n{probe}\nstop = {{ {stop} }}");
        Scene::of("two-bars-push").replaced("kind = \"path\"", &keys).refused(said);
    };
    refused("displacement = { probe = \"tip\", value = -0.33 }", "no probe is called `tip`");
    refused("", "no condition to stop at");
    Scene::of("star-trace")
        .replaced("name = \"loops\"", "name = \"loops\"\nstop = { drive = 1.0 }")
        .refused("a trace does not stop there");
}

/// Claim: stiffness is driven to exactly rigid bars, where a state of the truss at rest stays as it is.
#[test]
fn stiffness_is_driven_to_rigid() {
    let [old, new] = ["vertices = \"apex\"\naxis = \"z\"\nto = -0.7", "stiffness = \"bars\"\nto = inf"];
    let ran = Scene::of("two-bars-push").replaced(old, new).converged();
    let branch = branch(&ran, "pushed");
    assert_eq!((branch.end.as_str(), branch.drive), ("arrived", None));
    let table = ran.out.table("pushed.csv");
    let energy = table.last("energy_total");
    assert!(table.field(table.len() - 1, "drive") == "inf" && energy.abs() < 1e-20, "{energy}");
}

/// Claim: values of `at` that lie off the way of the drive are refused with the way and before anything is computed, and
/// so is a stop at which the drive never is; one that a path does not reach, since it ends early, is named.
#[test]
fn listed_values_lie_on_the_way() {
    let scene = Scene::of("two-bars-push");
    for (at, value) in [("at = [0.1]", "0.1"), ("at = [-0.2, -0.9]", "\u{2212}0.9"), ("stop = { drive = 50 }", "50")] {
        let words = format!("the drive `push` does not pass {value}: it goes from 0 to \u{2212}0.7");
        scene.clone().replaced("kind = \"path\"", &format!("kind = \"path\"\n{at}")).refused(&words);
    }
    let early = "kind = \"path\"\nat = [-0.1, -0.4]\nstop = { drive = -0.3 }";
    let ran = scene.clone().replaced("kind = \"path\"", early).converged();
    assert_eq!(ran.path("pushed").not_passed, [-0.4]);
    let said = ran.report.summary.studies[0].sentence();
    assert!(said.contains("not passed: \u{2212}0.4 of `at`"), "{said}");
}

/// Claim: panels that fold without energy have no limit point: all their forces are rounding errors.
#[test]
fn sheets_without_energy_have_no_limits() {
    let ran = Scene::of("thick-miura").converged();
    let branch = branch(&ran, "folded");
    assert!(branch.end == "arrived" && branch.events.is_empty(), "{:?}", branch.events);
}

/// Claim: a tolerance with which no state is an equilibrium is refused, and cells of a finite sheet are said to have no
/// effect.
#[test]
fn settings_that_mean_nothing_are_said() {
    let scene = Scene::of("two-bars-push");
    scene.clone().replaced("kind = \"path\"", "kind = \"path\"\ntolerance = 0.1").refused("states are no equilibria");
    let ran = scene.replaced("[energy]", "cells = [2, 2]\n[energy]").converged();
    assert!(ran.report.summary.notes.iter().any(|note| note.contains("`cells` has no effect")));
}

/// Claim: the picture of the last state has the loads times their factor there, and none where the factor is 0. Source: the
/// force of the scene, 1.
#[test]
fn loads_are_drawn_as_large_as_they_are() {
    let text = "[energy]\nbars = { stiffness = 1.0 }\n[[pin]]\nvertices = [0, 2]\n[[pin]]\nvertex = 1\naxes = \"xy\"\n\
                [[load]]\nvertex = 1\nforce = [0.0, 0.0, -1.0]\n[[drive]]\nname = \"weight\"\nload = true\nto = ";
    for (to, said) in [("0.005", Some("load, at most 0.005")), ("[0.005, 0.0]", None)] {
        let study = "\n[[study]]\nname = \"a\"\nkind = \"path\"\ndraw = [\"svg\"]\n";
        let ran = Scene::on("generate = { pattern = \"truss\" }", &format!("{text}{to}{study}")).converged();
        let picture = ran.out.text("a.svg");
        assert_eq!(picture.contains("load, at most"), said.is_some(), "{to}");
        assert!(said.is_none_or(|said| picture.contains(said)), "{to}");
    }
}
