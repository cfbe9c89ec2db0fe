//! The JSON schema of `summary.json`. It is generated from the types that are written ([`Summary`], [`SweepSummary`]),
//! so that both always agree.
//!
//! The schema allows no keys other than those described. A study that gave a result has all keys of its kind; the other
//! studies have none of them.

use schemars::generate::SchemaSettings;
use schemars::{JsonSchema, Schema};
use serde_json::Value;

use super::summary::Summary;
use super::sweep::SweepSummary;

/// Returns the JSON schema (draft 2020-12) of `summary.json`, pretty-printed.
pub fn schema() -> String {
    schema_of::<Summary>()
}

/// Returns the JSON schema (draft 2020-12) of `sweep.json`, pretty-printed.
pub fn of_sweep() -> String {
    schema_of::<SweepSummary>()
}

fn schema_of<T: JsonSchema>() -> String {
    let generator = SchemaSettings::draft2020_12().for_serialize().into_generator();
    let mut root = generator.into_root_schema_for::<T>();
    close(&mut root);
    if let Some(Value::Object(tables)) = root.get_mut("$defs") {
        tables.values_mut().filter_map(|table| table.try_into().ok()).for_each(close);
    }
    format!("{:#}\n", root.to_value())
}

/// Forbids keys that are not described, unless the table has keys of any name.
fn close(table: &mut Schema) {
    let key = if table.get("allOf").is_some() { "unevaluatedProperties" } else { "additionalProperties" };
    if table.get(key).is_none() {
        table.insert(key.to_owned(), Value::Bool(false));
    }
}
