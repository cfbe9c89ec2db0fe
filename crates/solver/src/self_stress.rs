//! Self stresses: tensions of rigid measures that balance each other, so that equilibrium does not determine them.

use super::linearization::Linearization;
use super::problem::Problem;
use foldwell_numerics::random::numbers;
use foldwell_numerics::rank;
use foldwell_numerics::sparse::{Cliques, Rows};

/// Singular values of the stiff Jacobian below this, relative to its largest entry, count as zero.
const ZERO_SINGULAR_VALUE: f64 = 1e-6;
/// Seed of the random tensions of which a self stress is a part.
const SEED: u64 = 1;
/// Size of that part, relative to the random tensions, up to which it is rounding error and there is no self stress.
const LEAST_SELF_STRESS: f64 = 1e-6;

/// Number of self stresses at a linearization; `None` where no measure is rigid, or where they cannot be counted.
pub(crate) fn self_stresses<P: Problem>(problem: &P, at: &Linearization) -> Option<usize> {
    let (layout, rigid) = (problem.layout(), RigidRows::new(problem, at, &at.sizes));
    if rigid.numbers.is_empty() {
        return None;
    }
    let rank = rank::count_above(&rigid.rows(), layout.unknowns, &layout.node, ZERO_SINGULAR_VALUE).ok()?;
    Some(rigid.numbers.len() - rank)
}

/// Tensions that make the same forces, of which those of rigid measures store the least energy if they are very stiff,
/// in the proportion of [`Problem::proportions`]: those of finite stiffness follow from their stretch.
pub(crate) fn without_self_stress<P: Problem>(problem: &P, at: &Linearization, tension: &[f64]) -> Option<Vec<f64>> {
    let units: Vec<f64> = problem.proportions().into_iter().map(f64::sqrt).collect();
    let (layout, rigid) = (problem.layout(), RigidRows::new(problem, at, &units));
    let forces: Vec<f64> = rigid.numbers.iter().map(|&row| tension[row] * units[row]).collect();
    let least = rank::without_null(&rigid.rows(), layout.unknowns, &layout.node, &forces).ok()?;
    let mut tension = tension.to_vec();
    rigid.numbers.into_iter().zip(least).for_each(|(row, force)| tension[row] = force / units[row]);
    Some(tension)
}

/// One of the self stresses of the rigid measures, taken at random, as large as these tensions of theirs; `None` if they
/// have no self stress, or the tensions are zero.
pub fn self_stress<P: Problem>(problem: &P, at: &Linearization, tension: &[f64]) -> Option<Vec<f64>> {
    let compliance = problem.compliance();
    let rigid = || (0..compliance.len()).filter(|&row| compliance[row] == 0.0);
    let size = |of: &[f64]| rigid().map(|row| (of[row] * at.sizes[row]).powi(2)).sum::<f64>().sqrt();
    let mut any = vec![0.0; compliance.len()];
    rigid().zip(numbers(SEED)).for_each(|(row, number)| any[row] = number / at.sizes[row]);
    let least = without_self_stress(problem, at, &any)?;
    let stress: Vec<f64> = any.iter().zip(&least).map(|(any, least)| any - least).collect();
    let scale = size(tension) / size(&stress);
    let is_one = size(&stress) > LEAST_SELF_STRESS * size(&any) && scale > 0.0;
    is_one.then(|| stress.into_iter().map(|stress| scale * stress).collect())
}

/// The gradients of the rigid measures, each in a unit of its own.
struct RigidRows {
    /// Numbers of the rigid measures among the stiff ones.
    pub numbers: Vec<usize>,
    cliques: Cliques,
    values: Vec<f64>,
}

impl RigidRows {
    /// Collects those of a problem at a linearization, each divided by its unit.
    pub fn new<P: Problem>(problem: &P, at: &Linearization, units: &[f64]) -> Self {
        let (layout, compliance) = (problem.layout(), problem.compliance());
        let numbers: Vec<usize> = (0..compliance.len()).filter(|&row| compliance[row] == 0.0).collect();
        let (mut cliques, mut values) = (Cliques::new(), vec![]);
        for &row in &numbers {
            cliques.push(layout.stiff.members(row).iter().copied());
            values.extend(at.stiff_gradient(row).iter().map(|entry| entry / units[row]));
        }
        Self { numbers, cliques, values }
    }

    /// They as a sparse matrix.
    pub fn rows(&self) -> Rows<'_> {
        Rows { cliques: &self.cliques, values: &self.values }
    }
}
