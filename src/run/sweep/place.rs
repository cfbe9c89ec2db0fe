//! The points of a sweep, and the names of its files and folders.

use crate::run::error::RunError;
use crate::scene::{SceneFile, Sweep};
use std::path::{Path, PathBuf};

/// Name of the table of a sweep.
pub(crate) const TABLE: &str = "sweep.csv";
/// Name of the summary of a sweep.
pub(crate) const SUMMARY: &str = "sweep.json";
/// Word for the bar over the points.
pub(super) const POINTS: &str = "points";

/// Word for the bar over the points while they are checked.
pub(super) const CHECKS: &str = "checks of points";

/// Returns the points of a scene with a table `[sweep]`: their keys, and the settings and the scene of each.
///
/// # Errors
/// [`RunError`] if the scene has no sweep, or if the sweep is wrong.
pub fn points(file: &SceneFile) -> Result<Sweep, RunError> {
    let help = "add a table, as in [sweep], \"energy.bars.stiffness\" = [1e2, 1e4]";
    Ok(Sweep::of(file)?.ok_or_else(|| file.error_at(0..0, "the scene has no [sweep]", help))?)
}

/// Returns the folder of a point in that of the sweep.
pub(super) fn point_folder(out: &Path, index: usize) -> PathBuf {
    out.join(POINTS).join(format!("{index:04}"))
}
