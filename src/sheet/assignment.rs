//! The letters of FOLD that say what an edge is meant to be.

use std::fmt;

use super::cell::{Edge, EdgeKind, Sheet};
use super::error::DrawnEdge;

/// Drawing fold angles below this many degrees count as flat.
pub const FLAT: f64 = 1e-9;

/// What an edge is meant to be, as FOLD 1.2 assigns it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Assignment {
    /// `B`: the edge has one face only.
    Boundary,
    /// `M`: the edge is to fold as a mountain, to negative angles.
    Mountain,
    /// `V`: the edge is to fold as a valley, to positive angles.
    Valley,
    /// `F`: the edge is a crease that stays unfolded.
    Flat,
    /// `U`: the edge is a crease, and nothing is said about its side.
    Unassigned,
    /// `C`: the edge is a cut, and its two faces are not joined.
    Cut,
    /// `J`: the edge joins two parts of one polygon, and is no crease.
    Join,
}

impl Assignment {
    const LETTERS: [(Self, &'static str); 7] = [
        (Self::Boundary, "B"),
        (Self::Mountain, "M"),
        (Self::Valley, "V"),
        (Self::Flat, "F"),
        (Self::Unassigned, "U"),
        (Self::Cut, "C"),
        (Self::Join, "J"),
    ];

    /// The assignment with this letter, if FOLD has it.
    pub fn from_letter(letter: &str) -> Option<Self> {
        Self::LETTERS.iter().find(|(_, known)| *known == letter).map(|(assignment, _)| *assignment)
    }

    /// The letter that FOLD has for it.
    pub fn letter(self) -> &'static str {
        Self::LETTERS.iter().find(|(known, _)| *known == self).map_or("U", |(_, letter)| letter)
    }
}

impl fmt::Display for Assignment {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.letter())
    }
}

impl Sheet {
    /// What an edge is meant to be: the letter of its file, or what the drawing shows where the file gives none.
    pub fn assignment(&self, edge: &Edge) -> Assignment {
        self.assignments.get(&edge.key).copied().unwrap_or_else(|| self.drawn_assignment(edge))
    }

    /// What the drawing alone shows: a boundary, part of a polygon, a mountain, a valley, or an edge that lies flat.
    pub fn drawn_assignment(&self, edge: &Edge) -> Assignment {
        match (edge.kind, self.drawn_angle(edge).unwrap_or(0.0).to_degrees()) {
            (EdgeKind::Boundary, _) => Assignment::Boundary,
            (EdgeKind::Facet, _) => Assignment::Join,
            (EdgeKind::Crease, angle) if angle >= FLAT => Assignment::Valley,
            (EdgeKind::Crease, angle) if angle <= -FLAT => Assignment::Mountain,
            (EdgeKind::Crease, _) => Assignment::Flat,
        }
    }
}

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
