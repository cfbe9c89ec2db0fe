//! Why a study cannot be asked.

use crate::output::OutputError;
use crate::scene::SceneError;
use thiserror::Error;

/// Why a study cannot be asked.
#[derive(Debug, Error)]
pub enum StudyError {
    /// The scene asks for what its sheet has not.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// A file that the study starts from cannot be read, or a checkpoint cannot be kept.
    #[error(transparent)]
    Output(#[from] OutputError),
}
