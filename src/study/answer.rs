//! What a study found: its part of the summary, its files, and what later studies can start from or draw.

use crate::output::artifact::Artifact;
use crate::output::figure::surface::PathPoint;
use crate::output::summary::{StudyResult, StudySummary};
use crate::scene::spec::StudySpec;
use serde::{Deserialize, Serialize};

/// What a study found. Nothing of it has been written.
#[derive(Debug)]
pub struct Answer {
    /// Its part of `summary.json`; the time that it took is left open.
    pub summary: StudySummary,
    /// Its files: names relative to the folder of the run, in the order in which they are to be written.
    pub files: Vec<(String, Artifact)>,
    /// The state in which it ended, from which later studies can start.
    pub state: Option<SavedState>,
    /// The trajectories that it followed, in the space of lattice strains; later surfaces show them.
    pub paths: Vec<Vec<PathPoint>>,
}

/// A state that later studies may start from.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SavedState {
    /// All coordinates.
    pub coordinates: Vec<f64>,
    /// Angles from which angles continue, see [`crate::model::Model::angles`].
    pub angles: Vec<f64>,
    /// Tensions of the stiff measures; `None` where the study knows none.
    #[serde(default)]
    pub tension: Option<Vec<f64>>,
}

impl Answer {
    /// An answer that says nothing yet, of a study that did not converge.
    pub fn empty(study: &StudySpec) -> Self {
        let summary = StudySummary::unanswered(&study.name.0, study.kind.name());
        Self { summary, files: Vec::new(), state: None, paths: Vec::new() }
    }

    /// An answer that says why there is none.
    pub fn failed(study: &StudySpec, reason: impl ToString) -> Self {
        let mut answer = Self::empty(study);
        answer.summary.reason = Some(reason.to_string());
        answer
    }

    /// Takes in what was found: converged where there is no reason against it.
    pub fn conclude(&mut self, result: StudyResult, error: Option<f64>, reason: Option<String>) {
        self.summary.converged = reason.is_none();
        self.summary.error = error;
        self.summary.reason = reason;
        self.summary.result = Some(result);
    }

    /// Adds a file.
    pub fn add(&mut self, name: impl Into<String>, artifact: impl Into<Artifact>) {
        self.files.push((name.into(), artifact.into()));
    }
}
