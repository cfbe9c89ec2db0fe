//! The errors of writing and reading files.

use std::io;
use std::path::PathBuf;

use thiserror::Error;

use super::fault::{ShapeError, VtuFault};

/// The reason why a file could not be written or read.
#[derive(Debug, Error)]
#[allow(missing_docs)] // the messages say it
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
