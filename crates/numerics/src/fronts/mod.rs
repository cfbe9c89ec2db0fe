//! Multifrontal `L D L^T` factorization without pivoting, on all of the caller's threads.
//!
//! A *front* is a dense matrix for a few unknowns that are eliminated together, its *pivots*, and for all other
//! unknowns that their elimination changes, its rows below. It is the sum of the entries of the matrix in the columns
//! of its pivots and of the *update matrices* of its children in the tree of fronts. Eliminating the pivots,
//!
//! `[ F_11  F_21^T ]   [ L_1     ] [ D    ] [ L_1^T  L_2^T ]`
//! `[ F_21  F_22   ] = [ L_2  1  ] [    U ] [           1  ]`
//!
//! leaves `L_1`, `L_2` and `D` to the factor, and the update matrix `U = F_22 - L_2 D L_2^T` to the parent (I. Duff and
//! J. Reid, ACM Trans. Math. Softw. 9, 302 (1983); J. Liu, SIAM Rev. 34, 82 (1992)). Which unknowns make a front is
//! faer's analysis into supernodes.
//!
//! Subtrees are independent of each other, and large fronts are worked on in tiles. Neither division depends on the
//! number of threads, and every sum is made in an order that is fixed: results have the same bits for any number.
//!
//! | file | what it is for |
//! |---|---|
//! | `supernodes` | the supernodes of faer's analysis as a tree |
//! | `symbolic` | the tree of fronts, its division into tasks, and where everything goes |
//! | `numeric` | assembling the fronts, from the leaves to the roots |
//! | `dense` | eliminating the pivots of one front |
//! | `solve` | substitution |

mod dense;
mod numeric;
mod solve;
mod supernodes;
mod symbolic;
#[cfg(test)]
mod tests;

use super::factor_error::FactorError;
use super::parallel;
use bytemuck::allocation::try_zeroed_vec;
use numeric::{Factorization, Space};
use solve::{FrontNumbers, Substitution};
use std::sync::Arc;
use symbolic::Room;

pub(super) use symbolic::AssemblyTree;

/// Count of numbers in a factor below which substitution stays on the calling thread.
const FEWEST_SHARED_NUMBERS: usize = 500_000;

/// A factorization, refilled with numbers as often as wanted.
pub(super) struct Fronts {
    tree: Arc<AssemblyTree>,
    /// The factor.
    panels: Vec<f64>,
    /// Room for update matrices.
    even: Vec<f64>,
    odd: Vec<f64>,
    /// Room for substitution: the unknowns, and the rows below the pivots of all fronts.
    unknowns: Vec<f64>,
    rows: Vec<f64>,
}

impl Fronts {
    /// Makes room for a factorization.
    ///
    /// # Errors
    /// [`FactorError::TooLarge`] where there is not enough memory.
    pub fn new(tree: &Arc<AssemblyTree>) -> Result<Self, FactorError> {
        let tree = tree.clone();
        let size = tree.order.len();
        // the system gives zeros page by page when they are first used, which the threads of a factorization then share
        let zeros = |count: usize| try_zeroed_vec(count).map_err(|()| FactorError::TooLarge { size });
        let (panels, rows) = tree.fronts.last().map_or((0, 0), |front| (front.panel.end, front.rows.end));
        let Room { even, odd } = Room::sum(&tree.branches);
        let (panels, even, odd) = (zeros(panels)?, zeros(even)?, zeros(odd)?);
        Ok(Self { panels, even, odd, unknowns: zeros(size)?, rows: zeros(rows)?, tree })
    }

    /// Factors the matrix with these entries of its lower triangle in the pattern.
    ///
    /// # Errors
    /// [`FactorError::Singular`] where a pivot is zero or not finite.
    pub fn factor(&mut self, input: &[f64]) -> Result<(), FactorError> {
        let Self { tree, panels, even, odd, .. } = self;
        let worthwhile = matches!(&tree.branches[..], [_, _, ..]) || tree.branches.iter().any(|branch| branch.divided);
        let done = parallel::in_pool(worthwhile, |shared| {
            Factorization { tree, input, shared }.branches(&tree.branches, Space { panels, even, odd })
        });
        done.map_err(|dense::ZeroPivot| FactorError::Singular { ratio: 0.0 })
    }

    /// The entries of `D`.
    pub fn pivots(&self) -> impl Iterator<Item = f64> + '_ {
        self.tree.fronts.iter().flat_map(move |front| {
            let (start, height) = (front.panel.start, front.height());
            (0..front.width()).map(move |k| self.panels[start + k * height + k])
        })
    }

    /// Solves with the last factorization, in place.
    pub fn solve(&mut self, x: &mut [f64]) {
        let Self { tree, panels, unknowns, rows, .. } = self;
        unknowns.iter_mut().zip(&tree.order).for_each(|(to, &from)| *to = x[from as usize]);
        parallel::in_pool(panels.len() >= FEWEST_SHARED_NUMBERS, |shared| {
            let substitution = Substitution { tree, panels, shared };
            substitution.forward(&tree.branches, FrontNumbers { unknowns: &mut *unknowns, rows: &mut *rows });
            substitution.back(&tree.branches, FrontNumbers { unknowns: &mut *unknowns, rows: &mut *rows });
        });
        unknowns.iter().zip(&tree.order).for_each(|(from, &to)| x[to as usize] = *from);
    }

    /// Count of numbers stored in the factor.
    pub fn stored(&self) -> usize {
        self.panels.len()
    }
}
