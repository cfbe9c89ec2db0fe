//! The sheet of a frame of a FOLD file, as it is listed or cleaned up.

use std::path::Path;

use super::frames;
use super::locate::Source;
use super::read::read_drawing;
use super::{clean, read as listed};
use crate::sheet::cell::Sheet;
use crate::sheet::error::SheetError;
use crate::sheet::pattern::Cleanup;
use crate::sheet::text;

/// Reads the sheet of the file at `path`.
///
/// # Errors
/// [`SheetError::Read`] if the file does not exist or cannot be read, otherwise as [`parse`].
pub fn read(path: &Path) -> Result<Sheet, SheetError> {
    read_frame(path, None, None)
}

/// Reads one frame of the file at `path`; see [`parse_frame`].
///
/// # Errors
/// [`SheetError::Read`] if the file does not exist or cannot be read, otherwise as [`parse_frame`].
pub fn read_frame(path: &Path, frame: Option<usize>, cleanup: Option<&Cleanup>) -> Result<Sheet, SheetError> {
    let text = text::read_text(path).map_err(|source| SheetError::Read { path: path.to_owned(), source })?;
    parse_frame(&text, &path.display().to_string(), frame, cleanup)
}

/// Reads the sheet of a FOLD text. `name` is the name of its file: it appears in messages, and is the title if the
/// file has none.
///
/// # Errors
/// [`SheetError::Bad`] with line, column, and the vertex, face or edge that is wrong.
pub fn parse(text: &str, name: &str) -> Result<Sheet, SheetError> {
    parse_frame(text, name, None, None)
}

/// Reads one frame of a FOLD text: 0 is the top of the file, and those of `file_frames` are numbered from 1. If no
/// number is given it is the first frame with a mesh. Keys are inherited as `frame_inherit` and `frame_parent` say.
///
/// A flat pattern with edges of the letters F or U that end inside a face, or with a cut of one edge inside the sheet,
/// has its faces found from its edges, without these ends and with a vertex in the middle of such a cut. So has a flat
/// crease pattern with a clean-up, by which its vertices are merged and its edges split; keys about the file and its
/// frame are kept, with the letters and target angles of the edges.
///
/// # Errors
/// As [`parse`]; also if there is no such frame, or its parents lead back to it; with a clean-up, if the pattern is
/// folded or periodic, or edges that lie on each other have different letters or angles.
pub fn parse_frame(
    text: &str,
    name: &str,
    frame: Option<usize>,
    cleanup: Option<&Cleanup>,
) -> Result<Sheet, SheetError> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let source = Source { name, text };
    let frame = frames::choose(&source, frame)?;
    let drawn = read_drawing(&source, &frame.values)?;
    match cleanup.copied().or_else(|| clean::needed(&drawn)) {
        Some(cleanup) => clean::sheet(&source, &frame, drawn, &cleanup),
        None => listed::sheet(&source, &frame, drawn),
    }
}
