//! Reading of a scene file, or of its text, with all checks that need only the scene.

use super::checks::check;
use super::error::SceneError;
use super::file::SceneFile;
use super::setting::Setting;
use crate::sheet::text::read_text;
use std::path::Path;

/// Reads and checks a scene file.
///
/// # Errors
/// [`SceneError::Read`] if the file cannot be read, [`SceneError::At`] with the place of the first error in it.
pub fn read(path: &Path) -> Result<SceneFile, SceneError> {
    read_set(path, &[])
}

/// Reads a scene file, sets some of its keys, and checks the scene that results.
///
/// # Errors
/// As [`read`], with places in the changed text, and [`SceneError::Setting`].
pub fn read_set(path: &Path, settings: &[Setting]) -> Result<SceneFile, SceneError> {
    let text = read_text(path).map_err(|source| SceneError::Read { path: path.into(), source })?;
    parse_set(&text, path, settings)
}

/// Reads and checks the text of a scene. `name` is used in messages, and paths in the scene are relative to it.
///
/// # Errors
/// [`SceneError::At`] with the place of the first error.
pub fn parse(text: &str, name: impl AsRef<Path>) -> Result<SceneFile, SceneError> {
    parse_set(text, name, &[])
}

/// Sets some keys in the text of a scene and does the same as [`parse`].
///
/// # Errors
/// As [`parse`], with places in the changed text, and [`SceneError::Setting`].
pub fn parse_set(text: &str, name: impl AsRef<Path>, settings: &[Setting]) -> Result<SceneFile, SceneError> {
    let file = SceneFile::unchecked(text, name.as_ref(), settings)?;
    check(&file)?;
    Ok(file)
}
