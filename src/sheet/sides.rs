//! The sides of triangles.

use std::collections::BTreeMap;

/// Returns the sides of triangles, each in its direction round the triangle, that more of them have than have it in the
/// other direction: the rim of the surface that they are.
pub(crate) fn open_sides(triangles: &[[usize; 3]]) -> Vec<[usize; 2]> {
    let mut uses = BTreeMap::<[usize; 2], usize>::new();
    let sides = triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
    sides.for_each(|side| *uses.entry(side).or_default() += 1);
    let of = |side: &[usize; 2]| uses.get(side).copied().unwrap_or_default();
    uses.keys().copied().filter(|side @ &[a, b]| of(side) > of(&[b, a])).collect()
}
