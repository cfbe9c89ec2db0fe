//! Edges that fold, as closure sees them.

use crate::sheet::{Corner, Edge, TiledEdge};

/// An edge with its ends and the opposite vertices of its left and right face, as in [`Edge`].
///
/// The corners may be in any cells; those of one edge refer to the same frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct HingedEdge {
    /// First and second end.
    pub ends: [Corner; 2],
    /// Opposite vertices of the left and of the right face; if one of them is missing, the edge does not fold.
    pub wings: [Option<Corner>; 2],
}

impl HingedEdge {
    /// Whether it has a face on both sides.
    pub(super) fn folds(&self) -> bool {
        self.wings.iter().all(Option::is_some)
    }
}

impl From<&Edge> for HingedEdge {
    fn from(edge: &Edge) -> Self {
        Self { ends: edge.key.ends(), wings: edge.wings }
    }
}

impl From<&TiledEdge> for HingedEdge {
    fn from(edge: &TiledEdge) -> Self {
        Self { ends: edge.ends, wings: edge.wings }
    }
}
