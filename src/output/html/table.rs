//! The tables of a page: those of the files of a study, and those in its summary.

use serde::Serialize;
use serde_json::{Map, Value};

use super::numbers::{Arrays, Scaled};

/// Largest number of columns of a table; further ones, the fold angles of large cells, are left out.
const COLUMNS: usize = 200;
/// Largest number of rows of a table of the summary.
const ROWS: usize = 5_000;
/// Keys of a summary that a page gives elsewhere, or that differ from run to run.
const ELSEWHERE: [&str; 6] = ["name", "kind", "converged", "reason", "seconds", "files"];

/// A table.
#[derive(Debug, PartialEq, Serialize)]
pub(super) struct TableData {
    name: String,
    rows: usize,
    columns: Vec<PageColumn>,
    /// Number of columns that are left out.
    left_out: usize,
}

#[derive(Debug, PartialEq, Serialize)]
struct PageColumn {
    name: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    numbers: Option<Scaled>,
    #[serde(skip_serializing_if = "Option::is_none")]
    words: Option<Vec<String>>,
}

/// A result of a study that is one number, one word or one truth value: its key and its value.
#[derive(Debug, PartialEq, Serialize)]
pub(super) struct Fact(String, Value);

impl PageColumn {
    /// Makes a column of numbers if all of its fields are numbers or empty, otherwise one of words.
    fn new(arrays: &mut Arrays, name: &str, fields: &[String]) -> Self {
        let number = |field: &String| if field.is_empty() { Some(f64::NAN) } else { field.parse().ok() };
        let numbers: Option<Vec<f64>> = fields.iter().map(number).collect();
        Self {
            name: name.to_owned(),
            words: numbers.is_none().then(|| fields.to_vec()),
            numbers: numbers.map(|numbers| arrays.scaled(&numbers)),
        }
    }
}

impl TableData {
    /// Reads the text of a table of comma-separated fields without quotes. Rows that are too short end with empty
    /// fields.
    pub(super) fn of_text(arrays: &mut Arrays, name: &str, text: &str) -> Self {
        let mut lines = text.trim_start_matches('\u{feff}').lines();
        let header: Vec<&str> = lines.next().unwrap_or_default().split(',').collect();
        let rows: Vec<Vec<&str>> =
            lines.filter(|line| !line.is_empty()).map(|line| line.split(',').collect()).collect();
        let field = |row: &Vec<&'_ str>, at: usize| row.get(at).map_or("", |field| field.trim()).to_owned();
        let column = |(at, name): (usize, &&str)| {
            let fields: Vec<String> = rows.iter().map(|row| field(row, at)).collect();
            PageColumn::new(arrays, name, &fields)
        };
        let columns = header.iter().enumerate().take(COLUMNS).map(column).collect();
        Self { name: name.to_owned(), rows: rows.len(), columns, left_out: header.len().saturating_sub(COLUMNS) }
    }

    /// Makes a table of a list in a summary: numbers, or objects with the same keys, of which the entries that are
    /// lists or objects themselves are left out. `None` for other lists.
    fn of_list(arrays: &mut Arrays, name: &str, list: &[Value]) -> Option<Self> {
        let list = &list[..list.len().min(ROWS)];
        let columns: Vec<(&str, Vec<String>)> = match list.first()? {
            Value::Object(first) => {
                let simple = first.keys().filter(|key| {
                    !list.iter().any(|entry| matches!(entry.get(*key), Some(Value::Array(_) | Value::Object(_))))
                });
                simple.map(|key| (key.as_str(), list.iter().map(|entry| field(entry.get(key))).collect())).collect()
            }
            Value::Number(_) => {
                let places = (0..list.len()).map(|k| k.to_string()).collect();
                vec![("number", places), (name, list.iter().map(|value| field(Some(value))).collect())]
            }
            _ => return None,
        };
        let columns: Vec<PageColumn> =
            columns.iter().map(|(name, fields)| PageColumn::new(arrays, name, fields)).collect();
        (!columns.is_empty()).then(|| Self { name: name.to_owned(), rows: list.len(), columns, left_out: 0 })
    }
}

/// Returns a value of a summary as a field of a table; truth values are 0 and 1.
fn field(value: Option<&Value>) -> String {
    match value {
        Some(Value::Bool(truth)) => u8::from(*truth).to_string(),
        Some(Value::Number(number)) => number.to_string(),
        Some(Value::String(word)) => word.clone(),
        _ => String::new(),
    }
}

/// Returns the results of a study that are single values, and those that are lists as tables. The keys of an object
/// within the summary have the name of the object in front.
pub(super) fn results(arrays: &mut Arrays, summary: &Map<String, Value>) -> (Vec<Fact>, Vec<TableData>) {
    let (mut facts, mut tables) = (Vec::new(), Vec::new());
    for (key, value) in summary.iter().filter(|(key, _)| !ELSEWHERE.contains(&key.as_str())) {
        match value {
            Value::Array(list) => tables.extend(TableData::of_list(arrays, key, list)),
            Value::Object(inner) => {
                let simple = inner.iter().filter(|(_, value)| !value.is_array() && !value.is_object());
                facts.extend(simple.map(|(name, value)| Fact(format!("{key}.{name}"), value.clone())));
            }
            simple => facts.push(Fact(key.clone(), simple.clone())),
        }
    }
    facts.retain(|Fact(_, value)| !value.is_null());
    (facts, tables)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::table::columns_of;
    use serde_json::json;

    /// Claim: columns of numbers, with empty fields and with any magnitude, are arrays; a column with a word is one of
    /// words; CRLF, a byte order mark and short rows do no harm.
    #[test]
    fn columns_are_numbers_or_words() {
        let mut arrays = Arrays::default();
        let text = "\u{feff}step,reaction,event\r\n0,,\r\n1,1e300,limit-load\r\n2\r\n";
        let table = TableData::of_text(&mut arrays, "p.csv", text);
        assert_eq!((table.rows, table.columns.len(), table.left_out), (3, 3, 0));
        assert_eq!(table.columns[0].numbers.map(|numbers| numbers.scale), Some(2.0));
        assert_eq!(table.columns[1].numbers.map(|numbers| numbers.scale), Some(1e300));
        assert_eq!(table.columns[2].words, Some(vec![String::new(), "limit-load".into(), String::new()]));
        let steps = columns_of(text, &["step", "sign"]);
        assert!(steps.iter().map(|row| row[0]).eq([0.0, 1.0, 2.0]) && steps.iter().all(|row| row[1].is_nan()));
        assert!(columns_of("", &["step"]).is_empty());
        assert_eq!(TableData::of_text(&mut arrays, "e.csv", "").rows, 0);
    }

    /// Claim: single results are facts, lists of numbers and of objects are tables; what differs from run to run
    /// (seconds) and what the page says elsewhere is left out.
    #[test]
    fn results_of_a_summary() {
        let summary = json!({
            "name": "a", "seconds": 1.5, "iterations": 4, "gap": null, "energy": { "bars": 0.5, "of": [1] },
            "eigenvalues": [0.0, 2.0], "history": [{ "iteration": 0, "step": 1.0, "method": "vertices", "more": [] }],
            "determinant": [[0, 1, 2.0]],
        });
        let (facts, tables) = results(&mut Arrays::default(), summary.as_object().unwrap());
        assert_eq!(facts, [Fact("energy.bars".into(), json!(0.5)), Fact("iterations".into(), json!(4))]);
        let named: Vec<(&str, usize, Vec<&str>)> = tables
            .iter()
            .map(|table| {
                let columns = table.columns.iter().map(|column| column.name.as_str()).collect();
                (table.name.as_str(), table.rows, columns)
            })
            .collect();
        let expected =
            [("eigenvalues", 2, vec!["number", "eigenvalues"]), ("history", 1, vec!["iteration", "method", "step"])];
        assert_eq!(named, expected);
    }
}
