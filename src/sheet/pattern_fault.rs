//! Faults of crease patterns that are drawn as lines.

use std::fmt;

use super::assignment::Assignment;
use crate::math::short;

/// A line of a crease pattern as messages name it: by the coordinates of its ends, in the file's own directions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LineName(pub [[f64; 2]; 2]);

impl fmt::Display for LineName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [[x1, y1], [x2, y2]] = self.0.map(|end| end.map(short));
        write!(f, "from ({x1}, {y1}) to ({x2}, {y2})")
    }
}

/// The reason why lines are not a crease pattern; the message says how to correct it.
#[derive(Debug, PartialEq, thiserror::Error)]
pub enum PatternFault {
    #[error("not {format}: {message}")]
    Syntax { format: &'static str, message: String },
    #[error("`{found}` is no {what}; it should be {right}")]
    Value { found: String, what: &'static str, right: &'static str },
    #[error("{element} in a crease pattern; {right}")]
    Element { element: String, right: &'static str },
    #[error("there is no line to fold along; {right}")]
    Empty { right: &'static str },
    #[error("the line {line} has a coordinate over 1e50 in magnitude; coordinates should be below")]
    Coordinate { line: LineName },
    #[error("the lines {a} and {b} lie on each other, one with {} and one with {}; give both the same, or leave one out",
        meaning(*.meanings.first().unwrap_or(&(Assignment::Unassigned, None))),
        meaning(*.meanings.last().unwrap_or(&(Assignment::Unassigned, None))))]
    Overlap {
        a: LineName,
        b: LineName,
        /// Their letters, and their fold angles in degrees.
        meanings: [(Assignment, Option<f64>); 2],
    },
    #[error(
        "there is a gap of {distance:.3e} {gap}, and points are merged up to {tolerance:.3e}; draw one point, or {}",
        merging(*cure)
    )]
    Apart { gap: LineName, distance: f64, tolerance: f64, cure: Option<f64> },
    #[error(
        "the line {line} meets a chain of points of which each is within {tolerance:.3e} of the next, or of a line at the next, \
         too long to be one point; draw them as one point, or {}",
        merging(*cure)
    )]
    Tangled { line: LineName, tolerance: f64, cure: Option<f64> },
    #[error("the lines meet at more than {points} points; a crease pattern should have fewer")]
    TooMany { points: usize },
    #[error(
        "the line {line} bounds no face, and no line is a boundary; draw the outline of the sheet too: black in SVG, type 1 \
         in CP and OPX, BLACK_0 in ORI, B in FOLD"
    )]
    NoRim { line: LineName },
    #[error(
        "the line {line}, or a part of it, has the same face on both sides or the outside on both; a line should bound a face \
         on one side at least and end at other lines: join the ends of a slit to others by lines that do not fold (cyan in SVG, \
         J in FOLD), and leave out what lies beside the sheet, or draw it grey"
    )]
    Loose { line: LineName },
    #[error("the line {line}: {problem}")]
    Line { line: LineName, problem: String },
    #[error(
        "the line {line} belongs to an outline inside a face that does not touch the other lines; join it to them by \
         two lines or more that do not fold (cyan in SVG, J in FOLD), or draw it beside the sheet, where it is a \
         piece of its own"
    )]
    Nested { line: LineName },
    #[error(
        "vertices are to be merged within {found:e}; the distance should be above 0 and below a tenth of the extent, {extent:e}"
    )]
    Tolerance { found: f64, extent: f64 },
    #[error("vertices are merged and edges split in flat finite crease patterns only; {found}")]
    NotFlat { found: &'static str },
}

impl PatternFault {
    /// Returns the fault of a value that cannot be read.
    pub(crate) fn value(found: &str, what: &'static str, right: &'static str) -> Self {
        Self::Value { found: found.chars().take(40).collect(), what, right }
    }
}

/// Returns the advice to merge points within another distance.
fn merging(cure: Option<f64>) -> String {
    let how = "as `merge` in [sheet] of a scene and `foldwell convert --merge` do";
    cure.map_or_else(
        || format!("merge within another distance, {how}"),
        |cure| format!("merge within {cure:.2e}, {how}"),
    )
}

fn meaning((letter, angle): (Assignment, Option<f64>)) -> String {
    match angle {
        Some(angle) => format!("{letter} and {angle} degrees"),
        None => letter.to_string(),
    }
}
