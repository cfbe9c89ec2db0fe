//! The scalar results of the studies of a point, named `STUDY.key`.
//!
//! Keys of tables inside are joined by points, `relaxed.energy.total`. Of lists only the main answers of a study are
//! there, by their numbers from 0: `cost.modes.0.exponent`, `loops.branches.0.arc_length`, `stable.wells.0.energy`.

use serde_json::{Map, Value};

/// Keys of a study that are no results, or that differ from run to run.
const LEFT_OUT: [&str; 5] = ["name", "kind", "reason", "seconds", "files"];
/// Kinds of studies and those of their lists that are main answers.
const ANSWERS: [(&str, &str); 5] =
    [("landscape", "modes"), ("trace", "branches"), ("path", "branches"), ("wells", "wells"), ("wells", "barriers")];

/// Returns the scalar results of a study as names and fields of a table; a field is empty where the result is null.
pub(super) fn of_study(study: &Map<String, Value>) -> Vec<(String, String)> {
    let text = |key: &str| study.get(key).and_then(Value::as_str).unwrap_or_default();
    let (name, kind) = (text("name"), text("kind"));
    let mut found = Vec::new();
    for (key, value) in study.iter().filter(|(key, _)| !LEFT_OUT.contains(&key.as_str())) {
        let path = format!("{name}.{key}");
        match value {
            Value::Array(list) if ANSWERS.contains(&(kind, key)) => {
                list.iter().enumerate().for_each(|(k, value)| add(&mut found, format!("{path}.{k}"), value));
            }
            value => add(&mut found, path, value),
        }
    }
    found
}

fn add(found: &mut Vec<(String, String)>, path: String, value: &Value) {
    match value {
        Value::Null => found.push((path, String::new())),
        Value::Bool(word) => found.push((path, word.to_string())),
        Value::Number(number) => found.push((path, field(number))),
        Value::String(text) => found.push((path, text.clone())),
        Value::Object(table) => table.iter().for_each(|(key, value)| add(found, format!("{path}.{key}"), value)),
        Value::Array(_) => {}
    }
}

/// Returns a number with the fewest digits that are read back exactly, as in the tables of studies.
fn field(number: &serde_json::Number) -> String {
    match number.as_f64() {
        Some(value) if number.is_f64() => format!("{value:?}"),
        _ => number.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    /// Claim: tables are joined by points, main answers have numbers, other lists and times are left out, and null is
    /// empty.
    #[test]
    fn scalars_have_their_paths() {
        let study = json!({
            "name": "a", "kind": "wells", "seconds": 0.1, "error": null, "converged": true, "history": [{ "step": 1 }],
            "wells": [{ "energy": 1e-7, "joins": [0, 1] }], "rigid": { "states": 3 }, "words": "b, c",
        });
        let found = of_study(study.as_object().unwrap());
        let expected = [
            ("a.converged", "true"),
            ("a.error", ""),
            ("a.rigid.states", "3"),
            ("a.wells.0.energy", "1e-7"),
            ("a.words", "b, c"),
        ];
        assert_eq!(found, expected.map(|(name, value)| (name.to_owned(), value.to_owned())));
    }
}
