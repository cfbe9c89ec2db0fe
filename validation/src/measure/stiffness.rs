//! Error and run time against the stiffness of bars, for the program's tension form, a plain penalty and the augmented
//! form.

use super::super::findings::{ExperimentError, Findings, ReportTable};
use super::super::forms::{self, Form};
use super::super::precision::{Diagram, Method, Setting, medians};
use super::super::report::figure;
use super::super::star::Star;
use super::trial::distance;
use foldwell::analysis::exact::error_to_kinematic;
use foldwell::analysis::state::State;
use foldwell::numerics::{larger, worst};
use foldwell::solver::Options;
use serde_json::json;

const STIFFNESSES: [f64; 9] = [1e2, 1e4, 1e6, 1e8, 1e10, 1e12, 1e14, 1e16, f64::INFINITY];
/// Index of the stiffness with which the numbers of iterations of others are compared.
const MODERATE: usize = 1;
/// Number of cells along each side, the largest that the dense exact solver accepts.
const CELLS: usize = 5;
/// Weight of the augmented form relative to the stiffness of the creases.
const WEIGHT: f64 = 1e4;
const ROUNDS: usize = 5;

/// The result of a form at a stiffness.
struct Reached {
    angles: Vec<f64>,
    residual: f64,
    iterations: usize,
}

/// Relaxes 5 x 5 cells with random rest angles (within 0.1 rad) from the drawn state at every stiffness by the three
/// forms.
///
/// The error is the largest difference of a fold angle from the exact kinematics of rigid faces. To a user who wants
/// rigid faces the stiffness is a parameter of the method, and the error decreases as one over it until the form fails.
/// The residual is the larger one of the scaled residuals of force and length, which must be small at every stiffness.
pub fn measure(_quick: bool) -> Result<Findings, ExperimentError> {
    let star = Star::new([CELLS, CELLS], 0.1)?;
    let (exact, rigid_error) = exact(&star)?;
    let mut all = Vec::new();
    for k in STIFFNESSES {
        let tension = Some(by_tension(&star, k)?);
        let penalty = k.is_finite().then(|| by_form(&star, k, Form::Penalty)).transpose()?;
        let augmented = Some(by_form(&star, k, Form::Augmented(WEIGHT))?);
        all.push([tension, penalty, augmented]);
    }
    let seconds = times(&star);
    let names = ["tension form (this program)", "plain penalty", "augmented form"];
    let setting = |k: usize, form: usize| {
        let reached = all[k][form].as_ref()?;
        let error = distance(&reached.angles, &exact);
        Some(Setting { label: format!("k = {:e}", STIFFNESSES[k]), error, seconds: seconds[k][form] })
    };
    let methods = (0..names.len()).map(|form| Method {
        name: names[form].into(),
        settings: (0..STIFFNESSES.len()).filter_map(|k| setting(k, form)).collect(),
    });
    let diagram = Diagram {
        title: format!("Stiffness of the bars, {CELLS} x {CELLS} cells, three forms"),
        error: "largest difference of a fold angle to the exact kinematics of rigid faces (rad)".into(),
        methods: methods.collect(),
    };
    let residuals = |form: usize| -> Vec<f64> {
        all.iter().filter_map(|forms| forms[form].as_ref()).map(|reached| reached.residual).collect()
    };
    let tension = |k: usize| all[k][0].as_ref().map_or(f64::NAN, |reached| reached.iterations as f64);
    let scaled = |k: usize| STIFFNESSES[k] * diagram.methods[0].settings[k].error;
    let most = |of: &dyn Fn(usize) -> f64| worst((0..STIFFNESSES.len()).map(of));
    let values = json!({
        "tension residuals": residuals(0),
        "penalty residuals": residuals(1),
        "augmented residuals": residuals(2),
        "rigid error": rigid_error,
        "most iterations over moderate": most(&|k| tension(k) / tension(MODERATE)),
        "scaled error at 1e10 over 1e12": scaled(4) / scaled(5),
    });
    let tables = vec![table(&all, &seconds, &names)];
    Ok(Findings { values, tables, diagrams: vec![diagram], ..Findings::default() })
}

/// Returns the fold angles of the rigid state, with which other states are compared, and their error relative to the
/// exact kinematics, which must be negligible.
fn exact(star: &Star) -> Result<(Vec<f64>, f64), ExperimentError> {
    let model = star.model(f64::INFINITY);
    let angles = star.relax(&model, Options::default())?.state.fold_angle;
    match error_to_kinematic(star.assembly.sheet(), star.assembly.tiling(), &model, &angles) {
        Some(error) if error <= 1e-9 => Ok((angles, error)),
        Some(_) => Err(ExperimentError::Other("the rigid state is not that of the exact kinematics".into())),
        None => Err(ExperimentError::Other("there is no exact state to compare with".into())),
    }
}

fn by_tension(star: &Star, k: f64) -> Result<Reached, ExperimentError> {
    let found = star.relax(&star.model(k), Options::default())?;
    let residual = larger(found.residual_force, found.residual_length);
    Ok(Reached { angles: found.state.fold_angle, residual, iterations: found.iterations })
}

fn by_form(star: &Star, k: f64, form: Form) -> Result<Reached, ExperimentError> {
    let mut model = star.model(k);
    let found =
        forms::minimize(&mut model, form).map_err(|_| ExperimentError::Other("a pattern is too large".into()))?;
    let state = State::new(&model, &found.x, &found.tension);
    let residual = larger(found.residuals[0], found.residuals[1]);
    Ok(Reached { angles: state.fold_angle, residual, iterations: found.iterations })
}

/// Returns the run time in seconds of every form at every stiffness, including the assembly of the model.
fn times(star: &Star) -> Vec<[f64; 3]> {
    let at = |k: f64| {
        let mut work: [Box<dyn FnMut() + '_>; 3] = [
            Box::new(move || _ = by_tension(star, k)),
            Box::new(move || _ = k.is_finite().then(|| by_form(star, k, Form::Penalty))),
            Box::new(move || _ = by_form(star, k, Form::Augmented(WEIGHT))),
        ];
        let found = medians(ROUNDS, &mut work);
        [found[0], found[1], found[2]]
    };
    let mut seconds: Vec<[f64; 3]> = STIFFNESSES.into_iter().map(at).collect();
    // once more by turns over the stiffnesses, whose times are compared with each other
    let tension = |k: f64| Box::new(move || _ = by_tension(star, k)) as Box<dyn FnMut() + '_>;
    let in_turns = medians(ROUNDS, &mut STIFFNESSES.map(tension));
    seconds.iter_mut().zip(in_turns).for_each(|(all, time)| all[0] = time);
    seconds
}

fn table(all: &[[Option<Reached>; 3]], seconds: &[[f64; 3]], names: &[&str; 3]) -> ReportTable {
    let of = |reached: &Option<Reached>, seconds: f64| match reached {
        Some(reached) => {
            let Reached { residual, iterations, .. } = reached;
            format!("{residual:.0e} in {iterations} steps, {} ms", figure((1e4 * seconds).round() / 10.0))
        }
        None => "not possible".into(),
    };
    let row = |k: usize| {
        let cells = (0..names.len()).map(|form| of(&all[k][form], seconds[k][form]));
        [format!("{:e}", STIFFNESSES[k])].into_iter().chain(cells).collect()
    };
    ReportTable {
        title: "Residual that is left at each stiffness (the larger one of force and length, scaled)".into(),
        header: ["k"].iter().chain(names).map(|name| (*name).to_owned()).collect(),
        rows: (0..all.len()).map(row).collect(),
    }
}
