//! The errors of a study.

use crate::output::OutputError;
use crate::scene::SceneError;
use thiserror::Error;

/// The reasons for which a study cannot be computed.
#[derive(Debug, Error)]
pub enum StudyError {
    /// The scene asks for something that its sheet does not allow.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// A file from which the study starts cannot be read, or a checkpoint cannot be kept.
    #[error(transparent)]
    Output(#[from] OutputError),
}
