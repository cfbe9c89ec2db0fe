//! The kinds of study in the schema: which keys belong to which.

use super::{
    BlochSummary, BranchesSummary, LandscapeSummary, ModesSummary, RelaxSummary, SurfaceSummary, TraceSummary,
    WellsSummary,
};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde_json::json;

/// The kinds of studies, and the schema of what each has to say.
type Answer = fn(&mut SchemaGenerator) -> Schema;
const ANSWERS: [(&str, Answer); 8] = [
    ("relax", RelaxSummary::json_schema),
    ("trace", TraceSummary::json_schema),
    ("surface", SurfaceSummary::json_schema),
    ("modes", ModesSummary::json_schema),
    ("branches", BranchesSummary::json_schema),
    ("landscape", LandscapeSummary::json_schema),
    ("bloch", BlochSummary::json_schema),
    ("wells", WellsSummary::json_schema),
];

/// The kind of a study.
pub(crate) fn kind(_: &mut SchemaGenerator) -> Schema {
    json_schema!({ "enum": ANSWERS.map(|(kind, _)| kind) })
}

/// What a study has beside the keys of all: the keys of its kind where it converged, or has the first of them.
pub(crate) fn answers(generator: &mut SchemaGenerator) -> Schema {
    let by_kind = ANSWERS.map(|(kind, answer)| {
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
    json_schema!({ "allOf": by_kind })
}
