//! A closed curve of zero modes, and the grid over which such curves are searched for.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Grid points along each direction.
pub(super) const GRID: usize = 192;

/// A line of zeros of the determinant: a closed curve of zero modes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(rename = "ZeroLineSummary")]
pub struct ZeroLine {
    /// Wavenumbers along it, continuous, not reduced to the zone; the last is the first moved by the winding. Summaries
    /// are without them.
    #[serde(skip)]
    pub points: Vec<[f64; 2]>,
    /// How often it goes round the zone along both wavenumbers; `[0, 0]`: it closes in itself.
    pub winding: [i32; 2],
    /// How often it passes `q = 0`.
    pub passes: usize,
    /// Length in the plane of `(q1, q2)`.
    pub length: f64,
    /// Largest distance of a point from the zero of the determinant, estimated by its last correction; of
    /// refined lines also by the rounding of the determinant.
    pub residual: f64,
}

/// The length of a curve through these points.
pub(super) fn length(points: &[[f64; 2]]) -> f64 {
    points.windows(2).map(|q| (q[1][0] - q[0][0]).hypot(q[1][1] - q[0][1])).sum()
}

/// The neighbour of a grid point in the direction `a`.
pub(super) fn next(a: usize, k: usize) -> usize {
    let (column, row) = (k % GRID, k / GRID);
    if a == 0 { row * GRID + (column + 1) % GRID } else { (row + 1) % GRID * GRID + column }
}
