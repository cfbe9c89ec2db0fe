//! Tensions of a converged state without self stress, and the residuals that hold with them.

use super::linearization::{HessianKind, Linearization};
use super::newton::Equilibrium;
use super::problem::{Problem, Residuals};
use super::self_stress::{self_stress, self_stresses, without_self_stress};
use super::tangent::Tangent;
use foldwell_numerics::vector::moved;

/// Tensions without self stress are taken where the scaled residual force with them is at most this many times the one
/// before.
const MOST_FORCE_RATIO: f64 = 10.0;
/// Scaled residual force below which it may be rounding error alone.
const ROUNDING_FORCE: f64 = 1e-13;

/// Multiples of a self stress as large as the tensions, each with both signs, with which negative eigenvalues are counted
/// again: those that hold a sheet may be several times as large.
const MULTIPLES: [f64; 8] = [0.25, 0.5, 1.0, 1.5, 2.0, 3.0, 4.0, 6.0];

/// A converged state's tensions.
#[derive(Clone, Debug)]
pub struct BalancedTensions {
    /// Tensions, of least energy where rigid measures leave a self stress free.
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

/// Negative eigenvalues of an equilibrium with these tensions of least energy; `None` if their number cannot be
/// established. Where rigid measures have self stresses, the Hessian is not the same for all of them. If any gives no
/// negative eigenvalue, the state is a minimum; another number is known only if no self stress of a few sizes changes it.
pub fn negative_eigenvalues<P: Problem>(problem: &P, x: &[f64], least: &[f64]) -> Option<usize> {
    let count = |tension: &[f64]| {
        let mut tangent = Tangent::at_state(problem, x, tension, HessianKind::Full).ok()?;
        tangent.negative_eigenvalues().ok()?
    };
    let counted = count(least)?;
    if counted == 0 || !problem.compliance().contains(&0.0) {
        return Some(counted);
    }
    let mut at = Linearization::new(problem.layout());
    problem.linearize(x, least, HessianKind::GaussNewton, &mut at);
    let Some(stress) = self_stress(problem, &at, least) else { return Some(counted) };
    let mut multiples = MULTIPLES.iter().flat_map(|multiple| [*multiple, -multiple]);
    multiples.all(|multiple| count(&moved(least, multiple, &stress)) == Some(counted)).then_some(counted)
}
