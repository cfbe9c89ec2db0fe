//! The letters of FOLD that say what an edge is meant to be.

use std::fmt;

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
    pub(crate) fn from_letter(letter: &str) -> Option<Self> {
        Self::LETTERS.iter().find(|(_, known)| *known == letter).map(|(assignment, _)| *assignment)
    }

    /// The letter that FOLD has for it.
    pub(crate) fn letter(self) -> &'static str {
        Self::LETTERS.iter().find(|(known, _)| *known == self).map_or("U", |(_, letter)| letter)
    }
}

impl fmt::Display for Assignment {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.letter())
    }
}
