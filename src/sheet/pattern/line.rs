//! A line of a crease pattern.

use crate::math::Vec2;
use crate::sheet::assignment::Assignment;
use crate::sheet::error::MeshProblem;
use crate::sheet::pattern_fault::{LineName, PatternFault};
use crate::sheet::record::Redrawing;

/// The lines of a file, or an error with its line and column.
pub(super) type Lines = Result<DrawnLines, Misread>;

/// The lines of a file.
#[derive(Default)]
pub(super) struct DrawnLines {
    pub lines: Vec<PatternLine>,
    /// Title of the file; empty if it has none.
    pub title: String,
    /// Changes that were made to read the lines.
    pub redrawing: Redrawing,
}

/// A problem together with the line and column of the file that have it.
pub(super) type Misread = ([usize; 2], Box<MeshProblem>);

impl DrawnLines {
    /// Adds a line; one without a finite length draws nothing, and is counted.
    pub fn push(&mut self, line: PatternLine) {
        if line.ends.iter().flat_map(|end| end.iter()).all(|c| c.is_finite()) {
            self.lines.push(line);
        } else {
            self.redrawing.not_finite += 1;
        }
    }
}

impl From<PatternFault> for Box<MeshProblem> {
    fn from(fault: PatternFault) -> Self {
        Self::new(fault.into())
    }
}

/// A line of a crease pattern and what is to become of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PatternLine {
    /// The two ends, y upwards.
    pub ends: [Vec2; 2],
    /// The letter of its edges.
    pub letter: Assignment,
    /// Target angle in degrees, valley positive.
    pub angle: Option<f64>,
    /// Whether it is auxiliary: another line on it counts instead, and what separates no faces is left out.
    pub auxiliary: bool,
    /// Whether it is the rim of the sheet where it has a face on one side only, whatever its letter. Between two faces
    /// it has its letter, and cuts the sheet if that is a boundary; boundaries that are no contours are refused there.
    pub contour: bool,
    /// Place in the text of the file, in bytes.
    pub at: usize,
    /// Whether y points downwards in the file.
    pub flipped: bool,
}

impl PatternLine {
    /// Whether it is drawn without a letter: the rim, or a crease, as the faces beside it say.
    pub(super) fn is_plain(&self) -> bool {
        self.contour && self.letter == Assignment::Unassigned
    }

    /// Returns the name of the line in messages, in coordinates of the file.
    pub(super) fn name(&self) -> LineName {
        LineName(self.ends.map(|end| [end.x, if self.flipped { flip(end.y) } else { end.y }]))
    }
}

/// Returns the place in bytes of a part of a text.
pub(super) fn offset(text: &str, part: &str) -> usize {
    (part.as_ptr() as usize).saturating_sub(text.as_ptr() as usize)
}

/// Returns the coordinate along the other direction of y; zero has no sign.
pub(super) fn flip(y: f64) -> f64 {
    0.0 - y
}
