//! Reading of a scene file, or of its text, with all checks that need only the scene.

use super::checks::check;
use super::error::SceneError;
use super::file::SceneFile;
use crate::sheet::text::read_text;
use std::path::Path;

/// Reads and checks a scene file.
///
/// # Errors
/// [`SceneError::Read`] if the file cannot be read, [`SceneError::At`] with the place of the first error in it.
pub fn read(path: &Path) -> Result<SceneFile, SceneError> {
    let text = read_text(path).map_err(|source| SceneError::Read { path: path.into(), source })?;
    parse(&text, path)
}

/// Reads and checks the text of a scene. `name` is used in messages, and paths in the scene are relative to it.
///
/// # Errors
/// [`SceneError::At`] with the place of the first error.
pub fn parse(text: &str, name: impl AsRef<Path>) -> Result<SceneFile, SceneError> {
    let file = SceneFile::unchecked(text, name.as_ref())?;
    check(&file)?;
    Ok(file)
}
