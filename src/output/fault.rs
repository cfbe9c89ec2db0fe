//! What can be wrong with a picture, a table, or a VTU file.

use thiserror::Error;

/// Parts of a picture that do not fit together.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
pub enum ShapeError {
    /// An array has the wrong length.
    #[error("array `{array}` has {found} entries, expected {expected}")]
    Length {
        /// Name of the array.
        array: &'static str,
        /// Its length.
        found: usize,
        /// The length it should have.
        expected: usize,
    },
    /// A triangle or a line names a point that is not there.
    #[error("point {point} is used, but there are {count}")]
    NoSuchPoint {
        /// The point.
        point: usize,
        /// How many there are.
        count: usize,
    },
    /// A row of a table has the wrong length.
    #[error("row {row} has {found} values, expected {expected} as in the header")]
    Row {
        /// The row, counted from 0.
        row: usize,
        /// Its length.
        found: usize,
        /// The number of columns.
        expected: usize,
    },
}

/// What is wrong with a VTU file.
#[derive(Debug, Error, PartialEq, Eq)]
pub enum VtuFault {
    /// No XML file of VTK.
    #[error("not a readable VTU file: {0}")]
    Format(String),
    /// Another kind of data set.
    #[error("not an unstructured grid")]
    NotUnstructured,
    /// Points that are no numbers.
    #[error("the coordinates of the points are no floating-point numbers")]
    Coordinates,
    /// A cell other than a triangle or a line.
    #[error("cell {cell} is a {kind}, expected triangles and lines only")]
    CellKind {
        /// The cell, counted from 0.
        cell: usize,
        /// What it is.
        kind: String,
    },
    /// Connectivity and offsets do not fit.
    #[error("cell {cell} has {found} points, expected {expected}")]
    CellSize {
        /// The cell, counted from 0.
        cell: usize,
        /// Its number of points.
        found: usize,
        /// The number it should have.
        expected: usize,
    },
    /// A cell names a point that is not there.
    #[error("cell {cell} uses point {point}, but there are {count}")]
    NoSuchPoint {
        /// The cell, counted from 0.
        cell: usize,
        /// The point.
        point: u64,
        /// How many there are.
        count: usize,
    },
}
