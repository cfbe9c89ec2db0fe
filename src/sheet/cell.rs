//! The types of a sheet: vertices, lattice vectors, polygons, their triangles, and the edges between them.

use std::collections::{BTreeMap, HashSet};
use std::fmt;

use super::assignment::Assignment;
use super::record::FileRecord;
use super::screws::ScrewLattice;
use crate::math::{Vec3, fold_angle::fold_angle};

/// A vertex of the cell together with the lattice translation of the copy that is meant.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Corner {
    /// Number of the vertex in the cell.
    pub vertex: usize,
    /// Cell `(n1, n2)` of this copy: its translation in lattice vectors.
    pub shift: [i32; 2],
}

/// The name `[i, j, n1, n2]` of an edge: from vertex `i` of cell (0, 0) to vertex `j` of cell `(n1, n2)`.
///
/// `[j, i, -n1, -n2]` names the same edge; [`EdgeKey::new`] returns the one with `i < j`, or, where `i == j`, the one
/// whose shift is lexicographically positive. An edge of more than two faces is listed once for each of its hinges,
/// which `round` tells apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct EdgeKey {
    /// First vertex, in cell (0, 0).
    pub i: usize,
    /// Second vertex.
    pub j: usize,
    /// Cell of the second vertex, in lattice vectors.
    pub shift: [i32; 2],
    /// Number of the hinge round the edge: 0 for the edge itself, which has the bar and the first hinge, and from 1 on
    /// for the further hinges of an edge of more than two faces.
    pub round: usize,
}

/// The kind of an edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum EdgeKind {
    /// An edge between two polygons, which folds.
    Crease,
    /// A diagonal of a polygon, or a weld between two, which bends, or is locked if polygons are rigid.
    Facet,
    /// An edge that does not fold: of one face, on the rim of a finite sheet or of an opening, or of no face, as cables
    /// and struts are.
    Boundary,
}

/// The joint between two neighbouring faces of an edge of more than two faces (`foldwell:glue`).
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Deserialize, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Glue {
    /// A crease, on which they fold.
    Fold,
    /// A joint that is as stiff as the polygons are, and keeps their angle if these are rigid.
    Weld,
    /// Nothing: they turn freely about the edge.
    Free,
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
    /// The name of the edge.
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
    /// Number of the polygon to which the triangle belongs.
    pub polygon: usize,
}

/// A quadrilateral that is split into four triangles round its centre.
///
/// ```text
/// d ----- c
/// | \   / |
/// |  0    |     triangles in order round the centre 0: (a, b, 0), (b, c, 0), (c, d, 0), (d, a, 0)
/// | /   \ |
/// a ----- b
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Panel {
    /// Number of the vertex at its centre.
    pub centre: usize,
    /// Numbers of its triangles in the sheet, counter-clockwise.
    pub triangles: [usize; 4],
}

/// A side of a [`Triangle`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TriangleSide {
    /// Name of the edge.
    pub key: EdgeKey,
    /// Side of the edge on which the triangle lies: 0 for left, 1 for right.
    pub side: usize,
    /// The edge's vertex `i`, as a corner of the triangle.
    pub base: Corner,
    /// The opposite vertex, in the frame in which `i` stands in cell (0, 0).
    pub opposite: Corner,
}

/// The stiffnesses that a mesh file gives its edges, by the names of the edges; edges without a value are left out.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MeshStiffness {
    /// Stiffnesses of the hinges (creases and diagonals of polygons), a torque per radian and unit length; infinite for
    /// rigid hinges.
    pub hinges: BTreeMap<EdgeKey, f64>,
    /// `EA` of the bars, a force; infinite for rigid bars.
    pub bars: BTreeMap<EdgeKey, f64>,
}

/// A sheet: one cell drawn in full and, if it is periodic, its two lattice vectors.
///
/// Vertices are numbered by first appearance in the file; edges by first appearance along the polygons (`(a, b)`,
/// `(b, c)`, `(c, a)` of each), the diagonals of polygons after them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Sheet {
    /// Name of the sheet.
    pub title: String,
    /// Origin of the sheet, and its units.
    pub description: String,
    /// Drawn positions of the cell's vertices, each where it first appears in the file.
    pub vertices: Vec<Vec3>,
    /// The two lattice vectors; `None` for a finite sheet, and for a cell repeated by screw motions.
    pub lattice: Option<[Vec3; 2]>,
    /// The two screw motions that repeat the cell of a tube; `None` for other sheets.
    pub screws: Option<ScrewLattice>,
    /// The faces of the file, counter-clockwise.
    pub polygons: Vec<Vec<Corner>>,
    /// The triangles into which the polygons are split by their shorter diagonals.
    pub triangles: Vec<Triangle>,
    /// The edges, diagonals of polygons included.
    pub edges: Vec<Edge>,
    /// The panels that have a vertex at their centre, if [`with_centres`](super::with_centres) has looked for them.
    pub panels: Vec<Panel>,
    /// Declared openings of a periodic sheet (`foldwell:holes`), each as the vertices around it.
    pub holes: Vec<Vec<Corner>>,
    /// Origins of the vertices made by cuts, which are the last ones of `vertices`: the vertex from which each was
    /// split off.
    pub cut_from: Vec<usize>,
    /// Assignments of the file that differ from what the drawing shows; see [`Sheet::assignment`].
    pub assignments: BTreeMap<EdgeKey, Assignment>,
    /// Fold angles that the file gives its edges, in radians, valley positive, if some of them are not the drawn ones:
    /// the angles to which the sheet is to be folded. Empty if all of them are drawn, or the file gives none.
    pub targets: BTreeMap<EdgeKey, f64>,
    /// Stiffnesses that the file gives its edges.
    pub stiffness: MeshStiffness,
    /// Joints between neighbouring faces of edges of more than two faces, one for each face, in the order of
    /// [`Drawing::glue`](super::build::Drawing::glue). At edges that are left out all faces fold.
    pub glue: BTreeMap<EdgeKey, Vec<Glue>>,
    /// Named lists of vertices (`foldwell:names`), each vertex as the corner that the file draws.
    pub names: BTreeMap<String, Vec<Corner>>,
    /// The edges in the order of the file, each by its drawn ends; empty if that is the order along the faces.
    pub listed_edges: Vec<[Corner; 2]>,
    /// Content of the file other than the shape.
    pub record: FileRecord,
}

/// Largest difference of a fold angle from pi or -pi, in radians, at which the edge counts as folded flat.
const FOLDED_FLAT_RAD: f64 = 2e-5;

/// Whether an edge with this fold angle is folded flat, up to rounding of a file.
pub(crate) fn is_folded_flat(angle: f64) -> bool {
    std::f64::consts::PI - angle.abs() < FOLDED_FLAT_RAD
}

impl Corner {
    /// Returns vertex `vertex` of cell (0, 0).
    pub fn home(vertex: usize) -> Self {
        Self { vertex, shift: [0, 0] }
    }

    /// Returns the copy of this corner that is translated by `shift` cells.
    pub(crate) fn translated(self, shift: [i32; 2]) -> Self {
        Self { vertex: self.vertex, shift: [self.shift[0] + shift[0], self.shift[1] + shift[1]] }
    }
}

impl EdgeKind {
    /// Returns the word for it.
    pub fn word(self) -> &'static str {
        match self {
            Self::Crease => "crease",
            Self::Facet => "facet",
            Self::Boundary => "boundary",
        }
    }
}

impl fmt::Display for EdgeKey {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { i, j, shift: [n1, n2], .. } = self;
        write!(f, "[{i}, {j}, {n1}, {n2}]")
    }
}

impl EdgeKey {
    /// Returns the name of the edge from corner `a` to corner `b`, and whether the name runs from `b` to `a`.
    pub fn new(a: Corner, b: Corner) -> (Self, bool) {
        let shift = [b.shift[0] - a.shift[0], b.shift[1] - a.shift[1]];
        let reversed = (b.vertex, shift) < (a.vertex, [0, 0]);
        if reversed {
            (Self { i: b.vertex, j: a.vertex, shift: [-shift[0], -shift[1]], round: 0 }, true)
        } else {
            (Self { i: a.vertex, j: b.vertex, shift, round: 0 }, false)
        }
    }

    /// Returns the name of the edge, in the direction of [`EdgeKey::new`] and without the number of a hinge round it.
    pub fn whole(self) -> Self {
        let [a, b] = self.ends();
        Self::new(a, b).0
    }

    /// Whether the edge has its bar here: an edge of more than two faces is listed for each of its hinges.
    pub fn has_bar(&self) -> bool {
        self.round == 0
    }

    /// Returns the two ends of the edge, the first in cell (0, 0).
    pub fn ends(&self) -> [Corner; 2] {
        [Corner::home(self.i), Corner { vertex: self.j, shift: self.shift }]
    }
}

impl Triangle {
    /// Returns the sides `(a, b)`, `(b, c)`, `(c, a)` of the triangle `(a, b, c)`.
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
    /// Whether the sheet is one cell of many, repeated by lattice vectors or by screw motions.
    pub fn is_repeated(&self) -> bool {
        self.lattice.is_some() || self.screws.is_some()
    }

    /// Returns the edges that have a bar: each edge once.
    pub fn bars(&self) -> impl Iterator<Item = &Edge> {
        self.edges.iter().filter(|edge| edge.key.has_bar())
    }

    /// Returns the edges of no face, as cables and struts are.
    pub fn bars_alone(&self) -> impl Iterator<Item = &Edge> {
        let sides: HashSet<EdgeKey> = self.triangles.iter().flat_map(Triangle::sides).map(|side| side.key).collect();
        self.edges.iter().filter(move |edge| !sides.contains(&edge.key.whole()))
    }

    /// Returns the number of hinges round an edge.
    pub fn hinges_round(&self, key: EdgeKey) -> usize {
        self.edges.iter().filter(|edge| edge.key.whole() == key.whole() && edge.wings != [None; 2]).count()
    }

    /// Whether the sheet is a surface with two sides: no edge has more than two faces or none, and the faces of each run
    /// along it in opposite directions.
    pub fn is_surface(&self) -> bool {
        let sides = self.triangles.iter().flat_map(Triangle::sides);
        let mut sides: Vec<(EdgeKey, usize)> = sides.map(|side| (side.key, side.side)).collect();
        let count = sides.len();
        sides.sort_unstable();
        sides.dedup();
        sides.len() == count && self.bars_alone().next().is_none()
    }

    /// Returns the chords from vertex 0 to its copies in cells (1, 0) and (0, 1): the lattice vectors, if there are
    /// any.
    pub fn chords(&self) -> Option<[Vec3; 2]> {
        self.lattice.or_else(|| Some(self.screws?.chords(self.vertices.first()?)))
    }

    /// Returns the corner that this corner was before the sheet was cut.
    pub(crate) fn uncut(&self, corner: Corner) -> Corner {
        let drawn = self.vertices.len() - self.cut_from.len();
        let vertex = corner.vertex.checked_sub(drawn).map_or(corner.vertex, |made| self.cut_from[made]);
        Corner { vertex, ..corner }
    }

    /// Returns the number of the crease with this name, in either direction; `None` if there is no such crease.
    pub fn crease(&self, key: EdgeKey) -> Option<usize> {
        let key = key.whole();
        self.edges.iter().position(|edge| edge.key == key && edge.kind == EdgeKind::Crease)
    }

    /// Returns the numbers of the edges that are diagonals of polygons.
    pub(crate) fn facets(&self) -> impl Iterator<Item = usize> + '_ {
        (0..self.edges.len()).filter(|&edge| self.edges[edge].kind == EdgeKind::Facet)
    }

    /// Returns the fold angle of an edge in the drawn state, in radians, valley positive; `None` for a boundary edge.
    /// An edge that is folded flat is drawn alike at pi and at -pi: it has the side of its target angle or its letter,
    /// if the file gives one of them.
    pub fn drawn_angle(&self, edge: &Edge) -> Option<f64> {
        let [left, right] = [edge.wings[0]?, edge.wings[1]?];
        let [i, j] = edge.key.ends();
        let angle = fold_angle([i, j, left, right].map(|corner| self.position(corner)));
        let side = if is_folded_flat(angle) { self.given_side(&edge.key) } else { None };
        Some(match side {
            Some(side) if side * angle < 0.0 => angle + std::f64::consts::TAU.copysign(side),
            _ => angle,
        })
    }

    /// Returns the sign of an edge's target angle or, without one, of the angle that its letter means.
    fn given_side(&self, key: &EdgeKey) -> Option<f64> {
        let of_letter = || self.assignments.get(key).and_then(|letter| letter.flat_folded_angle());
        self.targets.get(key).copied().or_else(of_letter).filter(|angle| *angle != 0.0)
    }

    /// Whether the drawn lattice vectors, or chords of screw motions, turn counter-clockwise seen from the side of the
    /// face normals; true for a finite sheet.
    pub(crate) fn is_counterclockwise(&self) -> bool {
        let area = |corners: [Corner; 3]| {
            let [a, b, c] = corners.map(|corner| self.position(corner));
            (b - a).cross(&(c - a))
        };
        let normal: Vec3 = self.triangles.iter().map(|triangle| area(triangle.corners)).sum();
        self.chords().is_none_or(|[l1, l2]| !(l1.cross(&l2).dot(&normal) < 0.0))
    }

    /// Returns the length of an edge in the drawn state.
    pub(crate) fn length(&self, key: EdgeKey) -> f64 {
        let [from, to] = key.ends().map(|end| self.position(end));
        (to - from).norm()
    }

    /// Returns the position of a corner in the drawn state.
    pub fn position(&self, corner: Corner) -> Vec3 {
        let home = self.vertices[corner.vertex];
        match (self.lattice, &self.screws) {
            (Some([l1, l2]), _) => home + l1 * f64::from(corner.shift[0]) + l2 * f64::from(corner.shift[1]),
            (None, Some(screws)) => screws.copy(&home, corner.shift),
            (None, None) => home,
        }
    }
}
