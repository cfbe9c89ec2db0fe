//! The published JSON schemas are those that the program prints, and describe the same studies.

use serde_json::Value;
use std::fs;
use std::path::Path;

/// Returns names of the files in `validation/schema`, and the output of `foldwell schema NAME`.
fn schemas() -> [(&'static str, String); 3] {
    use foldwell::run::schema::{of_sweep, schema};
    [("scene", foldwell::scene::schema()), ("summary", schema()), ("sweep", of_sweep())]
}

/// Claim: the files of the repository and the output of the program agree to the byte, so that a key that was added,
/// renamed or described differently is noticed.
#[test]
fn published_schemas_are_those_of_the_program() {
    for (name, printed) in schemas() {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("validation/schema/{name}.json"));
        let published = fs::read_to_string(path).unwrap();
        let anew = format!("write it anew: foldwell schema {name} > validation/schema/{name}.json");
        let differs = published.lines().zip(printed.lines()).find(|(a, b)| a != b);
        assert!(published == printed, "{anew}; the first difference (file, program): {differs:?}");
    }
}

/// Returns the values of all `"const": "..."` in a schema.
fn constants(schema: &Value) -> Vec<&str> {
    let below: Box<dyn Iterator<Item = &Value>> = match schema {
        Value::Object(keys) => Box::new(keys.values()),
        Value::Array(list) => Box::new(list.iter()),
        _ => return Vec::new(),
    };
    schema.get("const").and_then(Value::as_str).into_iter().chain(below.flat_map(constants)).collect()
}

/// Claim: the kinds of studies are the same in the schemas of scenes and of summaries.
#[test]
fn scenes_and_summaries_know_the_same_studies() {
    let [scene, summary, _] = schemas().map(|(_, text)| serde_json::from_str::<Value>(&text).unwrap());
    let mut asked = constants(&scene["$defs"]["StudySpec"]);
    let mut answered = constants(&summary["$defs"]["StudySummary"]);
    asked.sort_unstable();
    answered.sort_unstable();
    assert_eq!(asked, answered);
    assert_eq!(asked.len(), 11);
}

/// Returns the places of a schema where a table allows other keys, or a key has no description.
fn findings(schema: &Value, place: &str) -> Vec<String> {
    let Some(properties) = schema["properties"].as_object() else { return Vec::new() };
    let closed = ["additionalProperties", "unevaluatedProperties"].iter().any(|key| schema[key] == false);
    let open = (!closed).then(|| format!("{place} is open"));
    let silent = properties.iter().filter(|(_, key)| key["description"].is_null());
    open.into_iter().chain(silent.map(|(name, _)| format!("{place}.{name} says nothing"))).collect()
}

/// Claim: every key of a summary, also of a sweep, is described, and no table but that of energies allows other keys;
/// the results of studies are parts of the table of a study, which allows no other keys.
#[test]
fn every_key_of_a_summary_is_described() {
    let summary: Value = serde_json::from_str(&foldwell::run::schema::schema()).unwrap();
    let mut found = findings(&summary, "summary");
    for (name, table) in summary["$defs"].as_object().unwrap() {
        found.extend(findings(table, name));
    }
    let sweep: Value = serde_json::from_str(&foldwell::run::schema::of_sweep()).unwrap();
    found.extend(findings(&sweep, "sweep"));
    found.extend(findings(&sweep["$defs"]["UnansweredPoint"], "unanswered"));
    let answers = summary["$defs"]["StudySummary"]["allOf"].as_array().unwrap();
    assert_eq!(answers.len(), 11);
    for answer in answers {
        let kind = answer["if"]["properties"]["kind"]["const"].as_str().unwrap();
        assert!(answer["if"]["anyOf"][1]["required"][0].is_string(), "{kind}");
        let mut closed = answer["then"].clone();
        closed["additionalProperties"] = Value::Bool(false);
        found.extend(findings(&closed, kind));
    }
    assert_eq!(found, ["EnergySummary is open"], "energies are listed by the names of terms");
}
