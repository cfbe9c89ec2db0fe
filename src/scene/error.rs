//! The errors of a scene, with their places in the text.

use std::io;
use std::path::PathBuf;
use std::sync::Arc;

use super::setting::SettingError;
use crate::model::CurveError;
use miette::{Diagnostic, NamedSource, SourceSpan};
use thiserror::Error;

/// The reasons for which a scene, or a table that it names, is refused.
#[derive(Debug, Error, Diagnostic)]
pub enum SceneError {
    /// A file cannot be read.
    #[error("{}: cannot be read: {source}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// Cause of the error.
        source: io::Error,
    },
    /// A place in the scene is wrong.
    #[error("{}:{line}:{column}: {message}", text.name())]
    At {
        /// Line, counted from 1.
        line: usize,
        /// Column in characters, counted from 1.
        column: usize,
        /// Path of the key at the place, as in `energy.bars.stiffness` or `study.0.name`; empty if there is none.
        key: Box<str>,
        /// Description of the error.
        message: String,
        /// Proposed correction.
        #[help]
        help: Option<String>,
        /// The text of the scene, and the name of its file.
        #[source_code]
        text: Arc<NamedSource<String>>,
        /// The bytes to which the error refers.
        #[label]
        span: SourceSpan,
    },
    /// A key cannot be set from outside.
    #[error("{}: {fault}", path.display())]
    Setting {
        /// The scene.
        path: PathBuf,
        /// Description of the error.
        fault: SettingError,
    },
    /// The mesh is wrong.
    #[error(transparent)]
    Mesh(#[from] crate::sheet::SheetError),
    /// A line of a table is wrong.
    #[error("{}:{line}: {fault}", path.display())]
    Table {
        /// The table.
        path: PathBuf,
        /// Line, counted from 1.
        line: usize,
        /// Description of the error.
        fault: TableFault,
    },
}

/// The errors in a line of a table of angles, rates, stiffnesses or lengths.
#[derive(Debug, Error, PartialEq)]
pub enum TableFault {
    /// The header has other column names.
    #[error("the header is `{found}`, expected `i,j,n1,n2,{value}` or `cell1,cell2,i,j,n1,n2,{value}`")]
    Header {
        /// The first line.
        found: String,
        /// Name of the last column.
        value: &'static str,
    },
    /// The header of a curve has other column names.
    #[error("the header is `{found}`, expected `{},{}`", columns[0], columns[1])]
    CurveHeader {
        /// The first line.
        found: String,
        /// Names of the columns.
        columns: [&'static str; 2],
    },
    /// Points are no curve.
    #[error(transparent)]
    Curve(CurveError),
    /// A line has too few or too many fields.
    #[error("the line has {found} fields, expected {expected} as in the header")]
    Fields {
        /// Number of fields in this line.
        found: usize,
        /// Number of fields in the header.
        expected: usize,
    },
    /// A field that should be a whole number is not one.
    #[error("`{field}` in column `{column}` is not a whole number")]
    Whole {
        /// Text of the field.
        field: String,
        /// Name of the column.
        column: &'static str,
    },
    /// A field that should be a finite number is not one.
    #[error("`{field}` in column `{column}` is not a finite number")]
    Number {
        /// Text of the field.
        field: String,
        /// Name of the column.
        column: &'static str,
    },
    /// A field that should be a stiffness is not one.
    #[error("`{field}` in column `{column}` is not a positive number or `inf` (exactly rigid)")]
    Stiffness {
        /// Text of the field.
        field: String,
        /// Name of the column.
        column: &'static str,
    },
    /// A field that should be a length is not one.
    #[error("`{field}` in column `{column}` is not a finite number above 0")]
    Length {
        /// Text of the field.
        field: String,
        /// Name of the column.
        column: &'static str,
    },
    /// The absolute value of an angle is larger than 2 pi.
    #[error("{message}; {help}")]
    Turns {
        /// Description of the error.
        message: String,
        /// Proposed correction.
        help: String,
    },
    /// The sheet has no edge with this name.
    #[error("{0}")]
    Edge(String),
    /// The edge starts or ends in a cell with a negative index.
    #[error("the edge leaves the patch at cell [{0}, {1}]: cells are counted from 0")]
    Outside(i64, i64),
    /// The same edge was given before.
    #[error("the edge is given twice, first in line {first}")]
    Twice {
        /// Line in which the edge was given first.
        first: usize,
    },
    /// A column of a table of points has no key.
    #[error("a column has no key; the header has the paths of keys, as in energy.bars.stiffness")]
    NoKey,
    /// A field of a table of points is empty.
    #[error("`{0}` has no value in this row")]
    NoValue(String),
    /// The scene of a point is wrong.
    #[error("{0}")]
    Point(String),
    /// The table has a header and no rows.
    #[error("the table has no rows")]
    Empty,
}
