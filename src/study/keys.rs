//! Schemas of keys with few possible values.

use schemars::{Schema, SchemaGenerator, json_schema};

/// Returns the schema of a sign: 1 or -1.
pub(crate) fn sign(_: &mut SchemaGenerator) -> Schema {
    json_schema!({ "enum": [1, -1] })
}

/// Returns the schema of a sign that may be null.
pub(crate) fn sign_or_null(_: &mut SchemaGenerator) -> Schema {
    json_schema!({ "enum": [1, -1, null] })
}
