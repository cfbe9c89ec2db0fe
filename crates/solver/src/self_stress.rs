//! Self stresses: tensions of rigid measures that balance each other, so that equilibrium does not determine them.

use super::linearization::Linearization;
use super::problem::Problem;
use foldwell_numerics::rank;
use foldwell_numerics::sparse::{Cliques, Rows};

/// Singular values of the stiff Jacobian below this, relative to its largest entry, count as zero.
const ZERO_SINGULAR_VALUE: f64 = 1e-6;

/// Number of self stresses at a linearization; `None` where no measure is rigid, or where they cannot be counted.
pub(crate) fn self_stresses<P: Problem>(problem: &P, at: &Linearization) -> Option<usize> {
    let (layout, rigid) = (problem.layout(), RigidRows::new(problem, at));
    if rigid.numbers.is_empty() {
        return None;
    }
    let rank = rank::count_above(&rigid.rows(), layout.unknowns, &layout.node, ZERO_SINGULAR_VALUE).ok()?;
    Some(rigid.numbers.len() - rank)
}

/// The gradients of the rigid measures, each divided by its natural size.
pub(super) struct RigidRows {
    /// Numbers of the rigid measures among the stiff ones.
    pub numbers: Vec<usize>,
    cliques: Cliques,
    values: Vec<f64>,
}

impl RigidRows {
    /// Collects those of a problem at a linearization.
    pub fn new<P: Problem>(problem: &P, at: &Linearization) -> Self {
        let (layout, compliance) = (problem.layout(), problem.compliance());
        let numbers: Vec<usize> = (0..compliance.len()).filter(|&row| compliance[row] == 0.0).collect();
        let (mut cliques, mut values) = (Cliques::new(), vec![]);
        for &row in &numbers {
            cliques.push(layout.stiff.members(row).iter().copied());
            values.extend(at.stiff_gradient(row).iter().map(|entry| entry / at.sizes[row]));
        }
        Self { numbers, cliques, values }
    }

    /// They as a sparse matrix.
    pub fn rows(&self) -> Rows<'_> {
        Rows { cliques: &self.cliques, values: &self.values }
    }
}
