//! The place of a value of an axis, and the bounds and the name of the table of sweeps.

use std::ops::Range;
use std::path::PathBuf;

/// Largest number of points.
pub(super) const MOST_POINTS: usize = 1_000_000;
/// Name of the table.
pub(super) const TABLE: &str = "sweep";

/// Where a value of an axis is written.
pub(super) enum Place {
    /// In the scene.
    Span(Range<usize>),
    /// In a line of a table.
    Line(PathBuf, usize),
}
