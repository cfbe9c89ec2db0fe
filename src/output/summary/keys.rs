//! Schemas of keys that have few values.

use schemars::{Schema, SchemaGenerator, json_schema};

/// One way or the other.
pub(crate) fn sign(_: &mut SchemaGenerator) -> Schema {
    json_schema!({ "enum": [1, -1] })
}

/// One way or the other, or neither.
pub(crate) fn sign_or_null(_: &mut SchemaGenerator) -> Schema {
    json_schema!({ "enum": [1, -1, null] })
}
