//! How an assignment contradicts the mesh.

use super::assignment::Assignment;
use super::drawn_edge::DrawnEdge;

/// How an assignment contradicts the mesh, and what would be right.
#[derive(Debug, PartialEq, thiserror::Error)]
pub enum AssignmentFault {
    /// `B` on an edge of two faces.
    #[error(
        "edge {edge} of the list, {ends}, is assigned B, a boundary, but it lies between two faces; assign C to cut the \
         sheet there, M, V, F or U to a crease, or take away the face that is a hole"
    )]
    BoundaryInside {
        /// Entry of the list of edges.
        edge: usize,
        /// Its ends.
        ends: DrawnEdge,
    },
    /// `J` on an edge of one face.
    #[error("edge {edge} of the list, {ends}, is assigned J, which joins two faces, but it has only one; assign B")]
    JoinAtRim {
        /// Entry of the list of edges.
        edge: usize,
        /// Its ends.
        ends: DrawnEdge,
    },
    /// `M` on a valley or `V` on a mountain.
    #[error(
        "edge {edge} of the list, {ends}, is assigned {letter}, but the vertices draw a fold angle of {drawn} degrees \
         (valley positive, seen from the side of the face normals); assign the other letter, or turn all faces over"
    )]
    OtherSide {
        /// Entry of the list of edges.
        edge: usize,
        /// Its ends.
        ends: DrawnEdge,
        /// The letter of the file.
        letter: Assignment,
        /// The angle of the geometry.
        drawn: f64,
    },
    /// A cut between two vertices at which the sheet stays whole.
    #[error(
        "edge {edge} of the list, {ends}, is assigned C, but the sheet stays joined at both of its ends, so that this cut \
         cannot open; let cuts of two edges or more meet, or reach the rim"
    )]
    ClosedCut {
        /// Entry of the list of edges.
        edge: usize,
        /// Its ends.
        ends: DrawnEdge,
    },
    /// A cut in a sheet with lattice vectors.
    #[error(
        "edge {edge} of the list, {ends}, is assigned C, but a periodic sheet cannot be cut along an edge; draw the cut \
         as an opening, with vertices of its own on both sides, and list it in `foldwell:holes`"
    )]
    PeriodicCut {
        /// Entry of the list of edges.
        edge: usize,
        /// Its ends.
        ends: DrawnEdge,
    },
}
