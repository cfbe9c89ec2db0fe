//! The assignment of an edge, from the file or from the drawing.

use super::assignment::Assignment;
use super::cell::{Edge, EdgeKind, Sheet};

/// Largest magnitude in degrees of a drawn fold angle that counts as flat.
pub(crate) const FLAT: f64 = 1e-9;

/// Largest difference between two fold angles, in radians, that counts as rounding of a file: 1e-3 degrees.
const SAME_ANGLE_RAD: f64 = 1e-3 * std::f64::consts::PI / 180.0;

/// Whether two fold angles are the same up to full turns and rounding of a file.
pub(crate) fn is_same_angle(a: f64, b: f64) -> bool {
    let off = (a - b).rem_euclid(std::f64::consts::TAU);
    off.min(std::f64::consts::TAU - off) <= SAME_ANGLE_RAD
}

impl Sheet {
    /// Returns the number of creases and diagonals whose target angle differs from the drawn fold angle.
    pub fn targets_not_drawn(&self) -> usize {
        let differs = |edge: &&Edge| match (self.targets.get(&edge.key), self.drawn_angle(edge)) {
            (Some(target), Some(drawn)) => edge.kind != EdgeKind::Boundary && !is_same_angle(*target, drawn),
            _ => false,
        };
        self.edges.iter().filter(differs).count()
    }

    /// Returns the number of creases that are drawn folded to the other side than their target angle, and that of all
    /// creases that are drawn folded and have a target angle.
    pub fn drawn_against_targets(&self) -> [usize; 2] {
        let creases = self.edges.iter().filter(|edge| edge.kind == EdgeKind::Crease);
        let both = creases.filter_map(|edge| Some(self.targets.get(&edge.key)? * self.drawn_angle(edge)?));
        let folded: Vec<f64> = both.filter(|product| product.abs() > SAME_ANGLE_RAD * SAME_ANGLE_RAD).collect();
        [folded.iter().filter(|product| **product < 0.0).count(), folded.len()]
    }

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
