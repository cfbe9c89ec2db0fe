//! `.cp` files of ORIPA and Oriedita: a line of text for each line of the pattern, `type x1 y1 x2 y2`.

use super::line::{DrawnLines, Lines, PatternLine, flip, offset};
use crate::math::Vec2;
use crate::sheet::assignment::Assignment;
use crate::sheet::pattern_fault::PatternFault;
use crate::sheet::text::line_and_column;

/// A type of lines: its number, letter, target angle in degrees, and whether the line is auxiliary.
pub(super) type LineType = (i64, Assignment, Option<f64>, bool);

/// The types of `.cp` files, as ORIPA and Oriedita write them.
pub(super) const TYPES: [LineType; 5] = [
    (0, Assignment::Flat, Some(0.0), true),
    (1, Assignment::Boundary, None, false),
    (2, Assignment::Mountain, Some(-180.0), false),
    (3, Assignment::Valley, Some(180.0), false),
    (4, Assignment::Flat, Some(0.0), true),
];

/// The types as messages name them.
const RIGHT: &str = "1 (boundary), 2 (mountain), 3 (valley), or 0 or 4 (auxiliary)";

/// Returns the line of the pattern with one of these types between two points of the file, whose y points downwards;
/// `at` is its place in the file, and `right` names the types in messages.
pub(super) fn typed(
    found: &str,
    (types, right): (&[LineType], &'static str),
    numbers: [f64; 4],
    at: usize,
) -> Result<PatternLine, PatternFault> {
    let number: Option<i64> = found.parse().ok();
    let known = types.iter().find(|(type_, ..)| Some(*type_) == number);
    let Some(&(_, letter, angle, auxiliary)) = known else {
        return Err(PatternFault::value(found, "type of a line", right));
    };
    let [x1, y1, x2, y2] = numbers;
    let ends = [Vec2::new(x1, flip(y1)), Vec2::new(x2, flip(y2))];
    Ok(PatternLine { ends, letter, angle, auxiliary, contour: letter == Assignment::Boundary, at, flipped: true })
}

/// Returns the number that a word says, NaN and infinities included.
pub(super) fn number(word: &str) -> Result<f64, PatternFault> {
    word.parse().map_err(|_| PatternFault::value(word, "coordinate", "a number"))
}

/// Returns the numbers that the words of the two ends of a line say.
pub(super) fn numbers(words: [&str; 4]) -> Result<[f64; 4], PatternFault> {
    let [x1, y1, x2, y2] = words.map(number);
    Ok([x1?, y1?, x2?, y2?])
}

/// Reads the lines of a text.
pub(super) fn lines(text: &str) -> Lines {
    let mut drawn = DrawnLines::default();
    for row in text.lines() {
        let words: Vec<&str> = row.split_whitespace().collect();
        let at = offset(text, row.trim_start());
        let located = |fault: PatternFault| (line_and_column(text, at), fault.into());
        match words[..] {
            [] => {}
            [type_, x1, y1, x2, y2] => {
                let ends = numbers([x1, y1, x2, y2]).map_err(located)?;
                drawn.push(typed(type_, (&TYPES, RIGHT), ends, at).map_err(located)?);
            }
            _ => {
                let right = "five numbers, `type x1 y1 x2 y2`";
                return Err(located(PatternFault::value(row.trim(), "line of a crease pattern", right)));
            }
        }
    }
    Ok(drawn)
}
