//! What the length of a step buys when a trajectory is followed.

use super::super::experiment::{Bench, ExperimentError, Findings};
use super::super::precision::{Diagram, Method, Setting, shortest};
use super::super::star::Star;
use crate::analysis::trace::{Stop, Traced};
use crate::solver::continuation::End;
use serde_json::json;

const STEPS: [f64; 6] = [0.2, 0.1, 0.05, 0.025, 0.0125, 0.006_25];
/// The step of the trajectory that the others are compared with.
const REFERENCE: f64 = 0.003;
/// The steps between which the order is read off: longer ones the program shortens itself, below are rounding errors.
const ASYMPTOTIC: [usize; 2] = [2, 4];
const ROUNDS: usize = 3;

/// Follows the shorter loop of the reference cell, about 9.93 rad long, with steps of at most this length. Every point lies on the curve to
/// 3e-14 whatever the step; what depends on the step is the integral of the arc length. Its error is measured against a
/// trajectory followed with steps of 0.003.
pub fn measure(bench: &Bench) -> Result<Findings, ExperimentError> {
    let reference = length(REFERENCE)?;
    let mut settings = Vec::new();
    for (step, max_step) in STEPS.into_iter().enumerate() {
        bench.step(step, STEPS.len())?;
        let error = (length(max_step)? - reference).abs();
        let seconds = shortest(ROUNDS, &mut [Box::new(|| _ = short_loop(max_step))])[0];
        settings.push(Setting { label: format!("step {max_step}"), error, seconds });
    }
    let [long, short] = ASYMPTOTIC;
    let order = (settings[long].error / settings[short].error).ln() / (STEPS[long] / STEPS[short]).ln();
    let values = json!({
        "finest error": settings[STEPS.len() - 1].error,
        "default error": settings[0].error,
        "order": order,
        "length": reference,
    });
    let diagram = Diagram {
        title: "Longest step of a trajectory, the short loop of the reference cell".into(),
        error: "error of the arc length against steps of 0.003 (rad)".into(),
        methods: vec![Method { name: "Hermite, 3 points".into(), settings }],
    };
    Ok(Findings { values, diagrams: vec![diagram], ..Findings::default() })
}

fn short_loop(max_step: f64) -> Result<Traced, ExperimentError> {
    let all = Star::traced(max_step, Stop::default())?;
    all.into_iter().find(|traced| traced.branch == (0, -1)).ok_or(ExperimentError::Other("there is no such ray".into()))
}

fn length(max_step: f64) -> Result<f64, ExperimentError> {
    match short_loop(max_step)?.end {
        End::Closed(back) => Ok(back.arc_length),
        _ => Err(ExperimentError::Other("the loop did not close".into())),
    }
}
