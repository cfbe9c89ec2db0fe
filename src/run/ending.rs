//! The endings of file names, by which kinds of files are recognised.

use std::path::Path;

/// Returns the ending of a file name in lower case; empty if it has none.
pub(super) fn ending(path: &Path) -> String {
    path.extension().unwrap_or_default().to_string_lossy().to_lowercase()
}
