//! The assignment of an edge, from the file or from the drawing.

use super::assignment::Assignment;
use super::cell::{Edge, EdgeKind, Sheet};

/// Largest magnitude in degrees of a drawn fold angle that counts as flat.
pub(crate) const FLAT: f64 = 1e-9;

impl Sheet {
    /// Returns the assignment of an edge: that of the file, or what the drawing shows if the file gives none.
    pub fn assignment(&self, edge: &Edge) -> Assignment {
        self.assignments.get(&edge.key).copied().unwrap_or_else(|| self.drawn_assignment(edge))
    }

    /// Returns the assignment that the drawing alone shows: boundary, joint of a polygon, mountain, valley or flat.
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
