//! A table of points: CSV whose header has the paths of keys, and each row their values at a point.
//!
//! A field with commas stands in double quotes, in which `""` is a quote. Fields are values of TOML, texts without
//! quotes.

use super::super::error::TableFault;
use super::super::rows::{Fault, numbered_lines};

/// The content of a table of points.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct PointTable {
    /// The paths of the keys.
    pub(super) header: Vec<String>,
    /// The fields of each row.
    pub(super) rows: Vec<Vec<String>>,
    /// The line of each row, counted from 1.
    pub(super) lines: Vec<usize>,
}

/// Returns the content of the text of a table of points.
pub(super) fn parse(text: &str) -> Result<PointTable, Fault> {
    let mut lines = numbered_lines(text);
    let (at, header) = lines.next().ok_or((1, TableFault::Empty))?;
    let mut found = PointTable { header: fields(header), rows: vec![], lines: vec![] };
    if found.header.iter().any(String::is_empty) {
        return Err((at, TableFault::NoKey));
    }
    for (line, text) in lines {
        let row = fields(text);
        if row.len() != found.header.len() {
            return Err((line, TableFault::Fields { found: row.len(), expected: found.header.len() }));
        }
        if let Some((_, key)) = row.iter().zip(&found.header).find(|(field, _)| field.is_empty()) {
            return Err((line, TableFault::NoValue(key.clone())));
        }
        found.rows.push(row);
        found.lines.push(line);
    }
    if found.rows.is_empty() { Err((at, TableFault::Empty)) } else { Ok(found) }
}

/// Returns the fields of a line, without the quotes and the blanks around them.
fn fields(line: &str) -> Vec<String> {
    let (mut fields, mut field) = (Vec::new(), String::new());
    let (mut quoted, mut letters) = (false, line.chars().peekable());
    while let Some(letter) = letters.next() {
        match letter {
            '"' if quoted && letters.peek() == Some(&'"') => {
                letters.next();
                field.push('"');
            }
            '"' => quoted = !quoted,
            ',' if !quoted => fields.push(std::mem::take(&mut field)),
            letter => field.push(letter),
        }
    }
    fields.push(field);
    fields.iter().map(|field| field.trim().to_owned()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Claim: fields may have commas and quotes in quotes; rows know their lines, blank lines do not count.
    #[test]
    fn fields_and_lines() {
        let found = parse(
            "\u{feff}sheet.cells, energy.creases.rest\r\n\n\"[2, 3]\",flat\n\"[1,1]\",\"{ file = \"\"a.csv\"\" }\"\n",
        )
        .unwrap();
        assert_eq!(found.header, ["sheet.cells", "energy.creases.rest"]);
        assert_eq!(found.rows, [["[2, 3]", "flat"], ["[1,1]", "{ file = \"a.csv\" }"]]);
        assert_eq!(found.lines, [3, 4]);
    }

    /// Claim: each error names its line.
    #[test]
    fn faults_name_the_line() {
        for (text, line, message) in [
            ("", 1, "no rows"),
            ("a,b\n", 1, "no rows"),
            ("a,\n1,2\n", 1, "no key"),
            ("a,b\n1,2\n1\n", 3, "1 fields, expected 2"),
            ("a,b\n\n1,\n", 3, "`b` has no value"),
        ] {
            let (at, fault) = parse(text).unwrap_err();
            assert!(at == line && fault.to_string().contains(message), "{text:?}: line {at}: {fault}");
        }
    }
}
