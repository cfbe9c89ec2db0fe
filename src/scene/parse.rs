//! From a scene file, or its text, to a checked scene.

use super::checks::check;
use super::error::SceneError;
use super::file::SceneFile;
use crate::sheet::text::read_text;
use std::path::Path;

/// Reads and checks a scene file.
///
/// # Errors
/// [`SceneError::Read`] when the file cannot be read, [`SceneError::At`] for everything that is wrong in it.
pub fn read(path: &Path) -> Result<SceneFile, SceneError> {
    let text = read_text(path).map_err(|source| SceneError::Read { path: path.into(), source })?;
    parse(&text, path)
}

/// Reads and checks the text of a scene; `name` stands in messages and is what paths in the scene are relative to.
///
/// # Errors
/// [`SceneError::At`] for the first thing that is wrong.
pub fn parse(text: &str, name: impl AsRef<Path>) -> Result<SceneFile, SceneError> {
    let file = SceneFile::unchecked(text, name.as_ref())?;
    check(&file)?;
    Ok(file)
}
