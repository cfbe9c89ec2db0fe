//! The sides of polygons.

use std::collections::BTreeMap;

/// Returns the ends of an edge, the lower number first.
pub(crate) fn sorted([a, b]: [usize; 2]) -> [usize; 2] {
    [a.min(b), a.max(b)]
}

/// Returns the sides of a polygon, each in its direction round the polygon.
pub(crate) fn sides<T: Copy>(polygon: &[T]) -> impl Iterator<Item = [T; 2]> {
    (0..polygon.len()).map(|k| [polygon[k], polygon[(k + 1) % polygon.len()]])
}

/// Returns how often each side is among these.
pub(crate) fn uses<K: Ord>(sides: impl Iterator<Item = K>) -> BTreeMap<K, usize> {
    let mut uses = BTreeMap::new();
    sides.for_each(|side| *uses.entry(side).or_default() += 1);
    uses
}

/// Returns the number of polygons that have each side, by its ends in order.
pub(crate) fn uses_of_sides<P: AsRef<[usize]>>(polygons: &[P]) -> BTreeMap<[usize; 2], usize> {
    uses(polygons.iter().flat_map(|polygon| sides(polygon.as_ref())).map(sorted))
}

/// Returns the sides of triangles, each in its direction round the triangle, that more of them have than have it in the
/// other direction: the rim of the surface that they are.
pub(crate) fn open_sides(triangles: &[[usize; 3]]) -> Vec<[usize; 2]> {
    let uses = uses(triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]));
    let of = |side: &[usize; 2]| uses.get(side).copied().unwrap_or_default();
    uses.keys().copied().filter(|side @ &[a, b]| of(side) > of(&[b, a])).collect()
}
