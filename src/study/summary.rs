//! What comes out of a study, as `summary.json` has it.

use super::bloch::BlochSummary;
use super::branches::BranchesSummary;
use super::landscape::LandscapeSummary;
use super::modes::ModesSummary;
use super::path::PathSummary;
use super::relax::RelaxSummary;
use super::response::ResponseSummary;
use super::surface::SurfaceSummary;
use super::trace::TraceSummary;
use super::wells::WellsSummary;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Serialize};
use serde_json::json;

/// What came out of a study.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct StudySummary {
    /// Its name.
    pub name: String,
    /// Its kind; the other keys depend on it.
    #[schemars(schema_with = "kind")]
    pub kind: String,
    /// Whether it gave its answer.
    pub converged: bool,
    /// Time in seconds, drawing and writing excluded.
    pub seconds: f64,
    /// The study's own error estimate; null where it gave no answer.
    pub error: Option<f64>,
    /// Why it did not converge; absent where it did.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schemars(with = "String")]
    pub reason: Option<String>,
    /// What it wrote, by which a resumed run sees whether that is still there; absent while it is not finished.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Files")]
    pub files: Option<Files>,
    /// The keys of its kind; null where it did not get so far.
    #[serde(flatten)]
    #[schemars(schema_with = "answers")]
    pub result: Option<StudyResult>,
}

/// The files of a study, taken together.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct Files {
    /// How many there are.
    pub count: usize,
    /// Their bytes in all.
    pub bytes: u64,
    /// Sixteen hexadecimal digits that change with any name and any byte of theirs.
    pub digest: String,
}

/// Defines the results of each kind of study, and the list of kinds with the schemas of these.
macro_rules! kinds {
    ($($($word:literal)|+: $kind:ident($result:ty)),* $(,)?) => {
        /// The results of each kind of study.
        #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
        #[serde(untagged)]
        pub enum StudyResult {
            $($(#[doc = concat!("`kind = \"", $word, "\"`.")])+ $kind($result)),*
        }

        /// The word of every kind, and the function that returns the schema of its results.
        const KINDS: &[(&str, fn(&mut SchemaGenerator) -> Schema)] =
            &[$($(($word, <$result>::json_schema)),+),*];
    };
}
kinds! {
    "relax": Relax(RelaxSummary),
    "modes": Modes(ModesSummary),
    "branches": Branches(BranchesSummary),
    "surface": Surface(SurfaceSummary),
    "landscape": Landscape(LandscapeSummary),
    "bloch": Bloch(Box<BlochSummary>),
    "wells": Wells(WellsSummary),
    "path" | "fold": Path(PathSummary),
    "response": Response(Box<ResponseSummary>),
    "trace": Trace(TraceSummary),
}

impl StudySummary {
    /// Makes the summary of a study that has no result yet.
    pub(crate) fn unanswered(name: &str, kind: &str) -> Self {
        Self { name: name.to_owned(), kind: kind.to_owned(), ..Self::default() }
    }

    /// Describes the study for the console: what it found, how long it took, and why it did not converge.
    pub fn sentence(&self) -> String {
        let what = match &self.result {
            Some(StudyResult::Relax(found)) => found.sentence(self.converged),
            Some(StudyResult::Modes(found)) => found.sentence(),
            Some(StudyResult::Branches(found)) => found.sentence(),
            Some(StudyResult::Trace(found)) => found.sentence(),
            Some(StudyResult::Surface(found)) => found.sentence(),
            Some(StudyResult::Landscape(found)) => found.sentence(),
            Some(StudyResult::Bloch(found)) => found.sentence(),
            Some(StudyResult::Wells(found)) => found.sentence(),
            Some(StudyResult::Path(found)) => found.sentence(),
            Some(StudyResult::Response(found)) => found.sentence(),
            None => String::from("no result"),
        };
        let failed = self.reason.as_ref().map(|reason| format!("\n  not converged: {reason}")).unwrap_or_default();
        format!("{} ({}): {what}, {:.2} s{failed}", self.name, self.kind, self.seconds)
    }
}

/// Returns the schema of the name of a kind of study.
fn kind(_: &mut SchemaGenerator) -> Schema {
    json_schema!({ "enum": KINDS.iter().map(|(kind, _)| kind).collect::<Vec<_>>() })
}

/// Returns the schema of the keys that a study has in addition to the common ones: those of its kind, if it converged
/// or has the first of them.
fn answers(generator: &mut SchemaGenerator) -> Schema {
    let by_kind = KINDS.iter().map(|(kind, answer)| {
        let answer = answer(generator);
        json!({
            "if": {
                "properties": { "kind": { "const": kind } },
                "anyOf": [
                    { "properties": { "converged": { "const": true } } },
                    { "required": [answer.get("required").and_then(|keys| keys.get(0))] },
                ],
            },
            "then": answer,
        })
    });
    json_schema!({ "allOf": by_kind.collect::<Vec<_>>() })
}
