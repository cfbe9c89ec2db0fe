//! Figure of the frequencies of waves: along a path through the Brillouin zone, and beside it, on the same axis, the
//! density of states.

use super::axes::{Axis, Scale, rounded};
use super::canvas::{Canvas, Caption, MARGIN, WIDTH};
use super::palette::{GRID, INK, SERIES};
use super::style::{Font, PaperPoint, Style};
use std::f64::consts::PI;

const HEIGHT: f64 = 728.0;
/// Upper and lower side of the panels.
const TOP: f64 = 140.0;
const BOTTOM: f64 = HEIGHT - 92.0;
/// Left side of the first panel, right side of the last one, room between them, and part of the width that the path
/// takes; least distance of the names of corners.
const LEFT: f64 = MARGIN + 92.0;
const RIGHT: f64 = WIDTH - 60.0;
const BETWEEN: f64 = 64.0;
const PATH: f64 = 0.68;
const APART: f64 = 110.0;
const CURVE: f64 = 2.0;

/// The data of the figure.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BandPlot {
    /// Length of the path and frequencies, ascending, at every wavenumber of the path; empty without path.
    pub bands: Vec<(f64, Vec<f64>)>,
    /// Length of the path and wavenumbers `(q1, q2)` at every corner.
    pub corners: Vec<(f64, [f64; 2])>,
    /// Edges of the bins of the density of states, and the density in each.
    pub density: Option<(Vec<f64>, Vec<f64>)>,
}

/// Returns the figure.
pub(crate) fn svg(plot: &BandPlot, caption: &Caption) -> Canvas {
    let mut canvas = Canvas::new(HEIGHT, caption);
    let frequencies = plot.bands.iter().flat_map(|(_, values)| values);
    let edges = plot.density.iter().flat_map(|(edges, _)| edges);
    let axis = Axis::around(Scale::Linear, frequencies.chain(edges).copied().chain([0.0]), 0.0);
    let width = RIGHT - LEFT;
    let middle = match (plot.bands.is_empty(), &plot.density) {
        (true, _) => LEFT,
        (false, None) => RIGHT,
        (false, Some(_)) => LEFT + PATH * width,
    };
    if !plot.bands.is_empty() {
        along_path(&mut canvas, plot, &axis, middle);
    }
    if let Some((edges, values)) = &plot.density {
        let left = if plot.bands.is_empty() { LEFT } else { middle + BETWEEN };
        density(&mut canvas, (edges, values), &axis, left);
    }
    for tick in axis.ticks() {
        canvas.text([LEFT - 12.0, height(tick.part) + 5.5], &tick.label, Font::SMALL.end());
    }
    let name = axis.named("frequency \u{3c9} (rad per time)");
    canvas.text([MARGIN + 4.0, 0.5 * (TOP + BOTTOM)], &name, Font::LABEL.middle().turned());
    canvas
}

fn height(part: f64) -> f64 {
    BOTTOM - part * (BOTTOM - TOP)
}

/// Draws the lines of the frequency axis, the frame, and the name of a panel.
fn frame(canvas: &mut Canvas, axis: &Axis, [left, right]: [f64; 2], name: &str) {
    for tick in axis.ticks() {
        let y = height(tick.part);
        canvas.line(&[[left, y], [right, y]], Style::line(GRID, 1.0));
    }
    canvas.polygon(&[[left, TOP], [right, TOP], [right, BOTTOM], [left, BOTTOM]], Style::line(INK, 1.2));
    canvas.text([left, TOP - 14.0], name, Font::LABEL);
}

fn along_path(canvas: &mut Canvas, plot: &BandPlot, axis: &Axis, right: f64) {
    frame(canvas, axis, [LEFT, right], "along the path");
    let longest = plot.bands.last().map_or(1.0, |(length, _)| *length).max(f64::MIN_POSITIVE);
    let across = |length: f64| LEFT + length / longest * (right - LEFT);
    let mut named = f64::NEG_INFINITY;
    for (length, q) in &plot.corners {
        let x = across(*length);
        canvas.line(&[[x, TOP], [x, BOTTOM + 7.0]], Style::line(INK, 1.0));
        if x - named >= APART {
            named = x;
            let [q1, q2] = q.map(in_pi);
            canvas.text([x, BOTTOM + 28.0], &format!("({q1}, {q2})"), Font::SMALL.middle());
        }
    }
    let count = plot.bands.iter().map(|(_, values)| values.len()).min().unwrap_or(0);
    for band in 0..count {
        let places: Vec<PaperPoint> =
            plot.bands.iter().map(|(length, values)| [across(*length), height(axis.part(values[band]))]).collect();
        canvas.line(&places, Style::line(SERIES[0], CURVE));
    }
}

/// Returns a wavenumber in units of pi where it is a multiple of a twelfth of it, otherwise as a number.
fn in_pi(q: f64) -> String {
    let twelfths = (12.0 * q / PI).round();
    if (12.0 * q / PI - twelfths).abs() > 1e-9 {
        return rounded(q, 3);
    }
    match twelfths / 12.0 {
        0.0 => "0".to_owned(),
        1.0 => "\u{3c0}".to_owned(),
        -1.0 => "\u{2212}\u{3c0}".to_owned(),
        part => format!("{}\u{3c0}", rounded(part, 3)),
    }
}

/// Draws the density as steps, to the right.
fn density(canvas: &mut Canvas, (edges, values): (&[f64], &[f64]), axis: &Axis, left: f64) {
    let across = Axis::around(Scale::Linear, values.iter().copied().chain([0.0]), 0.0);
    frame(canvas, axis, [left, RIGHT], "density of states");
    let x = |value: f64| left + across.part(value) * (RIGHT - left);
    let mut ticks = across.ticks();
    let every = ticks.len().div_ceil(4).max(1);
    for tick in ticks.drain(..).step_by(every) {
        let at = left + tick.part * (RIGHT - left);
        canvas.line(&[[at, BOTTOM], [at, BOTTOM + 7.0]], Style::line(INK, 1.2));
        canvas.text([at, BOTTOM + 28.0], &tick.label, Font::SMALL.middle());
    }
    let bins = edges.windows(2).zip(values);
    let steps = bins.flat_map(|(ends, value)| [0, 1].map(|k| [x(*value), height(axis.part(ends[k]))]));
    canvas.line(&steps.collect::<Vec<PaperPoint>>(), Style::line(SERIES[1], CURVE));
    let words = across.named("states per frequency");
    canvas.text([0.5 * (left + RIGHT), BOTTOM + 60.0], &words, Font::LABEL.middle());
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Claim: there is a curve for every band and a step line for the density, each panel alone or both; corners are
    /// named in units of pi where there is room; nothing is not a number, and no text covers another.
    #[test]
    fn every_band_is_drawn() {
        let caption = Caption { title: "t".into(), state: "s".into() };
        let bands = (0..5).map(|k| (f64::from(k), vec![0.0, 0.1 * f64::from(k), 2.0])).collect();
        let corners = vec![(0.0, [0.0, 0.0]), (0.2, [0.1, 0.1]), (2.0, [PI, 0.5 * PI]), (4.0, [0.3, -PI])];
        let density = Some((vec![0.0, 1.0, 2.0], vec![1.0, 2.0]));
        let both = BandPlot { bands, corners, density };
        let lone =
            [BandPlot { density: None, ..both.clone() }, BandPlot { bands: vec![], corners: vec![], ..both.clone() }];
        for (plot, curves, steps) in [(&both, 3, 1), (&lone[0], 3, 0), (&lone[1], 0, 1)] {
            let canvas = svg(plot, &caption);
            assert_eq!(canvas.crowded(), 0);
            let text = canvas.finish();
            let count = |k: usize| text.matches(&format!("stroke=\"{}\" stroke-width=\"2\"", SERIES[k])).count();
            assert_eq!([count(0), count(1)], [curves, steps]);
            assert!(!text.contains("NaN") && !text.contains("inf"));
        }
        let text = svg(&both, &caption).finish();
        assert!(["(0, 0)", "(\u{3c0}, 0.5\u{3c0})", "(0.3, \u{2212}\u{3c0})"].iter().all(|words| text.contains(words)));
    }
}
