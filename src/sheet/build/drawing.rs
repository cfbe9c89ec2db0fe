//! A mesh as a file draws it, before it becomes a sheet.

use crate::math::Vec3;
use crate::sheet::ScrewLattice;
use crate::sheet::assignment::Assignment;
use crate::sheet::cell::Glue;
use crate::sheet::error::DrawnEdge;
use std::collections::BTreeMap;

/// The ends of an edge of more than two faces, and the words for the joints between these.
pub type GluedEdge = ([usize; 2], Vec<Glue>);

/// A mesh as a file draws it, before it becomes a sheet.
#[derive(Clone, Debug, Default)]
pub struct Drawing {
    /// Name of the sheet.
    pub title: String,
    /// Origin of the sheet, and its units.
    pub description: String,
    /// Positions of the drawn vertices, copies included.
    pub coords: Vec<Vec3>,
    /// Whether the mesh is drawn in the plane, so that edges must not cross.
    pub planar: bool,
    /// Whether the mesh is drawn in a folded state, whose layers may lie on each other.
    pub folded: bool,
    /// Faces, counter-clockwise, as indices into `coords`.
    pub faces: Vec<Vec<usize>>,
    /// The two lattice vectors.
    pub lattice: Option<[Vec3; 2]>,
    /// The two screw motions that repeat the cell of a tube, instead of lattice vectors.
    pub screws: Option<ScrewLattice>,
    /// Openings, as indices into `coords`.
    pub holes: Vec<Vec<usize>>,
    /// Assignments of drawn edges; the ends are indices into `coords`.
    pub assignments: Vec<([usize; 2], Assignment)>,
    /// Fold angles that the file gives to drawn edges, in radians, valley positive; `None` where it gives none.
    pub fold_angles: Vec<([usize; 2], Option<f64>)>,
    /// Words for the joints between neighbouring faces of edges of more than two faces: one word for all joints of an
    /// edge, or one for each. They begin at the face that is listed first and go on in the sense of a right-handed screw
    /// along the edge, from its end of lower number to the other.
    pub glue: Vec<GluedEdge>,
    /// Edges of no face, which have a bar only.
    pub bars: Vec<[usize; 2]>,
    /// Named lists of vertices, as indices into `coords`.
    pub names: BTreeMap<String, Vec<usize>>,
    /// Number that the file gives to its first vertex and face: 0 in FOLD, 1 in OBJ. Only messages use it.
    pub first: usize,
}

impl Drawing {
    /// Returns the copy of a drawn point in a cell.
    pub(super) fn copy(&self, point: &Vec3, cell: [i32; 2]) -> Vec3 {
        match (self.lattice, &self.screws) {
            (Some([l1, l2]), _) => point + l1 * f64::from(cell[0]) + l2 * f64::from(cell[1]),
            (None, Some(screws)) => screws.copy(point, cell),
            (None, None) => *point,
        }
    }

    /// Whether the mesh is one cell of many.
    pub(crate) fn is_repeated(&self) -> bool {
        self.lattice.is_some() || self.screws.is_some()
    }

    pub(crate) fn name(&self, number: usize) -> usize {
        number + self.first
    }

    pub(crate) fn edge_name(&self, ends: [usize; 2]) -> DrawnEdge {
        DrawnEdge(self.name(ends[0]), self.name(ends[1]))
    }
}
