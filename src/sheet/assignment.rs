//! Edge assignments, the letters of FOLD that say how an edge folds.

use std::cmp::Ordering;
use std::fmt;

/// The assignment of an edge in FOLD 1.2.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Assignment {
    /// `B`: the edge has one face only.
    Boundary,
    /// `M`: the edge is to fold as a mountain, to negative angles.
    Mountain,
    /// `V`: the edge is to fold as a valley, to positive angles.
    Valley,
    /// `F`: the edge is a crease that is flat.
    Flat,
    /// `U`: the edge is a crease, and nothing is said about its side.
    Unassigned,
    /// `C`: the sheet comes apart along the edge.
    Cut,
    /// `J`: the edge joins two parts of one polygon and is not a crease.
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

    /// Returns the assignment with this letter; `None` if FOLD has no such letter.
    pub fn from_letter(letter: &str) -> Option<Self> {
        Self::LETTERS.iter().find(|(_, known)| *known == letter).map(|(assignment, _)| *assignment)
    }

    /// Returns the letter of a crease that is to fold to this angle, in radians, which is not zero.
    pub(crate) fn of_side(angle: f64) -> Self {
        if angle > 0.0 { Self::Valley } else { Self::Mountain }
    }

    /// Returns the letter that the edge has from the other side of the sheet.
    pub(crate) fn seen_from_behind(self) -> Self {
        match self {
            Self::Mountain => Self::Valley,
            Self::Valley => Self::Mountain,
            other => other,
        }
    }

    /// Returns the fold angle of an edge with this letter in the sheet folded flat, in radians: -pi for a mountain, pi
    /// for a valley, 0 for an edge that does not fold; `None` if the letter says nothing about it.
    pub fn flat_folded_angle(self) -> Option<f64> {
        match self {
            Self::Mountain => Some(-std::f64::consts::PI),
            Self::Valley => Some(std::f64::consts::PI),
            Self::Flat | Self::Join => Some(0.0),
            Self::Boundary | Self::Cut | Self::Unassigned => None,
        }
    }

    /// Returns the number of the assignment, 0 to 6 for B, M, V, F, U, C, J, where a file has numbers only.
    pub(crate) fn number(self) -> usize {
        Self::LETTERS.iter().position(|(known, _)| *known == self).unwrap_or_default()
    }

    /// Returns the assignment with this number; `None` if there is none.
    pub(crate) fn from_number(number: f64) -> Option<Self> {
        (0..Self::LETTERS.len()).find(|k| *k as f64 == number).map(|k| Self::LETTERS[k].0)
    }

    /// Returns the assignment that a drawn fold angle in radians shows; a boundary if it is not a number.
    pub(crate) fn of_angle(angle: f64) -> Self {
        match angle.partial_cmp(&0.0) {
            None => Self::Boundary,
            Some(Ordering::Less) => Self::Mountain,
            Some(Ordering::Equal) => Self::Flat,
            Some(Ordering::Greater) => Self::Valley,
        }
    }

    /// Returns the letter of the assignment in FOLD.
    pub fn letter(self) -> &'static str {
        Self::LETTERS.iter().find(|(known, _)| *known == self).map_or("U", |(_, letter)| letter)
    }
}

impl fmt::Display for Assignment {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.letter())
    }
}
