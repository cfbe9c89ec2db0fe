//! Tubes with other closing conditions.

use super::assembly::Assembly;
use super::boundary::Drawn;
use super::domain::Domain;
use crate::sheet::SeamKept;
use std::f64::consts::TAU;

impl Assembly {
    /// Returns the same tube in the state with these coordinates, with other closing conditions, and its coordinates
    /// there; `None` for other boundary conditions.
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
            if before.turn { TAU / f64::from(seam.strands()) } else { free[free.len() - 1] },
        ];
        moved.extend([kept.rise, kept.turn].into_iter().zip(of_strand).filter(|(kept, _)| !kept).map(|(_, x)| x));
        let domain = Domain::Tube { seam: *seam, kept, counterclockwise: *counterclockwise };
        let place = Drawn { domain, coordinates: moved.clone(), ..drawn.clone() };
        Some((self.with_drawn(place), moved))
    }
}
