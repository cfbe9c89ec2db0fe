//! The colours of Origami Simulator, and the letters that they stand for.
//!
//! Drawing programs change colours a little, so that red is every saturated colour whose hue is within 30 degrees of
//! pure red, and so for the others; cyan, which only FOLD's joints have, within 10. Black is what has less than a
//! quarter of full brightness in every channel. Grey is what is neither black nor white and has hardly any hue: so
//! programs draw grids, and lines that are flat or not yet assigned.

use crate::sheet::assignment::Assignment;

/// Letters, colours as they are written, hues in degrees and how far colours that are read may be off; black has no
/// hue.
const COLOURS: [(Assignment, &str, Option<[f64; 2]>); 7] = [
    (Assignment::Boundary, "#000", None),
    (Assignment::Mountain, "#f00", Some([0.0, 30.0])),
    (Assignment::Flat, "#ff0", Some([60.0, 30.0])),
    (Assignment::Cut, "#0f0", Some([120.0, 30.0])),
    (Assignment::Join, "#0ff", Some([180.0, 10.0])),
    (Assignment::Valley, "#00f", Some([240.0, 30.0])),
    (Assignment::Unassigned, "#f0f", Some([300.0, 30.0])),
];

/// Brightness of a channel, of 255, below which a colour is black if all channels are.
const BLACK: u8 = 64;

/// Brightness of a channel, of 255, from which a colour without a hue is white.
const WHITE: u8 = 240;

/// Difference of the channels of grey, relative to the largest one.
const HARDLY_ANY_HUE: f64 = 0.15;

/// The colours as messages name them.
pub(super) const RIGHT: &str = "black (boundary), red (mountain), blue (valley), yellow (facet), magenta (hinge), \
                                green (cut), cyan (joint) or grey (auxiliary)";

/// Returns the colour of a letter.
pub(super) fn of_letter(letter: Assignment) -> &'static str {
    COLOURS.iter().find(|(known, ..)| *known == letter).map_or("#000", |(_, colour, _)| colour)
}

/// Returns the letter of a colour; `None` if it is none of these.
pub(super) fn letter(rgb: [u8; 3]) -> Option<Assignment> {
    if rgb.iter().all(|channel| *channel < BLACK) {
        return Some(Assignment::Boundary);
    }
    let hue = hue(rgb)?;
    let off = |from: f64| (hue - from + 180.0).rem_euclid(360.0) - 180.0;
    let near = |range: &Option<[f64; 2]>| range.is_some_and(|[from, most]| off(from).abs() < most);
    COLOURS.iter().find(|(.., range)| near(range)).map(|(letter, ..)| *letter)
}

/// Whether a colour is grey, as auxiliary lines are.
pub(super) fn is_grey(rgb: [u8; 3]) -> bool {
    let [most, least] = [rgb.iter().max(), rgb.iter().min()].map(|channel| channel.copied().unwrap_or_default());
    (BLACK..WHITE).contains(&most) && f64::from(most - least) <= HARDLY_ANY_HUE * f64::from(most)
}

/// Returns the hue of a colour in degrees; `None` if it is closer to grey than to a pure colour.
fn hue(rgb: [u8; 3]) -> Option<f64> {
    let [r, g, b] = rgb.map(f64::from);
    let (most, least) = (r.max(g).max(b), r.min(g).min(b));
    let spread = most - least;
    if spread < 0.5 * most {
        return None;
    }
    let sector = if most == r {
        (g - b) / spread
    } else if most == g {
        2.0 + (b - r) / spread
    } else {
        4.0 + (r - g) / spread
    };
    Some((60.0 * sector).rem_euclid(360.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Claim: pure colours and those of Illustrator's default swatches have their letters; white, grey and azure have
    /// none, and grey is grey. Source: CSS Color 3 for names, Illustrator's RGB swatches for the others.
    #[test]
    fn colours_and_letters() {
        let pure = [[0, 0, 0], [255, 0, 0], [255, 255, 0], [0, 255, 0], [0, 255, 255], [0, 0, 255], [255, 0, 255]];
        for (rgb, (known, ..)) in pure.iter().zip(COLOURS) {
            assert_eq!(letter(*rgb), Some(known));
        }
        let swatches = [
            ([0xed, 0x1c, 0x24], "M"),
            ([0x2e, 0x31, 0x92], "V"),
            ([0x00, 0xa6, 0x51], "C"),
            ([0x23, 0x1f, 0x20], "B"),
            ([0xff, 0xf2, 0x00], "F"),
            ([0x00, 0x80, 0x00], "C"),
        ];
        for (rgb, name) in swatches {
            assert_eq!(letter(rgb).map(Assignment::letter), Some(name), "{rgb:?}");
        }
        for (rgb, grey) in
            [([255; 3], false), ([128; 3], true), ([0x00, 0x71, 0xbc], false), ([0xb0, 0xa0, 0xa0], true)]
        {
            assert_eq!((letter(rgb), is_grey(rgb)), (None, grey), "{rgb:?}");
        }
    }
}
