//! Figure of spatially varying modes: decay rates against `q1`, and the determinant over the Brillouin zone with its
//! lines of zeros (as in the figure of McInerney and others, PNAS 117, 30252 (2020), on spatially varying modes).
//!
//! Decay rates are drawn as dots, dark if the mode neither grows nor decays. The map is blue where the determinant is
//! positive and red where it is negative. Its intensity increases with the fourth root of the magnitude, since the
//! determinant vanishes to fourth order at `q = 0`; a determinant that is not real is drawn by its magnitude. Rings
//! mark the wavenumbers of the rotations of a cylinder, and among the decay rates those that were measured in a strip.

use std::f64::consts::{PI, TAU};

use super::axes::{Axis, Scale, rounded, unit};
use super::canvas::{Canvas, Caption, Mark};
use super::contour::regions;
use super::palette::{Colour, GRID, INK, MAGNITUDE, SERIES, SIGNED};
use super::style::{Area, Font, PaperPoint, Style};
use crate::analysis::bloch::Laurent;

const HEIGHT: f64 = 728.0;
/// Side of both panels, their upper side, and their left sides.
const SIDE: f64 = 450.0;
const TOP: f64 = 132.0;
const LEFT: [f64; 2] = [112.0, 630.0];
const BAR: Area = Area { low: [1090.0, TOP + 12.0], high: [1110.0, TOP + SIDE] };
/// Number of squares of the map along each axis.
const SQUARES: usize = 96;
/// Number of shades of each of the two colours.
const SHADES: usize = 16;
/// Largest magnitude of a decay rate that is drawn.
const MOST: f64 = 6.0;
/// Radius of the ring of a measured rate.
const MEASURED: f64 = 6.0;
const OTHER: Colour = SERIES[5];
const GROWING: Colour = SERIES[3];
const DECAYING: Colour = SERIES[4];

/// The data of the figure.
pub struct BlochPlot<'a> {
    /// `(q1, kappa2, whether it lies on the unit circle)` of each root.
    pub rates: Vec<(f64, f64, bool)>,
    /// The determinant.
    pub polynomial: &'a Laurent,
    /// Lines of zeros as points `(q1, q2)`, continuous (not reduced to one zone).
    pub lines: Vec<Vec<[f64; 2]>>,
    /// Wavenumbers `(q1, q2)` that are marked on the map.
    pub marks: Vec<[f64; 2]>,
    /// `(q1, kappa2)` of the roots of the other cell of an interface.
    pub other: Vec<(f64, f64)>,
    /// `(q1, kappa2)` of each rate that was measured in a strip.
    pub measured: Vec<(f64, f64)>,
}

/// Returns the figure of spatially varying modes.
pub(crate) fn svg(plot: &BlochPlot<'_>, caption: &Caption) -> Canvas {
    let mut canvas = Canvas::new(HEIGHT, caption);
    rates(&mut canvas, plot);
    map(&mut canvas, plot);
    lines(&mut canvas, plot);
    for q in &plot.marks {
        let [x, y] = q.map(|q| along((q + PI).rem_euclid(TAU) - PI));
        canvas.circle([LEFT[1] + x, TOP + SIDE - y], 9.0, Style::line(INK, 2.0));
    }
    canvas
}

/// Returns the position of a wavenumber in `[-pi, pi]` along a panel, from 0 to its side.
fn along(q: f64) -> f64 {
    (q + PI) / TAU * SIDE
}

/// Vertical position of the legends.
const LEGEND: f64 = TOP + SIDE + 96.0;

fn rates(canvas: &mut Canvas, plot: &BlochPlot<'_>) {
    let drawn = || plot.rates.iter().filter(|(_, kappa, _)| kappa.abs() <= MOST);
    let most = drawn().map(|(_, kappa, _)| kappa.abs()).fold(0.1, f64::max);
    let axis = Axis::around(Scale::Linear, [-most, most].into_iter(), 0.0);
    for tick in axis.ticks() {
        let y = TOP + SIDE * (1.0 - tick.part);
        canvas.line(&[[LEFT[0], y], [LEFT[0] + SIDE, y]], Style::line(GRID, 1.0));
        canvas.text([LEFT[0] - 10.0, y + 5.5], &tick.label, Font::SMALL.end());
    }
    for &(q, kappa, on_circle) in drawn() {
        let colour = match (on_circle, kappa > 0.0) {
            (true, _) => INK,
            (false, true) => GROWING,
            (false, false) => DECAYING,
        };
        let place = [LEFT[0] + along(q), TOP + SIDE * (1.0 - axis.part(kappa))];
        canvas.circle(place, 2.0, Style::area(colour));
    }
    for &(q, kappa) in plot.other.iter().filter(|(_, kappa)| kappa.abs() <= most) {
        canvas.circle([LEFT[0] + along(q), TOP + SIDE * (1.0 - axis.part(kappa))], 1.2, Style::area(OTHER));
    }
    for &(q, kappa) in plot.measured.iter().filter(|(_, kappa)| kappa.abs() <= most) {
        canvas.circle([LEFT[0] + along(q), TOP + SIDE * (1.0 - axis.part(kappa))], MEASURED, Style::line(INK, 1.6));
    }
    frame(canvas, 0, "inverse decay rate \u{3ba}\u{2082} per cell, at real q\u{2081}");
    let dot = |colour| Mark::Circle(5.0, Style::area(colour));
    let entries = [(dot(GROWING), "grows"), (dot(DECAYING), "decays"), (dot(INK), "neither")];
    canvas.legend([LEFT[0], LEGEND], &entries);
    let mut of_strip = Vec::new();
    if !plot.measured.is_empty() {
        of_strip.push((Mark::Circle(MEASURED, Style::line(INK, 1.6)), "in the strip"));
    }
    if !plot.other.is_empty() {
        of_strip.push((dot(OTHER), "of the other cell"));
    }
    canvas.legend([LEFT[0], LEGEND + 26.0], &of_strip);
}

/// Draws the frame, the ticks along `q1`, and the name of a panel.
fn frame(canvas: &mut Canvas, panel: usize, name: &str) {
    let (left, right, bottom) = (LEFT[panel], LEFT[panel] + SIDE, TOP + SIDE);
    canvas.polygon(&[[left, TOP], [right, TOP], [right, bottom], [left, bottom]], Style::line(INK, 1.2));
    for (q, word) in ZONE {
        let x = left + along(q);
        canvas.line(&[[x, bottom], [x, bottom + 7.0]], Style::line(INK, 1.2));
        canvas.text([x, bottom + 26.0], word, Font::SMALL.middle());
    }
    canvas.text([left + 0.5 * SIDE, bottom + 54.0], "q\u{2081} (rad per cell)", Font::LABEL.middle());
    canvas.text([left, TOP - 14.0], name, Font::LABEL);
}

/// Ticks along a side of the zone.
const ZONE: [(f64, &str); 3] = [(-PI, "\u{2212}\u{3c0}"), (0.0, "0"), (PI, "\u{3c0}")];

fn map(canvas: &mut Canvas, plot: &BlochPlot<'_>) {
    let real = !plot.lines.is_empty();
    let points: Vec<[f64; 2]> =
        (0..(SQUARES + 1).pow(2)).map(|k| [k % (SQUARES + 1), k / (SQUARES + 1)].map(wavenumber)).collect();
    let value = |q: &[f64; 2]| plot.polynomial.at(*q);
    let values: Vec<f64> = points.iter().map(value).map(|v| if real { v.re } else { v.norm() }).collect();
    let largest = values.iter().fold(f64::MIN_POSITIVE, |most, value| most.max(value.abs()));
    let roots: Vec<f64> = values.iter().map(|value| value.signum() * (value.abs() / largest).powf(0.25)).collect();
    let places: Vec<PaperPoint> = points.iter().map(|q| [LEFT[1] + along(q[0]), TOP + SIDE - along(q[1])]).collect();
    let corners = (0..SQUARES.pow(2)).map(|k| k / SQUARES * (SQUARES + 1) + k % SQUARES);
    let n = SQUARES + 1;
    let triangles: Vec<[usize; 3]> = corners.flat_map(|k| [[k, k + 1, k + n + 1], [k, k + n + 1, k + n]]).collect();
    let [right, bottom] = [LEFT[1] + SIDE, TOP + SIDE];
    canvas.polygon(&[[LEFT[1], TOP], [right, TOP], [right, bottom], [LEFT[1], bottom]], Style::area(SIGNED.at(0.5)));
    for sign in [1.0, -1.0] {
        let signed: Vec<f64> = roots.iter().map(|root| sign * root).collect();
        for shade in 1..SHADES {
            let part = (shade as f64 + 0.5) / SHADES as f64;
            let areas = regions(&places, &triangles, &signed, shade as f64 / SHADES as f64);
            if !areas.is_empty() {
                canvas.polygons(&areas, Style::area(SIGNED.at(0.5 + 0.5 * sign * part)));
            }
        }
    }
    frame(canvas, 1, if real { "determinant at real q\u{2081}, q\u{2082}" } else { "magnitude of the determinant" });
    for (q, word) in ZONE {
        let y = TOP + SIDE - along(q);
        canvas.line(&[[LEFT[1] - 7.0, y], [LEFT[1], y]], Style::line(INK, 1.2));
        canvas.text([LEFT[1] - 12.0, y + 5.5], word, Font::SMALL.end());
    }
    canvas.text([LEFT[1] - 46.0, TOP + 0.5 * SIDE], "q\u{2082} (rad per cell)", Font::LABEL.middle().turned());
    bar(canvas, real, largest);
    legend(canvas, plot);
}

/// Returns the `k`-th wavenumber of the grid.
fn wavenumber(k: usize) -> f64 {
    k as f64 * TAU / SQUARES as f64 - PI
}

/// Draws the colour bar, which is linear in the fourth root.
fn bar(canvas: &mut Canvas, real: bool, largest: f64) {
    let (unit, words) = unit(largest);
    let (start, ramp) = if real { (0.5, SIGNED) } else { (0.0, MAGNITUDE) };
    let tick = |part: f64| (start + (1.0 - start) * part, rounded(part.signum() * part.powi(4) * largest / unit, 3));
    let parts: &[f64] = if real { &[-1.0, -0.75, -0.5, 0.0, 0.5, 0.75, 1.0] } else { &[0.0, 0.5, 0.75, 1.0] };
    let ticks: Vec<(f64, String)> = parts.iter().map(|part| tick(*part)).collect();
    canvas.colour_bar(BAR, ramp, words.trim(), &ticks);
}

fn legend(canvas: &mut Canvas, plot: &BlochPlot<'_>) {
    let mut entries = Vec::new();
    if !plot.lines.is_empty() {
        entries.push((Mark::Line(Style::line(INK, 2.2)), "zero"));
    }
    if !plot.marks.is_empty() {
        entries.push((Mark::Circle(8.0, Style::line(INK, 2.0)), "rotations of the cylinder"));
    }
    entries.push((Mark::None, "colour: fourth root"));
    canvas.legend([LEFT[1], LEGEND], &entries);
}

/// Draws the lines of zeros, cut where they leave the zone.
fn lines(canvas: &mut Canvas, plot: &BlochPlot<'_>) {
    let style = Style::line(INK, 2.2);
    for line in &plot.lines {
        let (mut home, mut part) = ([f64::NAN; 2], Vec::new());
        for pair in line.windows(2) {
            let middle = [0, 1].map(|a| TAU * (0.5 * (pair[0][a] + pair[1][a]) / TAU).round());
            let at = |q: [f64; 2]| {
                let within = [0, 1].map(|a| (q[a] - middle[a]).clamp(-PI, PI));
                [LEFT[1] + along(within[0]), TOP + SIDE - along(within[1])]
            };
            if middle != home && !part.is_empty() {
                canvas.line(&std::mem::take(&mut part), style);
            }
            if part.is_empty() {
                part.push(at(pair[0]));
            }
            part.push(at(pair[1]));
            home = middle;
        }
        if part.len() > 1 {
            canvas.line(&part, style);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::DenseMatrix;

    fn caption() -> Caption {
        Caption { title: "a < b".into(), state: "drawn state".into() }
    }

    /// Claim: the figure has a dot for every rate within the range, a ring for every one of a strip, and a path for
    /// every line, cut where it leaves the zone; a determinant without lines is labelled as its magnitude; texts do not
    /// overlap.
    #[test]
    fn everything_is_drawn() {
        let polynomial =
            Laurent { coefficients: DenseMatrix::from_row_slice(1, 3, &[0.5, 0.2, 0.5]), lowest: [0.0, -1.0] };
        let rates = vec![(0.5, 0.3, false), (0.5, -0.3, false), (0.7, 0.0, true), (1.0, 40.0, false)];
        let across = vec![[PI - 0.1, 0.0], [PI - 0.01, 0.1], [PI + 0.1, 0.2]];
        let plot = BlochPlot {
            rates,
            polynomial: &polynomial,
            lines: vec![across],
            marks: vec![[0.3, -0.2 + TAU]],
            other: vec![(0.6, 0.2)],
            measured: vec![(0.5, 0.3), (0.5, 9.0)],
        };
        let text = svg(&plot, &caption()).finish();
        assert!(text.contains("<title>a &lt; b</title>") && !text.contains("NaN"));
        assert_eq!([2, 9].map(|r| text.matches(&format!(" r=\"{r}\"")).count()), [3, 1]);
        assert_eq!(text.matches(" r=\"1.2\"").count(), 1);
        assert_eq!(text.matches(" r=\"6\"").count(), 1 + 1, "the one within the range, and the legend");
        let ring = format!("cx=\"{:.1}\" cy=\"{:.1}\"", LEFT[1] + along(0.3), TOP + SIDE - along(-0.2));
        assert!(text.contains(&ring), "{ring}");
        assert_eq!(text.matches("stroke-width=\"2.2\"").count(), 2 + 1, "two parts, and the legend");
        assert_eq!(svg(&plot, &caption()).crowded(), 0);
        let magnitude = svg(&BlochPlot { lines: vec![], ..plot }, &caption()).finish();
        assert!(magnitude.contains("magnitude") && !magnitude.contains("determinant at real"));
    }

    /// Claim: for the determinant `cos q1`, the map is blue where it is positive and red where it is negative.
    #[test]
    fn signs() {
        let polynomial =
            Laurent { coefficients: DenseMatrix::from_row_slice(3, 1, &[0.5, 0.0, 0.5]), lowest: [-1.0, 0.0] };
        let lines = vec![vec![[0.5 * PI, -PI], [0.5 * PI, PI]]];
        let text = svg(
            &BlochPlot {
                rates: vec![],
                polynomial: &polynomial,
                lines,
                marks: vec![],
                other: vec![],
                measured: vec![],
            },
            &caption(),
        )
        .finish();
        let middles = |colour: Colour| {
            let deep = text.lines().find(|line| line.contains(&format!("fill=\"{colour}\"/>"))).unwrap();
            let parts = deep.split('M').skip(1).filter(|part| part.contains('Z'));
            let x = |part: &str| part.split(' ').next().unwrap().parse::<f64>().unwrap();
            parts.map(x).collect::<Vec<f64>>()
        };
        let shade = |sign: f64| SIGNED.at(0.5 + 0.5 * sign * (SHADES as f64 - 0.5) / SHADES as f64);
        let middle = LEFT[1] + 0.5 * SIDE;
        assert!(middles(shade(1.0)).iter().all(|x| (x - middle).abs() < 0.25 * SIDE));
        assert!(middles(shade(-1.0)).iter().all(|x| (x - middle).abs() > 0.25 * SIDE));
    }
}
