//! A closed curve of zero modes, its pieces between passes of `q = 0`, and the grid over which such curves are searched
//! for.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

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

/// A piece of a line: all of one that closes, or from a ray at `q = 0` to another.
pub(crate) struct Arc {
    /// Wavenumbers along it.
    pub points: Vec<[f64; 2]>,
    /// Largest distance of a point from the zero of the determinant.
    pub residual: f64,
}

/// A line from its points, with the winding that follows from its ends.
pub(crate) fn line(points: Vec<[f64; 2]>, passes: usize, residual: f64) -> ZeroLine {
    let (first, last) = (points[0], points[points.len() - 1]);
    let winding = [0, 1].map(|a| ((last[a] - first[a]) / TAU).round() as i32);
    ZeroLine { length: length(&points), points, winding, passes, residual }
}

/// Pieces joined at `q = 0`: a line that arrives along one ray leaves along the opposite one.
pub(crate) fn joined(arcs: Vec<([usize; 2], Arc)>) -> Vec<ZeroLine> {
    let mut left: Vec<Option<([usize; 2], Arc)>> = arcs.into_iter().map(Some).collect();
    let mut lines = Vec::new();
    while let Some(([first, mut ray], arc)) = left.iter_mut().find_map(Option::take) {
        let (mut points, mut residual, mut passes) = (vec![[0.0; 2]], arc.residual, 1);
        append(&mut points, arc.points);
        while ray ^ 1 != first {
            let leaves =
                |piece: &Option<([usize; 2], Arc)>| piece.as_ref().is_some_and(|(ends, _)| ends.contains(&(ray ^ 1)));
            let Some((ends, mut arc)) = left.iter_mut().find(|piece| leaves(piece)).and_then(Option::take) else {
                break;
            };
            if ends[0] != ray ^ 1 {
                arc.points.reverse();
            }
            ray = if ends[0] == ray ^ 1 { ends[1] } else { ends[0] };
            append(&mut points, arc.points);
            (residual, passes) = (residual.max(arc.residual), passes + 1);
        }
        lines.push(line(points, passes, residual));
    }
    lines
}

/// Continues a curve that has come to a copy of `q = 0` with a piece from there to the next, and ends it on that copy.
fn append(points: &mut Vec<[f64; 2]>, piece: Vec<[f64; 2]>) {
    let here = points[points.len() - 1];
    let home = piece[0].map(|q| TAU * (q / TAU).round());
    let moved = |q: [f64; 2]| [0, 1].map(|a| q[a] - home[a] + here[a]);
    points.extend(piece.into_iter().map(moved));
    let last = points[points.len() - 1];
    points.push(last.map(|q| TAU * (q / TAU).round()));
}
