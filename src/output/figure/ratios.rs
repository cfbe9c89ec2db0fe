//! The figure of Poisson's ratios: polar plots over the directions in the plane of the sheet.
//!
//! The distance from the centre is `|nu| / (1 + |nu|)`, so that ratios that grow without bound where a mode has no
//! strain along a direction stay within the outer circle; the colour is that of the sign.

use super::canvas::{Canvas, Caption, MARGIN, Mark, WIDTH};
use super::palette::{GREY, GRID, INK, MOUNTAIN, VALLEY};
use super::style::{Font, PaperPoint, Style};
use std::f64::consts::PI;

const HEIGHT: f64 = 720.0;
const RADIUS: f64 = 220.0;
/// Heights of the centres and of the names of the plots.
const CENTRE: f64 = 420.0;
const NAMES: f64 = 168.0;
const LEGEND: f64 = 108.0;
const CURVE: f64 = 3.0;
/// Ratios with a circle.
const CIRCLES: [f64; 4] = [0.25, 0.5, 1.0, 3.0];
/// Directions over half a turn at which the curves are drawn.
const DIRECTIONS: usize = 720;

/// A ratio as a function of the direction, an angle in radians from the first lattice vector.
pub type RatioOf<'a> = &'a dyn Fn(f64) -> Option<f64>;

/// Returns the figure of named ratios, side by side.
pub(crate) fn svg(plots: &[(&str, RatioOf<'_>)], caption: &Caption) -> Canvas {
    let mut canvas = Canvas::new(HEIGHT, caption);
    let signs = [(VALLEY, "positive"), (MOUNTAIN, "negative")];
    canvas.legend([MARGIN, LEGEND], &signs.map(|(colour, words)| (Mark::Line(Style::line(colour, CURVE)), words)));
    let width = WIDTH / plots.len().max(1) as f64;
    for (number, (name, ratio)) in plots.iter().enumerate() {
        let centre = [width * (number as f64 + 0.5), CENTRE];
        canvas.text([centre[0], NAMES], name, Font::LABEL.middle());
        circles(&mut canvas, centre);
        if !curves(&mut canvas, centre, *ratio) {
            canvas.text([centre[0], CENTRE - 12.0], "no ratio", Font::SMALL.middle().colour(GREY));
        }
    }
    canvas
}

/// Returns the distance of a ratio from the centre.
fn distance(ratio: f64) -> f64 {
    RADIUS * ratio.abs() / (1.0 + ratio.abs())
}

fn place([x, y]: PaperPoint, angle: f64, distance: f64) -> PaperPoint {
    [x + distance * angle.cos(), y - distance * angle.sin()]
}

/// Draws the circles of some ratios and the two axes.
fn circles(canvas: &mut Canvas, centre: PaperPoint) {
    for angle in [0.0, 0.5 * PI] {
        canvas.line(&[place(centre, angle, -RADIUS), place(centre, angle, RADIUS)], Style::line(GRID, 1.2));
    }
    let ring = |distance: f64| (0..=120).map(move |k| place(centre, PI * f64::from(k) / 60.0, distance));
    for ratio in CIRCLES {
        canvas.line(&ring(distance(ratio)).collect::<Vec<_>>(), Style::line(GRID, 1.2));
        let [x, y] = place(centre, -0.25 * PI, distance(ratio));
        canvas.text([x + 3.0, y + 14.0], &format!("{ratio}"), Font::SMALL.colour(GREY));
    }
    canvas.line(&ring(RADIUS).collect::<Vec<_>>(), Style::line(GREY, 1.4));
    canvas.text(place(centre, 0.0, RADIUS + 10.0), "x", Font::SMALL.colour(INK));
    canvas.text([centre[0], centre[1] - RADIUS - 8.0], "y", Font::SMALL.middle().colour(INK));
}

/// Draws the curve of a ratio in pieces of one sign; returns whether there is any.
fn curves(canvas: &mut Canvas, centre: PaperPoint, ratio: RatioOf<'_>) -> bool {
    let values: Vec<(f64, Option<f64>)> = (0..=2 * DIRECTIONS)
        .map(|k| {
            let angle = PI * k as f64 / DIRECTIONS as f64;
            (angle, ratio(angle).filter(|ratio| ratio.is_finite()))
        })
        .collect();
    let sign = |value: &(f64, Option<f64>)| value.1.map(|ratio| ratio >= 0.0);
    for run in values.chunk_by(|a, b| sign(a) == sign(b)) {
        let Some(positive) = sign(&run[0]) else { continue };
        let places: Vec<PaperPoint> =
            run.iter().filter_map(|(angle, ratio)| Some(place(centre, *angle, distance((*ratio)?)))).collect();
        canvas.line(&places, Style::line(if positive { VALLEY } else { MOUNTAIN }, CURVE));
    }
    values.iter().any(|(_, ratio)| ratio.is_some())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Claim: a ratio of one sign is one curve of its colour, one that passes through zero and infinity has pieces of
    /// both colours, one that does not exist is named as such; nothing is not a number, and no text covers another.
    #[test]
    fn pieces_have_the_colour_of_their_sign() {
        let (negative, none) = (|_: f64| Some(-1.0), |_: f64| None);
        let sheared = |angle: f64| Some((2.0 * angle).tan());
        let caption = Caption { title: "t".into(), state: "s".into() };
        let plots: [(&str, RatioOf<'_>); 2] = [("a", &negative), ("b", &none)];
        let canvas = svg(&plots, &caption);
        assert_eq!(canvas.crowded(), 0);
        let text = canvas.finish();
        let curves = |text: &str, colour| text.matches(&format!("stroke=\"{colour}\" stroke-width=\"3\"")).count();
        // the samples of the legend are curves too
        assert_eq!([curves(&text, VALLEY), curves(&text, MOUNTAIN)], [1, 1 + 1]);
        let other = svg(&[("c", &sheared)], &caption).finish();
        assert_eq!([curves(&other, VALLEY), curves(&other, MOUNTAIN)], [1 + 4, 1 + 4]);
        assert!(text.contains("no ratio") && !text.contains("NaN") && !text.contains("inf"));
    }
}
