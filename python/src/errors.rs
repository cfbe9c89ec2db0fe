//! Errors of the library as Python exceptions.

use foldwell::run::RunError;
use foldwell::scene::SceneError;
use miette::Diagnostic;
use pyo3::prelude::*;
use std::path::Path;

/// Name in the place of a file of a scene that is a dict.
pub(crate) const DICT: &str = "scene";
/// Name in the place of a file of a scene that is made of arguments.
pub(crate) const ARGUMENTS: &str = "arguments";

/// Returns the exception of a class of `foldwell.errors` with these arguments.
fn exception(py: Python<'_>, class: &str, arguments: (String, Option<String>, Option<String>, Option<usize>)) -> PyErr {
    let make = || py.import("foldwell.errors")?.getattr(class)?.call1(arguments);
    make().map_or_else(|error| error, PyErr::from_value)
}

/// Returns the exception for an error of the library: `SceneError` if something that was given is wrong, `SheetError`
/// if that is a mesh, `OutputError` if a file cannot be read or written. What is wrong in a scene that is no file is
/// named by its key, or by the argument that stands for the key.
pub(crate) fn raise(py: Python<'_>, error: &RunError) -> PyErr {
    let class = match error {
        RunError::Mesh(_) | RunError::NoSheet { .. } | RunError::Scene(SceneError::Mesh(_)) => "SheetError",
        _ if error.exit_status() == 3 => "OutputError",
        _ => "SceneError",
    };
    let mut help = error.help().map(|help| help.to_string());
    if matches!(error, RunError::Pattern(_)) {
        help = help.map(|help| in_python(&help));
    }
    let RunError::Scene(SceneError::At { text, line, key, message, .. }) = error else {
        return exception(py, class, (error.to_string(), help, None, None));
    };
    let key = key.strip_suffix(".file").or_else(|| key.strip_suffix(".rates")).unwrap_or(&**key);
    let key = match Path::new(text.name().trim_end_matches(" (keys set)")).file_name() {
        Some(name) if name == DICT => key.to_owned(),
        Some(name) if name == ARGUMENTS => argument(key),
        _ => return exception(py, class, (error.to_string(), help, Some(text.name().to_owned()), Some(*line))),
    };
    // messages about arrays begin with their names, and are about numbers as they were given
    if !key.is_empty() && message.starts_with(&key) {
        return exception(py, class, (message.clone(), help, None, None));
    }
    let message = if key.is_empty() { message.clone() } else { format!("{key}: {message}") };
    let [message, help] = [Some(message), help].map(|text| text.map(|text| in_python(&text)));
    exception(py, class, (message.unwrap_or_default(), help, None, None))
}

/// Returns the argument of a function of the package that stands for a key of a scene.
pub(crate) fn argument(key: &str) -> String {
    let parts: Vec<&str> = key.split('.').collect();
    match parts[..] {
        ["energy", "bars", "rest", ..] => "rest_lengths".to_owned(),
        ["energy", "creases", "rest", ..] => "rest".to_owned(),
        ["energy", "facets", "rest", ..] => "facet_rest".to_owned(),
        ["study", _, "kind"] => String::new(), // it is in the name of the function
        ["energy", term, "law", ..] => format!("laws.{term}"),
        ["energy", term, "yield", ref rest @ ..] => [&["yields", term], rest].concat().join("."),
        ["energy", term, "stiffness", ..] => term.to_owned(),
        ["energy", _, ref rest @ ..] | ["sheet", ref rest @ ..] | ["study", _, ref rest @ ..] => rest.join("."),
        [list @ ("lock" | "pin" | "load" | "pressure" | "part" | "tie" | "spring" | "drive"), ref rest @ ..] => {
            [&[format!("{list}s").as_str()], rest].concat().join(".")
        }
        _ => key.to_owned(),
    }
}

/// Words of messages about scenes, and those of Python.
const WORDS: [(&str, &str); 13] = [
    (" in a scene and 2,2 after `--key` of `foldwell new`", ""),
    ("`foldwell new PATTERN --help`", "`foldwell.pattern_help`"),
    ("[[", "`"),
    ("]]", "`"),
    ("[sweep]", "`sweep`"),
    ("[material]", "`material`"),
    ("`inf`", "`foldwell.RIGID`"),
    ("{ file = \"k.csv\" }", "an array"),
    ("{ file = \"angles.csv\" }", "an array"),
    ("{ file = \"lengths.csv\" }", "an array"),
    (" in quotes", ""),
    ("a list [..]", "a list"),
    ("a table", "a dict"),
];

/// Returns a message about a scene in the words of Python: `{ key = value }` becomes `{ "key": value }`.
fn in_python(text: &str) -> String {
    let text = WORDS.iter().fold(text.to_owned(), |text, (scene, python)| text.replace(scene, python));
    let mut parts = text.split(" = ");
    let mut written = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let is_inside = written.matches('{').count() > written.matches('}').count();
        let key = written.rfind([' ', '`']).map_or(0, |at| at + 1);
        written = match is_inside {
            _ if written.ends_with('"') => format!("{written}: {part}"),
            true => format!("{}\"{}\": {part}", &written[..key], &written[key..]),
            false => format!("{written}={part}"),
        };
    }
    written
}

/// Returns the `SceneError` about something that was given, with a hint.
pub(crate) fn refused(py: Python<'_>, message: String, help: &str) -> PyErr {
    exception(py, "SceneError", (message, Some(help.to_owned()), None, None))
}

/// Returns the exception for a failure of the program itself.
pub(crate) fn bug(py: Python<'_>, message: String) -> PyErr {
    exception(py, "FoldwellError", (message, None, None, None))
}
