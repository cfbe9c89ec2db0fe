//! Error and run time of a trajectory against the length of its steps and the degree of its interpolant.

use super::super::findings::{ExperimentError, Findings};
use super::super::precision::{Diagram, Method, Setting, medians};
use super::super::star;
use foldwell::analysis::branches::{BranchesError, branches};
use foldwell::kinematics::{Closing, Closure, KinematicsError};
use foldwell::model::{Assembly, Boundary, Terms};
use foldwell::solver::continuation::{CurveOptions, End, follow};
use serde_json::json;
use std::f64::consts::TAU;

const STEPS: [f64; 6] = [0.2, 0.1, 0.05, 0.025, 0.0125, 0.006_25];
/// Numbers of points of the interpolants; the program uses the second.
const POINTS: [usize; 3] = [2, 3, 4];
const USUAL: usize = 1;
/// Step of the trajectory with which the others are compared.
const REFERENCE: f64 = 0.003;
/// Indices of the steps between which the order of the usual interpolant is determined: longer steps are shortened by
/// the program, and the errors of shorter ones are rounding errors. With degree three the order has not settled at
/// these steps, and with degree seven all errors are rounding errors.
const ASYMPTOTIC: [usize; 2] = [2, 4];
const ROUNDS: usize = 5;

/// Follows the shorter loop of the reference cell, about 9.93 rad long, with steps of at most each length and
/// interpolants of degree three, five and seven. All points lie on the curve within 3e-14 in every case; only the
/// integral of the arc length depends on steps and degree. Its error is measured against a trajectory followed with
/// steps of 0.003.
pub fn measure(_quick: bool) -> Result<Findings, ExperimentError> {
    let mut short = Short::new()?;
    let reference = short.length(REFERENCE, POINTS[USUAL])?;
    let mut methods = Vec::new();
    for points in POINTS {
        let mut settings = Vec::new();
        for max_step in STEPS {
            let error = (short.length(max_step, points)? - reference).abs();
            let seconds = medians(ROUNDS, &mut [Box::new(|| _ = short.length(max_step, points))])[0];
            settings.push(Setting { label: format!("step {max_step}"), error, seconds });
        }
        methods.push(Method { name: format!("through {points} points, degree {}", 2 * points - 1), settings });
    }
    let [long, short] = ASYMPTOTIC;
    let error = |step: usize| methods[USUAL].settings[step].error;
    let order = (error(long) / error(short)).ln() / (STEPS[long] / STEPS[short]).ln();
    let values = json!({
        "default error": methods[USUAL].settings[0].error,
        "order": order,
        "length": reference,
    });
    let diagram = Diagram {
        title: "Longest step and interpolant of a trajectory, the short loop of the reference cell".into(),
        error: "error of the arc length against steps of 0.003 (rad)".into(),
        methods,
    };
    Ok(Findings { values, diagrams: vec![diagram], ..Findings::default() })
}

/// The short loop of the cell with its first edge locked.
struct Short {
    closure: Closure,
    angles: Vec<f64>,
    direction: Vec<f64>,
}

impl Short {
    fn new() -> Result<Self, ExperimentError> {
        let drawn = Assembly::without_terms(star::cell()?, [1, 1], Boundary::Screw)?;
        let angles = drawn.drawn_angles().to_vec();
        let cell = drawn.with_terms(Terms { locks: vec![(0, angles[0])], ..Terms::default() });
        let found = branches(&cell).map_err(|error: BranchesError| ExperimentError::Other(error.to_string()))?;
        let ray = found.rays.rays.iter().find(|ray| (ray.branch, ray.sign) == (0, -1));
        let direction = ray.ok_or(ExperimentError::Other("there is no such ray".into()))?.direction.clone();
        let closure = Closure::of_cell(cell.sheet())
            .map_err(|error: KinematicsError| ExperimentError::Other(error.to_string()))?;
        Ok(Self { closure: closure.with_locked(&cell.locked_edges()), angles, direction })
    }

    /// Returns the length of the loop.
    fn length(&mut self, max_step: f64, points: usize) -> Result<f64, ExperimentError> {
        let mut closing = Closing::new(&self.closure, self.angles.clone());
        let [start, leaving] = [&self.angles, &self.direction].map(|all| closing.folding(all));
        let options = CurveOptions { tolerance: 3e-14, max_step, points, period: Some(TAU), ..CurveOptions::default() };
        match follow(&mut closing, start, leaving, &options, &mut |_, _, _| {}, &mut |_| true).end {
            End::Closed(back) => Ok(back.arc_length),
            _ => Err(ExperimentError::Other("the loop did not close".into())),
        }
    }
}
