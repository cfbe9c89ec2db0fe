//! Tensions of a converged state without self stress, and the residuals that hold with them.

use super::linearization::{HessianKind, Linearization};
use super::newton::Equilibrium;
use super::problem::{Problem, Residuals};
use super::self_stress::self_stresses;
use crate::numerics::rank;
use crate::numerics::sparse::Rows;

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
    let all_rigid = problem.compliance().iter().all(|c| *c == 0.0);
    if !all_rigid || self_stresses.unwrap_or(0) == 0 {
        return before;
    }
    let Some(least) = without_self_stress(problem, &at, &found.tension) else { return before };
    // the unit of forces is smaller without those that only hold each other
    problem.linearize(&found.x, &least, HessianKind::GaussNewton, &mut at);
    let least = settled(&at, least);
    // next to a singular state what is taken out is only nearly a self stress: balanced forces are worth more
    let allowed = MOST_FORCE_RATIO * before.residuals.force.max(ROUNDING_FORCE);
    if least.residuals.force <= allowed { least } else { before }
}

/// The tensions of least norm that make the same forces.
fn without_self_stress<P: Problem>(problem: &P, at: &Linearization, tension: &[f64]) -> Option<Vec<f64>> {
    let layout = problem.layout();
    let scaled = at.scaled_jacobian();
    let rows = Rows { cliques: &layout.stiff, values: &scaled };
    let forces: Vec<f64> = tension.iter().zip(&at.sizes).map(|(t, size)| t * size).collect();
    let least = rank::without_null(&rows, layout.unknowns, &layout.node, &forces).ok()?;
    Some(least.iter().zip(&at.sizes).map(|(t, size)| t / size).collect())
}
