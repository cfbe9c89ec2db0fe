//! Where the iteration stops, what it finds, and why it finds nothing.

use foldwell_numerics::factor::FactorError;
use thiserror::Error;

/// Tolerance and number of steps.
#[derive(Clone, Copy, Debug)]
pub struct Settings {
    /// Largest change of a variable by a Gauss-Newton step at a converged state, relative to the largest variable
    /// where that is above 1.
    pub tolerance: f64,
    /// Largest number of steps.
    pub iterations: usize,
}

impl Default for Settings {
    fn default() -> Self {
        Self { tolerance: 1e-10, iterations: 100 }
    }
}

/// One state of the iteration, the start first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ConstrainedStep {
    /// The function that is minimised.
    pub value: f64,
    /// Largest unbalanced force, `(z - a)/c + J^T l`, over the largest force `(z - a)/c`.
    pub imbalance: f64,
    /// Largest value of a constraint.
    pub violation: f64,
    /// Largest change of a variable by the Gauss-Newton step from here.
    pub correction: f64,
    /// Fraction of the step taken to get here; 0 for the start.
    pub fraction: f64,
    /// Whether the step from here uses the full Hessian.
    pub full: bool,
    /// Number of factorizations made to get here.
    pub factorizations: usize,
    /// Number of linear solves made to get here.
    pub solves: usize,
}

/// A state of the iteration with its record, as an observer sees it.
#[derive(Clone, Copy, Debug)]
pub struct ConstrainedIterate<'a> {
    /// Variables.
    pub z: &'a [f64],
    /// Multipliers of the constraints.
    pub multipliers: &'a [f64],
    /// The record.
    pub step: &'a ConstrainedStep,
}

/// A converged state.
#[derive(Clone, Debug)]
pub struct Minimum {
    /// Variables.
    pub z: Vec<f64>,
    /// Multipliers of the constraints.
    pub multipliers: Vec<f64>,
    /// All states, the start first.
    pub history: Vec<ConstrainedStep>,
}

/// Why the iteration did not converge.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[allow(missing_docs)] // the messages say it
pub enum ConstrainedFailure {
    #[error("no step shrinks the correction, which changes a variable by {correction:.1e}")]
    Stuck { correction: f64 },
    #[error("no convergence within {iterations} steps")]
    TooManySteps { iterations: usize },
    #[error("a constraint is not finite")]
    NotFinite,
    #[error("constraints that depend on each other: {0}")]
    Factor(#[from] FactorError),
    #[error("stopped on request")]
    Interrupted,
}

/// A failure with the last state.
#[derive(Debug, Error)]
#[error("{failure}")]
pub struct ConstrainedError {
    /// The reason.
    pub failure: ConstrainedFailure,
    /// Variables of the last state.
    pub z: Vec<f64>,
    /// All states, the start first.
    pub history: Vec<ConstrainedStep>,
}
