//! Options of a relaxation: tolerance, unknowns, which states on the way are kept.

use crate::model::intrinsic::Unsupported;
use crate::solver::constrained::ConstrainedFailure;
use crate::solver::inertia::in_words;
use crate::solver::{Failure, Options};
use schemars::JsonSchema;
use serde::Deserialize;
use std::num::NonZeroUsize;
use thiserror::Error;

/// The unknowns of a relaxation.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
#[schemars(rename = "MethodSpec")]
pub enum Method {
    /// Positions; but fold angles for a patch with many vertices that starts without known tensions and of whose first
    /// step in positions no more than a quarter can be taken, and for any patch where positions do not converge.
    #[default]
    Auto,
    /// Positions of the vertices.
    Vertices,
    /// Fold angles; positions if these fail.
    Intrinsic,
}

/// Tolerance, number of steps, and method of a relaxation, and the states that are kept.
#[derive(Clone, Copy, Debug, Default)]
pub struct RelaxOptions {
    /// Tolerance and number of steps of Newton's method.
    pub newton: Options,
    /// The unknowns.
    pub method: Method,
    /// Which states on the way are kept: one in so many, the first and the last one included; none without it.
    pub keep_every: Option<NonZeroUsize>,
}

impl From<Options> for RelaxOptions {
    fn from(newton: Options) -> Self {
        Self { newton, method: Method::Auto, keep_every: None }
    }
}

/// Why a relaxation that was to be made in fold angles was made in positions alone.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[allow(missing_docs)] // each variant is documented by its message
pub enum IntrinsicFailure {
    #[error(transparent)]
    Unsupported(#[from] Unsupported),
    #[error(transparent)]
    Solver(#[from] ConstrainedFailure),
    #[error("an edge is folded by {angle:.3} rad: faces have passed through each other")]
    FoldedThrough {
        /// The largest fold angle, in radians.
        angle: f64,
    },
    #[error("the state found in fold angles is no minimum: {} negative eigenvalues", in_words(*negative))]
    Saddle { negative: Option<usize> },
    #[error("the state found in fold angles was not confirmed in positions: {failure}")]
    NotConfirmed { failure: Failure },
}
