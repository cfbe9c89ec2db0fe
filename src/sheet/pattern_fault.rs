//! Faults of crease patterns that are drawn as lines.

use std::fmt;

use super::assignment::Assignment;

/// A line of a crease pattern as messages name it: by the coordinates of its ends, in the file's own directions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LineName(pub [[f64; 2]; 2]);

impl fmt::Display for LineName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let number = |x: f64| if x.abs() < 1e15 { format!("{x}") } else { format!("{x:e}") };
        let [[x1, y1], [x2, y2]] = self.0.map(|end| end.map(number));
        write!(f, "from ({x1}, {y1}) to ({x2}, {y2})")
    }
}

/// The reason why lines are not a crease pattern; the message says how to correct it.
#[derive(Debug, PartialEq, thiserror::Error)]
pub enum PatternFault {
    /// The text is not of its format.
    #[error("not {format}: {message}")]
    Syntax {
        /// The format, with its article.
        format: &'static str,
        /// The parser's message.
        message: String,
    },
    /// A value cannot be read.
    #[error("`{found}` is no {what}; it should be {right}")]
    Value {
        /// The value, shortened.
        found: String,
        /// Name of the expected kind of value.
        what: &'static str,
        /// An example, or the values that are known.
        right: &'static str,
    },
    /// An element of a drawing that has no meaning in a crease pattern.
    #[error("{element} in a crease pattern; {right}")]
    Element {
        /// The element.
        element: String,
        /// Advice.
        right: &'static str,
    },
    /// There are no lines.
    #[error("there is no line to fold along; {right}")]
    Empty {
        /// Description of a file that has lines.
        right: &'static str,
    },
    /// A coordinate is not finite or larger than 1e50.
    #[error("the line {line} has a coordinate over 1e50 in magnitude; coordinates should be below")]
    Coordinate {
        /// The line.
        line: LineName,
    },
    /// Two lines that lie on each other and say different things.
    #[error("the lines {a} and {b} lie on each other, one with {} and one with {}; give both the same, or leave one out",
        meaning(*.meanings.first().unwrap_or(&(Assignment::Unassigned, None))),
        meaning(*.meanings.last().unwrap_or(&(Assignment::Unassigned, None))))]
    Overlap {
        /// The line that is listed first.
        a: LineName,
        /// The other one.
        b: LineName,
        /// Their letters, and their fold angles in degrees.
        meanings: [(Assignment, Option<f64>); 2],
    },
    /// Two points that are a little too far apart to be merged, where the pattern is wrong.
    #[error(
        "there is a gap of {distance:.3e} {gap}, and points are merged up to {tolerance:.3e}; draw one point, or {}",
        merging(*cure)
    )]
    Apart {
        /// The two points, as the ends of a line.
        gap: LineName,
        /// Their distance.
        distance: f64,
        /// The distance within which points are merged.
        tolerance: f64,
        /// Distance of merging with which the lines are a crease pattern.
        cure: Option<f64>,
    },
    /// Points that are near each other without being near one point.
    #[error(
        "the line {line} meets a chain of points of which each is within {tolerance:.3e} of the next, or of a line at the next, \
         too long to be one point; draw them as one point, or {}",
        merging(*cure)
    )]
    Tangled {
        /// A line at these points.
        line: LineName,
        /// The distance within which points are merged.
        tolerance: f64,
        /// Distance of merging with which the lines are a crease pattern.
        cure: Option<f64>,
    },
    /// Lines that cross at more points than a crease pattern has.
    #[error("the lines meet at more than {points} points; a crease pattern should have fewer")]
    TooMany {
        /// The number of points.
        points: usize,
    },
    /// Lines of which none is the rim of a sheet.
    #[error(
        "the line {line} bounds no face, and no line is a boundary; draw the outline of the sheet too: black in SVG, type 1 \
         in CP and OPX, BLACK_0 in ORI, B in FOLD"
    )]
    NoRim {
        /// The line.
        line: LineName,
    },
    /// A line that separates no faces.
    #[error(
        "the line {line}, or a part of it, has the same face on both sides or the outside on both; a line should bound a face \
         on one side at least and end at other lines"
    )]
    Loose {
        /// The line.
        line: LineName,
    },
    /// A line whose edge contradicts the sheet.
    #[error("the line {line}: {problem}")]
    Line {
        /// The line.
        line: LineName,
        /// Description of the error of its edge.
        problem: String,
    },
    /// An outline inside a face that no line joins to the others.
    #[error(
        "the line {line} belongs to an outline inside a face that does not touch the other lines; join it to them, or draw it \
         beside the sheet, where it is a piece of its own"
    )]
    Nested {
        /// A line of the outline.
        line: LineName,
    },
    /// A merging distance that is not positive or not smaller than the sheet.
    #[error(
        "vertices are to be merged within {found:e}; the distance should be above 0 and below a tenth of the extent, {extent:e}"
    )]
    Tolerance {
        /// The distance.
        found: f64,
        /// Extent of the sheet.
        extent: f64,
    },
    /// A sheet that cannot be merged or split, since it is not a flat crease pattern of its own.
    #[error("vertices are merged and edges split in flat finite crease patterns only; {found}")]
    NotFlat {
        /// Description of the mesh.
        found: &'static str,
    },
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
