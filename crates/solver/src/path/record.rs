//! The record of a path: what was found, step by step, so that an interrupted run can go on from there.
//!
//! A path is determined by its beginning, and each branch by its two last states, so that a run that takes the recorded
//! steps for its own and goes on finds the same states to the last bit as one that was not interrupted.

use super::outcome::{BranchEnd, MarkedState};
use serde::{Deserialize, Serialize};

/// The states that a branch gained at once: those with which it begins, or those of one step.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PathEntry {
    /// Number of the branch.
    pub branch: usize,
    /// Whether the branch begins with these states.
    pub begins: bool,
    /// The states, in order.
    pub states: Vec<MarkedState>,
    /// Length of the next step.
    pub next_step: f64,
    /// The reason for the end of the branch, if it ends with these states.
    pub end: Option<BranchEnd>,
}

/// The entries of a path that was interrupted.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PathRecord(Vec<Vec<PathEntry>>);

impl FromIterator<PathEntry> for PathRecord {
    /// Collects entries in the order in which they were made. A branch that begins anew replaces what was recorded of
    /// it and of all later ones.
    fn from_iter<T: IntoIterator<Item = PathEntry>>(entries: T) -> Self {
        let mut branches: Vec<Vec<PathEntry>> = vec![];
        for entry in entries {
            if entry.begins {
                branches.truncate(entry.branch);
                branches.push(vec![]);
            }
            if let Some(branch) = branches.last_mut().filter(|_| entry.states.iter().all(is_finite)) {
                branch.push(entry);
            }
        }
        Self(branches)
    }
}

impl PathRecord {
    /// Takes what was recorded under the number of a branch, as the record of a path of its own.
    pub fn part(&mut self, branch: usize) -> Self {
        let mut entries = self.0.get_mut(branch).map(std::mem::take).unwrap_or_default();
        entries.iter_mut().for_each(|entry| entry.branch = 0);
        Self(vec![entries])
    }

    /// Takes the entries of a branch that begins with these states. If another one is recorded nothing is taken, and
    /// what was recorded of later branches is forgotten.
    pub(super) fn take(&mut self, branch: usize, first: &[MarkedState]) -> Vec<PathEntry> {
        let recorded = self.0.get_mut(branch).map(std::mem::take).unwrap_or_default();
        if recorded.first().is_some_and(|begin| begin.begins && begin.states == first) {
            return recorded;
        }
        self.0.clear();
        vec![]
    }
}

fn is_finite(marked: &MarkedState) -> bool {
    let state = &marked.state;
    state.x.iter().chain(&state.tension).all(|value| value.is_finite())
}

/// An observer of a path while it is followed: it receives each state and each entry of the record, and can stop the
/// path.
pub trait PathObserver<P> {
    /// Sees a new state of a branch; returns false to stop.
    fn state(&mut self, branch: usize, problem: &P, state: &MarkedState) -> bool;
    /// Sees a state of the record, which was computed before.
    fn known_state(&mut self, branch: usize, problem: &P, state: &MarkedState);
    /// Sees what is new in the record, before its states; returns false to stop.
    fn entry(&mut self, entry: &PathEntry) -> bool;
}
