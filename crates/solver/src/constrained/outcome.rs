//! The minimum to which the iteration converges, and the reasons for which it does not converge.

use crate::newton::Step;
use foldwell_numerics::factor::FactorError;
use thiserror::Error;

/// A state of the iteration with its record, as an observer sees it.
#[derive(Clone, Copy, Debug)]
pub struct ConstrainedIterate<'a> {
    /// Variables.
    pub z: &'a [f64],
    /// Multipliers of the constraints.
    pub multipliers: &'a [f64],
    /// The record.
    pub step: &'a Step,
}

/// A converged state.
#[derive(Clone, Debug)]
pub struct Minimum {
    /// Variables.
    pub z: Vec<f64>,
    /// Multipliers of the constraints.
    pub multipliers: Vec<f64>,
    /// All states, the start first.
    pub history: Vec<Step>,
}

/// Why the iteration did not converge.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[allow(missing_docs)] // each variant is documented by its message
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
    pub history: Vec<Step>,
}
