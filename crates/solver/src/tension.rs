//! Tensions of a converged state without self stress, and the residuals that hold with them.

use super::linearization::{HessianKind, Linearization};
use super::newton::Equilibrium;
use super::problem::{Problem, Residuals};
use super::self_stress::{RigidRows, self_stresses};
use super::tangent::Tangent;
use foldwell_numerics::random::symmetric;
use foldwell_numerics::rank;
use foldwell_numerics::vector::moved;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;

/// Tensions without self stress are taken where the scaled residual force with them is at most this many times the one
/// before.
const MOST_FORCE_RATIO: f64 = 10.0;
/// Scaled residual force below which it may be rounding error alone.
const ROUNDING_FORCE: f64 = 1e-13;

/// Seed of a random self stress, and the part of random tensions from which on what balances itself is one.
const SEED: u64 = 1;
const LEAST_SELF_STRESS: f64 = 1e-6;

/// Parts of a self stress, of both signs, with which negative eigenvalues are counted.
const PARTS: [f64; 8] = [0.25, 0.5, 1.0, 1.5, 2.0, 3.0, 4.0, 6.0];

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

/// A self stress of the rigid measures, one of random direction, as large as these tensions of theirs; `None` if they
/// have none, or the tensions are zero.
pub fn self_stress<P: Problem>(problem: &P, at: &Linearization, tension: &[f64]) -> Option<Vec<f64>> {
    let (mut random, compliance) = (ChaCha8Rng::seed_from_u64(SEED), problem.compliance());
    let size = |of: &[f64]| {
        let rigid = (0..of.len()).filter(|&row| compliance[row] == 0.0);
        rigid.map(|row| (of[row] * at.sizes[row]).powi(2)).sum::<f64>().sqrt()
    };
    let rigid = (0..compliance.len()).map(|row| (compliance[row] == 0.0, at.sizes[row]));
    let any: Vec<f64> = rigid.map(|(rigid, size)| if rigid { symmetric(&mut random) / size } else { 0.0 }).collect();
    let least = without_self_stress(problem, at, &any)?;
    let stress: Vec<f64> = any.iter().zip(&least).map(|(any, least)| any - least).collect();
    let scale = size(tension) / size(&stress);
    let is_one = size(&stress) > LEAST_SELF_STRESS * size(&any) && scale > 0.0;
    is_one.then(|| stress.into_iter().map(|stress| scale * stress).collect())
}

/// Negative eigenvalues of an equilibrium with these tensions of least norm; `None` if their number cannot be
/// established. Where rigid measures have self stresses, the Hessian is not the same for all of them. If any gives no
/// negative eigenvalue, the state is a minimum; another number is known only if no self stress of a few sizes changes it.
pub fn negative_eigenvalues<P: Problem>(problem: &P, x: &[f64], least: &[f64]) -> Option<usize> {
    let count = |tension: &[f64]| {
        let mut tangent = Tangent::at_state(problem, x, tension, HessianKind::Full).ok()?;
        tangent.negative_eigenvalues().ok()?
    };
    let mut at = Linearization::new(problem.layout());
    problem.linearize(x, least, HessianKind::GaussNewton, &mut at);
    let counted = count(least)?;
    let Some(stress) = self_stress(problem, &at, least).filter(|_| counted > 0) else { return Some(counted) };
    let mut parts = PARTS.iter().flat_map(|part| [*part, -part]);
    parts.all(|part| count(&moved(least, part, &stress)) == Some(counted)).then_some(counted)
}
