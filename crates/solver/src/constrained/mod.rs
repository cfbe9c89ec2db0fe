//! Minimisation of a separable quadratic function under local constraints, by Newton's method in the variables and the
//! multipliers. Knows no origami.
//!
//! Minimise `sum_i (z_i - a_i)^2 / (2 c_i)` under `F(z) = 0` ([`ConstrainedProblem`]). With multipliers `l`, the
//! Jacobian `J` and `W = sum_k l_k F_k''` the equations and their Newton step are
//!
//! `D^-1 (z - a) + J^T l = 0`, `F = 0`;  `(D^-1 + W) dz + J^T dl = -D^-1 (z - a) - J^T l`, `J dz = -F`,
//!
//! with `D = diag(c)`. The step is reduced to the multipliers (`reduced`). Constraints that are violated are not
//! restored at every step: they are carried along and corrected by the next ones.
//!
//! # Example
//!
//! The point of the unit circle that is closest to `(2, 1)`:
//!
//! ```
//! use foldwell_solver::constrained::{Block, Blocks, ConstrainedProblem, minimize_constrained};
//!
//! struct Circle(Blocks);
//!
//! impl ConstrainedProblem for Circle {
//!     fn blocks(&self) -> &Blocks {
//!         &self.0
//!     }
//!     fn target(&self) -> &[f64] {
//!         &[2.0, 1.0]
//!     }
//!     fn compliance(&self) -> &[f64] {
//!         &[1.0, 1.0]
//!     }
//!     fn linearize(&self, _number: usize, z: &[f64], multipliers: Option<&[f64]>, out: &mut Block) {
//!         out.values = vec![z[0] * z[0] + z[1] * z[1] - 1.0];
//!         out.jacobian = vec![2.0 * z[0], 2.0 * z[1]];
//!         // second derivatives xx, xy, yy
//!         out.hessian = multipliers.map_or(vec![], |l| vec![2.0 * l[0], 0.0, 2.0 * l[0]]);
//!     }
//! }
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let mut blocks = Blocks::default();
//! blocks.push(1, &[0, 1]); // one constraint on the variables 0 and 1
//! let found = minimize_constrained(&Circle(blocks), vec![0.6, 0.9], &mut |_| true)?;
//! assert!((found.z[0] - 2.0 / f64::sqrt(5.0)).abs() < 1e-12);
//! # Ok(())
//! # }
//! ```

mod iteration;
mod outcome;
mod problem;
mod reduced;
#[cfg(test)]
mod tests;

use iteration::Iteration;
pub use outcome::{ConstrainedError, ConstrainedFailure, ConstrainedIterate, Minimum};
pub use problem::{Block, Blocks, ConstrainedProblem};

/// Minimises from a start. `observe` sees every state, the start first, and returns false to stop.
///
/// The result satisfies the equations of a stationary point; it is a minimum unless the iteration began next to
/// another one, and a caller who must know asks for second derivatives.
///
/// # Errors
/// [`ConstrainedError`] with the reason and the last state.
pub fn minimize_constrained<P: ConstrainedProblem>(
    problem: &P,
    start: Vec<f64>,
    observe: &mut dyn FnMut(&ConstrainedIterate<'_>) -> bool,
) -> Result<Minimum, ConstrainedError> {
    Iteration::new(problem, start)?.run(observe)
}
