//! The errors of a study.

use crate::output::OutputError;
use crate::scene::SceneError;
use thiserror::Error;

/// The reasons for which a study cannot be computed.
#[derive(Debug, Error)]
#[allow(missing_docs)] // each variant is documented by its message
pub enum StudyError {
    #[error(transparent)]
    Scene(#[from] SceneError),
    #[error(transparent)]
    Output(#[from] OutputError),
}
