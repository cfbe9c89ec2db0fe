//! Tensions of a converged state: least norm where they are not unique, and the residuals that hold with them.

use super::newton::Equilibrium;
use super::problem::{Curvature, Linearization, Problem};
use crate::numerics::sparse::Rows;
use crate::numerics::{larger, rank};

/// Singular values of the stiff Jacobian below this, relative to its largest entry, count as zero.
const NULL: f64 = 1e-6;
/// Tensions without self stress are taken where forces balance at most this much worse with them, or but for rounding.
const WORSE: f64 = 10.0;
const ROUNDING: f64 = 1e-13;

/// A converged state's tensions.
#[derive(Clone, Debug)]
pub struct Settled {
    /// Tensions, without self stress where rigid measures leave one free.
    pub tension: Vec<f64>,
    /// Self stresses of the rigid measures; `None` where no measure is rigid or they could not be counted.
    pub self_stresses: Option<usize>,
    /// Largest unbalanced force over the largest force of an element.
    pub residual_force: f64,
    /// Largest scaled gap.
    pub residual_length: f64,
}

/// Takes self stresses out of the tensions of an equilibrium; where its measures were seen to be independent there is none.
pub fn settle<P: Problem>(problem: &P, found: &Equilibrium) -> Settled {
    if let (true, Some(last)) = (found.independent, found.history.last()) {
        return Settled {
            tension: found.tension.clone(),
            self_stresses: problem.compliance().contains(&0.0).then_some(0),
            residual_force: last.residual_force,
            residual_length: last.residual_length,
        };
    }
    let layout = problem.layout();
    let mut at = Linearization::new(layout);
    problem.linearize(&found.x, &found.tension, Curvature::GaussNewton, &mut at);
    let self_stresses = self_stresses(problem, &at);
    let even = at.even_jacobian(layout);
    let rows = Rows { cliques: &layout.stiff, values: &even };
    let all_rigid = problem.compliance().iter().all(|c| *c == 0.0);
    let settled = |at: &Linearization, tension: Vec<f64>| {
        let (residual_force, residual_length) = residuals(problem, at, &tension);
        Settled { tension, self_stresses, residual_force, residual_length }
    };
    let before = settled(&at, found.tension.clone());
    if !all_rigid || self_stresses.unwrap_or(0) == 0 {
        return before;
    }
    let forces: Vec<f64> = found.tension.iter().zip(&at.sizes).map(|(t, size)| t * size).collect();
    let Ok(least) = rank::without_null(&rows, layout.unknowns, &layout.node, &forces) else { return before };
    let least: Vec<f64> = least.iter().zip(&at.sizes).map(|(t, size)| t / size).collect();
    // the unit of forces is smaller without those that only hold each other
    problem.linearize(&found.x, &least, Curvature::GaussNewton, &mut at);
    let least = settled(&at, least);
    // what is taken out next to a singular state is only nearly a self stress: forces that balance are worth more
    if least.residual_force <= WORSE * before.residual_force.max(ROUNDING) { least } else { before }
}

/// Number of self stresses where measures are rigid; `None` where none is, or they could not be counted.
pub fn self_stresses<P: Problem>(problem: &P, at: &Linearization) -> Option<usize> {
    let layout = problem.layout();
    if !problem.compliance().contains(&0.0) {
        return None;
    }
    let even = at.even_jacobian(layout);
    let rows = Rows { cliques: &layout.stiff, values: &even };
    let rank = rank::count_above(&rows, layout.unknowns, &layout.node, NULL).ok()?;
    Some(layout.stiff.len() - rank)
}

/// Scaled residuals of force and length.
pub fn residuals<P: Problem>(problem: &P, at: &Linearization, tension: &[f64]) -> (f64, f64) {
    let force = at.force(problem.layout(), tension);
    let unbalanced = force.iter().fold(0.0f64, |m, f| larger(m, f.abs()));
    let open = at.gaps.iter().zip(tension).zip(problem.compliance()).map(|((m, t), c)| m - c * t);
    let gap = open.zip(problem.gap_scale()).fold(0.0, |m, (o, s)| larger(m, o.abs() / s));
    (if unbalanced == 0.0 { 0.0 } else { unbalanced / at.largest_force }, gap)
}
