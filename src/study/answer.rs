//! The answer of a study: its part of the summary, its files, and the data that later studies start from or draw.

use crate::model::Configuration;
use crate::output::artifact::Artifact;
use crate::output::figure::surface::TrajectoryPoint;
use crate::scene::spec::StudySpec;
use crate::study::{StudyResult, StudySummary};

/// The answer of a study, not yet written to files.
#[derive(Debug)]
pub struct Answer {
    /// The study's part of `summary.json`; its computing time is filled in later.
    pub summary: StudySummary,
    /// The study's files: names relative to the folder of the run, in the order in which they are to be written.
    pub files: Vec<(String, Artifact)>,
    /// The state in which the study ended, from which later studies can start.
    pub state: Option<Configuration>,
    /// The trajectories that the study followed, in the space of lattice strains; later surface studies draw them.
    pub paths: Vec<Vec<TrajectoryPoint>>,
}

impl Answer {
    /// Returns an answer without content, of a study that did not converge.
    pub fn empty(study: &StudySpec) -> Self {
        let summary = StudySummary::unanswered(&study.name.0, study.kind.name());
        Self { summary, files: Vec::new(), state: None, paths: Vec::new() }
    }

    /// Returns an answer without result, with the reason for that.
    pub fn failed(study: &StudySpec, reason: String) -> Self {
        let mut answer = Self::empty(study);
        answer.summary.reason = Some(reason);
        answer
    }

    /// Records the result and its error estimate. The study counts as converged if there is no `reason` against it.
    pub fn conclude(&mut self, result: StudyResult, error: Option<f64>, reason: Option<String>) {
        self.summary.converged = reason.is_none();
        self.summary.error = error;
        self.summary.reason = reason;
        self.summary.result = Some(result);
    }

    /// Adds a file. `name` is relative to the folder of the run.
    pub fn add(&mut self, name: impl Into<String>, artifact: impl Into<Artifact>) {
        self.files.push((name.into(), artifact.into()));
    }
}
