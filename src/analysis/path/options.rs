//! The options of a path: its tolerance, its steps, and where it ends.

use crate::analysis::path::stops::PathStop;

/// Tolerance, steps and ends of a path.
#[derive(Clone, Debug, PartialEq)]
pub struct PathOptions {
    /// Bound on both scaled residuals of every state.
    pub tolerance: f64,
    /// Longest step in arc length.
    pub max_step: f64,
    /// Whether the branches that leave at branch points are followed too.
    pub switch: bool,
    /// Whether the sheet goes to the minimum beyond where the driven value cannot grow, as in an experiment, instead of
    /// along the path, on which the driven value turns back; then no branches are followed.
    pub snap: bool,
    /// Conditions that end the path early.
    pub stop: PathStop,
    /// Driven values of which the states are points of their own, wherever the path passes them.
    pub at: Vec<f64>,
    /// Driven values to which the drive goes, one after the other, when it has come to the end that it names: to and fro.
    pub then: Vec<f64>,
}

impl Default for PathOptions {
    fn default() -> Self {
        let (switch, snap, stop) = (false, false, PathStop::default());
        Self { tolerance: 1e-12, max_step: 0.05, switch, snap, stop, at: vec![], then: vec![] }
    }
}
