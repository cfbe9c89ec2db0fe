//! What can be wrong with a scene, and where.

use std::io;
use std::path::PathBuf;
use std::sync::Arc;

use miette::{Diagnostic, NamedSource, SourceSpan};
use thiserror::Error;

/// Why a scene, or a table that it names, was refused.
#[derive(Debug, Error, Diagnostic)]
pub enum SceneError {
    /// A file cannot be read.
    #[error("{}: cannot be read: {source}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// A place in the scene is wrong.
    #[error("{file}:{line}:{column}: {message}")]
    At {
        /// Name of the scene file.
        file: String,
        /// Line, counted from 1.
        line: usize,
        /// Column in characters, counted from 1.
        column: usize,
        /// What is wrong.
        message: String,
        /// What would be right.
        #[help]
        help: Option<String>,
        /// The text of the scene.
        #[source_code]
        text: Arc<NamedSource<String>>,
        /// The bytes in question.
        #[label]
        span: SourceSpan,
    },
    /// The mesh is wrong.
    #[error(transparent)]
    Mesh(#[from] crate::sheet::SheetError),
    /// A line of a table of angles or rates is wrong.
    #[error("{}:{line}: {fault}", path.display())]
    Table {
        /// The table.
        path: PathBuf,
        /// Line, counted from 1.
        line: usize,
        /// What is wrong.
        fault: TableFault,
    },
}

/// What is wrong with a line of a table of angles or rates.
#[derive(Debug, Error, PartialEq)]
pub enum TableFault {
    /// The first line names other columns.
    #[error("the header is `{found}`, expected `i,j,n1,n2,{value}` or `cell1,cell2,i,j,n1,n2,{value}`")]
    Header {
        /// The first line.
        found: String,
        /// Name of the last column.
        value: &'static str,
    },
    /// A line has too few or too many fields.
    #[error("the line has {found} fields, expected {expected} as in the header")]
    Fields {
        /// Fields in this line.
        found: usize,
        /// Fields in the header.
        expected: usize,
    },
    /// A field that should be a whole number.
    #[error("`{field}` in column `{column}` is not a whole number")]
    Whole {
        /// The text.
        field: String,
        /// The column.
        column: &'static str,
    },
    /// A field that should be a finite number.
    #[error("`{field}` in column `{column}` is not a finite number")]
    Number {
        /// The text.
        field: String,
        /// The column.
        column: &'static str,
    },
    /// An angle of more than a turn.
    #[error("{message}; {help}")]
    Turns {
        /// What is wrong.
        message: String,
        /// What would be right.
        help: String,
    },
    /// The numbers name no edge.
    #[error("{0}")]
    Edge(String),
    /// The edge starts or ends in a cell with a negative number.
    #[error("the edge leaves the patch at cell [{0}, {1}]: cells are counted from 0")]
    Outside(i64, i64),
    /// The same edge was given before.
    #[error("the edge is given twice, first in line {first}")]
    Twice {
        /// Line of the first row.
        first: usize,
    },
    /// The table has a header only.
    #[error("the table has no rows")]
    Empty,
}
