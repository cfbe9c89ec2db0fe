//! The content of a page, taken from the files of a study: tables, states of the sheet, and drawings.

use std::borrow::Cow;

use crate::output::artifact::Artifact;
use crate::output::picture::Picture;

/// The content of a file that a page shows.
#[derive(Debug)]
pub(crate) enum Content<'a> {
    /// The text of a table.
    Table(Cow<'a, str>),
    /// A state of the sheet.
    State(&'a Picture),
    /// A state of the sheet that was read from a file.
    StateRead(Box<Picture>),
    /// The text of a drawing.
    Figure(Cow<'a, str>),
    /// A file of another kind; the page names it.
    Other,
}

impl<'a> Content<'a> {
    /// Returns the state of the sheet, if this is one.
    pub(crate) fn picture(&self) -> Option<&Picture> {
        match self {
            Self::State(picture) => Some(picture),
            Self::StateRead(picture) => Some(picture),
            Self::Table(_) | Self::Figure(_) | Self::Other => None,
        }
    }

    /// Returns what a page shows of a file that is not yet written; `None` for a collection of other files, and for
    /// what cannot be written.
    pub(crate) fn of(artifact: &'a Artifact) -> Option<Self> {
        match artifact {
            Artifact::Table(table) => table.to_csv().ok().map(|text| Self::Table(text.into())),
            Artifact::State(picture) => picture.check().is_ok().then_some(Self::State(picture)),
            Artifact::Svg(Ok(text)) => Some(Self::Figure(text.into())),
            Artifact::Surface(_) | Artifact::Net(_) | Artifact::Grid(_) => Some(Self::Other),
            Artifact::Series(_) | Artifact::Script(_) | Artifact::Svg(Err(_)) | Artifact::Page(_) => None,
        }
    }
}
