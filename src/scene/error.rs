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
#[allow(missing_docs)] // each variant is documented by its message
pub enum SceneError {
    #[error("{}: cannot be read: {source}", path.display())]
    Read { path: PathBuf, source: io::Error },
    #[error("{}:{line}:{column}: {message}", text.name())]
    At {
        /// Line, counted from 1.
        line: usize,
        /// Column in characters, counted from 1.
        column: usize,
        key: Box<str>,
        message: String,
        #[help]
        help: Option<String>,
        #[source_code]
        text: Arc<NamedSource<String>>,
        /// The bytes to which the error refers.
        #[label]
        span: SourceSpan,
    },
    #[error("{}: {fault}", path.display())]
    Setting { path: PathBuf, fault: SettingError },
    #[error(transparent)]
    Mesh(#[from] crate::sheet::SheetError),
    #[error("{}:{line}: {fault}", path.display())]
    Table {
        path: PathBuf,
        /// Line, counted from 1.
        line: usize,
        fault: TableFault,
    },
}

/// The errors in a line of a table of angles, rates, stiffnesses or lengths.
#[derive(Debug, Error, PartialEq)]
#[allow(missing_docs)] // each variant is documented by its message
pub enum TableFault {
    #[error("the header is `{found}`, expected `i,j,n1,n2,{value}` or `cell1,cell2,i,j,n1,n2,{value}`")]
    Header { found: String, value: &'static str },
    #[error("the header is `{found}`, expected `{},{}`", columns[0], columns[1])]
    CurveHeader { found: String, columns: [&'static str; 2] },
    #[error(transparent)]
    Curve(CurveError),
    #[error("the line has {found} fields, expected {expected} as in the header")]
    Fields { found: usize, expected: usize },
    #[error("`{field}` in column `{column}` is not a whole number")]
    Whole { field: String, column: &'static str },
    #[error("`{field}` in column `{column}` is not a finite number")]
    Number { field: String, column: &'static str },
    #[error("`{field}` in column `{column}` is not a positive number or `inf` (exactly rigid), 1e-300 at least")]
    Stiffness { field: String, column: &'static str },
    /// A field that should be a length is not one.
    #[error("`{field}` in column `{column}` is not a finite number above 0")]
    Length { field: String, column: &'static str },
    /// A number that is none of the laws that are listed.
    #[error(
        "`{field}` in column `{column}` is no law of the list: they are counted from 1 to {laws}, and 0 is a spring"
    )]
    Law { field: String, column: &'static str, laws: usize },
    #[error("{message}; {help}")]
    Turns { message: String, help: String },
    #[error("{0}")]
    Edge(String),
    #[error("the edge leaves the patch at cell [{0}, {1}]: cells are counted from 0")]
    Outside(i64, i64),
    #[error("the edge is given twice, first in line {first}")]
    Twice { first: usize },
    #[error("a column has no key; the header has the paths of keys, as in energy.bars.stiffness")]
    NoKey,
    #[error("`{0}` has no value in this row")]
    NoValue(String),
    #[error("{0}")]
    Point(String),
    #[error("the table has no rows")]
    Empty,
}
