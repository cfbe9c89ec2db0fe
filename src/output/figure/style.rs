//! How lines, areas and words look, where they may stand, and how text and numbers are written in an SVG.

use super::palette::{Colour, GREY, INK};
use std::fmt::{self, Display};

/// Widths of letters over their height, at most on average: of plain and of bold ones.
const LETTER: [f64; 2] = [0.58, 0.64];

/// A place on the paper.
pub(crate) type PaperPoint = [f64; 2];

/// Left, top, right and bottom of a rectangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Area {
    /// Smallest coordinates.
    pub low: PaperPoint,
    /// Largest coordinates.
    pub high: PaperPoint,
}

/// How lines and areas are drawn; everything is off in the default.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Style {
    fill: Option<Colour>,
    stroke: Option<(Colour, f64)>,
    dash: Option<[f64; 2]>,
    opacity: Option<f64>,
}

/// How words are set.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Font {
    /// Height.
    pub size: f64,
    pub(super) bold: bool,
    pub(super) colour: Colour,
    pub(super) anchor: Anchor,
    pub(super) turned: bool,
}

/// Which part of the words is at their place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Anchor {
    Start,
    Middle,
    End,
}

impl Style {
    /// A line.
    pub(crate) fn line(colour: Colour, width: f64) -> Self {
        Self { stroke: Some((colour, width)), ..Self::default() }
    }

    /// An area without outline.
    pub(crate) fn area(colour: Colour) -> Self {
        Self { fill: Some(colour), ..Self::default() }
    }

    /// An area with an outline as wide as the group says in its own colour, so that no gap shows beside its neighbours.
    pub(crate) fn tile(colour: Colour) -> Self {
        Self { fill: Some(colour), stroke: Some((colour, 0.0)), ..Self::default() }
    }

    /// The same with an outline.
    pub(crate) fn outlined(self, colour: Colour, width: f64) -> Self {
        Self { stroke: Some((colour, width)), ..self }
    }

    /// The same with dashes and gaps of these lengths.
    pub(crate) fn dashed(self, dash: f64, gap: f64) -> Self {
        Self { dash: Some([dash, gap]), ..self }
    }

    /// The same, so that what is below shows through.
    pub(crate) fn opacity(self, opacity: f64) -> Self {
        Self { opacity: Some(opacity), ..self }
    }
}

impl Display for Style {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.fill {
            Some(colour) => write!(f, " fill=\"{colour}\"")?,
            None => f.write_str(" fill=\"none\"")?,
        }
        if let Some((colour, width)) = self.stroke {
            write!(f, " stroke=\"{colour}\"")?;
            if width > 0.0 {
                write!(f, " stroke-width=\"{}\"", Short(width, 2))?;
            }
        }
        if let Some([dash, gap]) = self.dash {
            write!(f, " stroke-dasharray=\"{} {}\"", Short(dash, 1), Short(gap, 1))?;
        }
        self.opacity.map_or(Ok(()), |opacity| write!(f, " opacity=\"{opacity}\""))
    }
}

impl Font {
    /// Words beside axes and in legends.
    pub(crate) const LABEL: Self = Self { size: 19.0, bold: false, colour: INK, anchor: Anchor::Start, turned: false };
    /// Smaller words beside points.
    pub(crate) const SMALL: Self = Self { size: 16.0, ..Self::LABEL };
    pub(super) const TITLE: Self = Self { size: 23.0, bold: true, ..Self::LABEL };
    pub(super) const STATE: Self = Self { size: 18.0, colour: GREY, ..Self::LABEL };

    /// The same in heavy letters.
    pub(crate) fn bold(self) -> Self {
        Self { bold: true, ..self }
    }

    /// The same in another colour.
    pub(crate) fn colour(self, colour: Colour) -> Self {
        Self { colour, ..self }
    }

    /// The same with the middle of the words at their place.
    pub(crate) fn middle(self) -> Self {
        Self { anchor: Anchor::Middle, ..self }
    }

    /// The same with the end of the words at their place.
    pub(crate) fn end(self) -> Self {
        Self { anchor: Anchor::End, ..self }
    }

    /// The same, read from below to above.
    pub(crate) fn turned(self) -> Self {
        Self { turned: true, ..self }
    }

    /// Width of words, at most.
    pub(crate) fn width(&self, words: &str) -> f64 {
        words.chars().count() as f64 * self.size * LETTER[usize::from(self.bold)]
    }

    /// Where words are whose foot is at a place.
    pub(super) fn area(&self, [x, y]: PaperPoint, words: &str) -> Area {
        let width = self.width(words);
        let before = match self.anchor {
            Anchor::Start => 0.0,
            Anchor::Middle => 0.5 * width,
            Anchor::End => width,
        };
        let (up, down) = (0.76 * self.size, 0.22 * self.size);
        if self.turned {
            return Area { low: [x - up, y - width + before], high: [x + down, y + before] };
        }
        Area { low: [x - before, y - up], high: [x - before + width, y + down] }
    }
}

impl Area {
    /// The rectangle around a place.
    pub(crate) fn around([x, y]: PaperPoint, radius: f64) -> Self {
        Self { low: [x - radius, y - radius], high: [x + radius, y + radius] }
    }

    /// Common part of two rectangles.
    pub(super) fn common(&self, other: &Self) -> f64 {
        let side = |k: usize| (self.high[k].min(other.high[k]) - self.low[k].max(other.low[k])).max(0.0);
        side(0) * side(1)
    }
}

/// Text as it stands in XML and HTML, without the characters that neither allows.
pub fn escaped(text: &str) -> String {
    let allowed = text.chars().filter(|c| !c.is_control() || matches!(c, '\t' | '\n' | '\r'));
    let allowed: String = allowed.filter(|c| !matches!(c, '\u{fffe}' | '\u{ffff}')).collect();
    allowed.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// A number with at most some decimals, without zeros at its end.
pub(super) struct Short(pub f64, pub usize);

impl Display for Short {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let text = format!("{:.*}", self.1, self.0);
        let text = if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
        f.write_str(if text == "-0" { "0" } else { text })
    }
}
