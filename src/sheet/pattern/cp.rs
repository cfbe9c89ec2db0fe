//! `.cp` files of ORIPA and Oriedita: a line of text for each line of the pattern, `type x1 y1 x2 y2`.

use super::line::{Line, Lines, flip};
use crate::math::Vec2;
use crate::sheet::assignment::Assignment;
use crate::sheet::pattern_fault::PatternFault;

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
/// `place` is its place in the file, and `right` names the types in messages.
pub(super) fn typed(
    found: &str,
    (types, right): (&[LineType], &'static str),
    numbers: [f64; 4],
    place: [usize; 2],
) -> Result<Line, PatternFault> {
    let number: Option<i64> = found.parse().ok();
    let known = types.iter().find(|(type_, ..)| Some(*type_) == number);
    let Some(&(_, letter, angle, auxiliary)) = known else { return Err(value(found, "type of a line", right)) };
    let [x1, y1, x2, y2] = numbers;
    let ends = [Vec2::new(x1, flip(y1)), Vec2::new(x2, flip(y2))];
    Ok(Line { ends, letter, angle, auxiliary, place, flipped: true })
}

/// Returns the fault of a value that cannot be read.
pub(super) fn value(found: &str, what: &'static str, right: &'static str) -> PatternFault {
    PatternFault::Value { found: found.chars().take(40).collect(), what, right }
}

/// Reads the lines of a text.
pub(super) fn lines(text: &str) -> Lines {
    let mut lines = Vec::new();
    for (k, row) in text.lines().enumerate() {
        let words: Vec<&str> = row.split_whitespace().collect();
        let place = [k + 1, 1 + row.chars().take_while(|c| c.is_whitespace()).count()];
        let located = |fault: PatternFault| (place, fault.into());
        match words[..] {
            [] => {}
            [type_, ref numbers @ ..] if numbers.len() == 4 => {
                let mut ends = [0.0; 4];
                for (end, word) in ends.iter_mut().zip(numbers) {
                    let number = word.parse().ok().filter(|number: &f64| number.is_finite());
                    let fault = || located(value(word, "coordinate", "a finite number"));
                    *end = number.ok_or_else(fault)?;
                }
                lines.push(typed(type_, (&TYPES, RIGHT), ends, place).map_err(located)?);
            }
            _ => {
                return Err(located(value(row.trim(), "line of a crease pattern", "five numbers, `type x1 y1 x2 y2`")));
            }
        }
    }
    Ok((lines, String::new()))
}
