//! Self stresses: tensions of rigid measures that balance each other, so that equilibrium does not determine them.

use super::linearization::Linearization;
use super::problem::Problem;
use crate::numerics::rank;
use crate::numerics::sparse::Rows;

/// Singular values of the stiff Jacobian below this, relative to its largest entry, count as zero.
const ZERO_SINGULAR_VALUE: f64 = 1e-6;

/// Number of self stresses at a linearization; `None` where no measure is rigid, or where they cannot be counted.
pub(crate) fn self_stresses<P: Problem>(problem: &P, at: &Linearization) -> Option<usize> {
    let layout = problem.layout();
    if !problem.compliance().contains(&0.0) {
        return None;
    }
    let scaled = at.scaled_jacobian();
    let rows = Rows { cliques: &layout.stiff, values: &scaled };
    let rank = rank::count_above(&rows, layout.unknowns, &layout.node, ZERO_SINGULAR_VALUE).ok()?;
    Some(layout.stiff.len() - rank)
}
