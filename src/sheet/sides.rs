//! The sides of triangles.

use std::collections::BTreeSet;

/// Returns the sides of triangles, each in its direction round the triangle, that belong to one of them only.
pub(crate) fn open_sides(triangles: &[[usize; 3]]) -> Vec<[usize; 2]> {
    let sides: BTreeSet<[usize; 2]> = triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]).collect();
    sides.iter().copied().filter(|&[a, b]| !sides.contains(&[b, a])).collect()
}
