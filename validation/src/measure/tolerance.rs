//! Error and run time against the tolerance of relaxations of a rigid patch.

use super::super::findings::{ExperimentError, Findings};
use super::super::precision::{Diagram, Method, Setting, medians};
use super::super::star::Star;
use foldwell::analysis::exact::error_to_kinematic;
use foldwell::numerics::worst;
use foldwell::solver::Options;
use serde_json::json;

const TOLERANCES: [f64; 8] = [1e-1, 1e-2, 1e-3, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12];
/// Number of cells along each side, the largest that the dense exact solver accepts.
const CELLS: usize = 5;
const ROUNDS: usize = 5;

/// Relaxes 5 x 5 rigid cells with random rest angles (within 0.1 rad) to each tolerance. The error is the largest
/// difference of a fold angle from the equilibrium of the exact kinematics, which does not use bars.
pub fn measure(_quick: bool) -> Result<Findings, ExperimentError> {
    let star = Star::new([CELLS, CELLS], 0.1)?;
    let mut settings = Vec::new();
    for tolerance in TOLERANCES {
        let options = Options { tolerance, ..Options::default() };
        let model = star.model(f64::INFINITY);
        let found = star.relax(&model, options)?;
        let error = error_to_kinematic(star.assembly.sheet(), star.assembly.tiling(), &model, &found.state.fold_angle);
        let error = error.ok_or(ExperimentError::Other("there is no exact state to compare with".into()))?;
        let again = || _ = star.relax(&star.model(f64::INFINITY), options);
        let seconds = medians(ROUNDS, &mut [Box::new(again)])[0];
        settings.push(Setting { label: format!("{tolerance:e}"), error, seconds });
    }
    let over = settings.iter().zip(TOLERANCES).map(|(setting, tolerance)| setting.error / tolerance);
    let values = json!({
        "errors": settings.iter().map(|setting| setting.error).collect::<Vec<_>>(),
        "error over tolerance": worst(over),
        "finest": settings[TOLERANCES.len() - 1].error,
    });
    let diagram = Diagram {
        title: format!("Tolerance of a relaxation, {CELLS} x {CELLS} rigid cells"),
        error: "largest error of a fold angle against exact kinematics (rad)".into(),
        methods: vec![Method { name: "tension form".into(), settings }],
    };
    Ok(Findings { values, diagrams: vec![diagram], ..Findings::default() })
}
