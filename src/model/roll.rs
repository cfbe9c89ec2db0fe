//! The start of a tube: where its vertices are about the axis, and how it goes on from cell to cell.

use super::assembly::Assembly;
use super::boundary::{Boundary, Drawn};
use super::domain::Domain;
use crate::math::Vec3;
use crate::sheet::{Seam, SeamKept, Sheet};
use nalgebra::Matrix3;

/// A tube about the z axis, as coordinates of the [domain](Domain) that belongs to it, with the fold angles of its edges.
#[derive(Clone, Debug, PartialEq)]
pub struct Roll {
    /// The seam along which it closes.
    pub seam: Seam,
    /// The closing conditions that it keeps when it moves.
    pub kept: SeamKept,
    /// Coordinates `x, y, z` of the vertices of cell (0, 0), then turn (radians) and translation from one row of cells to the
    /// next, then those from one strand to the next that are not kept: translation, turn.
    pub coordinates: Vec<f64>,
    /// Fold angle of every edge of the sheet in radians, continued through pi; NaN for a boundary edge.
    pub angles: Vec<f64>,
    /// Rotation from the frame in which the tube is shown to the frame of its axis, about `origin`.
    pub frame: Matrix3<f64>,
    /// Point on the axis, in the frame in which the tube is shown.
    pub origin: Vec3,
}

impl Roll {
    /// Returns the boundary conditions of the tube.
    pub fn boundary(&self) -> Boundary {
        Boundary::Tube { seam: self.seam, kept: self.kept }
    }

    /// Returns the start in the coordinates of the tube's domain.
    pub(super) fn drawn(&self, sheet: &Sheet) -> Drawn {
        let (counterclockwise, chords) = (sheet.is_counterclockwise(), sheet.lattice);
        let domain = Domain::Tube { seam: self.seam, kept: self.kept, counterclockwise };
        let coordinates = self.coordinates.clone();
        Drawn { domain, coordinates, held: vec![], frame: self.frame, origin: self.origin, chords }
    }
}

impl Assembly {
    /// Returns the same tube in the state with these coordinates, with other closing conditions, and its coordinates there;
    /// `None` for other boundary conditions.
    pub(crate) fn tube_keeping(&self, kept: SeamKept, coordinates: &[f64]) -> Option<(Self, Vec<f64>)> {
        let drawn = self.drawn();
        let (Domain::Tube { seam, kept: before, counterclockwise }, true) =
            (&drawn.domain, coordinates.len() == drawn.coordinates.len())
        else {
            return None;
        };
        let (common, free) = coordinates.split_at(coordinates.len() - before.free());
        let mut moved = common.to_vec();
        let of_strand = [
            if before.rise { 0.0 } else { free[0] },
            if before.turn { std::f64::consts::TAU / f64::from(seam.strands()) } else { free[free.len() - 1] },
        ];
        moved.extend([kept.rise, kept.turn].into_iter().zip(of_strand).filter(|(kept, _)| !kept).map(|(_, x)| x));
        let domain = Domain::Tube { seam: *seam, kept, counterclockwise: *counterclockwise };
        let place = Drawn { domain, coordinates: moved.clone(), ..drawn.clone() };
        Some((self.with_drawn(place, Boundary::Tube { seam: *seam, kept }), moved))
    }
}
