//! The faults of a picture, a table or a VTU file.

use thiserror::Error;

/// Parts of a picture or a table that are inconsistent.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
pub enum ShapeError {
    /// An array has the wrong length.
    #[error("array `{array}` has {found} entries, expected {expected}")]
    Length {
        /// Name of the array.
        array: &'static str,
        /// Its length.
        found: usize,
        /// Expected length.
        expected: usize,
    },
    /// A triangle or a line uses a point that does not exist.
    #[error("point {point} is used, but there are {count}")]
    NoSuchPoint {
        /// Index of the point.
        point: usize,
        /// Number of points.
        count: usize,
    },
    /// A row of a table has the wrong length.
    #[error("row {row} has {found} values, expected {expected} as in the header")]
    Row {
        /// Index of the row, counted from 0.
        row: usize,
        /// Number of its values.
        found: usize,
        /// Number of columns.
        expected: usize,
    },
}

/// A fault of the content of a VTU file.
#[derive(Debug, Error, PartialEq, Eq)]
pub enum VtuFault {
    /// The content is not an XML file of VTK.
    #[error("not a readable VTU file: {0}")]
    Format(String),
    /// The data set is of another kind than an unstructured grid.
    #[error("not an unstructured grid")]
    NotUnstructured,
    /// The coordinates of the points are not floating-point numbers.
    #[error("the coordinates of the points are no floating-point numbers")]
    Coordinates,
    /// A cell is neither a triangle nor a line.
    #[error("cell {cell} is a {kind}, expected triangles, quadrangles, polygons and lines only")]
    CellKind {
        /// Index of the cell, counted from 0.
        cell: usize,
        /// Name of its VTK cell type.
        kind: String,
    },
    /// The number of points of a cell, by the arrays of connectivity and offsets, does not match its type.
    #[error("cell {cell} has {found} points, expected {expected}")]
    CellSize {
        /// Index of the cell, counted from 0.
        cell: usize,
        /// Number of its points.
        found: usize,
        /// Expected number of points.
        expected: usize,
    },
    /// A cell uses a point that does not exist.
    #[error("cell {cell} uses point {point}, but there are {count}")]
    NoSuchPoint {
        /// Index of the cell, counted from 0.
        cell: usize,
        /// Index of the point.
        point: u64,
        /// Number of points.
        count: usize,
    },
}
