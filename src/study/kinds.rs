//! The kinds of study in the JSON schema, and the keys that belong to each kind.

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
use serde_json::json;

/// A function that returns the schema of the results of a kind of study.
type Answer = fn(&mut SchemaGenerator) -> Schema;
const ANSWERS: [(&str, Answer); 10] = [
    ("relax", RelaxSummary::json_schema),
    ("trace", TraceSummary::json_schema),
    ("surface", SurfaceSummary::json_schema),
    ("modes", ModesSummary::json_schema),
    ("branches", BranchesSummary::json_schema),
    ("landscape", LandscapeSummary::json_schema),
    ("bloch", BlochSummary::json_schema),
    ("wells", WellsSummary::json_schema),
    ("path", PathSummary::json_schema),
    ("response", ResponseSummary::json_schema),
];

/// Returns the schema of the name of a kind of study.
pub(crate) fn kind(_: &mut SchemaGenerator) -> Schema {
    json_schema!({ "enum": ANSWERS.map(|(kind, _)| kind) })
}

/// Returns the schema of the keys that a study has in addition to the common ones: those of its kind, if it converged
/// or has the first of them.
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
