//! The JSON schema of `summary.json`, made from the types that write it ([`super::summary`]), so that it cannot fall behind
//! them.
//!
//! Keys that are not described are findings: every table is closed. The keys of a kind of study stand with it where it gave its
//! answer; where it did not get so far all of them are missing.

use schemars::generate::SchemaSettings;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde_json::{Value, json};

use super::summary::{
    BlochSummary, BranchesSummary, LandscapeSummary, ModesSummary, RelaxSummary, Summary, SurfaceSummary, TraceSummary,
    WellsSummary,
};

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

/// The JSON schema (draft 2020-12) of `summary.json`, pretty-printed.
pub fn schema() -> String {
    let generator = SchemaSettings::draft2020_12().for_serialize().into_generator();
    let mut root = generator.into_root_schema_for::<Summary>();
    close(&mut root);
    if let Some(Value::Object(tables)) = root.get_mut("$defs") {
        tables.values_mut().filter_map(|table| table.try_into().ok()).for_each(close);
    }
    format!("{:#}\n", root.to_value())
}

/// Refuses keys that are not described.
fn close(table: &mut Schema) {
    let key = if table.get("allOf").is_some() { "unevaluatedProperties" } else { "additionalProperties" };
    table.insert(key.to_owned(), Value::Bool(false));
}

/// The kind of a study.
pub(super) fn kind(_: &mut SchemaGenerator) -> Schema {
    json_schema!({ "enum": ANSWERS.map(|(kind, _)| kind) })
}

/// What a study has beside the keys of all: the keys of its kind where it converged, or has the first of them.
pub(super) fn answers(generator: &mut SchemaGenerator) -> Schema {
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

/// One way or the other.
pub(super) fn sign(_: &mut SchemaGenerator) -> Schema {
    json_schema!({ "enum": [1, -1] })
}

/// One way or the other, or neither.
pub(super) fn sign_or_null(_: &mut SchemaGenerator) -> Schema {
    json_schema!({ "enum": [1, -1, null] })
}
