//! Contradictions between the assignment of an edge and the mesh.

use super::assignment::Assignment;
use super::drawn_edge::DrawnEdge;

/// A contradiction between an assignment and the mesh; the message says how to correct it.
#[derive(Debug, PartialEq, thiserror::Error)]
#[allow(missing_docs)] // the messages say it
pub enum AssignmentFault {
    #[error(
        "edge {edge} of the list, {ends}, is assigned B, a boundary, but it lies between two faces; assign C to cut the \
         sheet there, M, V, F or U to a crease, or take away the face that is a hole"
    )]
    BoundaryInside { edge: usize, ends: DrawnEdge },
    #[error("edge {edge} of the list, {ends}, is assigned J, which joins two faces, but it has only one; assign B")]
    JoinAtRim { edge: usize, ends: DrawnEdge },
    #[error(
        "edge {edge} of the list, {ends}, is assigned {letter}, but the vertices draw a fold angle of {drawn} degrees \
         (valley positive, seen from the side of the face normals); assign the other letter, or turn all faces over"
    )]
    OtherSide {
        edge: usize,
        ends: DrawnEdge,
        letter: Assignment,
        /// Fold angle that the vertices draw, in degrees.
        drawn: f64,
    },
    #[error(
        "`foldwell:glue` has {found} word(s) for edge {edge} of {faces} face(s); it is for edges of three or more faces, \
         and has one word, or one for each face"
    )]
    Glue { edge: DrawnEdge, faces: usize, found: usize },
    #[error(
        "edge {edge} of the list, {ends}, is assigned C, but the sheet stays joined at both of its ends, so that this cut \
         cannot open; let cuts of two edges or more meet, or reach the rim"
    )]
    ClosedCut { edge: usize, ends: DrawnEdge },
    #[error(
        "edge {edge} of the list, {ends}, is assigned C, but a periodic sheet cannot be cut along an edge; draw the cut \
         as an opening, with vertices of its own on both sides, and list it in `foldwell:holes`"
    )]
    PeriodicCut { edge: usize, ends: DrawnEdge },
}

impl AssignmentFault {
    /// Whether the letter is that of the other side.
    pub(crate) fn is_other_side(&self) -> bool {
        matches!(self, Self::OtherSide { .. })
    }
}
