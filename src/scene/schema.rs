//! The JSON schema of a scene, generated from the types that read it, so that both always agree.

use schemars::{JsonSchema, Schema, SchemaGenerator, schema_for};
use serde_json::Value;

use super::spec::{Scene, StudyKind};

/// Returns the JSON schema of a scene file, pretty-printed, in the form that editors with a TOML language server use.
pub fn schema() -> String {
    format!("{:#}\n", schema_for!(Scene).to_value())
}

/// Returns the keys that every study has.
pub(super) fn common_study_keys() -> [&'static str; 4] {
    ["name", "kind", "check", "draw"]
}

/// Returns the kinds of studies.
pub(super) fn kinds() -> impl Iterator<Item = &'static str> {
    StudyKind::ALL.iter().map(|(kind, _)| *kind)
}

/// Returns the kinds of studies that have a key.
pub(super) fn kinds_with_key(key: &str) -> Vec<&'static str> {
    let with_key = StudyKind::ALL.iter().filter(|(_, of_kind)| keys(*of_kind).iter().any(|k| k == key));
    with_key.map(|(kind, _)| *kind).collect()
}

/// Whether a key stands in no table of a scene.
pub(super) fn is_key_of_scene(key: &str) -> bool {
    keys(Scene::json_schema).iter().any(|known| known == key)
}

fn keys(schema: fn(&mut SchemaGenerator) -> Schema) -> Vec<String> {
    let schema = schema(&mut SchemaGenerator::default());
    let properties = schema.get("properties").and_then(Value::as_object);
    properties.map(|p| p.keys().cloned().collect()).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::spec::StudySpec;

    fn properties(schema: &Value) -> Vec<&str> {
        schema["properties"].as_object().unwrap().keys().map(String::as_str).collect()
    }

    /// Claim: the schema contains every table of the scene under the name that scene files use.
    #[test]
    fn schema_names_the_tables_of_a_scene() {
        let schema: Value = serde_json::from_str(&schema()).unwrap();
        assert_eq!(
            properties(&schema),
            [
                "drive", "energy", "load", "lock", "mass", "material", "part", "pin", "pressure", "sheet", "spring",
                "study", "sweep", "tie", "title", "units"
            ]
        );
        assert_eq!(schema["required"], serde_json::json!(["sheet"]));
    }

    /// Claim: the keys that are separated before a kind is read are those of the type of a study.
    #[test]
    fn common_keys_are_the_keys_of_a_study() {
        let mut found = keys(StudySpec::json_schema);
        found.push("kind".into());
        found.sort();
        let mut expected = common_study_keys();
        expected.sort_unstable();
        assert_eq!(found, expected);
    }

    /// Claim: kinds and keys are those that the documentation of the scene lists.
    #[test]
    fn keys_of_kinds() {
        assert_eq!(kinds_with_key("tolerance"), ["relax", "trace", "path", "fold"]);
        assert_eq!(kinds_with_key("grid"), ["bloch"]);
        assert!(kinds_with_key("mesh").is_empty());
    }
}
