//! Settings and results of a path.

use super::problem::PathState;
use foldwell_numerics::factor::FactorError;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use thiserror::Error;

/// Tolerance, steps and end of a path.
#[derive(Clone, Debug, PartialEq)]
pub struct PathSettings {
    /// Bound on both scaled residuals of every state.
    pub tolerance: f64,
    /// Longest step in arc length.
    pub max_step: f64,
    /// Largest number of states of a branch.
    pub steps: usize,
    /// Parameter to which the path goes first.
    pub target: f64,
    /// Parameters to which it goes from there, one after the other; at the last one it ends.
    pub then: Vec<f64>,
    /// Whether the first branch too, as the others, ends where the parameter is that of the beginning again.
    pub returns: bool,
    /// Parameters of which the states are listed.
    pub listed: Vec<f64>,
    /// Arc length at which a branch ends.
    pub length: f64,
    /// Whether branches that leave at branch points are followed too.
    pub switch: bool,
}

impl Default for PathSettings {
    fn default() -> Self {
        Self {
            tolerance: 1e-12,
            max_step: 0.1,
            steps: 10_000,
            target: f64::INFINITY,
            then: vec![],
            returns: false,
            listed: vec![],
            length: f64::INFINITY,
            switch: false,
        }
    }
}

/// A kind of special state, located between two ordinary ones.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum PathMark {
    /// The parameter has an extremum along the path.
    ParameterTurns,
    /// The conjugate quantity has an extremum along the path.
    ConjugateTurns,
    /// This many eigenvalues change their sign although the parameter goes on: other equilibria leave the path.
    BranchPoint(usize),
    /// The function with this number that is watched along the path changes its sign.
    Watched(usize),
    /// The parameter is one of those that are listed.
    Listed,
    /// The parameter goes another way from here.
    Turned,
}

/// The reason for which a branch ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum BranchEnd {
    /// The parameter is the target's.
    Target,
    /// The branch came back to the parameter at which the path began, or to a branch point that is known.
    Returned,
    /// The branch came back to a state of its own and would go on over its own states.
    Retraced,
    /// The branch has the wanted length.
    Length,
    /// The observer wanted the branch to end at its last mark.
    Marked,
    /// The largest number of states was reached.
    Steps,
    /// No step, however short, could be corrected onto the path.
    Failed,
    /// The observer asked to stop.
    Interrupted,
}

/// A branch of equilibria.
#[derive(Clone, Debug)]
pub struct Branch {
    /// States in order, each with its mark and the work done from the first state of the path to it.
    pub states: Vec<MarkedState>,
    /// The reason for its end.
    pub end: BranchEnd,
    /// The half branches found at its branch points, by number of the state; only for points at which they were sought.
    pub half_branches: BTreeMap<usize, HalfBranches>,
}

/// Numbers of the half branches that leave at a branch point. A branch that passes through the point is two of them;
/// that on which the point was found does not count.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct HalfBranches {
    /// Number of those of which a state was found.
    pub found: usize,
    /// Number of all; `None` where it is not known, since more than two eigenvalues vanish at once or since what tells
    /// directions from each other is rounding error. Then they were sought along null vectors only.
    pub expected: Option<usize>,
    /// Number of those found that have no branch of their own, since they are on a branch that was followed before.
    pub known: usize,
    /// Number of those found that have none, since there are as many branches as may be, or the observer stopped.
    pub left: usize,
}

/// A state of a branch.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MarkedState {
    /// The state.
    pub state: PathState,
    /// The kind of special state; `None` for an ordinary one.
    pub mark: Option<PathMark>,
    /// Negative eigenvalues of the Hessian at fixed parameter; `None` where their number cannot be established, or
    /// where another self stress of rigid measures changes it.
    pub negative_eigenvalues: Option<usize>,
    /// Integral of the conjugate quantity over the parameter, from the first state of the path.
    pub work: f64,
    /// Reference values of the problem after this state was accepted; see [`super::ParametrizedProblem::reference`].
    pub reference: Vec<f64>,
}

/// The reason for which a path cannot be followed.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[allow(missing_docs)] // each variant is documented by its message
pub enum PathError {
    #[error("the start is not an equilibrium, and none is found next to it")]
    NoStart,
    #[error(transparent)]
    Factor(#[from] FactorError),
}

/// Result of a computation on a path: a value, or the error with which the path ends.
pub(super) type Found<T> = Result<T, PathError>;
