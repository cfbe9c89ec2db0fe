//! Subscripts and superscripts as smaller digits below and above the line: many fonts lack the characters of their own,
//! and programs that draw by cairo show boxes for these.
//!
//! The digits are moved by `dy`, not by `baseline-shift`, which Firefox does not know, and text with them is placed by
//! its estimated width, since CairoSVG aligns each part of a text on its own.

use super::style::{Short, escaped};
use std::fmt::Write;

/// Size of raised and lowered digits, and the heights by which they are moved, relative to the size of the font.
const SMALLER: f64 = 0.7;
const RAISED: f64 = -0.38;
const LOWERED: f64 = 0.2;

/// Returns a character as it is written, and the height at which it stands.
fn plain(c: char) -> (char, f64) {
    let digit = |first: u32| char::from_digit(u32::from(c) - first, 10).unwrap_or(c);
    match c {
        '\u{207b}' => ('\u{2212}', RAISED),
        '\u{b9}' => ('1', RAISED),
        '\u{b2}' => ('2', RAISED),
        '\u{b3}' => ('3', RAISED),
        '\u{2070}'..='\u{2079}' => (digit(0x2070), RAISED),
        '\u{2080}'..='\u{2089}' => (digit(0x2080), LOWERED),
        _ => (c, 0.0),
    }
}

/// Whether a text has subscripts or superscripts.
pub(super) fn has_script(words: &str) -> bool {
    words.chars().any(|c| plain(c).1 != 0.0)
}

/// Returns a text as the content of an SVG element of this font size.
pub(super) fn spans(words: &str, size: f64) -> String {
    let mut runs: Vec<(f64, String)> = Vec::new();
    for (c, height) in words.chars().map(plain) {
        match runs.last_mut() {
            Some((before, run)) if *before == height => run.push(c),
            _ => runs.push((height, c.to_string())),
        }
    }
    let (mut text, mut at) = (String::new(), 0.0);
    for (height, run) in runs {
        let letters = if height == 0.0 { size } else { SMALLER * size };
        let (move_by, letters) = (Short((height - at) * size, 1), Short(letters, 1));
        // writing into a text does not fail
        let _ = write!(text, "<tspan dy=\"{move_by}\" font-size=\"{letters}\">{}</tspan>", escaped(&run));
        at = height;
    }
    text
}

/// Returns the width of a text in Helvetica, or in a font made for the same widths: exactly for digits and signs, of
/// letters their mean.
pub(super) fn width(words: &str, size: f64) -> f64 {
    let mut sum = 0.0;
    for (c, height) in words.chars().map(plain) {
        let part = match c {
            '0'..='9' => 0.556,
            '\u{2212}' | '=' | '<' | '>' => 0.584,
            ' ' | '\u{b7}' | ',' | '.' => 0.278,
            '(' | ')' => 0.333,
            _ => 0.5,
        };
        sum += if height == 0.0 { part } else { SMALLER * part };
    }
    sum * size
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Claim: digits and signs above and below the line are written as plain ones, moved there and back, and take less
    /// room; text without them is as it was.
    #[test]
    fn scripts_are_plain_digits() {
        let text = spans("2\u{b7}10\u{207b}\u{2074} k\u{2081}\u{2082}", 20.0);
        let expected = "<tspan dy=\"0\" font-size=\"20\">2\u{b7}10</tspan>\
                        <tspan dy=\"-7.6\" font-size=\"14\">\u{2212}4</tspan>\
                        <tspan dy=\"7.6\" font-size=\"20\"> k</tspan><tspan dy=\"4\" font-size=\"14\">12</tspan>";
        assert_eq!(text, expected);
        assert!(has_script("x\u{b2}") && !has_script("\u{2212}0.5 < \u{3c0}"));
        assert!((width("10\u{2076}", 20.0) - 20.0 * (2.0 + 0.7) * 0.556).abs() < 1e-12);
    }
}
