//! The start of a tube: where its vertices are about the axis, and how it goes on from cell to cell.

use super::boundary::Drawn;
use super::domain::Domain;
use crate::sheet::{Seam, SeamKept, Sheet};
use std::f64::consts::TAU;
use thiserror::Error;

/// Largest angle in radians, and rise relative to the shorter chord, by which the seam of a drawn tube may miss.
const CLOSED: f64 = 1e-6;

/// The reason why a sheet is not drawn as a tube with a given seam.
#[derive(Clone, Debug, PartialEq, Error)]
#[allow(missing_docs)] // each variant is documented by its message
pub enum RollError {
    #[error("the sheet is not drawn as a tube: no screw motions repeat its cell")]
    NoScrews,
    #[error("a seam is a cell other than [0, 0], with numbers of at most 15 bits")]
    NoSeam,
    #[error("the drawn tube does not close: the seam turns by {} degrees and rises by {}, not by 360 and 0", rounded(turn.to_degrees()), rounded(*rise))]
    Open {
        /// Angle of the seam, in radians.
        turn: f64,
        rise: f64,
    },
}

/// Returns a number to six decimals, which is as closely as a seam has to close.
fn rounded(number: f64) -> f64 {
    (number * 1e6).round() / 1e6
}

/// A tube about the z axis, as coordinates of the [domain](Domain) that belongs to it, with the fold angles of its
/// edges.
#[derive(Clone, Debug, PartialEq)]
pub struct Roll {
    /// The seam along which it closes.
    pub seam: Seam,
    /// The closing conditions that it keeps when it moves.
    pub kept: SeamKept,
    /// Coordinates `x, y, z` of the vertices of cell (0, 0), then turn (radians) and translation from one row of cells
    /// to the next, then those from one strand to the next that are not kept: translation, turn.
    pub coordinates: Vec<f64>,
    /// Fold angle of every edge of the sheet in radians, continued through pi; NaN for a boundary edge.
    pub angles: Vec<f64>,
}

impl Roll {
    /// Returns a tube as its file draws it: the cell repeated by the sheet's [screw
    /// motions](crate::sheet::ScrewLattice).
    ///
    /// ```
    /// use foldwell::sheet::SeamKept;
    /// use foldwell::{Assembly, RIGID, Roll, relax};
    ///
    /// let path = concat!(env!("CARGO_MANIFEST_DIR"), "/meshes/kresling-cell.fold");
    /// let sheet = foldwell::sheet::fold::read(path.as_ref())?;
    /// let roll = Roll::as_drawn(&sheet, [6, 0], SeamKept::BOTH)?;
    /// let tube = Assembly::tube(sheet, roll, [6, 4]).bars(RIGID).creases(1.0).build()?;
    /// // creases at rest as drawn: nothing moves
    /// assert_eq!(relax(&tube)?.iterations, 0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`RollError`] if no screw motions repeat the cell, for a seam that is none, and if a condition that is kept
    /// misses by more than 1e-6 (radians; relative to the shorter chord).
    pub fn as_drawn(sheet: &Sheet, seam: [i32; 2], kept: SeamKept) -> Result<Self, RollError> {
        let (Some(screws), Some(chords)) = (&sheet.screws, sheet.chords()) else { return Err(RollError::NoScrews) };
        let seam = Seam::new(seam).ok_or(RollError::NoSeam)?;
        let [turn, rise] = [screws.turn_of(seam.lattice_vector()), screws.rise_of(seam.lattice_vector())];
        let shorter = chords[0].norm().min(chords[1].norm());
        if (kept.turn && (turn - TAU).abs() > CLOSED) || (kept.rise && rise.abs() > CLOSED * shorter) {
            return Err(RollError::Open { turn, rise });
        }
        let mut coordinates: Vec<f64> = sheet.vertices.iter().flat_map(|p| <[f64; 3]>::from(*p)).collect();
        coordinates.extend(screws.shared(&seam, kept));
        let angles = sheet.edges.iter().map(|edge| sheet.drawn_angle(edge).unwrap_or(f64::NAN)).collect();
        Ok(Self { seam, kept, coordinates, angles })
    }

    /// Returns the start in the coordinates of the tube's domain.
    pub(super) fn drawn(&self, sheet: &Sheet) -> Drawn {
        let (counterclockwise, chords) = (sheet.is_counterclockwise(), sheet.chords());
        let domain = Domain::Tube { seam: self.seam, kept: self.kept, counterclockwise };
        Drawn { chords, ..Drawn::of(domain, self.coordinates.clone()) }
    }
}
