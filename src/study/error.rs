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

/// Why a study has no answer.
pub(crate) enum NoAnswer {
    /// It finds none, for this reason.
    Reason(String),
    /// It cannot be computed.
    Error(StudyError),
}

impl NoAnswer {
    /// The study finds no answer, for this reason.
    pub(super) fn because(reason: impl ToString) -> Self {
        Self::Reason(reason.to_string())
    }
}

impl<E: Into<StudyError>> From<E> for NoAnswer {
    fn from(error: E) -> Self {
        Self::Error(error.into())
    }
}
