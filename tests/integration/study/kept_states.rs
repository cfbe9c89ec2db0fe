//! States on the way of a relaxation: `keep_every` of scenes and of the library.

use crate::common::{Scene, mesh};
use foldwell::analysis::relax::{Method, RelaxOptions, Relaxed, relax_from};
use foldwell::analysis::state::State;
use foldwell::kinematics::folding_modes;
use foldwell::model::{Gauge, Model, TermKind};
use foldwell::sheet::fold;
use foldwell::{Assembly, RIGID, Rest};
use serde_json::Value;
use std::num::NonZeroUsize;

use crate::sheet::targets::FLAT as WATERBOMB;

fn relaxed(model: &Model, method: Method, keep_every: Option<usize>) -> Relaxed {
    let keep_every = keep_every.and_then(NonZeroUsize::new);
    relax_from(model, model.start(), RelaxOptions { method, keep_every, ..RelaxOptions::default() }, &mut |_| true)
        .unwrap()
}

/// The work of the tensions on the gaps of bars that are still open, `sum t (L - L0 - t/k)`, which the merit of a
/// history counts and the energy of a state does not. `t/k` times `t` is twice the energy of the bars.
fn work_on_gaps(model: &Model, state: &State) -> f64 {
    let bars = model.stiff().filter(|element| element.kind() == TermKind::Bars);
    let on_edges = bars.filter_map(|bar| Some((bar.edge()?, bar.spring.rest)));
    let work = on_edges.map(|(edge, rest)| state.tension[edge] * state.strain[edge] * rest);
    work.sum::<f64>() - 2.0 * state.energy_bars
}

/// The drawn angles of all edges plus those of the folding mode that rolls the star cell about its first lattice
/// vector.
fn bent(assembly: &Assembly) -> Rest {
    let rates = folding_modes(assembly.sheet()).unwrap().named([0.0, 0.1, 0.0]).unwrap();
    let angles = assembly.tiling().edges.iter().zip(assembly.drawn_angles());
    Rest::PerEdge(angles.map(|(edge, angle)| angle + rates[edge.edge]).collect())
}

/// One assembly for every way of relaxing: moved vertices, fold angles, a screw, bars that stretch for a while.
fn ways() -> Vec<(&'static str, Assembly, Method)> {
    let star = |cells: usize, bars: f64| {
        let builder = || Assembly::patch(mesh("open-star"), [cells, cells]).bars(bars).creases(1.0);
        builder().rest(bent(&builder().build().unwrap())).build().unwrap()
    };
    let screw = || Assembly::screw(mesh("open-star"), [1, 1]).bars(RIGID).creases(1.0);
    let flat = Assembly::patch(fold::parse(WATERBOMB, "waterbomb.fold").unwrap(), [1, 1]).bars(RIGID).creases(1.0);
    vec![
        ("rigid", star(6, RIGID), Method::Vertices),
        ("soft", star(6, 1e3), Method::Vertices),
        ("angles", star(6, RIGID), Method::Intrinsic),
        ("angles and lengths", star(6, 1e3), Method::Intrinsic),
        ("auto", star(12, RIGID), Method::Auto),
        ("screw", screw().rest(bent(&screw().build().unwrap())).build().unwrap(), Method::Auto),
        ("flat", flat.rest(Rest::Assigned(0.2)).build().unwrap(), Method::Auto),
    ]
}

/// Claim: in every way of relaxing there is one state for each step of the history, it has the energy of that step, and
/// the last one is the result, bit by bit; keeping states changes no bit of the history or the result.
/// Tolerance: the merit of a step in positions is the energy and the work on gaps that are still open; both are sums of
/// some thousand terms in different orders. 1e-13 of the largest energy is a hundred times what was measured.
#[test]
fn a_state_for_each_step() {
    for (name, assembly, method) in ways() {
        let model = assembly.model(Gauge::Held);
        let found = relaxed(&model, method, Some(1));
        let iterations: Vec<usize> = found.kept.iter().map(|kept| kept.iteration).collect();
        assert_eq!(iterations, Vec::from_iter(0..found.history.len()), "{name}");
        let scale = found.history.iter().fold(0.0f64, |most, step| most.max(step.energy));
        for (kept, step) in found.kept.iter().zip(&found.history) {
            let open = if step.intrinsic { 0.0 } else { work_on_gaps(&model, &kept.state) };
            let off = (kept.state.total() + open - step.energy).abs();
            assert!(off <= 1e-13 * scale, "{name} {}: {} and {}", kept.iteration, kept.state.total(), step.energy);
        }
        let bits = |state: &State| format!("{state:?}");
        assert_eq!(bits(&found.kept.last().unwrap().state), bits(&found.state), "{name}");
        let plain = relaxed(&assembly.model(Gauge::Held), method, None);
        assert!(plain.kept.is_empty(), "{name}");
        assert_eq!((bits(&plain.state), &plain.history), (bits(&found.state), &found.history), "{name}");
    }
    let used: Vec<_> = ways()
        .into_iter()
        .map(|(_, assembly, method)| {
            let found = relaxed(&assembly.model(Gauge::Held), method, None);
            (found.history.iter().any(|step| step.intrinsic), !found.soft_steps.is_empty())
        })
        .collect();
    let expected =
        [(false, false), (false, false), (true, false), (true, false), (true, false), (false, false), (false, true)];
    assert_eq!(used, expected, "the ways that the claim names were taken");
}

/// Returns a relaxation of four by four star cells with these keys.
fn scene(keys: &str) -> Scene {
    let rest = "{ mode = [0.0, 0.1, 0.0], amplitude = 1.0 }";
    Scene::on(
        "mesh = \"open-star.fold\"\ncells = [4, 4]",
        &format!(
            "[energy]\nbars = {{ stiffness = inf }}\ncreases = {{ stiffness = 1.0, rest = {rest} }}\n\
             [[study]]\nname = \"r\"\nkind = \"relax\"\n{keys}"
        ),
    )
}

/// Claim: `keep_every = 2` writes the iterates 0, 2, 4, ... and the last one: as rows of the table with their
/// iterations and energies, as files of the series with the iteration as their time, on the page, and in the film; the
/// last file is the one that a run without the key writes last, bit by bit. Energies: of rigid bars on which the last
/// state is closed to 1e-12 of a length, at tensions of some hundred torques, 1e-10.
#[test]
fn tables_series_pages_and_films_show_the_way() {
    let ran = scene("keep_every = 2\ndraw = [\"vtk\", \"html\"]").converged();
    let out = &ran.out;
    let history: Vec<f64> = ran.relaxed("r").history.iter().map(|row| row.energy).collect();
    let last = history.len() - 1;
    let expected: Vec<usize> = (0..last).step_by(2).chain([last]).collect();
    assert!(last >= 4, "{last} iterations are enough for this test");

    let table = out.table("r.csv");
    let steps: Vec<usize> = table.column("step").iter().map(|&step| step as usize).collect();
    assert_eq!(steps, expected);
    let energies = table.column("energy_total");
    assert!((energies[0] - history[0]).abs() < 1e-12 * history[0]);
    assert!((energies[steps.len() - 1] - history[last]).abs() < 1e-10 * history[last]);

    let series = out.text("r.pvd");
    let times: Vec<f64> =
        series.split("timestep=\"").skip(1).map(|rest| rest.split('"').next().unwrap().parse().unwrap()).collect();
    assert_eq!(times, expected.iter().map(|&step| step as f64).collect::<Vec<_>>());
    let files: Vec<_> = (0..=expected.len()).map(|row| out.has(format!("r/r_{row:04}.vtu"))).collect();
    assert!(!files[expected.len()] && files[..expected.len()].iter().all(|there| *there));
    let end = scene("draw = [\"vtk\"]").converged().out.bytes("r/r_0001.vtu");
    assert!(out.bytes(format!("r/r_{:04}.vtu", expected.len() - 1)) == end);

    let page = out.text("r.html");
    let (_, data) = page.split_once("id=\"data\">").unwrap();
    let data: Value = serde_json::from_str(data.split_once("</script>").unwrap().0).unwrap();
    assert_eq!(data["studies"][0]["sheet"]["states"].as_array().unwrap().len(), expected.len());
    out.foldwell("film r.pvd --size 100").well();
    let mut film = gif::DecodeOptions::new().read_info(std::fs::File::open(out.file("r.gif")).unwrap()).unwrap();
    let mut frames = 0;
    while film.read_next_frame().unwrap().is_some() {
        frames += 1;
    }
    assert!(frames >= expected.len(), "{frames} frames");
}

/// Claim: a relaxation that finds no equilibrium shows its way too, up to its last state.
#[test]
fn a_way_without_end() {
    let scene = "[sheet]\ngenerate = { pattern = \"miura\" }\ncells = [2, 2]\n[energy]\nbars = { stiffness = inf }\n\
                 creases = { stiffness = 1.0, rest = \"flat\" }\n[[study]]\nname = \"r\"\nkind = \"relax\"\n\
                 keep_every = 1\ntolerance = 1e-300\n";
    let out = Scene::new(scene).program("--quiet").ends(1).folder;
    let iterations = out.studies()[0]["history"].as_array().unwrap().len();
    assert!(iterations > 2);
    assert_eq!(out.table("r.csv").column("step"), (0..iterations).map(|step| step as f64).collect::<Vec<_>>());
}
