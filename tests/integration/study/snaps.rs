//! Paths on which a sheet snaps where the driven value turns back.

use super::folds::{folding as drawn, square};
use crate::common::Scene;

/// Returns a scene in which the pattern of this file folds flat by its letters.
fn folding(mesh: &str, energy: &str) -> Scene {
    let energy = format!("[energy]\n{energy}creases = {{ stiffness = 1.0, rest = \"assigned\" }}\n");
    let study = "[[study]]\nname = \"fold\"\nkind = \"fold\"\ndraw = []";
    Scene::on(&format!("mesh = \"{mesh}\""), &format!("{energy}{study}"))
}

/// Bars and facets that give way where a sheet does not fold rigidly.
const SOFT: &str = "bars = { stiffness = 1e3 }\nfacets = { stiffness = 10.0 }\n";

/// Two bars whose apex is pushed down by a load that goes to these values, one after the other.
fn loaded(to: &str, keys: &str) -> Scene {
    let scene = Scene::of("two-bars-load").replaced("to = 0.02", &format!("to = {to}"));
    scene.replaced("max_step = 0.05", &format!("max_step = 0.05\nsnap = true\n{keys}"))
}

/// Claim: crease patterns that do not fold rigidly fold to 100 % of their letters, where no energy is left: they snap to
/// stable states only, and none turns back. Up to the first snap the work is the energy, to its integration; what a snap
/// sets free, work less energy, does not become less. Source: balance of energy; without snaps the paths of bird base
/// and crane turn back to the other side.
#[test]
fn patterns_snap_to_their_flat_fold() {
    for mesh in ["cases/fold/bird-base.fold", "cases/fold/square-twist.fold", "crane.fold"] {
        let ran = folding(mesh, SOFT).converged();
        let (branch, table) = (&ran.path("fold").branches[0], ran.out.table("fold.csv"));
        let snaps = branch.events.iter().filter(|event| event.event == "snap").count();
        assert!(branch.end == "arrived" && branch.stable && snaps > 0, "{mesh}: {branch:?}");
        assert!(branch.energy.is_some_and(|energy| energy < 1e-20), "{mesh}: {:?}", branch.energy);
        assert!(branch.rest_sides.is_some_and(|sides| sides.hinges == sides.on_rest_side), "{mesh}");
        let mut free: f64 = 0.0;
        let mut snapped = false;
        for row in 0..table.len() {
            let at = |column: &str| table.at(row, column);
            snapped |= table.field(row, "event") == "snap";
            let tolerance = 1e-6 * at("work").abs().max(1.0);
            if row > 0 {
                assert!(at("drive") > table.at(row - 1, "drive") - 1e-9, "{mesh}, row {row}");
            }
            assert!(snapped || (at("work") - at("energy_total")).abs() < tolerance, "{mesh}, row {row}");
            assert!(at("work") - at("energy_total") > free - tolerance, "{mesh}, row {row}");
            free = at("work") - at("energy_total");
        }
        let turned = folding(mesh, SOFT).then("\nsnap = false\n").out("path").ran();
        assert!(turned.path("fold").branches[0].events.iter().all(|event| event.event != "snap"), "{mesh}");
    }
}

/// Claim: four traditional bases fold to 100 % with all hinges on the side of their letters; boat, pinwheel and open sink
/// fold flat without energy, the last two by a snap, while the frog base is to keep two creases at right angles, which
/// costs energy. Source: they are traditional, and in the menu of Origami Simulator, drawn anew.
#[test]
fn traditional_bases_fold() {
    let spokes = "M0 0L20 20M80 0L60 20M80 80L60 60M0 80L20 60";
    let petals = "M40 0L28 12L40 40L52 12ZM80 40L68 28L40 40L68 52ZM40 80L52 68L40 40L28 68ZM0 40L12 52L40 40L12 28Z";
    let corners = "M28 12L0 0L12 28M52 12L80 0L68 28M68 52L80 80L52 68M28 68L0 80L12 52";
    let bases = [
        (
            "boat",
            format!("{spokes}M20 60H60M20 20H60M0 40L20 20M80 40L60 20M80 40L60 60M0 40L20 60"),
            "M60 20H80M0 20H20M0 40H80M60 60H80M0 60H20",
            0,
        ),
        ("pinwheel", format!("{spokes}M20 20H60V60H20Z"), "M80 40L60 20M0 40L20 60M20 20L40 0M60 60L40 80", 1),
        ("sink", format!("{spokes}M20 20H60V60H20ZM40 20V60"), "M20 60L60 20M20 20L60 60M40 0V20M40 60V80", 1),
        (
            "frog",
            format!("{petals}{corners}"),
            "M0 0L80 80M0 80L80 0M28 12V0M52 12V0M68 28H80M68 52H80M52 68V80M28 68V80M12 52H0M12 28H0",
            0,
        ),
    ];
    for (name, mountains, valleys, snaps) in bases {
        let half = if name == "frog" { "<path d=\"M0 40H80M40 0V80\" stroke=\"#00f\" opacity=\"0.5\"/>" } else { "" };
        let lines = format!("<path d=\"{mountains}\" stroke=\"#f00\"/><path d=\"{valleys}\" stroke=\"#00f\"/>{half}");
        let ran = drawn("mesh = \"base.svg\"", "target").with("base.svg", square(&lines)).converged();
        let branch = &ran.path("fold").branches[0];
        let sides = branch.rest_sides.unwrap();
        assert!(branch.end == "arrived" && sides.hinges == sides.on_rest_side, "{name}: {branch:?}");
        assert_eq!(branch.events.iter().filter(|event| event.event == "snap").count(), snaps, "{name}");
        assert_eq!(branch.energy.unwrap() < 1e-20, name != "frog", "{name}: {:?}", branch.energy);
    }
}

/// Claim: two bars under a load that goes to and fro snap twice each time round, each time where the load is largest; the
/// work of a whole turn, after which they are where they were, is what the snaps set free. Source: the largest force on
/// two bars of half span 1 and height 0.3, 9.530291997895e-3, is found where their length is the cube root of the drawn
/// one. Tolerance: a snap is made 0.5 % of the way beyond, and its work is known to second order in that.
#[test]
fn two_bars_have_a_loop() {
    let ran = loaded("[0.02, -0.02, 0.02]", "").converged();
    let (branch, table) = (&ran.path("loaded").branches[0], ran.out.table("loaded.csv"));
    let drives = |word: &str| -> Vec<f64> {
        branch.events.iter().filter(|event| event.event == word).filter_map(|event| event.drive).collect()
    };
    let (limits, snaps) = (drives("limit-load"), drives("snap"));
    assert_eq!((branch.end.as_str(), limits.len(), snaps.len()), ("arrived", 3, 3), "{branch:?}");
    for (sign, (limit, snap)) in [1.0, -1.0, 1.0].into_iter().zip(limits.iter().zip(&snaps)) {
        assert!((limit - sign * 9.530291997895e-3).abs() < 1e-9, "{limits:?}");
        assert!((snap - limit - sign * 0.005 * 0.02).abs() < 1e-9, "{snaps:?}");
    }
    let ends: Vec<usize> = (0..table.len()).filter(|row| table.at(*row, "drive") == 0.02).collect();
    let [first, last] = ends[..] else { panic!("{ends:?}") };
    assert!((table.at(first, "energy_total") - table.at(last, "energy_total")).abs() < 1e-12);
    let free = |row: usize| table.at(row, "work") - table.at(row, "energy_total");
    // the load is that of the limit point while it moves
    for row in (0..table.len()).filter(|row| table.field(*row, "event") == "snap") {
        let moved = |column: &str| table.at(row, column) - table.at(row - 1, column);
        assert!((moved("work") - table.at(row - 1, "drive") * moved("reaction")).abs() < 1e-12, "{row}");
    }
    let snapped = (first..last).filter(|row| table.field(*row, "event") == "snap").map(|row| free(row) - free(row - 1));
    let (work, all) = (table.at(last, "work") - table.at(first, "work"), snapped.sum::<f64>());
    assert!(all > 0.0 && (work - all).abs() < 1e-4 * all, "{work} {all}");
}

/// Claim: where the drive ends less than half a per cent beyond a limit point, the sheet snaps before that end and stays on
/// its way to it. Source: the largest force on two bars, see above; the drive ends 1.5e-5 beyond it.
#[test]
fn a_snap_stays_within_the_drive() {
    let ran = loaded("9.545e-3", "").converged();
    let (branch, table) = (&ran.path("loaded").branches[0], ran.out.table("loaded.csv"));
    assert!(branch.end == "arrived" && branch.events.iter().any(|event| event.event == "snap"), "{branch:?}");
    let drives = table.column("drive");
    assert!(drives.is_sorted() && drives.last() == Some(&9.545e-3), "{drives:?}");
}

/// Claim: stops count over snaps, values that are listed or at which to stop are not jumped over, a quantity that jumps over
/// the value at which to stop ends the path behind the jump, and a sheet that snaps follows no branches. Source: the
/// snap of two bars goes from a load of 9.5303e-3 to 9.6303e-3, and from a displacement of 0.129 to 0.649.
#[test]
fn stops_count_over_snaps() {
    let ran = loaded("[0.02, -0.02]", "stop = { limit_points = 2 }").converged();
    let branch = &ran.path("loaded").branches[0];
    assert_eq!((branch.end.as_str(), branch.events.len()), ("stop", 3), "{branch:?}");
    let ran = loaded("0.02", "stop = { states = 20 }").converged();
    let branch = &ran.path("loaded").branches[0];
    assert!(branch.steps == 20 && branch.events.iter().any(|event| event.event == "snap"), "{branch:?}");
    let ran = loaded("0.02", "at = [0.00956]\nstop = { drive = 0.00962 }").converged();
    let table = ran.out.table("loaded.csv");
    assert!((0..table.len()).any(|row| (table.at(row, "drive") - 0.00956).abs() < 1e-15));
    assert!((table.last("drive") - 0.00962).abs() < 1e-12 && table.last("reaction") > 0.6);
    let ran = loaded("0.02", "stop = { reaction = 0.4 }").converged();
    let (table, branch) = (ran.out.table("loaded.csv"), &ran.path("loaded").branches[0]);
    assert_eq!((branch.end.as_str(), branch.events.last().map(|event| event.event.as_str())), ("stop", Some("stop")));
    assert!(table.last("reaction") > 0.6 && table.at(table.len() - 2, "reaction") < 0.2);
    // a limit point so near to the end of the drive that the snap would go beyond it
    for to in ["0.00955", "[0.00955, 0.0]", "[0.00955, 0.02]"] {
        let ran = loaded(to, "").converged();
        let branch = &ran.path("loaded").branches[0];
        let snaps = branch.events.iter().filter(|event| event.event == "snap").count();
        assert_eq!((branch.end.as_str(), snaps), ("arrived", 1), "{to}: {branch:?}");
        assert!(ran.out.table("loaded.csv").column("drive").contains(&0.00955), "{to}");
    }
    // as many states as there are up to the limit point
    let whole = loaded("0.02", "").converged().out.table("loaded.csv");
    let limit = (0..whole.len()).find(|row| whole.field(*row, "event") == "limit-load").unwrap();
    let ran = loaded("0.02", &format!("stop = {{ states = {} }}", limit + 1)).converged();
    let branch = &ran.path("loaded").branches[0];
    assert_eq!((branch.end.as_str(), branch.steps), ("stop", limit + 1));
    loaded("0.02", "switch = true").refused("a sheet that snaps follows no other branches");
}

/// Reports of progress that are of no new state: of files, and of the states that were seen when the run was stopped.
const NOT_STATES: usize = 8;

/// Claim: a fold that was interrupted before, between and after its snaps goes on to the same files as one that was not,
/// and computes no state again.
#[test]
fn an_interrupted_fold_goes_on() {
    let scene = folding("cases/fold/square-twist.fold", SOFT);
    let whole = scene.clone().converged();
    let steps = whole.path("fold").branches[0].steps;
    for stop in [5, steps / 2, steps - 5, steps - 1] {
        let scene = scene.clone().out(format!("stopped-{stop}"));
        assert!(scene.clone().stopped_after(stop - 1).ran().report.interrupted);
        let left = steps - stop + NOT_STATES;
        scene.stopped_after(left).resumed().converged().out.assert_same(&whole.out, &format!("stopped at {stop}"));
    }
}

/// Claim: a path keeps to its curve where another one is next to it, whatever the longest step: an imperfect dome snaps up
/// and down at the same loads. Source: an independent arc-length continuation, which turns at -0.00199265 and never comes
/// to the other curve, whose energy differs by 4e-6 of the largest work. Tolerance: 1e-10, to which limit points are located.
#[test]
fn long_steps_keep_to_their_curve() {
    let text = "[energy]\nbars = { stiffness = 1.0 }\ncreases = { stiffness = 0.001 }\n\
                [[pin]]\nvertices = [6, 7, 8, 9, 10]\n\
                [[load]]\nvertices = [0, 1, 2, 3, 4, 5]\nforce = [0.0, 0.0, -1.0]\n\
                [[drive]]\nname = \"load\"\nload = true\nto = [0.004, -0.004]\n\
                [[study]]\nname = \"p\"\nkind = \"path\"\nsnap = true\ndraw = []\nmax_step = ";
    for max_step in [0.05, 0.1, 0.2, 0.3] {
        let ran = Scene::on("mesh = \"cases/dome-of-five.fold\"", &format!("{text}{max_step}")).converged();
        let events = &ran.path("p").branches[0].events;
        let limits = events.iter().filter(|event| event.event == "limit-load").filter_map(|event| event.drive);
        let limits: Vec<f64> = limits.collect();
        let [up, down] = limits[..] else { panic!("{max_step}: {events:?}") };
        assert!(
            (up - 0.0022165401424).abs() <= 1e-10 && (down + 0.0019926774315).abs() <= 1e-10,
            "{max_step}: {limits:?}"
        );
    }
}
