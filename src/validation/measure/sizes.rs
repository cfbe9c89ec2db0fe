//! What the size of a patch costs, against an exact state that is known at every size.

use super::super::experiment::{Bench, ExperimentError, Findings};
use super::super::forms::{self, Form};
use super::super::precision::{Diagram, Method, Setting, shortest};
use super::super::star::{Star, size};
use crate::analysis::state::State;
use crate::solver::Options;
use serde_json::json;

const CELLS: [usize; 6] = [3, 6, 9, 12, 18, 24];
/// Larger ones where there is time.
const MORE: [usize; 2] = [36, 48];
/// Up to this size the plain penalty is tried.
const MOST_FOR_PENALTY: usize = 12;
const STIFFNESS: f64 = 1e6;
/// Arc length along which the cell is folded.
const FOLDED: f64 = 0.1;

/// Patches whose creases rest at the angles of an exact cylinder, the reference cell followed over 0.1 rad by the
/// kinematics: relaxed from the drawn state they have to end there. The error is the largest difference of a fold angle. Rigid bars by
/// the program's form; bars of 1e6 by a plain penalty, for which this state, free of tension, is as exact.
pub fn measure(bench: &Bench) -> Result<Findings, ExperimentError> {
    let exact = Star::cylinder(FOLDED)?;
    let sizes: Vec<usize> = CELLS.into_iter().chain(MORE.into_iter().filter(|_| !bench.quick)).collect();
    let (mut tension, mut penalty, mut growth) = (Vec::new(), Vec::new(), Vec::new());
    for (step, &n) in sizes.iter().enumerate() {
        bench.step(step, sizes.len())?;
        let star = Star::resting([n, n], &exact)?;
        let (label, rounds) = (format!("{n} x {n}"), if n <= 12 { 3 } else { 1 });
        let mut angles = Vec::new();
        let mut failure = None;
        let run = || match star.relax(&mut star.model(f64::INFINITY), Options::default()) {
            Ok(found) => angles = found.state.fold_angle,
            Err(error) => failure = Some(error),
        };
        let seconds = shortest(rounds, &mut [Box::new(run)])[0];
        if let Some(error) = failure {
            return Err(error.into());
        }
        tension.push(Setting { label: label.clone(), error: error(&angles, &star.rest), seconds });
        growth.push((size(&star.model(1.0)).0 as f64, seconds));
        if n <= MOST_FOR_PENALTY {
            let mut angles = Vec::new();
            let seconds = shortest(1, &mut [Box::new(|| angles = by_penalty(&star))])[0];
            penalty.push(Setting { label, error: error(&angles, &star.rest), seconds });
        }
    }
    let values = json!({
        "errors": tension.iter().map(|setting: &Setting| setting.error).collect::<Vec<_>>(),
        "growth": exponent(&growth[2..]),
    });
    let diagram = Diagram {
        title: "Size of a patch that rolls up to an exact cylinder".into(),
        error: "largest error of a fold angle against exact kinematics (rad)".into(),
        methods: vec![
            Method { name: "tension form, rigid".into(), settings: tension },
            Method { name: format!("plain penalty, {STIFFNESS:e}"), settings: penalty },
        ],
    };
    Ok(Findings { values, diagrams: vec![diagram], tables: vec![] })
}

fn by_penalty(star: &Star) -> Vec<f64> {
    let mut model = star.model(STIFFNESS);
    let found = forms::minimize(&mut model, Form::Penalty);
    found.map_or(vec![], |found| State::new(&model, &found.x, &found.tension, star.tiling.edges.len()).fold_angle)
}

/// The largest difference; NaN where there is no state.
fn error(angles: &[f64], exact: &[f64]) -> f64 {
    let known = angles.iter().zip(exact).filter(|(_, exact)| !exact.is_nan());
    known.map(|(a, b)| (a - b).abs()).reduce(f64::max).unwrap_or(f64::NAN)
}

/// Exponent `p` of the power law `y ~ x^p` that fits best in logarithms.
pub fn exponent(points: &[(f64, f64)]) -> f64 {
    let logs: Vec<(f64, f64)> = points.iter().map(|(x, y)| (x.ln(), y.ln())).collect();
    let count = logs.len() as f64;
    let middle = |of: fn(&(f64, f64)) -> f64| logs.iter().map(of).sum::<f64>() / count;
    let (mx, my) = (middle(|p| p.0), middle(|p| p.1));
    let above: f64 = logs.iter().map(|p| (p.0 - mx) * (p.1 - my)).sum();
    above / logs.iter().map(|p| (p.0 - mx) * (p.0 - mx)).sum::<f64>()
}
