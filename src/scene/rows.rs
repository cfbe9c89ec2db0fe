//! Tables of values of edges: rest angles, fold-angle rates, stiffnesses and rest lengths. CSV, one row per edge.
//!
//! The header is `i,j,n1,n2,angle`, one row per edge of the cell, or `cell1,cell2,i,j,n1,n2,angle`, one row per edge of
//! a patch; the last column is `angle`, `rate`, `stiffness` or `length`. Angles are in radians, a stiffness may be
//! `inf`.

use std::collections::HashMap;
use std::fmt::Display;
use std::path::Path;

use super::error::{SceneError, TableFault};
use super::values::{LEAST_STIFFNESS, directed_edge};
use crate::sheet::EdgeKey;

/// The quantity in the last column of a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ColumnQuantity {
    /// Rest angles in radians.
    Angle,
    /// Rates of fold angles.
    Rate,
    /// Stiffnesses: positive, and infinite for rigid elements.
    Stiffness,
    /// Rest lengths: positive.
    Length,
    /// Numbers of laws in a list of so many, counted from 1; 0 is a spring.
    Law(usize),
}

impl ColumnQuantity {
    /// Returns the name of the last column.
    fn name(self) -> &'static str {
        match self {
            Self::Angle => "angle",
            Self::Rate => "rate",
            Self::Stiffness => "stiffness",
            Self::Length => "length",
            Self::Law(_) => "law",
        }
    }

    /// Returns the names of all columns of a table.
    fn names(self) -> [&'static str; 7] {
        ["cell1", "cell2", "i", "j", "n1", "n2", self.name()]
    }

    /// Returns a number, if the column allows it. `field` is the number as it was given.
    pub(super) fn checked(self, number: f64, field: impl Display) -> Result<f64, TableFault> {
        let (field, column) = (|| field.to_string(), self.name());
        match self {
            Self::Angle | Self::Rate if !number.is_finite() => Err(TableFault::Number { field: field(), column }),
            Self::Angle => match super::turns::fault_of_turns(number) {
                Some([message, help]) => Err(TableFault::Turns { message, help }),
                None => Ok(number),
            },
            Self::Stiffness if !(number >= LEAST_STIFFNESS) => Err(TableFault::Stiffness { field: field(), column }),
            Self::Length if !(number > 0.0 && number.is_finite()) => Err(TableFault::Length { field: field(), column }),
            Self::Law(laws) if !(number.fract() == 0.0 && (0.0..=laws as f64).contains(&number)) => {
                Err(TableFault::Law { field: field(), column, laws })
            }
            Self::Rate | Self::Stiffness | Self::Length | Self::Law(_) => Ok(number),
        }
    }
}

/// A row of a table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct TableRow {
    /// The cell in which the edge `key` starts (at its vertex `key.i`); `None` if the row holds for every cell.
    pub cell: Option<[usize; 2]>,
    /// Canonical name of the edge.
    pub key: EdgeKey,
    /// The value of the last column.
    pub value: f64,
    /// Line of the table, for messages about it.
    pub line: usize,
}

/// Reads a table with this last column.
pub(crate) fn read(path: &Path, value: ColumnQuantity) -> Result<Vec<TableRow>, SceneError> {
    read_table(path, |text| parse(text, value))
}

/// Reads a table by a function that knows its columns.
pub(super) fn read_table<T>(path: &Path, parse: impl FnOnce(&str) -> Result<T, Fault>) -> Result<T, SceneError> {
    let text = crate::sheet::text::read_text(path).map_err(|source| SceneError::Read { path: path.into(), source })?;
    parse(&text).map_err(|(line, fault)| SceneError::Table { path: path.into(), line, fault })
}

/// Returns the lines of a table that are not empty, with their numbers, counted from 1.
pub(super) fn numbered_lines(text: &str) -> impl Iterator<Item = (usize, &str)> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    text.lines().enumerate().map(|(at, line)| (at + 1, line)).filter(|(_, line)| !line.trim().is_empty())
}

/// The number of a line of a table, and its fault.
pub(super) type Fault = (usize, TableFault);

fn parse(text: &str, value: ColumnQuantity) -> Result<Vec<TableRow>, Fault> {
    let mut lines = numbered_lines(text);
    let (at, header) = lines.next().ok_or((1, TableFault::Empty))?;
    let all = value.names();
    let wrong = || (at, TableFault::Header { found: header.trim().into(), value: all[6] });
    let columns = columns(header, &all).ok_or_else(wrong)?;
    let mut rows = Vec::new();
    let mut seen = HashMap::new();
    for (line, text) in lines {
        let row = row(text, (columns, value), line).map_err(|fault| (line, fault))?;
        if let Some(first) = seen.insert((row.cell, row.key), line) {
            return Err((line, TableFault::Twice { first }));
        }
        rows.push(row);
    }
    if rows.is_empty() { Err((at, TableFault::Empty)) } else { Ok(rows) }
}

/// Returns the columns of a header; `None` if it is not one of the two valid headers.
fn columns<'a>(header: &str, all: &'a [&'static str; 7]) -> Option<&'a [&'static str]> {
    let found: Vec<&str> = header.split(',').map(str::trim).collect();
    [&all[..], &all[2..]].into_iter().find(|columns| **columns == *found)
}

fn row(text: &str, (columns, value): (&[&'static str], ColumnQuantity), line: usize) -> Result<TableRow, TableFault> {
    let fields: Vec<&str> = text.split(',').map(str::trim).collect();
    let wrong = || TableFault::Fields { found: fields.len(), expected: columns.len() };
    let (number, numbers) = fields.split_last().filter(|_| fields.len() == columns.len()).ok_or_else(wrong)?;
    let whole: Vec<i64> =
        columns.iter().zip(numbers).map(|(column, field)| integer(field, column)).collect::<Result<_, _>>()?;
    let value = checked(number, value)?;
    let (cell, name) = match whole[..] {
        [c1, c2, i, j, n1, n2] => (Some([c1, c2]), [i, j, n1, n2]),
        [i, j, n1, n2] => (None, [i, j, n1, n2]),
        _ => return Err(wrong()),
    };
    let (key, reversed) = directed_edge(name).map_err(|fault| TableFault::Edge(fault.to_string()))?;
    let cell = cell.map(|cell| start_cell(cell, name, reversed)).transpose()?;
    Ok(TableRow { cell, key, value, line })
}

fn integer(field: &str, column: &'static str) -> Result<i64, TableFault> {
    field.parse().map_err(|_| TableFault::Whole { field: field.into(), column })
}

/// Returns the number of a field, if the column allows it.
fn checked(field: &str, of: ColumnQuantity) -> Result<f64, TableFault> {
    let number = field.parse().unwrap_or(f64::NAN);
    // a number too large for a double is not meant to be rigid
    let overflows = number == f64::INFINITY && field.contains(|c: char| c.is_ascii_digit());
    of.checked(if overflows { f64::NAN } else { number }, field)
}

/// Returns the cell in which the canonical name starts: if the row names the edge in the opposite direction, this is
/// the cell of the other end.
fn start_cell([c1, c2]: [i64; 2], [.., n1, n2]: [i64; 4], reversed: bool) -> Result<[usize; 2], TableFault> {
    let [s1, s2] = if reversed { [c1.saturating_add(n1), c2.saturating_add(n2)] } else { [c1, c2] };
    match (usize::try_from(s1), usize::try_from(s2)) {
        (Ok(c1), Ok(c2)) => Ok([c1, c2]),
        _ => Err(TableFault::Outside(s1, s2)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn angles(text: &str) -> Result<Vec<TableRow>, Fault> {
        parse(text, ColumnQuantity::Angle)
    }

    /// Claim: both headers are read. The backward name [2, 0, 1, 0] of cell (3, 4) starts at vertex 2 of (3, 4), so the
    /// canonical [0, 2, -1, 0] starts at vertex 0 of cell (4, 4).
    #[test]
    fn rows_come_back_with_their_lines() {
        let key = EdgeKey { i: 0, j: 2, shift: [-1, 0], round: 0 };
        let cell = angles("i,j,n1,n2,angle\r\n0, 2, -1, 0, 0.25\r\n").unwrap();
        assert_eq!(cell, [TableRow { cell: None, key, value: 0.25, line: 2 }]);
        let patch = angles("cell1,cell2,i,j,n1,n2,angle\n\n3,4,2,0,1,0,-1e-3\n").unwrap();
        assert_eq!(patch, [TableRow { cell: Some([4, 4]), key, value: -1e-3, line: 3 }]);
    }

    /// Claim: each error names its line.
    #[test]
    fn faults_name_the_line() {
        let cases: [(&str, usize, &str); 9] = [
            ("", 1, "no rows"),
            ("i,j,n1,n2,angle\n", 1, "no rows"),
            ("i,j,n1,n2,rate\n0,1,0,0,1\n", 1, "expected `i,j,n1,n2,angle`"),
            ("i,j,n1,n2,angle\n0,1,0,1\n", 2, "4 fields, expected 5"),
            ("i,j,n1,n2,angle\n0,x,0,0,1\n", 2, "`x` in column `j`"),
            ("i,j,n1,n2,angle\n0,1,0,0,nan\n", 2, "`nan` in column `angle` is not a finite"),
            ("i,j,n1,n2,angle\n1,1,0,0,1\n", 2, "from vertex 1 to itself"),
            ("i,j,n1,n2,angle\n0,1,0,0,1\n1,0,0,0,2\n", 3, "first in line 2"),
            ("cell1,cell2,i,j,n1,n2,angle\n0,0,1,0,-1,0,1\n", 2, "cell [-1, 0]"),
        ];
        for (text, line, message) in cases {
            let (at, fault) = angles(text).unwrap_err();
            assert!(at == line && fault.to_string().contains(message), "{text:?}: line {at}: {fault}");
        }
    }
}
