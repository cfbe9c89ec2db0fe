//! JSON as summaries have it.

use serde::Serialize;

/// Returns a value as pretty-printed JSON with a newline at the end.
pub fn to_json(value: &impl Serialize) -> String {
    // serialization cannot fail: the types above have string keys and derived serializers
    serde_json::to_string_pretty(value).unwrap_or_default() + "\n"
}
