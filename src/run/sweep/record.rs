//! What the folder of a point says about it: `summary.json` of its run, or `failed.json` with the reason for which its
//! scene could not be computed.
//!
//! Either counts only if it has the digest of the point's scene, and a summary only if it has every study: a point that
//! a run was computing when it ended has no result.

use std::path::Path;

use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

use super::summary::PointStatus;
use crate::output::json::{from_file, to_json};
use crate::output::{OutputError, files};
use crate::run::belongings::Belongings;
use crate::run::ledger::INTERRUPTED;
use crate::run::{RunError, Summary};
use crate::scene::{Fingerprint, SceneFile, digest};
use crate::study::Files;

/// Name of the summary of a run.
pub(super) const SUMMARY: &str = "summary.json";
/// Name of the file with the reason for which a point could not be computed.
const FAILURE: &str = "failed.json";

/// The result of a point.
pub(super) enum Record {
    /// The studies of its summary.
    Computed(Vec<Map<String, Value>>),
    /// Why it could not be computed.
    Failed(String),
}

/// The parts of `summary.json` that say whether a point is finished.
#[derive(Deserialize)]
struct RecordedSummary {
    digest: String,
    studies: Vec<Map<String, Value>>,
}

/// The content of `failed.json`.
#[derive(Serialize, Deserialize)]
struct FailedPoint {
    /// Digest of the point's scene.
    digest: String,
    /// What the point sets, as `key=value`.
    settings: Vec<String>,
    /// Why it could not be computed.
    reason: String,
}

impl Record {
    /// Returns the result of a point whose run has this summary.
    pub(super) fn of(summary: &Summary) -> Self {
        let studies = serde_json::to_value(&summary.studies).and_then(serde_json::from_value);
        Self::Computed(studies.unwrap_or_default())
    }

    /// Reads the result of a point with this scene; `None` if there is none.
    pub(super) fn read(scene: &SceneFile, folder: &Path) -> Option<Self> {
        if !folder.is_dir() {
            return None;
        }
        let digest = digest_of(scene);
        if let Some(found) = from_file::<FailedPoint>(&folder.join(FAILURE)).filter(|found| found.digest == digest) {
            return Some(Self::Failed(found.reason));
        }
        let found = from_file::<RecordedSummary>(&folder.join(SUMMARY)).filter(|found| found.digest == digest)?;
        let names = scene.scene.studies.iter().map(|study| Some(study.name.0.as_str()));
        let complete = names.eq(found.studies.iter().map(|study| word(study, "name")));
        let interrupted = found.studies.iter().any(|study| word(study, "reason") == Some(INTERRUPTED));
        (complete && !interrupted).then_some(Self::Computed(found.studies))
    }

    /// Reads the result of a point that need not be computed again. A point that could not be computed is tried again.
    /// Drafts that a killed run has left in its folder are removed.
    pub(super) fn finished(scene: &SceneFile, folder: &Path) -> Option<Self> {
        files::remove_drafts(folder);
        Self::read(scene, folder).filter(|found| found.is_whole(scene, folder))
    }

    /// Whether the point was computed and its files are those on record.
    pub(super) fn is_whole(&self, scene: &SceneFile, folder: &Path) -> bool {
        let Self::Computed(studies) = self else { return false };
        let belongings = Belongings::new(scene, folder);
        studies.iter().all(|study| {
            let recorded = study.get("files").and_then(|files| serde_json::from_value::<Files>(files.clone()).ok());
            recorded.is_some() && recorded == word(study, "name").and_then(|name| belongings.record(name).ok())
        })
    }

    /// Returns what became of the point.
    pub(super) fn status(&self) -> PointStatus {
        match self {
            Self::Computed(studies) if studies.iter().all(converged) => PointStatus::Converged,
            Self::Computed(_) => PointStatus::NotConverged,
            Self::Failed(_) => PointStatus::Failed,
        }
    }

    /// Returns why the point has no answer to every study; empty if it has.
    pub(super) fn reason(&self) -> String {
        match self {
            Self::Failed(reason) => reason.clone(),
            Self::Computed(studies) => {
                let part = |study: &Map<String, Value>| {
                    let [name, reason] = ["name", "reason"].map(|key| word(study, key).unwrap_or_default());
                    format!("{name}: {reason}")
                };
                let without = studies.iter().filter(|study| !converged(study));
                without.map(part).collect::<Vec<_>>().join("; ")
            }
        }
    }
}

/// Writes the reason for which a point could not be computed into its folder.
pub(super) fn write_failure(scene: &SceneFile, folder: &Path, error: &RunError) -> Result<(), OutputError> {
    let (digest, settings) = (digest_of(scene), scene.settings().to_vec());
    files::write(&folder.join(FAILURE), to_json(&FailedPoint { digest, settings, reason: error.to_string() }))
}

/// Removes the record that an earlier run could not compute a point.
pub(super) fn forget_failure(folder: &Path) -> Result<(), OutputError> {
    files::remove(&folder.join(FAILURE))
}

/// Returns the digest of a scene; of its settings and name alone if a file that it names cannot be read.
fn digest_of(scene: &SceneFile) -> String {
    digest(scene).unwrap_or_else(|_| {
        let mut hash = Fingerprint::default();
        scene.settings().iter().for_each(|setting| hash.add(setting.as_bytes()));
        hash.add(scene.title().as_bytes());
        hash.to_string()
    })
}

fn word<'a>(study: &'a Map<String, Value>, key: &str) -> Option<&'a str> {
    study.get(key)?.as_str()
}

fn converged(study: &Map<String, Value>) -> bool {
    study.get("converged") == Some(&Value::Bool(true))
}
