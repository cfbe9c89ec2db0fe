//! JSON as summaries have it.

use serde::Serialize;
use serde::de::DeserializeOwned;
use std::fs;
use std::path::Path;

/// Returns a value as pretty-printed JSON with a newline at the end.
pub fn to_json(value: &impl Serialize) -> String {
    // serialization cannot fail: the types above have string keys and derived serializers
    serde_json::to_string_pretty(value).unwrap_or_default() + "\n"
}

/// Reads a value from a file; `None` where it is not there, truncated, or something else.
pub(crate) fn from_file<T: DeserializeOwned>(path: &Path) -> Option<T> {
    serde_json::from_str(&fs::read_to_string(path).ok()?).ok()
}
