//! Paths of equilibria: how the solutions of a problem change with one parameter.
//!
//! A [`ParametrizedProblem`] depends on a parameter `l`, a load factor or a prescribed displacement for instance. Its
//! equilibria are a curve in the space of unknowns, tensions and parameter. The curve is followed by pseudo-arc-length
//! continuation (E. Riks, J. Appl. Mech. 39, 1060, 1972; H. B. Keller, "Numerical solution of bifurcation and nonlinear
//! eigenvalue problems", 1977): the next state is predicted by a cubic through the last two and corrected by Newton's
//! method in the plane across the predicted direction. The parameter is one of the unknowns there, so that states at
//! which it turns back are like all others.
//!
//! At every state the number of negative eigenvalues at fixed parameter tells the stability. Extrema of the parameter
//! and of its conjugate, branch points and sign changes of watched functions are located between states.
//!
//! | file | content |
//! |---|---|
//! | `problem` | [`ParametrizedProblem`], and the states of a path |
//! | `bordered`, `corrector` | the linear system with the parameter as an unknown, and Newton's method with it |
//! | `interpolant`, `follower` | states between two others, and steps |
//! | `events`, `work` | special states, and the work along the path |
//! | `branching`, `ring` | directions that leave a path at a branch point, also where two eigenvalues vanish at once |
//! | `run`, `exits`, `switching` | branches from their beginning to their end, and from one to the next |
//! | `reach` | the state at the target alone |
//! | `record` | what an interrupted run has found, and how a later one goes on from it |
//! | `outcome` | settings and results |

mod bordered;
mod branching;
mod corrector;
mod events;
mod exits;
mod follower;
mod interpolant;
mod outcome;
mod problem;
mod reach;
mod record;
mod ring;
mod run;
mod switching;
#[cfg(test)]
mod tests;
mod work;

use super::newton::Start;
pub use events::Watch;
pub use outcome::{Branch, BranchEnd, HalfBranches, MarkedState, PathError, PathMark, PathSettings};
pub use problem::{ParametrizedProblem, PathState, Rates};
pub use reach::reach;
pub use record::{PathEntry, PathObserver, PathRecord};
use run::PathRun;

/// Follows the equilibria of a problem from a start near one, at the problem's present parameter, towards the target of
/// the settings; then, if the settings ask for it, the branches that leave at branch points. `record` is what an
/// earlier run of the same path has found, empty if there was none; of that nothing is computed again.
///
/// # Errors
/// [`PathError`] if no equilibrium is found to begin with, or a linear system is too large.
pub fn follow_path<P: ParametrizedProblem>(
    problem: &mut P,
    start: Start,
    settings: &PathSettings,
    watch: &mut dyn Watch<P>,
    observer: &mut dyn PathObserver<P>,
    record: PathRecord,
) -> Result<Vec<Branch>, PathError> {
    let mut run = PathRun::new(problem, settings, watch, observer, record)?;
    run.main_branch(start)?;
    run.other_branches()?;
    Ok(run.branches)
}
