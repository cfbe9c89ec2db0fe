//! The errors of writing and reading files.

use std::io;
use std::path::PathBuf;

use thiserror::Error;

use super::fault::{ShapeError, VtuFault};

/// The reason why a file could not be written or read.
#[derive(Debug, Error)]
pub enum OutputError {
    /// The file was not written, and no part of it is left on the disk.
    #[error("{}: cannot be written: {source}", path.display())]
    Write {
        /// Path of the file.
        path: PathBuf,
        /// Error of the operating system.
        source: io::Error,
    },
    /// The file cannot be read.
    #[error("{}: cannot be read: {source}", path.display())]
    Read {
        /// Path of the file.
        path: PathBuf,
        /// Error of the operating system.
        source: io::Error,
    },
    /// Another run is writing into the folder.
    #[error(
        "{}: another run (process {process}) is writing into this folder; wait for its end, or choose another folder",
        path.display()
    )]
    Claimed {
        /// Path of the folder.
        path: PathBuf,
        /// The process of the other run, on the machine on which it is.
        process: u32,
    },
    /// The file was read, but its content is not a valid VTU file of triangles and lines.
    #[error("{}: {fault}", path.display())]
    Vtu {
        /// Path of the file.
        path: PathBuf,
        /// Fault of the content.
        fault: VtuFault,
    },
    /// The file was not written, because the data for it are inconsistent.
    #[error("{}: not written: {fault}", path.display())]
    Shape {
        /// Path of the file.
        path: PathBuf,
        /// Inconsistency of the data.
        fault: ShapeError,
    },
}
