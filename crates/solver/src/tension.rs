//! Tensions of a converged state without self stress, and the residuals that hold with them.

use super::linearization::{HessianKind, Linearization};
use super::newton::Equilibrium;
use super::problem::{Problem, Residuals};
use super::self_stress::{RigidRows, self_stresses};
use foldwell_numerics::rank;

/// Tensions without self stress are taken where the scaled residual force with them is at most this many times the one
/// before.
const MOST_FORCE_RATIO: f64 = 10.0;
/// Scaled residual force below which it may be rounding error alone.
const ROUNDING_FORCE: f64 = 1e-13;

/// A converged state's tensions.
#[derive(Clone, Debug)]
pub struct BalancedTensions {
    /// Tensions, of least norm where rigid measures leave a self stress free.
    pub tension: Vec<f64>,
    /// Number of self stresses of the rigid measures; `None` where no measure is rigid or they could not be counted.
    pub self_stresses: Option<usize>,
    /// Residuals with these tensions.
    pub residuals: Residuals,
}

/// Takes self stresses out of the tensions of an equilibrium. Where its measures were seen to be independent there are
/// none.
pub fn settle<P: Problem>(problem: &P, found: &Equilibrium) -> BalancedTensions {
    if let (true, Some(last)) = (found.independent, found.history.last()) {
        return BalancedTensions {
            tension: found.tension.clone(),
            self_stresses: problem.compliance().contains(&0.0).then_some(0),
            residuals: Residuals { force: last.residual_force, length: last.residual_length },
        };
    }
    let layout = problem.layout();
    let mut at = Linearization::new(layout);
    problem.linearize(&found.x, &found.tension, HessianKind::GaussNewton, &mut at);
    let self_stresses = self_stresses(problem, &at);
    let settled = |at: &Linearization, tension: Vec<f64>| {
        let residuals = Residuals::new(problem, at, &tension);
        BalancedTensions { tension, self_stresses, residuals }
    };
    let before = settled(&at, found.tension.clone());
    if self_stresses.unwrap_or(0) == 0 {
        return before;
    }
    let unbalanced =
        |of: &BalancedTensions, at: &Linearization| of.residuals.force.max(ROUNDING_FORCE) * at.largest_force;
    let allowed = MOST_FORCE_RATIO * unbalanced(&before, &at);
    let Some(least) = without_self_stress(problem, &at, &found.tension) else { return before };
    // the unit of forces is smaller without those that only hold each other
    problem.linearize(&found.x, &least, HessianKind::GaussNewton, &mut at);
    let least = settled(&at, least);
    // next to a singular state what is taken out is only nearly a self stress: balanced forces are worth more
    if unbalanced(&least, &at) <= allowed { least } else { before }
}

/// Tensions that make the same forces, of which those of rigid measures have the least norm: those of finite stiffness
/// follow from their stretch.
fn without_self_stress<P: Problem>(problem: &P, at: &Linearization, tension: &[f64]) -> Option<Vec<f64>> {
    let (layout, rigid) = (problem.layout(), RigidRows::new(problem, at));
    let forces: Vec<f64> = rigid.numbers.iter().map(|&row| tension[row] * at.sizes[row]).collect();
    let least = rank::without_null(&rigid.rows(), layout.unknowns, &layout.node, &forces).ok()?;
    let mut tension = tension.to_vec();
    rigid.numbers.into_iter().zip(least).for_each(|(row, force)| tension[row] = force / at.sizes[row]);
    Some(tension)
}
