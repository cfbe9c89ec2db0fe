//! A line of a crease pattern.

use crate::math::Vec2;
use crate::sheet::assignment::Assignment;
use crate::sheet::error::Problem;
use crate::sheet::pattern_fault::{LineName, PatternFault};

/// The lines of a file, and its title if it has one; an error has its line and column.
pub(super) type Lines = Result<(Vec<Line>, String), Misread>;

/// A problem together with the line and column of the file that have it.
pub(super) type Misread = ([usize; 2], Box<Problem>);

impl From<PatternFault> for Box<Problem> {
    fn from(fault: PatternFault) -> Self {
        Self::new(fault.into())
    }
}

/// A line of a crease pattern and what is to become of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Line {
    /// The two ends, y upwards.
    pub ends: [Vec2; 2],
    /// The letter of its edges.
    pub letter: Assignment,
    /// Target angle in degrees, valley positive.
    pub angle: Option<f64>,
    /// Whether it is auxiliary: another line on it counts instead, and what separates no faces is left out.
    pub auxiliary: bool,
    /// Place in the file: line and column, from 1.
    pub place: [usize; 2],
    /// Whether y points downwards in the file.
    pub flipped: bool,
}

impl Line {
    /// Returns the name of the line in messages, in coordinates of the file.
    pub(super) fn name(&self) -> LineName {
        LineName(self.ends.map(|end| [end.x, if self.flipped { flip(end.y) } else { end.y }]))
    }
}

/// Returns the coordinate along the other direction of y; zero has no sign.
pub(super) fn flip(y: f64) -> f64 {
    0.0 - y
}
