//! Contradictions between the assignment of an edge and the mesh.

use super::assignment::Assignment;
use super::drawn_edge::DrawnEdge;

/// A contradiction between an assignment and the mesh; the message says how to correct it.
#[derive(Debug, PartialEq, thiserror::Error)]
pub enum AssignmentFault {
    /// The assignment is `B`, but the edge has two faces.
    #[error(
        "edge {edge} of the list, {ends}, is assigned B, a boundary, but it lies between two faces; assign C to cut the \
         sheet there, M, V, F or U to a crease, or take away the face that is a hole"
    )]
    BoundaryInside {
        /// Index of the edge in the list of edges.
        edge: usize,
        /// Its ends.
        ends: DrawnEdge,
    },
    /// The assignment is `J`, but the edge has one face.
    #[error("edge {edge} of the list, {ends}, is assigned J, which joins two faces, but it has only one; assign B")]
    JoinAtRim {
        /// Index of the edge in the list of edges.
        edge: usize,
        /// Its ends.
        ends: DrawnEdge,
    },
    /// The assignment is `M` on a valley or `V` on a mountain.
    #[error(
        "edge {edge} of the list, {ends}, is assigned {letter}, but the vertices draw a fold angle of {drawn} degrees \
         (valley positive, seen from the side of the face normals); assign the other letter, or turn all faces over"
    )]
    OtherSide {
        /// Index of the edge in the list of edges.
        edge: usize,
        /// Its ends.
        ends: DrawnEdge,
        /// The assignment of the file.
        letter: Assignment,
        /// Fold angle that the vertices draw, in degrees.
        drawn: f64,
    },
    /// The words of `foldwell:glue` for an edge are not one, or one for each face, or the edge has two faces or less.
    #[error(
        "`foldwell:glue` has {found} word(s) for edge {edge} of {faces} face(s); it is for edges of three or more faces, \
         and has one word, or one for each face"
    )]
    Glue {
        /// The edge.
        edge: DrawnEdge,
        /// Number of its faces.
        faces: usize,
        /// Number of words.
        found: usize,
    },
    /// The edge is cut, but the sheet stays joined at both of its ends.
    #[error(
        "edge {edge} of the list, {ends}, is assigned C, but the sheet stays joined at both of its ends, so that this cut \
         cannot open; let cuts of two edges or more meet, or reach the rim"
    )]
    ClosedCut {
        /// Index of the edge in the list of edges.
        edge: usize,
        /// Its ends.
        ends: DrawnEdge,
    },
    /// The edge is cut, but the sheet has lattice vectors.
    #[error(
        "edge {edge} of the list, {ends}, is assigned C, but a periodic sheet cannot be cut along an edge; draw the cut \
         as an opening, with vertices of its own on both sides, and list it in `foldwell:holes`"
    )]
    PeriodicCut {
        /// Index of the edge in the list of edges.
        edge: usize,
        /// Its ends.
        ends: DrawnEdge,
    },
}

impl AssignmentFault {
    /// Whether the letter is that of the other side.
    pub(crate) fn is_other_side(&self) -> bool {
        matches!(self, Self::OtherSide { .. })
    }
}
