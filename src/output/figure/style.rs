//! Styles of lines, areas and text, the areas that text takes, and the formats of text and numbers in an SVG.

use super::palette::{Colour, GREY, INK};
use std::fmt::{self, Display};

/// Upper bounds of the mean width of letters relative to the font size, for plain and for bold letters.
const LETTER: [f64; 2] = [0.58, 0.64];

/// A point of the figure: coordinates to the right and downwards from the upper left corner.
pub(crate) type PaperPoint = [f64; 2];

/// A rectangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Area {
    /// Left and upper sides.
    pub low: PaperPoint,
    /// Right and lower sides.
    pub high: PaperPoint,
}

/// The style of lines and areas; by default nothing is drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Style {
    /// Colour of the area.
    pub fill: Option<Colour>,
    /// Colour and width of the line; the width 0 is that of the group.
    pub stroke: Option<(Colour, f64)>,
    /// Lengths of dashes and gaps.
    pub dash: Option<[f64; 2]>,
    /// Opacity, from 0 to 1.
    pub opacity: Option<f64>,
}

/// The style of text.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Font {
    /// Size of the letters.
    pub size: f64,
    pub(super) bold: bool,
    pub(super) colour: Colour,
    pub(super) anchor: Anchor,
    pub(super) turned: bool,
}

/// The part of a text that is placed at its given point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Anchor {
    Start,
    Middle,
    End,
}

impl Anchor {
    /// The part of the width of a text that lies before its point.
    pub(super) fn part(self) -> f64 {
        match self {
            Self::Start => 0.0,
            Self::Middle => 0.5,
            Self::End => 1.0,
        }
    }
}

impl Style {
    /// Returns the style of a line.
    pub(crate) fn line(colour: Colour, width: f64) -> Self {
        Self { stroke: Some((colour, width)), ..Self::default() }
    }

    /// Returns the style of an area without outline.
    pub(crate) fn area(colour: Colour) -> Self {
        Self { fill: Some(colour), ..Self::default() }
    }

    /// Returns the style of an area with an outline in its own colour and of the width of the group, so that no gap is
    /// visible between neighbours.
    pub(crate) fn tile(colour: Colour) -> Self {
        Self { fill: Some(colour), stroke: Some((colour, 0.0)), ..Self::default() }
    }

    /// Adds an outline.
    pub(crate) fn outlined(self, colour: Colour, width: f64) -> Self {
        Self { stroke: Some((colour, width)), ..self }
    }

    /// Adds dashes and gaps of these lengths.
    pub(crate) fn dashed(self, dash: f64, gap: f64) -> Self {
        Self { dash: Some([dash, gap]), ..self }
    }

    /// Sets the opacity, from 0 (invisible) to 1.
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
    /// Text next to axes and in legends.
    pub(crate) const LABEL: Self = Self { size: 19.0, bold: false, colour: INK, anchor: Anchor::Start, turned: false };
    /// Smaller text, for example next to points.
    pub(crate) const SMALL: Self = Self { size: 16.0, ..Self::LABEL };
    pub(super) const TITLE: Self = Self { size: 23.0, bold: true, ..Self::LABEL };
    pub(super) const STATE: Self = Self { size: 18.0, colour: GREY, ..Self::LABEL };

    /// Returns the font with bold letters.
    pub(crate) fn bold(self) -> Self {
        Self { bold: true, ..self }
    }

    /// Returns the font in another colour.
    pub(crate) fn colour(self, colour: Colour) -> Self {
        Self { colour, ..self }
    }

    /// Returns the font with the middle of the text at its point.
    pub(crate) fn middle(self) -> Self {
        Self { anchor: Anchor::Middle, ..self }
    }

    /// Returns the font with the end of the text at its point.
    pub(crate) fn end(self) -> Self {
        Self { anchor: Anchor::End, ..self }
    }

    /// Returns the font turned, so that the text is read upwards.
    pub(crate) fn turned(self) -> Self {
        Self { turned: true, ..self }
    }

    /// Returns an upper bound of the width of a text.
    pub(crate) fn width(&self, words: &str) -> f64 {
        words.chars().count() as f64 * self.size * LETTER[usize::from(self.bold)]
    }

    /// Returns the area of a text placed at a point.
    pub(super) fn area(&self, [x, y]: PaperPoint, words: &str) -> Area {
        let width = self.width(words);
        let before = self.anchor.part() * width;
        let (up, down) = (0.76 * self.size, 0.22 * self.size);
        if self.turned {
            return Area { low: [x - up, y - width + before], high: [x + down, y + before] };
        }
        Area { low: [x - before, y - up], high: [x - before + width, y + down] }
    }
}

impl Area {
    /// Returns the square of half-side `radius` around a point.
    pub(crate) fn around([x, y]: PaperPoint, radius: f64) -> Self {
        Self { low: [x - radius, y - radius], high: [x + radius, y + radius] }
    }

    /// Returns the area that two rectangles have in common.
    pub(super) fn common(&self, other: &Self) -> f64 {
        let side = |k: usize| (self.high[k].min(other.high[k]) - self.low[k].max(other.low[k])).max(0.0);
        side(0) * side(1)
    }
}

/// Escapes a text for XML and HTML, without the characters that neither allows.
pub fn escaped(text: &str) -> String {
    let allowed = text.chars().filter(|c| !c.is_control() || matches!(c, '\t' | '\n' | '\r'));
    let allowed: String = allowed.filter(|c| !matches!(c, '\u{fffe}' | '\u{ffff}')).collect();
    allowed.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// A number that is written with at most the given number of decimals, without trailing zeros.
pub(super) struct Short(pub f64, pub usize);

impl Display for Short {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let text = format!("{:.*}", self.1, self.0);
        let text = if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { &text };
        f.write_str(if text == "-0" { "0" } else { text })
    }
}
