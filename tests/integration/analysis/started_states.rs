//! Modes and wells of states other than the drawn one: spectra with the geometric stiffness of tensions, counts at
//! saddle points, and starts that stay where they are.

use crate::common::{self, Folder, Scene, Testing, eigenvalues, jacobian, linearized, on, patch};
use approx::{abs_diff_eq, assert_relative_eq};
use foldwell::analysis::modes::{DENSE_LIMIT, modes_at};
use foldwell::analysis::wells::barrier::barrier;
use foldwell::analysis::wells::merge::{Comparison, wells};
use foldwell::analysis::wells::starts::{Outcome, Starts, relax_around};
use foldwell::model::{Assembly, Boundary, Configuration, Gauge, Model, Terms};
use foldwell::numerics::DenseMatrix;
use foldwell::solver::{Options, Problem};
use serde_json::Value;

/// The energy of the drum: its creases have a millionth of the stiffness of its bars.
const DRUM_ENERGY: &str = "bars = { stiffness = 1.0 }\ncreases = { stiffness = 1e-6 }";

/// Returns a scene of the closed drum of `tests/cases`, two hexagons and twelve triangles, with these studies.
fn drum(studies: &str) -> Scene {
    Scene::on("mesh = \"cases/drum.fold\"", &format!("[energy]\n{DRUM_ENERGY}\n{studies}"))
}

/// Runs the drum into a folder of this name; returns its studies.
fn studies(folder: &Folder, name: &str, studies: &str) -> Value {
    drum(studies).within(folder).named(name).out(name).converged().json()
}

/// Returns the first minimum that a random start near the drawn state reaches.
fn minimum(assembly: &Assembly) -> Configuration {
    let starts = Starts { count: 1, seed: 3, spread: 0.02, options: Options::default() };
    match relax_around(assembly, None, &starts, &|| true).remove(0) {
        Outcome::Well(settled) => settled.place,
        other => panic!("{other:?}"),
    }
}

/// Returns the state with tensions of zero.
fn unstressed(state: &Configuration) -> Configuration {
    let measures = state.tension.as_ref().unwrap().len();
    Configuration { tension: Some(vec![0.0; measures]), ..state.clone() }
}

/// Returns the model of the whole energy in a state, and the unknowns of the state.
fn model_at(assembly: &Assembly, state: &Configuration) -> (Model, Vec<f64>) {
    let mut model = assembly.model(Gauge::Free);
    let x = model.enter(state).x;
    (model, x)
}

/// Returns the Hessian of the whole energy by central differences of its gradient, in which every bar pulls with its
/// stiffness times its elongation: no tension and no second derivative takes part.
fn hessian_by_differences(assembly: &Assembly, state: &Configuration) -> DenseMatrix {
    let (model, x) = model_at(assembly, state);
    let gradient = |x: &[f64]| {
        let at = linearized(&model, x, &vec![0.0; model.layout().stiff.len()]);
        let pulls = at.gaps.iter().zip(model.compliance()).map(|(gap, c)| gap / c);
        let pulls = nalgebra::DVector::from_iterator(at.gaps.len(), pulls);
        nalgebra::DVector::from_column_slice(&at.gradient) + jacobian(&model, &at).tr_mul(&pulls)
    };
    let step = 1e-5;
    let mut hessian = DenseMatrix::zeros(x.len(), x.len());
    for k in 0..x.len() {
        let moved = |sign: f64| {
            let mut x = x.clone();
            x[k] += sign * step;
            gradient(&x)
        };
        hessian.set_column(k, &((moved(1.0) - moved(-1.0)) / (2.0 * step)));
    }
    0.5 * (&hessian + hessian.transpose())
}

/// Returns the assembly of 2 x 2 star cells that curl, with soft or rigid bars: their relaxed states have tensions.
fn curled(bars: f64, cells: [usize; 2]) -> Assembly {
    let case = patch("open-star", cells);
    let rest = case.rest_per_cell(0.4, 5);
    case.with_terms(Terms::bars_and_creases(bars, 1.0, rest))
}

/// Claim: the eigenvalues of a relaxed state are those of the Hessian of the whole energy at that state, tensions of
/// the bars included. Source: central differences of the gradient, whose error is the square of the step of 1e-5 times
/// fourth derivatives of bars of stiffness 1e3; nothing but the geometric stiffness makes the difference to the last
/// check, in which the tensions are left out.
#[test]
fn spectra_have_the_geometric_stiffness() {
    let case = curled(30.0, [2, 2]);
    let state = minimum(&case);
    let expected = eigenvalues(hessian_by_differences(&case, &state));
    let found = modes_at(&case, &state, 12, &mut || true).unwrap();
    let allowed = 1e-5;
    for (found, expected) in found.eigenvalues.iter().zip(&expected) {
        assert!(abs_diff_eq!(*found, *expected, epsilon = allowed), "{found:e} for {expected:e}");
    }
    assert_eq!((found.rigid_motions, found.zero_modes - found.self_stresses), (6, found.maxwell_count as usize));
    assert!(found.eigenvalues[..6].iter().all(|value| value.abs() < 1e-9) && found.eigenvalues[6] > 1e-3);
    let without = modes_at(&case, &unstressed(&state), 12, &mut || true).unwrap();
    let change = common::distance(&without.eigenvalues, &found.eigenvalues);
    assert!(change > 1e3 * allowed, "the tensions matter: {change:e}");
    // those that are not known follow from lengths
    let unknown = modes_at(&case, &state.without_tension(), 12, &mut || true).unwrap();
    assert!(common::distance(&unknown.eigenvalues, &found.eigenvalues) < 1e-9);
}

/// Claim: the sparse method finds the same eigenvalues of a relaxed state as the dense one, to the eight digits of the
/// sparse method, just above the size at which it is chosen. Asking for more eigenvalues than the iteration can give
/// makes the program choose the dense one.
#[test]
fn large_spectra_of_relaxed_states() {
    let case = curled(30.0, [10, 11]);
    let state = minimum(&case);
    assert!(state.coordinates.len() > DENSE_LIMIT);
    let sparse = modes_at(&case, &state, 12, &mut || true).unwrap();
    let dense = modes_at(&case, &state, 400, &mut || true).unwrap();
    assert_eq!((sparse.eigenvalues.len(), dense.eigenvalues.len()), (12, 400));
    for (sparse, dense) in sparse.eigenvalues.iter().zip(&dense.eigenvalues) {
        assert!(abs_diff_eq!(*sparse, *dense, epsilon = 1e-8 * dense.abs() + 1e-9), "{sparse:e} {dense:e}");
    }
}

/// Claim: at a pass of rigid bars, between two wells of the reference cell on a screw, the spectrum has exactly one
/// negative eigenvalue on the motions that the bars allow, as the inertia of the tangent system says, and at the wells
/// none. The forces of rigid bars are unknowns: without them the count is another one.
#[test]
fn one_negative_eigenvalue_at_a_rigid_pass() {
    let case = on(common::mesh("open-star"), [1, 1], Boundary::Screw);
    let rest = case.rest_per_hinge(1.0, 1);
    let case = case.with_terms(Terms::bars_and_creases(f64::INFINITY, 1.0, rest));
    let starts = Starts { count: 24, seed: 1, spread: 1.0, options: Options::default() };
    let minima = relax_around(&case, None, &starts, &|| true).into_iter().filter_map(|outcome| match outcome {
        Outcome::Well(settled) => Some(*settled),
        _ => None,
    });
    let wells = wells(minima, &Comparison::new(&case));
    let pass = barrier(&case, &wells, [0, 1], &mut || true).unwrap().pass;
    let negative = |state: &Configuration| {
        let found = modes_at(&case, state, 8, &mut || true).unwrap().eigenvalues;
        found.iter().filter(|value| **value < -1e-6).count()
    };
    assert_eq!((negative(&pass.place), pass.negative_eigenvalues), (1, Some(1)));
    assert_ne!(negative(&unstressed(&pass.place)), 1);
    assert!(wells[..2].iter().all(|well| negative(&well.settled.place) == 0));
}

/// Returns a study with these keys.
fn study(name: &str, kind: &str, keys: &str) -> String {
    format!("[[study]]\nname = \"{name}\"\nkind = \"{kind}\"\n{keys}\n")
}

fn counts(modes: &Value) -> (usize, Value, Value) {
    let values = modes["eigenvalues"].as_array().unwrap().iter().map(|value| value.as_f64().unwrap());
    (values.filter(|value| *value < -1e-12).count(), modes["rigid_motions"].clone(), modes["zero_modes"].clone())
}

/// Claim: a study of wells writes its states with all forces: a relaxation that starts from any of its files, the pass
/// included, takes no step and has the same energy and the same number of negative eigenvalues, and so has the spectrum
/// from the same file. The drum is closed and rigid as drawn: 6 motions in every state.
#[test]
fn wells_write_what_starts_need() {
    let folder = Folder::new();
    let asked = study("w", "wells", "starts = 40\nseed = 11\nbarriers = [[0, 1]]");
    let found = studies(&folder, "first", &asked)[0].clone();
    let energies = [&found["wells"][0], &found["wells"][1], &found["barriers"][0]].map(|one| one["energy"].clone());
    for (k, energy) in energies.iter().enumerate() {
        let start = format!("start = \"first/w/w_{k:04}.vtu\"");
        let modes = format!("{start}\neigenvalues = 12");
        let asked = study("r", "relax", &start)
            + &study("m", "modes", &modes)
            + &study("n", "modes", "start = \"r\"\neigenvalues = 12");
        let again = studies(&folder, &format!("again{k}"), &asked);
        let saddle = usize::from(k == 2);
        assert_eq!((&again[0]["iterations"], &again[0]["negative_eigenvalues"]), (&0.into(), &saddle.into()), "{k}");
        let [energy, relaxed] = [energy, &again[0]["energy"]["total"]].map(|value| value.as_f64().unwrap());
        assert!(abs_diff_eq!(energy, relaxed, epsilon = 1e-12 * 8.2e-5), "{k}: {energy:e} {relaxed:e}");
        assert_eq!(counts(&again[1]), (saddle, 6.into(), 6.into()), "{k}: {}", again[1]);
        assert_eq!(counts(&again[2]), (saddle, 6.into(), 6.into()), "{k}: {}", again[2]);
    }
}

/// Claim: starts of a study of wells are crumpled around the state that it names: around either state of the drum only
/// that state is found, with a spread that does not lead to the other one; the first start is the state itself, also if
/// the study names a pass, from which it then has to leave. From the pass both states are reached.
#[test]
fn wells_around_a_state() {
    let folder = Folder::new();
    let asked = study("w", "wells", "starts = 40\nseed = 11\nbarriers = [[0, 1]]");
    let found = studies(&folder, "first", &asked)[0].clone();
    let energy = |wells: &Value, k: usize| wells["wells"][k]["energy"].as_f64().unwrap();
    let around = |k: usize| {
        let keys = format!("start = \"first/w/w_{k:04}.vtu\"\nstarts = 12\nspread = 0.05");
        studies(&folder, &format!("around{k}"), &study("w", "wells", &keys))[0].clone()
    };
    for k in [0, 1] {
        let near = around(k);
        assert_eq!(near["wells"].as_array().unwrap().len(), 1, "{k}: {near}");
        assert!(abs_diff_eq!(energy(&near, 0), energy(&found, k), epsilon = 1e-12), "{k}: {near}");
    }
    assert_eq!(around(2)["wells"].as_array().unwrap().len(), 2);
}

/// Claim: if no other start is asked for, the state itself is the well; angles beyond pi are those of the state, since
/// they are part of its energy.
#[test]
fn the_first_start_is_the_state() {
    let case = curled(30.0, [1, 1]);
    let state = minimum(&case);
    let starts = Starts { count: 1, seed: 0, spread: 3.0, options: Options::default() };
    let Outcome::Well(found) = relax_around(&case, Some(&state), &starts, &|| true).remove(0) else { panic!("a well") };
    assert_eq!((found.relaxed.iterations, &found.place.angles), (0, &state.angles));
    assert!(common::distance(&found.place.coordinates, &state.coordinates) <= 1e-12);
}

/// Claim: a start that does not exist is refused at its place in the scene, for both kinds.
#[test]
fn unknown_starts_are_refused() {
    for kind in ["modes", "wells"] {
        drum(&study("w", kind, "start = \"nobody\"")).refused("no earlier study is called `nobody`");
    }
}

/// Claim: modes of the drawn state are unchanged by naming it.
#[test]
fn drawn_is_the_default() {
    let folder = Folder::new();
    let modes = study("a", "modes", "eigenvalues = 8") + &study("b", "modes", "start = \"drawn\"\neigenvalues = 8");
    let found = studies(&folder, "d", &modes);
    assert_eq!(found[0]["eigenvalues"], found[1]["eigenvalues"]);
    let first = found[0]["eigenvalues"][6].as_f64().unwrap();
    assert_relative_eq!(first, found[1]["eigenvalues"][6].as_f64().unwrap());
}
