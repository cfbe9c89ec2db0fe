//! Runs of landscapes: files, resuming, refusals.

use crate::common::{Folder, Scene, mesh};
use approx::{abs_diff_eq, assert_abs_diff_eq};
use foldwell::kinematics::folding_modes_with_locked;
use foldwell::sheet::generate::{Pattern, generate};
use foldwell::sheet::{Edge, EdgeKind};

const MAP: &str = "modes = [[1, 1, 0]]\namplitudes = [0.001]\nmap = { amplitude = 0.01, rings = 3 }";

fn scene(sheet: &str, energy: &str, study: &str) -> Scene {
    let study = format!("[energy]\n{energy}\n[[study]]\nname = \"a\"\nkind = \"landscape\"\n{study}");
    Scene::on(sheet, &study).threads(1)
}

const PATCH: &str = "mesh = \"open-star.fold\"\ndomain = \"patch\"\ncells = [3, 3]";
const TORUS: &str = "mesh = \"star-wave.fold\"\ndomain = \"torus\"\ncells = [5, 5]";
const RIGID: &str = "bars = { stiffness = inf }\ncreases = { stiffness = 1.0 }";
const SOFT: &str = "bars = { stiffness = 1e3 }\ncreases = { stiffness = 1.0 }";

/// Claim: a map has a sample for every direction and its zeros on the exact cone; an interrupted map is continued and
/// ends with the same bytes, also with another number of threads and where its log was damaged.
#[test]
fn maps_go_on_where_they_stopped() {
    let scene = scene(PATCH, RIGID, MAP);
    let (whole, parts) = (scene.clone().out("whole").threads(2).converged(), scene.out("parts"));
    let map = whole.landscape("a").map.as_ref().unwrap();
    assert!(map.samples == 62 && map.failed == 0);
    assert!(map.cone_points == 192 && map.cone_distance.unwrap() <= 1e-6, "{map:?}");

    let interrupted = parts.clone().stopped_after(40).ran();
    assert!(!interrupted.study("a").converged);
    let (whole, out) = (whole.out, interrupted.out);
    let [done, all] = [&out, &whole].map(|out| out.text("a-map.csv").lines().count());
    assert!(1 < done && done < all, "{done} of {all}");
    // a sample whose energy was changed, and those after it, are not used
    let kept = out.text("a.map.jsonl");
    let damaged = kept.lines().nth(done / 2).unwrap();
    out.write("a.map.jsonl", kept.replace(damaged, &damaged.replacen("e-", "e-1", 1)));
    assert!(damaged.contains("e-"), "{damaged}");
    parts.resumed().converged();
    assert!(!out.has("a.map.jsonl"));
    for file in ["a.csv", "a-map.csv", "a.svg", "a-map.svg", "a.pvd", "a/a_map.vtp"] {
        assert_eq!(whole.bytes(file), out.bytes(file), "{file}");
    }
}

/// Claim: a map does not go on from the rows of another scene, which an earlier run left in the folder, if the run in
/// between was stopped before it began its own.
#[test]
fn maps_of_other_scenes_are_not_continued() {
    // the study before the map is the one that is stopped
    let folder = Folder::new();
    let after_a_relaxation = |energy: &str| {
        let relaxed = "[[study]]\nname = \"first\"\nkind = \"relax\"\n[[study]]\nname = \"a\"";
        let scene = scene(PATCH, energy, MAP).replaced("[[study]]\nname = \"a\"", relaxed);
        scene.within(&folder).threads(2)
    };
    after_a_relaxation(SOFT).converged();
    let rigid = after_a_relaxation(RIGID);
    assert!(!rigid.clone().stopped_after(0).ran().study("first").converged);
    let map = rigid.clone().resumed().converged().out.text("a-map.csv");
    assert!(map == rigid.out("fresh").converged().out.text("a-map.csv"));
}

/// Claim: a wave on a torus is named, relaxed and predicted; its summary gives the wave, and no curvature.
#[test]
fn waves_are_named() {
    let ran = scene(TORUS, SOFT, "modes = [{ wave = [2, 3] }]\namplitudes = [0.001, 0.0005]").converged();
    let mode = &ran.landscape("a").modes[0];
    assert!(mode.wave == Some([2, 3]) && mode.mode.is_none() && mode.defect.is_none());
    assert!(abs_diff_eq!(mode.exponent.unwrap(), 6.0, epsilon = 0.05), "{mode:?}");
    assert_eq!(mode.samples.iter().map(|sample| sample.amplitude).collect::<Vec<_>>(), [0.0005, 0.001]);
}

/// Claim: a mode given by its rates is the same as that given by its curvatures.
#[test]
fn modes_by_rates() {
    let both = "modes = [[1, 1, 0], { rates = \"mode.csv\" }]\namplitudes = [0.001]";
    let sheet = mesh("open-star");
    let rates = foldwell::kinematics::folding_modes(&sheet).unwrap().named([1.0, 1.0, 0.0]).unwrap();
    let row = |(edge, rate): (&foldwell::sheet::Edge, &f64)| {
        let key = &edge.key;
        format!("{},{},{},{},{rate:?}\n", key.i, key.j, key.shift[0], key.shift[1])
    };
    let rows: String = sheet.edges.iter().zip(&rates).map(row).collect();
    let ran = scene(PATCH, RIGID, both).with("mode.csv", format!("i,j,n1,n2,rate\n{rows}")).ran();
    let landscape = ran.landscape("a");
    let [one, other] = [0, 1].map(|k| landscape.modes[k].samples[0].energy.unwrap());
    assert!(abs_diff_eq!(one / other, 1.0, epsilon = 1e-9), "{one:e} {other:e}");
    let tensor = landscape.modes[1].mode.unwrap();
    assert!(
        tensor.iter().zip([1.0, 1.0, 0.0]).all(|(a, b): (&f64, f64)| abs_diff_eq!(*a, b, epsilon = 1e-12)),
        "{tensor:?}"
    );
}

/// Claim: an impossible landscape is refused with its reason, before anything is written.
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
        scene(sheet, energy, study).refused(expected);
    }
}

/// Claim: samples whose energy may be rounding errors are counted and left out of the fits; if too few are left there
/// is no fit and the study fails. The energy increases as 1105 a^4 (that of the cylinder as a^6): at 1e-9 it would be
/// 1e-33, where rounding errors are 2e-29. Tolerance of the exponent of the other samples: the next order, some
/// thousandths of the energy at an amplitude of 1e-3 (5.9985 was found; with rounding errors in the fit, 5.773).
#[test]
fn rounding_is_not_fitted() {
    let along = |mode: &str, amplitudes: &str| {
        let ran = scene(PATCH, RIGID, &format!("modes = [{mode}]\namplitudes = {amplitudes}")).ran();
        let study = ran.study("a");
        (study.converged, study.reason.clone().unwrap_or_default(), ran.landscape("a").modes[0].clone())
    };
    for amplitudes in ["[1e-9, 1e-8]", "[1e-9, 1e-3]"] {
        let (converged, reason, mode) = along("[1, 1, 0]", amplitudes);
        assert!(!converged && reason.contains("larger amplitudes"), "{reason}");
        assert_eq!((mode.exponent, mode.coefficient, mode.fit_agrees), (None, None, None));
        assert!(mode.samples[0].below_rounding && mode.below_rounding > 0);
    }
    let (converged, reason, mode) = along("[1, 0, 0]", "[1e-5, 1e-4, 1e-3]");
    assert!(converged, "{reason}");
    assert_eq!((mode.below_rounding, mode.fit_agrees), (1, Some(true)), "{mode:?}");
    assert_abs_diff_eq!(mode.exponent.unwrap(), 6.0, epsilon = 5e-3);
}

/// Claim: an eggbox, whose modes are not determined by curvatures, has a landscape of a mode that is given by the rates
/// of its creases and of the facets that fold, and the energies are those predicted; rates of creases only do not
/// determine a mode, which is reported, and so are rates that are all zero. Tolerance: `fit_agrees`, and an exponent of
/// 4 or 6 to the next order at these amplitudes.
#[test]
fn rates_of_facets_name_modes() {
    let sheet = generate(&Pattern::Eggbox(Default::default())).unwrap();
    let modes = folding_modes_with_locked(&sheet, &[]).unwrap();
    assert_eq!(modes.basis.ncols(), 3);
    let energy = format!("{RIGID}\nfacets = {{ stiffness = 1.0 }}");
    let patch = "generate = { pattern = \"eggbox\" }\ndomain = \"patch\"\ncells = [4, 4]";
    let study = "modes = [{ rates = \"rates.csv\" }]\namplitudes = [0.0005, 0.001, 0.002]";
    let scene = |rates: &dyn Fn(usize) -> f64, facets: bool| {
        let rows = sheet.edges.iter().enumerate().filter(|(_, edge)| facets || edge.kind == EdgeKind::Crease);
        let row = |(k, edge): (usize, &Edge)| {
            let [n1, n2] = edge.key.shift;
            format!("{},{},{n1},{n2},{:e}\n", edge.key.i, edge.key.j, rates(k))
        };
        let text = format!("i,j,n1,n2,rate\n{}", rows.map(row).collect::<String>());
        scene(patch, &energy, study).with("rates.csv", text)
    };
    for mode in 0..3 {
        let ran = scene(&|k| modes.basis[(k, mode)], true).ran();
        let (found, along) = (ran.study("a"), &ran.landscape("a").modes[0]);
        println!("mode {mode}: {:?} {along:?}", found.reason);
        assert!(along.samples.iter().all(|sample| sample.converged), "{:?}", found.reason);
        assert!(along.predicted_coefficient.is_some() && along.fit_agrees != Some(false), "{along:?}");
    }
    scene(&|k| modes.basis[(k, 0)], false).refused("of 3 modes open");
    scene(&|_| 0.0, true).refused("all zero");
}

/// Claim: the axis of energies has the units that the scene names, and says that there are none without names.
#[test]
fn energies_have_the_units_of_the_scene() {
    let scene = scene(PATCH, RIGID, "modes = [[1, 1, 0]]\namplitudes = [0.01, 0.02]");
    let drawn = |scene: Scene| scene.converged().out.text("a.svg");
    assert!(
        drawn(scene.clone().then("[units]\nlength = \"mm\"\nforce = \"N\"\n").out("named")).contains("energy (N mm)")
    );
    assert!(drawn(scene).contains("energy (unit of the scene)"));
}

/// Claim: a sample in another minimum than the one before it says so and is left out of the fits; samples that continue do
/// not. Source: with an amplitude of 1 the rest angles of a patch of 4 x 4 random cells are no small change.
#[test]
fn samples_in_other_minima_say_so() {
    let mesh = "{\"vertices_coords\": [[0, 0, 0], [1.27957, 0.173308, -0.206947], [0.351861, 1.27252, -0.203887], \
                [1.63674, 1.0129, -0.192], [2, 0, 0], [2.351861, 1.27252, -0.203887], [1.87957, 2.173308, -0.206947], [0.6, 2, 0], \
                [2.6, 2, 0]], \"faces_vertices\": [[0, 1, 2], [1, 3, 2], \
                [1, 4, 5], [1, 5, 3], [2, 3, 6], [2, 6, 7], [3, 5, 6], [5, 8, 6]], \"foldwell:lattice\": [[2, 0, 0], [0.6, 2, 0]]}";
    let found = |amplitudes: &str| {
        let sheet = "mesh = \"cell.fold\"\ndomain = \"patch\"\ncells = [4, 4]";
        let study = format!("modes = [[0, 0.1, 0.05]]\namplitudes = {amplitudes}");
        scene(sheet, RIGID, &study).with("cell.fold", mesh).converged().landscape("a").modes[0].clone()
    };
    let [near, far] = ["[0.01, 0.02, 0.04]", "[0.5, 1.0]"].map(found);
    assert!(near.samples.iter().all(|sample| !sample.other_minimum) && near.exponent.is_some(), "{near:?}");
    assert!(far.samples.iter().any(|sample| sample.other_minimum) && far.exponent.is_none(), "{far:?}");
}
