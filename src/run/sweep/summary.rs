//! The summary of a sweep: `sweep.json`.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::scene::spec::UnitsSpec;

/// What a sweep of `foldwell` found: `sweep.json`. The results of its points are in `sweep.csv`, a row for each.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
#[schemars(title = "foldwell sweep")]
pub struct SweepSummary {
    /// Version of the program.
    pub version: &'static str,
    /// The scene file, as it was named.
    pub scene: String,
    /// Keys that were set in the scene from outside, as `key=value`; left out where there are none.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub settings: Vec<String>,
    /// The title of the scene; the name of its file where it has none.
    pub title: String,
    /// The names of units that the scene gives; left out where it gives none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub units: Option<UnitsSpec>,
    /// A fingerprint of the scene and of every file that it names.
    pub digest: String,
    /// The paths of the keys that the points set, in the order of the columns.
    pub keys: Vec<String>,
    /// How many points there are.
    pub points: usize,
    /// Those at which every study gave its answer.
    pub converged: usize,
    /// Those at which a study did not converge.
    pub not_converged: usize,
    /// Those whose scene could not be computed.
    pub failed: usize,
    /// Numbers of the points that have no result yet.
    pub missing: Vec<usize>,
    /// The points that have no answer to every study, missing ones apart.
    pub unanswered: Vec<UnansweredPoint>,
}

/// A point of a sweep that has no answer to every study.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, JsonSchema)]
pub struct UnansweredPoint {
    /// Number of the point.
    pub point: usize,
    /// What it sets, as `key=value`.
    pub settings: Vec<String>,
    /// What became of it.
    pub status: PointStatus,
    /// Why.
    pub reason: String,
}

/// What became of a point of a sweep.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum PointStatus {
    /// Every study gave its answer.
    Converged,
    /// A study did not converge.
    NotConverged,
    /// The scene of the point could not be computed.
    Failed,
    /// It has no result yet.
    Missing,
}

impl PointStatus {
    /// Returns the word in tables and summaries.
    pub fn word(self) -> &'static str {
        match self {
            Self::Converged => "converged",
            Self::NotConverged => "not-converged",
            Self::Failed => "failed",
            Self::Missing => "missing",
        }
    }
}
