//! The cell: vertices, lattice, polygons, their triangles, and the edges between them.

use std::collections::BTreeMap;

use super::assignment::Assignment;
use super::record::FileRecord;
use crate::math::{Vec3, fold_angle::fold_angle};

/// A vertex of the cell together with the lattice translate in which it stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Corner {
    /// Number of the vertex in the cell.
    pub vertex: usize,
    /// Cell `(n1, n2)` of this copy, in lattice vectors.
    pub shift: [i32; 2],
}

/// The name `[i, j, n1, n2]` of an edge: from vertex `i` of cell (0, 0) to vertex `j` of cell `(n1, n2)`.
///
/// `[j, i, -n1, -n2]` names the same edge; [`EdgeKey::new`] returns the one with `i < j`, or, where `i == j`, the one
/// whose shift is lexicographically positive.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct EdgeKey {
    /// First vertex, in cell (0, 0).
    pub i: usize,
    /// Second vertex.
    pub j: usize,
    /// Cell of the second vertex.
    pub shift: [i32; 2],
}

/// What an edge is in the sheet.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum EdgeKind {
    /// Between two polygons: it folds.
    Crease,
    /// Diagonal of a polygon: it bends, or is locked where polygons are rigid.
    Facet,
    /// One face only: the rim of a finite sheet or of an opening.
    Boundary,
}

/// An edge of the cell.
///
/// ```text
///            wings[0]            the left face (i, j, wings[0]) and the right face (j, i, wings[1])
///            /      \            are counter-clockwise seen from the side of the face normals
///           i ------ j
///            \      /
///            wings[1]
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Edge {
    /// Its name.
    pub key: EdgeKey,
    /// Crease, facet or boundary.
    pub kind: EdgeKind,
    /// Opposite vertices of the left and the right face, in the frame in which `i` stands in cell (0, 0).
    pub wings: [Option<Corner>; 2],
}

/// A triangle of the cell, counter-clockwise seen from the side of the face normals.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Triangle {
    /// Its corners.
    pub corners: [Corner; 3],
    /// The polygon of which it is a part.
    pub polygon: usize,
}

/// A side of a [`Triangle`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TriangleSide {
    /// The edge.
    pub key: EdgeKey,
    /// The triangle lies on its left (0) or on its right (1).
    pub side: usize,
    /// The edge's vertex `i`, as a corner of the triangle.
    pub base: Corner,
    /// The opposite vertex, in the frame in which `i` stands in cell (0, 0).
    pub opposite: Corner,
}

/// A sheet: one cell drawn in full and, where it is periodic, two lattice vectors.
///
/// Vertices are numbered by first appearance in the file; edges by first appearance along the polygons (`(a, b)`,
/// `(b, c)`, `(c, a)` of each), the diagonals of polygons after them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Sheet {
    /// Name of the sheet.
    pub title: String,
    /// Where it comes from, and its units.
    pub description: String,
    /// Positions of the cell's vertices as drawn, each in the cell where it first appears.
    pub vertices: Vec<Vec3>,
    /// The two lattice vectors; `None`: a finite sheet.
    pub lattice: Option<[Vec3; 2]>,
    /// Faces as the file has them, counter-clockwise.
    pub polygons: Vec<Vec<Corner>>,
    /// Polygons split by their shorter diagonals.
    pub triangles: Vec<Triangle>,
    /// Edges, diagonals of polygons included.
    pub edges: Vec<Edge>,
    /// Declared openings of a periodic sheet (`foldwell:holes`), each the round of its vertices.
    pub holes: Vec<Vec<Corner>>,
    /// For each of the last vertices, which a cut has made, the vertex that it was part of.
    pub cut_from: Vec<usize>,
    /// Assignments of the file where they are others than the drawing shows; see [`Sheet::assignment`].
    pub assignments: BTreeMap<EdgeKey, Assignment>,
    /// What the file says beside the shape.
    pub record: FileRecord,
}

impl Corner {
    /// Vertex `vertex` of cell (0, 0).
    pub fn home(vertex: usize) -> Self {
        Self { vertex, shift: [0, 0] }
    }

    /// The copy of this corner `shift` cells further.
    pub(crate) fn translated(self, shift: [i32; 2]) -> Self {
        Self { vertex: self.vertex, shift: [self.shift[0] + shift[0], self.shift[1] + shift[1]] }
    }
}

impl EdgeKey {
    /// The name of the edge from corner `a` to corner `b`, and whether it runs from `b` to `a`.
    pub fn new(a: Corner, b: Corner) -> (Self, bool) {
        let shift = [b.shift[0] - a.shift[0], b.shift[1] - a.shift[1]];
        let reversed = (b.vertex, shift) < (a.vertex, [0, 0]);
        if reversed {
            (Self { i: b.vertex, j: a.vertex, shift: [-shift[0], -shift[1]] }, true)
        } else {
            (Self { i: a.vertex, j: b.vertex, shift }, false)
        }
    }

    /// The two ends of the edge.
    pub fn ends(&self) -> [Corner; 2] {
        [Corner::home(self.i), Corner { vertex: self.j, shift: self.shift }]
    }
}

impl Triangle {
    /// Its sides `(a, b)`, `(b, c)`, `(c, a)`.
    pub fn sides(&self) -> [TriangleSide; 3] {
        std::array::from_fn(|k| {
            let [a, b, opposite] = [0, 1, 2].map(|d| self.corners[(k + d) % 3]);
            let (key, reversed) = EdgeKey::new(a, b);
            let base = if reversed { b } else { a };
            let opposite = opposite.translated([-base.shift[0], -base.shift[1]]);
            TriangleSide { key, side: usize::from(reversed), base, opposite }
        })
    }
}

impl Sheet {
    /// The corner as it was before the sheet was cut.
    pub(crate) fn uncut(&self, corner: Corner) -> Corner {
        let drawn = self.vertices.len() - self.cut_from.len();
        let vertex = corner.vertex.checked_sub(drawn).map_or(corner.vertex, |made| self.cut_from[made]);
        Corner { vertex, ..corner }
    }

    /// The number of the crease of this name, in either direction; `None` where there is no such crease.
    pub fn crease(&self, key: EdgeKey) -> Option<usize> {
        let [a, b] = key.ends();
        let (key, _) = EdgeKey::new(a, b);
        self.edges.iter().position(|edge| edge.key == key && edge.kind == EdgeKind::Crease)
    }

    /// The edges that are diagonals of polygons.
    pub(crate) fn facets(&self) -> impl Iterator<Item = usize> + '_ {
        (0..self.edges.len()).filter(|&edge| self.edges[edge].kind == EdgeKind::Facet)
    }

    /// Fold angle of an edge in the drawn state, in radians, valley positive; `None` on a boundary.
    pub fn drawn_angle(&self, edge: &Edge) -> Option<f64> {
        let [left, right] = [edge.wings[0]?, edge.wings[1]?];
        let [i, j] = edge.key.ends();
        Some(fold_angle([i, j, left, right].map(|corner| self.position(corner))))
    }

    /// Where a corner is in the drawn state.
    pub fn position(&self, corner: Corner) -> Vec3 {
        let home = self.vertices[corner.vertex];
        match self.lattice {
            Some([l1, l2]) => home + l1 * f64::from(corner.shift[0]) + l2 * f64::from(corner.shift[1]),
            None => home,
        }
    }
}
