//! A closed curve of zero modes, and the grid over which such curves are searched for.

/// Grid points along each direction.
pub(super) const GRID: usize = 192;

/// A closed curve of zero modes.
#[derive(Clone, Debug, PartialEq)]
pub struct ZeroLine {
    /// Wavenumbers along it, continuous, not reduced to the zone; the last is the first moved by the winding.
    pub points: Vec<[f64; 2]>,
    /// How often it goes round the zone in both directions; `[0, 0]`: it closes in itself.
    pub winding: [i32; 2],
    /// How often it passes `q = 0`.
    pub passes: usize,
    /// Largest distance of a point from the zero of the determinant, estimated by its last correction; of
    /// [refined](super::ZeroLines::refined) lines also by the rounding of the determinant.
    pub residual: f64,
}

/// The neighbour of a grid point in the direction `a`.
pub(super) fn next(a: usize, k: usize) -> usize {
    let (column, row) = (k % GRID, k / GRID);
    if a == 0 { row * GRID + (column + 1) % GRID } else { (row + 1) % GRID * GRID + column }
}
