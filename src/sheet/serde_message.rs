//! Messages of serde and of readers built on it, in words that do not name types of Rust.

/// Returns an error of serde in words: what is wrong, and what is expected.
pub(crate) fn in_words(message: &str) -> (String, Option<String>) {
    let (wrong, right) = match message.split_once(", expected ") {
        Some((wrong, _)) if wrong.contains("$__toml") => ("the value is a date", Some("a number, or a text in quotes")),
        Some((wrong, right)) => (wrong, Some(right)),
        None if message == "wanted string or table" => ("the value is no word", Some("a word in quotes")),
        None => (message, None),
    };
    let wrong = match wrong.strip_prefix("invalid type: ").or_else(|| wrong.strip_prefix("invalid value: ")) {
        Some("map") => "the value is a table".to_owned(),
        Some("sequence") => "the value is a list".to_owned(),
        Some(found) => {
            let value = found.find(['`', '"']).map_or(found, |at| &found[at..]);
            format!("the value is {}", value.trim_end_matches(" as i128"))
        }
        None => wrong.replace("unknown variant", "unknown word"),
    };
    let right = right.map(|right| match right {
        "f64" => "a number",
        "usize" | "u64" | "u32" => "a whole number, 0 or more",
        "i64" => "a whole number",
        "a boolean" => "true or false",
        "a string" | "string" => "a text in quotes",
        "literal string" => "a number, or a text in quotes",
        "a sequence" => "a list [..]",
        "map" | "a map" => "a table, { pattern = \"miura\", .. }",
        "struct BarsSpec" | "struct CreasesSpec" => "a table, { stiffness = 1.0, .. }",
        "struct HingeYieldSpec" => "a table, { moment = 0.2 }",
        "an array of length 2" => "two numbers, [2, 2] in a scene and 2,2 after `--key` of `foldwell new`",
        "path string" => "a path in quotes",
        right if right.starts_with("struct ") => "a table",
        right => right,
    });
    (wrong, right.map(str::to_owned))
}

/// Returns the message of an error in JSON without the line and column.
pub(crate) fn without_place(error: &serde_json::Error) -> String {
    let message = error.to_string();
    message.rsplit_once(" at line ").map_or(message.as_str(), |(message, _)| message).to_owned()
}
