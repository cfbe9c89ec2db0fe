//! What a minimisation finds, or why it finds nothing.

use crate::problem::Collapse;
use foldwell_numerics::factor::FactorError;
use std::fmt;
use thiserror::Error;

/// One accepted step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step {
    /// Merit: the energy, stiff measures included.
    pub energy: f64,
    /// Largest unbalanced force relative to the largest force of an element.
    pub residual_force: f64,
    /// Largest gap of a stiff measure relative to its natural size.
    pub residual_length: f64,
    /// Fraction of the Newton step taken to get here; 0 for a start.
    pub fraction: f64,
    /// Shift of the Hessian, relative to its largest diagonal entry.
    pub shift: f64,
    /// Number of factorizations made for this step.
    pub factorizations: usize,
    /// Number of linear solves made for this step, chord corrections included.
    pub solves: usize,
    /// Whether the step was made in other unknowns, by
    /// [`minimize_constrained`](crate::constrained::minimize_constrained); its gaps are then those of the constraints.
    pub intrinsic: bool,
}

/// The state that an accepted step leads to, as an observer sees it.
#[derive(Debug)]
pub struct Iterate<'a, P> {
    /// The problem, which has accepted this state.
    pub problem: &'a P,
    /// Unknowns.
    pub x: &'a [f64],
    /// Tensions of the stiff measures.
    pub tension: &'a [f64],
    /// The record of the step.
    pub step: &'a Step,
}

/// A converged state.
#[derive(Clone, Debug)]
pub struct Equilibrium {
    /// Unknowns.
    pub x: Vec<f64>,
    /// Tensions of the stiff measures.
    pub tension: Vec<f64>,
    /// Energy, stiff measures included.
    pub energy: f64,
    /// Negative eigenvalues of the energy's Hessian on what the rigid measures leave free; `None` where their number
    /// cannot be established.
    pub negative_eigenvalues: Option<usize>,
    /// Whether the rigid measures were seen to be independent; then there is no self stress.
    pub independent: bool,
    /// Accepted steps, the start first.
    pub history: Vec<Step>,
}

/// Why a minimisation did not converge.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[allow(missing_docs)] // each variant is documented by its message
pub enum Failure {
    #[error("the rigid measures cannot be met: largest scaled gap {gap:.2e}")]
    Infeasible { gap: f64 },
    #[error("singular start: to first order the rigid measures leave no motion that relieves the force")]
    SingularStart,
    #[error("no step lowers the energy: residual force {force:.2e}, residual length {length:.2e}")]
    Stuck {
        force: f64,
        /// Scaled residual length.
        length: f64,
    },
    #[error(
        "no convergence within {iterations} steps in a row: residual force {force:.2e}, residual length {length:.2e}"
    )]
    TooManySteps {
        iterations: usize,
        force: f64,
        /// Scaled residual length.
        length: f64,
    },
    #[error("{}", uncertain(*angle, *force, *tolerance))]
    Uncertain {
        /// Largest change of an angle that one more Newton step would make, in radians.
        angle: f64,
        force: f64,
        tolerance: f64,
    },
    #[error(
        "with rigid bars the forces cannot balance: the stiffer the bars, the nearer the sheet comes to a rigid state, but \
         for bars ten times as stiff the largest force in them grows by a factor of {growth:.2}, without bound"
    )]
    Unbounded { growth: f64 },
    #[error("the energy of the state is not a finite number")]
    NotFinite,
    #[error(transparent)]
    Collapsed(#[from] Collapse),
    #[error(transparent)]
    Factor(#[from] FactorError),
    #[error("stopped on request")]
    Interrupted,
}

/// The message of [`Failure::Uncertain`]: the forces balance, or they do not and cannot be improved.
fn uncertain(angle: f64, force: f64, tolerance: f64) -> String {
    if force <= tolerance {
        return format!(
            "the forces balance, but the angles are known to {angle:.1e} rad only: \
             rounding, or a direction without cost"
        );
    }
    let stays = format!("the residual force {force:.2e} stays above the tolerance {tolerance:.1e}");
    if angle.is_finite() {
        format!("{stays}: no step lowers it, and one more would turn angles by {angle:.1e} rad")
    } else {
        format!("{stays}, and no step lowers it")
    }
}

/// A failure with the last accepted state.
#[derive(Error)]
#[error("{failure}")]
pub struct NewtonError {
    /// The reason.
    pub failure: Failure,
    /// Unknowns of the last accepted state.
    pub x: Vec<f64>,
    /// Tensions of the last accepted state.
    pub tension: Vec<f64>,
    /// Accepted steps.
    pub history: Vec<Step>,
}

/// Without the numbers of the state and of all steps, of which there may be thousands.
impl fmt::Debug for NewtonError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut shown = f.debug_struct("NewtonError");
        shown.field("failure", &self.failure).field("unknowns", &self.x.len());
        shown.field("steps", &self.history.len()).field("last_step", &self.history.last());
        shown.finish_non_exhaustive()
    }
}
