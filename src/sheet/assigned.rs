//! What the edges of a sheet are meant to be: by its file, or by its drawing.

use super::assignment::Assignment;
use super::cell::{Edge, EdgeKind, Sheet};

/// Drawing fold angles below this many degrees count as flat.
pub(crate) const FLAT: f64 = 1e-9;

impl Sheet {
    /// What an edge is meant to be: the letter of its file, or what the drawing shows where the file gives none.
    pub fn assignment(&self, edge: &Edge) -> Assignment {
        self.assignments.get(&edge.key).copied().unwrap_or_else(|| self.drawn_assignment(edge))
    }

    /// What the drawing alone shows: a boundary, part of a polygon, a mountain, a valley, or an edge that lies flat.
    pub(crate) fn drawn_assignment(&self, edge: &Edge) -> Assignment {
        match (edge.kind, self.drawn_angle(edge).unwrap_or(0.0).to_degrees()) {
            (EdgeKind::Boundary, _) => Assignment::Boundary,
            (EdgeKind::Facet, _) => Assignment::Join,
            (EdgeKind::Crease, angle) if angle >= FLAT => Assignment::Valley,
            (EdgeKind::Crease, angle) if angle <= -FLAT => Assignment::Mountain,
            (EdgeKind::Crease, _) => Assignment::Flat,
        }
    }
}
