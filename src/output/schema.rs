//! The JSON schema of `summary.json`, made from the types that write it ([`super::summary`]), so that it cannot fall behind
//! them.
//!
//! Keys that are not described are findings: every table is closed. The keys of a kind of study stand with it where it gave its
//! answer; where it did not get so far all of them are missing.

use schemars::Schema;
use schemars::generate::SchemaSettings;
use serde_json::Value;

use super::summary::Summary;

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
