//! Why a file could not be written or read.

use std::io;
use std::path::PathBuf;

use thiserror::Error;

use super::fault::{ShapeError, VtuFault};

/// Why a file could not be written or read.
#[derive(Debug, Error)]
pub enum OutputError {
    /// The file was not written; nothing of it is left.
    #[error("{}: cannot be written: {source}", path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// The file cannot be read.
    #[error("{}: cannot be read: {source}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// The file was read but is not what it should be.
    #[error("{}: {fault}", path.display())]
    Vtu {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        fault: VtuFault,
    },
    /// What should be written does not fit together.
    #[error("{}: not written: {fault}", path.display())]
    Shape {
        /// The file.
        path: PathBuf,
        /// What does not fit.
        fault: ShapeError,
    },
}
