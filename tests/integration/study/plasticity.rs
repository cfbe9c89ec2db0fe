//! Elements that yield, and drives to and fro, against closed forms.
//!
//! Source: the model of kinematic and isotropic hardening in one dimension (J. C. Simo and T. J. R. Hughes,
//! "Computational inelasticity", 1998, 1.2 and 1.4): with the stiffness `k`, the bound `Y` and the slope `r k` beyond it the
//! force follows the elastic line until it meets a line of slope `r k`, and turns back on an elastic one.

use crate::common::{Scene, Table};

/// Two triangles with a hinge of this length, turned in the plane.
fn hinge(length: f64) -> String {
    let at = |x: f64, y: f64| [length * (0.6 * x - 0.8 * y), length * (0.8 * x + 0.6 * y), 0.0];
    let points = [at(0.0, 0.0), at(0.0, 1.0), at(-1.0, 0.5), at(1.0, 0.5)];
    format!("{{\"vertices_coords\": {points:?}, \"faces_vertices\": [[0, 1, 2], [1, 0, 3]]}}")
}

/// A crease that yields, whose angle is driven to these ends one after the other.
fn crease(length: f64, energy: &str, to: &str) -> Scene {
    Scene::on(
        "mesh = \"hinge.fold\"",
        &format!(
            "[energy]\nbars = {{ stiffness = inf }}\ncreases = {{ {energy} }}\n[[lock]]\ncrease = [0, 1, 0, 0]\nangle = 0\n\
             [[drive]]\nname = \"turn\"\nlock = [0, 1, 0, 0]\nto = {to}\n[[study]]\nname = \"turned\"\nkind = \"path\"\n"
        ),
    )
    .with("hinge.fold", hinge(length))
}

/// The row in which the drive is here for the `n`th time, counted from 0.
fn row_at(table: &Table, drive: f64, n: usize) -> usize {
    let rows = (0..table.len()).filter(|&row| table.at(row, "drive") == drive);
    rows.clone().nth(n).unwrap_or_else(|| panic!("{drive} is passed {} times", rows.count()))
}

/// Claim: in every row the work of the drive is the energy and what was dissipated, since both are functions of the state
/// and its memory. Tolerance: rounding of their sum; `size` is that of energies.
fn work_is_stored_or_lost(table: &Table, size: f64) {
    for row in 0..table.len() {
        let [work, energy, lost] = ["work", "energy_total", "dissipated"].map(|column| table.at(row, column));
        assert!((work - energy - lost).abs() <= 1e-13 * (size + work.abs()), "row {row}: {work} {energy} {lost}");
    }
}

/// Claim: the torque of a hinge that is turned to and fro between -1 and 1 is that of the closed form where it turns back,
/// for kinematic, isotropic, mixed and no hardening, in other units and lengths; and in a loop that closes the dissipation
/// is the area. Tolerance: 1e-10, the angle is kept to 1e-12.
#[test]
fn a_hinge_has_the_loop_of_the_closed_form() {
    for (unit, length, slope, isotropic) in
        [(1.0, 1.0, 0.1, 0.0), (1.0, 2.5, 0.3, 1.0), (1e-6, 1e3, 0.2, 0.5), (1e5, 1.0, 0.0, 0.0)]
    {
        let (k, bound) = (2.0 * unit, 0.6 * unit);
        let energy = format!(
            "stiffness = {k:e}, yield = {{ moment = {bound:e}, hardening = {slope}, isotropic = {isotropic} }}"
        );
        let ran = crease(length, &energy, "[1.0, -1.0, 1.0, -1.0]").converged();
        let table = ran.out.table("turned.csv");
        work_is_stored_or_lost(&table, unit * length);
        // the torque where it turns: a line of slope r k through the bounds, which isotropic hardening moves apart
        let hardening = slope / (1.0 - slope);
        let (mut plastic, mut gone, mut expected) = (0.0f64, 0.0f64, vec![]);
        for end in [1.0, -1.0, 1.0, -1.0f64] {
            let center = (1.0 - isotropic) * hardening * k * plastic;
            let trial = k * (end - plastic) - center;
            let change = ((trial.abs() - bound - isotropic * hardening * k * gone) / (k * (1.0 + hardening))).max(0.0);
            (plastic, gone) = (plastic + change * trial.signum(), gone + change);
            let lost = bound * gone + 0.5 * isotropic * hardening * k * gone * gone;
            expected.push((end, length * k * (end - plastic), length * lost));
        }
        for (n, (end, torque, lost)) in expected.into_iter().enumerate() {
            let row = row_at(&table, end, n / 2);
            let [found, dissipated] = ["reaction", "dissipated"].map(|column| table.at(row, column));
            let size = length * unit;
            assert!((found - torque).abs() < 1e-10 * size, "{slope} {isotropic}, end {n}: {found} {torque}");
            assert!((dissipated - lost).abs() < 1e-10 * size, "{slope} {isotropic}, end {n}: {dissipated} {lost}");
        }
        // without isotropic hardening the loop from 1 to -1 and back closes: its area, a parallelogram, is dissipated
        if isotropic == 0.0 {
            let area = 4.0 * bound * (1.0 - bound / k) * length / (1.0 + hardening);
            let [first, second] = [0, 1].map(|n| table.at(row_at(&table, 1.0, n), "dissipated"));
            assert!((second - first - area).abs() < 1e-10 * length * unit, "{slope}: {} {area}", second - first);
        }
    }
}

/// Claim: two bars that yield, soft or so stiff that their tensions are unknowns, have at every displacement of their apex
/// the force of a bar whose tension changes by `EA` times the strain and never exceeds the bound; on the way back too.
/// Source: the rate form of ideal plasticity, summed row by row. Tolerance: 1e-9 of
/// the bound, and what the rounding of a length makes of it.
#[test]
fn bars_yield() {
    for stiffness in [1.0, 1e6] {
        let bound = 0.01;
        let scene = Scene::of("two-bars-push")
            .replaced("stiffness = 1.0", &format!("stiffness = {stiffness:?}, yield = {{ force = {bound} }}"))
            .replaced("to = -0.7", "to = [-0.1, 0.05, -0.2]");
        let ran = scene.converged();
        let table = ran.out.table("pushed.csv");
        let length = |drive: f64| 1f64.hypot(0.3 + drive);
        let (mut tension, mut before) = (0.0f64, length(0.0));
        for row in 0..table.len() {
            let drive = table.at(row, "drive");
            let now = length(drive);
            tension = (tension + stiffness * (now - before) / length(0.0)).clamp(-bound, bound);
            before = now;
            let force = 2.0 * tension * (0.3 + drive) / now;
            let found = table.at(row, "reaction");
            assert!(
                (found - force).abs() < 1e-9 * bound + 1e-15 * stiffness,
                "EA {stiffness}, {drive}: {found} {force}"
            );
        }
        work_is_stored_or_lost(&table, f64::max(1.0, 1e-3 * stiffness));
        assert!(table.last("dissipated") > bound * 0.05);
    }
}

/// Claim: under a load the path of two bars goes on over the kink at which they yield, where the load is largest; every row
/// has the load of the rate form of hardening, written as the bound that a tension on its way meets. Source: the same bars,
/// of which the limit is the force at which the tension is the bound. Tolerance: 1e-9 of the bound.
#[test]
fn a_load_is_passed_where_bars_yield() {
    let (bound, slope) = (0.02, 0.01);
    let energy = format!("stiffness = 1.0, yield = {{ force = {bound}, hardening = {slope} }}");
    let ran = Scene::of("two-bars-load").replaced("stiffness = 1.0", &energy).converged();
    let table = ran.out.table("loaded.csv");
    let length = |height: f64| 1f64.hypot(height);
    let rest = length(0.3);
    let (mut tension, mut centre, mut before) = (0.0f64, 0.0f64, rest);
    for row in 0..table.len() {
        let height = 0.3 - table.at(row, "reaction");
        let now = length(height);
        let strain = (now - before) / rest;
        before = now;
        // beyond the bounds, which move with the plastic strain, the tension has the slope of the hardening
        let trial = tension + strain;
        let over = trial - trial.clamp(centre - bound, centre + bound);
        tension = trial - over * (1.0 - slope);
        centre += over * slope;
        let load = -2.0 * tension * height / now;
        assert!((table.at(row, "drive") - load).abs() < 1e-9 * bound, "row {row}: {} {load}", table.at(row, "drive"));
    }
    let at_yield = rest * (1.0 - bound);
    let largest = 2.0 * bound * (at_yield * at_yield - 1.0).sqrt() / at_yield;
    let events = &ran.path("loaded").branches[0].events;
    let limit = events.iter().find(|event| event.event == "limit-load").and_then(|event| event.drive).unwrap();
    assert!((limit - largest).abs() < 1e-9, "{limit} {largest}");
}

/// Claim: a path in two parts, the second from the state or from the file of the first, ends where the whole one ends, with
/// the same dissipation. Tolerance: 1e-11; files have all digits.
#[test]
fn memory_starts_again() {
    let energy = "stiffness = 2.0, yield = { moment = 0.6, hardening = 0.1, isotropic = 0.3 }";
    let whole = crease(1.0, energy, "[1.0, -1.0]").converged().out.table("turned.csv");
    let back = "[[drive]]\nname = \"back\"\nlock = [0, 1, 0, 0]\nto = -1.0\n[[study]]\nname = \"back\"\nkind = \"path\"\n\
                drive = \"back\"\nstart = ";
    let first = crease(1.0, energy, "1.0").replaced("kind = \"path\"", "kind = \"path\"\ndrive = \"turn\"");
    let ran = first.clone().then(&format!("{back}\"turned\"\n")).converged();
    let file = format!("turned/turned_{:04}.vtu", ran.path("turned").branches[0].steps - 1);
    let again = crease(1.0, energy, "1.0").replaced("kind = \"path\"", "kind = \"path\"\ndrive = \"turn\"");
    let again = again.then(&format!("{back}\"state.vtu\"\n")).with("state.vtu", ran.out.bytes(file)).converged();
    for parts in [ran.out.table("back.csv"), again.out.table("back.csv")] {
        for column in ["reaction", "energy_total", "dissipated"] {
            let [found, expected] = [&parts, &whole].map(|table| table.last(column));
            assert!((found - expected).abs() < 1e-11, "{column}: {found} {expected}");
        }
    }
}

/// Claim: a path to and fro that is stopped, before or behind its turn, and resumed, has the files of one that was not.
#[test]
fn an_interrupted_loop_goes_on() {
    let scene = crease(1.0, "stiffness = 2.0, yield = { moment = 0.6, hardening = 0.1 }", "[1.0, -1.0, 0.5]");
    let whole = scene.clone().converged();
    for stop in [12, 26, 40] {
        let scene = scene.clone().out(format!("stopped-{stop}"));
        assert!(scene.clone().stopped_after(stop - 1).ran().report.interrupted);
        scene.resumed().converged().out.assert_same(&whole.out, &format!("stopped at {stop}"));
    }
}

/// Claim: an elastic sheet that is driven to and fro comes back along its own states, and nothing is dissipated: where the
/// drive is listed on both ways the states are the same. Tolerance: 1e-9, states are equilibria to 1e-12.
#[test]
fn elastic_sheets_come_back() {
    let scene = Scene::of("two-bars-push").replaced("to = -0.7", "to = [-0.7, 0.1]");
    let ran = scene.replaced("max_step = 0.05", "max_step = 0.05\nat = [-0.1, -0.2, 0.05]").converged();
    let table = ran.out.table("pushed.csv");
    for drive in [-0.1, -0.2] {
        let [there, back] = [0, 1].map(|n| table.at(row_at(&table, drive, n), "reaction"));
        assert!((there - back).abs() < 1e-9, "{drive}: {there} {back}");
    }
    let branch = &ran.path("pushed").branches[0];
    assert!(
        branch.end == "arrived" && branch.dissipated.is_none() && row_at(&table, 0.05, 0) > row_at(&table, -0.7, 0)
    );
}

/// Claim: a Miura-ori sheet of creases that yield, with soft bars and in other units, has in every row as much work as
/// energy and dissipation, and its hysteresis loop has the area of its dissipation. Tolerance: rounding; the area by the
/// trapezoidal rule over the rows, 1 %.
#[test]
fn a_sheet_has_a_loop() {
    let ran = Scene::of("miura-yield").converged();
    let table = ran.out.table("pulled.csv");
    work_is_stored_or_lost(&table, 1.0);
    let [drive, force] = ["drive", "reaction"].map(|column| table.column(column));
    let area: f64 = (1..drive.len()).map(|k| 0.5 * (force[k] + force[k - 1]) * (drive[k] - drive[k - 1])).sum();
    let work = table.last("work");
    assert!((area - work).abs() < 0.01 * work && table.last("dissipated") > 0.5 * work, "{area} {work}");
    assert!(ran.out.has("pulled/pulled_0000.vtu") && ran.out.text("pulled/pulled_0000.vtu").contains("plastic_angle"));
}

/// Claim: laws that are given as a list, one for each edge, are those of their edges only: the creases
/// without one are springs.
#[test]
fn laws_of_single_edges() {
    use foldwell::model::{Law, OfAngle, Power};
    use foldwell::{Assembly, Pattern, Rest, generate, relax};
    use std::sync::Arc;
    let sheet = generate(&Pattern::named("miura").unwrap()).unwrap();
    let given = Assembly::patch(sheet.clone(), [2, 2]).bars(1e3).creases(1.0).rest(Rest::Assigned(0.3));
    let edges = given.clone().build().unwrap().edges();
    let law: Arc<dyn Law> = Arc::new(OfAngle(Power { exponent: 1.0 }));
    let energy = |laws: Vec<Option<Arc<dyn Law>>>| {
        relax(&given.clone().crease_law(laws).build().unwrap()).unwrap().state.total()
    };
    let spring = relax(&given.clone().build().unwrap()).unwrap().state.total();
    let mixed = energy((0..edges).map(|edge| (edge % 2 == 0).then(|| law.clone())).collect());
    assert!((mixed - spring).abs() < 1e-9 * spring, "a power of 1 is a spring: {mixed} {spring}");
    let stiffer: Arc<dyn Law> = Arc::new(OfAngle(Power { exponent: 1.5 }));
    let [none, half, all] = [0, 2, 1].map(|every| {
        energy((0..edges).map(|edge| (every > 0 && edge % every == 0).then(|| stiffer.clone())).collect())
    });
    assert!((none - spring).abs() < 1e-9 * spring && (half - none).abs() > 1e-3 && (half - all).abs() > 1e-3);
    assert!(given.crease_law(vec![None; edges + 1]).build().is_err(), "one law too many");
}

/// Claim: studies whose states do not depend on how they are reached refuse what yields, and branches are not asked for
/// where they are not sought.
#[test]
fn what_is_not_sought_is_refused() {
    let yields =
        |kind: &str| crease(1.0, "stiffness = 1.0, yield = { moment = 0.1 }", "1.0").replaced("kind = \"path\"", kind);
    yields("kind = \"wells\"").refused("those of creases that yield do");
    yields("kind = \"path\"\nswitch = true").refused("branches are not sought where elements yield");
    let springs = |to: &str, key: &str| crease(1.0, "stiffness = 1.0", to).then(key);
    springs("[1.0, 0.5]", "switch = true\n").refused("branches are not followed where a drive goes to and fro");
    springs("[1.0, 1.0]", "").refused("the drive stays at 1");
    springs("[]", "").refused("this is no end of a drive");
    springs("[1.0, -0.5]", "at = [-0.7]\n").refused("the drive `turn` does not pass −0.7: it goes from −0.5 to 1");
}

/// Claim: a sheet in which elements yield is not asked to snap, since what yields on the way there depends on its motion; a
/// fold of such a sheet does not snap by itself. Source: an overdamped motion of the two bars dissipates 7.8e-4 on its way
/// over, past a strain of twice that at which they yield, and one step to the minimum dissipates nothing.
#[test]
fn yielding_sheets_do_not_snap() {
    let bars = "{ stiffness = 1.0, yield = { force = 0.02, hardening = 0.2 } }";
    let scene = Scene::of("two-bars-load").replaced("max_step = 0.05", "max_step = 0.05\nsnap = true");
    scene
        .replaced("bars = { stiffness = 1.0 }", &format!("bars = {bars}"))
        .refused("depends on its motion where elements yield");
    let creases = "{ stiffness = 1.0, rest = \"assigned\", yield = { moment = 20.0, hardening = 0.1 } }";
    let energy =
        format!("[energy]\nbars = {{ stiffness = 1e3 }}\nfacets = {{ stiffness = 10.0 }}\ncreases = {creases}\n");
    let study = "[[study]]\nname = \"fold\"\nkind = \"fold\"\ndraw = []";
    let ran = Scene::on("mesh = \"cases/fold/bird-base.fold\"", &format!("{energy}{study}")).ran();
    let events = &ran.path("fold").branches[0].events;
    assert!(events.iter().any(|event| event.event == "limit-load") && events.iter().all(|event| event.event != "snap"));
}
