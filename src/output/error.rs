//! The errors of writing and reading files, and the faults of a picture, a table or a VTU file.

use std::io;
use std::path::PathBuf;

use thiserror::Error;

/// The reason why a file could not be written or read.
#[derive(Debug, Error)]
#[allow(missing_docs)] // each variant is documented by its message
pub enum OutputError {
    #[error("{}: cannot be written: {source}", path.display())]
    Write { path: PathBuf, source: io::Error },
    #[error("{}: cannot be read: {source}", path.display())]
    Read { path: PathBuf, source: io::Error },
    #[error(
        "{}: another run (process {process}) is writing into this folder; wait for its end, or choose another folder",
        path.display()
    )]
    Claimed { path: PathBuf, process: u32 },
    #[error("{}: {fault}", path.display())]
    Vtu { path: PathBuf, fault: VtuFault },
    #[error("{}: not written: {fault}", path.display())]
    Shape { path: PathBuf, fault: ShapeError },
}

/// Parts of a picture or a table that are inconsistent.
#[derive(Clone, Debug, Error, PartialEq, Eq)]
pub enum ShapeError {
    #[error("array `{array}` has {found} entries, expected {expected}")]
    Length {
        array: &'static str,
        /// Its length.
        found: usize,
        /// Expected length.
        expected: usize,
    },
    #[error("point {point} is used, but there are {count}")]
    NoSuchPoint { point: usize, count: usize },
    #[error("row {row} has {found} values, expected {expected} as in the header")]
    Row {
        /// Index of the row, counted from 0.
        row: usize,
        found: usize,
        expected: usize,
    },
}

impl ShapeError {
    /// Checks the lengths of arrays, each with its name and the expected length, and the numbers of points that are
    /// used among `count`.
    pub(super) fn check<'a>(
        arrays: impl IntoIterator<Item = (&'static str, usize, usize)>,
        used: impl IntoIterator<Item = &'a usize>,
        count: usize,
    ) -> Result<(), Self> {
        if let Some((array, found, expected)) = arrays.into_iter().find(|(_, found, expected)| found != expected) {
            return Err(Self::Length { array, found, expected });
        }
        let wrong = used.into_iter().find(|&&point| point >= count);
        wrong.map_or(Ok(()), |&point| Err(Self::NoSuchPoint { point, count }))
    }
}

/// A fault of the content of a VTU file.
#[derive(Debug, Error, PartialEq, Eq)]
pub enum VtuFault {
    #[error("not a readable VTU file: {0}")]
    Format(String),
    #[error("not an unstructured grid")]
    NotUnstructured,
    #[error("the coordinates of the points are no floating-point numbers")]
    Coordinates,
    #[error("cell {cell} is a {kind}, expected triangles, quadrangles, polygons and lines only")]
    CellKind {
        /// Index of the cell, counted from 0.
        cell: usize,
        kind: String,
    },
    #[error("cell {cell} has {found} points, expected {expected}")]
    CellSize {
        /// Index of the cell, counted from 0.
        cell: usize,
        found: usize,
        expected: usize,
    },
    #[error("cell {cell} uses point {point}, but there are {count}")]
    NoSuchPoint {
        /// Index of the cell, counted from 0.
        cell: usize,
        point: u64,
        count: usize,
    },
}
