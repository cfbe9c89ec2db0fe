//! The JSON schema of a scene, made from the types that read it, so that it cannot fall behind them.

use schemars::{JsonSchema, SchemaGenerator, schema_for};
use serde_json::Value;

use super::spec::{self, Scene};

/// The JSON schema of a scene file, pretty-printed; editors with a TOML language server take it as it is.
pub fn schema() -> String {
    format!("{:#}\n", schema_for!(Scene).to_value())
}

/// The keys that every study has.
pub(super) fn common_study_keys() -> [&'static str; 4] {
    ["name", "kind", "check", "draw"]
}

/// The kinds of studies.
pub(super) fn kinds() -> [&'static str; 8] {
    keys_of_kinds().map(|(kind, _)| kind)
}

/// The kinds of studies that have a key.
pub(super) fn kinds_with_key(key: &str) -> Vec<&'static str> {
    keys_of_kinds().into_iter().filter(|(_, keys)| keys.iter().any(|k| k == key)).map(|(kind, _)| kind).collect()
}

fn keys_of_kinds() -> [(&'static str, Vec<String>); 8] {
    [
        ("relax", keys::<spec::RelaxSpec>()),
        ("trace", keys::<spec::TraceSpec>()),
        ("surface", keys::<spec::SurfaceSpec>()),
        ("modes", keys::<spec::ModesSpec>()),
        ("branches", keys::<spec::BranchesSpec>()),
        ("landscape", keys::<spec::LandscapeSpec>()),
        ("bloch", keys::<spec::BlochSpec>()),
        ("wells", keys::<spec::WellsSpec>()),
    ]
}

fn keys<T: JsonSchema>() -> Vec<String> {
    let schema = T::json_schema(&mut SchemaGenerator::default());
    let properties = schema.get("properties").and_then(Value::as_object);
    properties.map(|p| p.keys().cloned().collect()).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn properties(schema: &Value) -> Vec<&str> {
        schema["properties"].as_object().unwrap().keys().map(String::as_str).collect()
    }

    /// Every table of the scene is there under the name that the file uses.
    #[test]
    fn schema_names_the_tables_of_a_scene() {
        let schema: Value = serde_json::from_str(&schema()).unwrap();
        assert_eq!(properties(&schema), ["energy", "load", "lock", "pin", "sheet", "study", "title"]);
        assert_eq!(schema["required"], serde_json::json!(["sheet"]));
    }

    /// The keys set aside before a kind is read are those that the type of a study has.
    #[test]
    fn common_keys_are_the_keys_of_a_study() {
        let mut found = keys::<spec::StudySpec>();
        found.push("kind".into());
        found.sort();
        let mut expected = common_study_keys();
        expected.sort_unstable();
        assert_eq!(found, expected);
    }

    /// Kinds and keys as the documentation of the scene lists them.
    #[test]
    fn keys_of_kinds() {
        assert_eq!(kinds_with_key("tolerance"), ["relax", "trace"]);
        assert_eq!(kinds_with_key("grid"), ["bloch"]);
        assert!(kinds_with_key("mesh").is_empty());
    }
}
