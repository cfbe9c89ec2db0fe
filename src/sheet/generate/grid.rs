//! A rectangular grid of vertices, and its periodic continuation.

use crate::sheet::cell::Corner;

/// A grid of `size[0] x size[1]` vertices; vertex `(i, j)` has the number `j size[0] + i`.
pub(super) struct VertexGrid {
    pub size: [usize; 2],
}

impl VertexGrid {
    /// Returns `(i, j)` of every vertex, in the order of their numbers.
    pub(crate) fn all(&self) -> impl Iterator<Item = [usize; 2]> + use<> {
        let [m1, m2] = self.size;
        (0..m2).flat_map(move |j| (0..m1).map(move |i| [i, j]))
    }

    /// Returns vertex `(i, j)` of the grid continued periodically.
    pub(crate) fn corner(&self, i: i64, j: i64) -> Corner {
        let [m1, m2] = self.size.map(|m| m as i64);
        Corner {
            vertex: (j.rem_euclid(m2) * m1 + i.rem_euclid(m1)) as usize,
            shift: [i.div_euclid(m1) as i32, j.div_euclid(m2) as i32],
        }
    }

    /// Returns the quadrilateral whose lower left corner is `(i, j)`, counter-clockwise from that corner.
    pub(crate) fn quad(&self, [i, j]: [usize; 2]) -> [Corner; 4] {
        let (i, j) = (i as i64, j as i64);
        [self.corner(i, j), self.corner(i + 1, j), self.corner(i + 1, j + 1), self.corner(i, j + 1)]
    }
}
