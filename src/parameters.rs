//! Parameters of a pattern from the command line: `--height 0.5 --cells 3,3` becomes a table.

use std::path::PathBuf;

use foldwell::Pattern;
use thiserror::Error;
use toml::{Table, Value};

/// Parameters that are true or false: without a value they are true.
const SWITCHES: [&str; 1] = ["closed"];

/// The errors in the words after a pattern.
#[derive(Debug, Error, PartialEq, Eq)]
pub(crate) enum ParameterError {
    #[error("`{0}` stands where a parameter was expected; write --key value, and -o FILE for the mesh")]
    NoKey(String),
    #[error("parameter `--{0}` has no value; write --{0} value")]
    NoValue(String),
    #[error("`-o` has no file; write -o FILE.fold")]
    NoFile,
    #[error("`{0}` is too large; whole numbers go up to 9223372036854775807")]
    TooLarge(String),
    #[error("parameter `--{0}` is given twice")]
    Twice(String),
    #[error("{0}")]
    NoPattern(String),
    #[error("there is no file for the mesh; add -o FILE.fold")]
    NoOutput,
}

/// Returns the table `{ pattern, key = value, .. }` and the file of `-o`.
///
/// Keys may contain `-` instead of `_`, and may be separated from the value by `=`. A value is a whole number, a
/// number, `true`, `false`, a list separated by commas, or otherwise a word. One of [`SWITCHES`] needs no value.
pub(crate) fn parse(pattern: &str, words: &[String]) -> Result<(Table, PathBuf), ParameterError> {
    let mut table = Table::new();
    table.insert("pattern".into(), pattern.into());
    let mut output = None;
    let mut words = words.iter().peekable();
    while let Some(word) = words.next() {
        let (key, inline) = split(word)?;
        let value = match inline {
            Some(value) => value,
            None if key == "o" => words.next().ok_or(ParameterError::NoFile)?,
            None if SWITCHES.contains(&&*key) && words.peek().is_none_or(|next| next.starts_with('-')) => "true",
            None => words.next().ok_or_else(|| ParameterError::NoValue(key.clone()))?,
        };
        if value.parse::<i64>().is_err() && !value.is_empty() && value.bytes().all(|byte| byte.is_ascii_digit()) {
            return Err(ParameterError::TooLarge(value.into()));
        }
        let before = match key.as_str() {
            "o" => output.replace(PathBuf::from(value)).is_some(),
            _ => table.insert(key.replace('-', "_"), parse_value(value)).is_some(),
        };
        if before {
            return Err(ParameterError::Twice(key));
        }
    }
    Ok((table, output.ok_or(ParameterError::NoOutput)?))
}

/// Whether the words after `foldwell new` ask for a page of help.
pub(crate) fn ask_for_help(pattern: &str, words: &[String]) -> bool {
    is_help(pattern) || words.iter().any(|word| is_help(word))
}

fn is_help(word: &str) -> bool {
    matches!(word, "-h" | "--help")
}

/// Returns a page about a pattern and its parameters, or, for a word that asks for help itself, about all patterns.
pub(crate) fn help(pattern: &str) -> Result<String, ParameterError> {
    let page = |name: &str| {
        Pattern::help(name).map_err(|error| ParameterError::NoPattern(format!("{error}; {}", error.help())))
    };
    if !is_help(pattern) {
        let usage = format!("Usage: foldwell new {pattern} [--key value]... -o <FILE.fold>");
        return Ok(format!(
            "{}\n{usage}\n\nLengths are in your own unit; an angle is a number of radians, or \"60 deg\".\n",
            page(pattern)?
        ));
    }
    let mut text =
        "Generate a pattern\n\nUsage: foldwell new <PATTERN> [--key value]... -o <FILE.fold>\n\nPatterns:\n".to_owned();
    for name in Pattern::names() {
        text.push_str(&format!(
            "  {name:<20} {}\n",
            page(name)?.split("\n\n").next().unwrap_or_default().replace('\n', " ")
        ));
    }
    Ok(text + "\n`foldwell new <PATTERN> --help` draws the parameters of one, with their ranges and defaults.\n")
}

/// Splits `--key`, `--key=value` or `-o` into the key and the value, if the word contains one.
fn split(word: &str) -> Result<(String, Option<&str>), ParameterError> {
    if word == "-o" || word == "--output" {
        return Ok(("o".into(), None));
    }
    let rest = word.strip_prefix("--").filter(|rest| !rest.is_empty() && !rest.starts_with('='));
    let rest = rest.filter(|rest| *rest != "o").ok_or_else(|| ParameterError::NoKey(word.into()))?;
    Ok(match rest.split_once('=') {
        Some((key, value)) => (key.into(), Some(value)),
        None => (rest.into(), None),
    })
}

fn parse_value(text: &str) -> Value {
    if text.contains(',') {
        return text.split(',').map(|item| parse_value(item.trim())).collect::<Vec<_>>().into();
    }
    let whole = text.parse::<i64>().ok().map(Value::from);
    let number = || text.parse::<f64>().ok().map(Value::from);
    let truth = || text.parse::<bool>().ok().map(Value::from);
    whole.or_else(number).or_else(truth).unwrap_or_else(|| text.into())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn words(text: &str) -> Vec<String> {
        text.split(' ').map(str::to_owned).collect()
    }

    /// Claim: every form of a value, including negative numbers, becomes the value that a scene would have.
    #[test]
    fn parameters_become_a_table() {
        let (table, out) =
            parse("miura", &words("--cells 3,3 --height -0.5 -o a.fold --seed=7 --bar-x foo --on true")).unwrap();
        let expected = "pattern = 'miura'\ncells = [3, 3]\nheight = -0.5\nseed = 7\nbar_x = 'foo'\non = true";
        assert_eq!((table, out), (expected.parse().unwrap(), PathBuf::from("a.fold")));
    }

    /// Claim: a switch without a value is true, wherever it stands, and a value that follows it is its own.
    #[test]
    fn switches_need_no_value() {
        for (text, closed) in [
            ("--closed -o a.fold --sides 5", true),
            ("--sides 5 -o a.fold --closed", true),
            ("--closed --sides=5 -o a.fold", true),
            ("--closed false --sides 5 -o a.fold", false),
            ("--closed=false --sides 5 -o a.fold", false),
        ] {
            let (table, _) = parse("kresling", &words(text)).unwrap();
            assert_eq!((table["closed"].as_bool(), table["sides"].as_integer()), (Some(closed), Some(5)), "{text}");
        }
    }

    /// Claim: the error names the missing or superfluous word.
    #[test]
    fn wrong_parameters_are_named() {
        let fault = |text: &str| parse("miura", &words(text)).unwrap_err();
        assert_eq!(fault("-o a.fold 3"), ParameterError::NoKey("3".into()));
        assert_eq!(fault("-o a.fold --seed"), ParameterError::NoValue("seed".into()));
        assert_eq!(fault("-o a.fold --seed 1 --seed 2"), ParameterError::Twice("seed".into()));
        assert_eq!(fault("-o a.fold --pattern x"), ParameterError::Twice("pattern".into()));
        assert_eq!(fault("--seed 1"), ParameterError::NoOutput);
        assert_eq!(fault("--seed 1 -o"), ParameterError::NoFile);
        assert_eq!(fault("--seed 18446744073709551615"), ParameterError::TooLarge("18446744073709551615".into()));
    }
}
