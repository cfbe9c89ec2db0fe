//! The colours of all figures.

use std::fmt;

/// A colour: its red, green and blue components.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Colour(pub u8, pub u8, pub u8);

/// Background.
pub(crate) const PAPER: Colour = Colour(252, 251, 248);
/// Text, axes and outlines.
pub(crate) const INK: Colour = Colour(46, 50, 56);
/// Secondary text, and edges that are flat.
pub(crate) const GREY: Colour = Colour(110, 108, 101);
/// Lines of a grid.
pub(crate) const GRID: Colour = Colour(220, 217, 207);
/// The far sides of a box.
pub(crate) const PANE: Colour = Colour(243, 241, 234);
/// Shadows.
pub(crate) const SHADOW: Colour = Colour(231, 228, 221);
/// Creases with a negative fold angle, and negative values.
pub(crate) const MOUNTAIN: Colour = Colour(200, 55, 45);
/// Creases with a positive fold angle, and positive values.
pub(crate) const VALLEY: Colour = Colour(29, 98, 176);
/// Colours of series. They differ in brightness as well as in hue, so that colour-blind readers can distinguish them.
pub(crate) const SERIES: [Colour; 6] =
    [VALLEY, MOUNTAIN, Colour(63, 38, 93), Colour(217, 138, 31), Colour(44, 138, 107), Colour(125, 122, 114)];
/// Colours of curvatures, from negative (violet) over zero (pale) to positive (orange).
pub(crate) const CURVATURE: Ramp =
    Ramp(&[[63, 38, 125], [150, 138, 196], [247, 244, 238], [238, 160, 78], [156, 70, 8]]);
/// Colours of energies, from zero to the largest.
pub(crate) const ENERGY: Ramp = Ramp(&[[250, 247, 240], [244, 196, 120], [209, 96, 62], [88, 24, 69]]);
/// Colours of signed values, from negative (red) over zero (pale) to positive (blue).
pub(crate) const SIGNED: Ramp = Ramp(&[[196, 66, 52], [250, 248, 243], [40, 98, 170]]);

/// Colours of magnitudes: the half of `SIGNED` for positive values.
pub(crate) const MAGNITUDE: Ramp = Ramp(&[[250, 248, 243], [40, 98, 170]]);

/// A colour scale: evenly spaced colours, between which others are interpolated.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ramp(&'static [[u8; 3]]);

impl Ramp {
    /// Returns the colours with their parameters from 0 to 1.
    pub(crate) fn stops(&self) -> impl Iterator<Item = (f64, Colour)> {
        let last = (self.0.len() - 1) as f64;
        self.0.iter().enumerate().map(move |(k, [red, green, blue])| (k as f64 / last, Colour(*red, *green, *blue)))
    }

    /// Returns the colour at a parameter from 0 to 1. Values outside this range are clamped; NaN gives the colour in
    /// the middle.
    pub(crate) fn at(&self, part: f64) -> Colour {
        let part = if part.is_nan() { 0.5 } else { part.clamp(0.0, 1.0) };
        let place = part * (self.0.len() - 1) as f64;
        let first = (place as usize).min(self.0.len() - 2);
        let share = place - first as f64;
        let mixed = |k: usize| f64::from(self.0[first][k]) * (1.0 - share) + f64::from(self.0[first + 1][k]) * share;
        Colour(mixed(0).round() as u8, mixed(1).round() as u8, mixed(2).round() as u8)
    }
}

impl Colour {
    /// Returns the colour with its components multiplied by a factor of at most 1.
    pub(crate) fn darker(self, factor: f64) -> Self {
        let part = |part: u8| (f64::from(part) * factor).round() as u8;
        Self(part(self.0), part(self.1), part(self.2))
    }

    /// Returns the mean of the components, from 0 (black) to 255 (white).
    pub(crate) fn brightness(self) -> f64 {
        (f64::from(self.0) + f64::from(self.1) + f64::from(self.2)) / 3.0
    }

    /// Interpolates between this colour (`share` = 0) and another one (`share` = 1).
    pub(crate) fn towards(self, other: Self, share: f64) -> Self {
        let part = |a: u8, b: u8| (f64::from(a) + (f64::from(b) - f64::from(a)) * share).round() as u8;
        Self(part(self.0, other.0), part(self.1, other.1), part(self.2, other.2))
    }
}

impl fmt::Display for Colour {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "#{:02x}{:02x}{:02x}", self.0, self.1, self.2)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Claim: a scale has its own colours at its ends and in its middle; values outside the range get the end colours,
    /// and NaN that in the middle.
    #[test]
    fn ramps() {
        let ends = [-3.0, 0.0, 0.5, 1.0, 3.0, f64::NAN].map(|part| CURVATURE.at(part).to_string());
        assert_eq!(ends, ["#3f267d", "#3f267d", "#f7f4ee", "#9c4608", "#9c4608", "#f7f4ee"]);
        assert_eq!(SIGNED.at(0.75), Colour(145, 173, 207));
    }
}
