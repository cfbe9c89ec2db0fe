//! Spatially varying modes as a picture: decay rates against `q1`, and beside them the determinant over the Brillouin
//! zone with its lines of zeros (the figure of McInerney and others, PNAS 117, 30252 (2020), on spatially varying
//! modes).
//!
//! Decay rates are dots, dark where the mode neither grows nor decays. The map is blue where the determinant is
//! positive and red where it is negative, the deeper the larger its fourth root is, since it vanishes to fourth order
//! at `q = 0`; a determinant that is not real is drawn by its magnitude. Rings mark the wavenumbers of a cylinder's
//! rotations. The SVG is written directly: the same numbers
//! give the same bytes.

use std::f64::consts::{PI, TAU};
use std::fmt::Write;
use std::path::Path;

use super::{OutputError, files};
use crate::analysis::bloch::Laurent;

const WIDTH: f64 = 1200.0;
const HEIGHT: f64 = 640.0;
/// Side of both panels, their top, and their left sides.
const SIDE: f64 = 480.0;
const TOP: f64 = 70.0;
const LEFT: [f64; 2] = [95.0, 675.0];
/// Squares of the map along each direction.
const SQUARES: usize = 120;
/// Shades of either colour.
const SHADES: f64 = 32.0;
/// Largest decay rate that is drawn.
const MOST: f64 = 6.0;
const PAPER: &str = "#fcfbf8";
const INK: &str = "#2e3238";
const GRID: &str = "#dcd9cf";
const GROWING: &str = "#c8372d";
const DECAYING: &str = "#1d62b0";
const PALE: [f64; 3] = [250.0, 248.0, 243.0];
const POSITIVE: [f64; 3] = [40.0, 98.0, 170.0];
const NEGATIVE: [f64; 3] = [196.0, 66.0, 52.0];

/// Appends formatted text; writing to a string does not fail.
macro_rules! put {
    ($text:expr, $($format:tt)*) => { let _ = write!($text, $($format)*); };
}

/// What is drawn.
pub struct BlochPlot<'a> {
    /// `(q1, kappa2, whether on the unit circle)` of roots.
    pub rates: Vec<(f64, f64, bool)>,
    /// The determinant.
    pub polynomial: &'a Laurent,
    /// Lines of zeros, continuous in wavenumbers.
    pub lines: Vec<Vec<[f64; 2]>>,
    /// Wavenumbers that are marked on the map.
    pub marks: Vec<[f64; 2]>,
}

/// Writes the picture.
///
/// # Errors
/// [`OutputError::Write`].
pub fn write_svg(path: &Path, plot: &BlochPlot<'_>, title: &str) -> Result<(), OutputError> {
    files::write(path, svg(plot, title))
}

fn svg(plot: &BlochPlot<'_>, title: &str) -> String {
    let title = title.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;");
    let mut text = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} {HEIGHT}\" width=\"{WIDTH}\" height=\"{HEIGHT}\" \
         font-family=\"Helvetica, Arial, sans-serif\" font-size=\"19\" fill=\"{INK}\">\n<title>{title}</title>\n\
         <rect width=\"{WIDTH}\" height=\"{HEIGHT}\" rx=\"14\" fill=\"{PAPER}\"/>\n"
    );
    rates(&mut text, plot);
    map(&mut text, plot);
    lines(&mut text, plot);
    marks(&mut text, plot);
    text.push_str("</svg>\n");
    text
}

/// Place of a wavenumber in `[-pi, pi]` along a panel, from 0 to its side.
fn along(q: f64) -> f64 {
    (q + PI) / TAU * SIDE
}

fn rates(text: &mut String, plot: &BlochPlot<'_>) {
    let drawn = || plot.rates.iter().filter(|(_, kappa, _)| kappa.abs() <= MOST);
    let most = drawn().map(|(_, kappa, _)| kappa.abs()).fold(0.1, f64::max) * 1.05;
    let level = |kappa: f64| TOP + 0.5 * SIDE * (1.0 - kappa / most);
    axes(text, 0, "q1", "inverse decay rate kappa2 per cell");
    let step = [0.05, 0.1, 0.2, 0.5, 1.0, 2.0].into_iter().find(|step| most / step <= 4.5).unwrap_or(4.0);
    for k in -4i32..=4 {
        let kappa = f64::from(k) * step;
        if kappa.abs() <= most {
            let y = level(kappa);
            put!(text, "<path d=\"M{} {y:.1}h{SIDE}\" stroke=\"{GRID}\"/>\n", LEFT[0]);
            let decimals = usize::from(step < 1.0) + usize::from(step < 0.1);
            put!(
                text,
                "<text x=\"{}\" y=\"{:.1}\" text-anchor=\"end\">{kappa:.decimals$}</text>\n",
                LEFT[0] - 10.0,
                y + 6.5
            );
        }
    }
    for &(q, kappa, on_circle) in drawn() {
        let colour = match (on_circle, kappa > 0.0) {
            (true, _) => INK,
            (false, true) => GROWING,
            (false, false) => DECAYING,
        };
        put!(text, "<circle cx=\"{:.1}\" cy=\"{:.1}\" r=\"2\" fill=\"{colour}\"/>\n", LEFT[0] + along(q), level(kappa));
    }
}

/// Frame, ticks and names of a panel.
fn axes(text: &mut String, panel: usize, name: &str, other: &str) {
    let (left, bottom) = (LEFT[panel], TOP + SIDE);
    put!(text, "<rect x=\"{left}\" y=\"{TOP}\" width=\"{SIDE}\" height=\"{SIDE}\" fill=\"none\" stroke=\"{INK}\"/>\n");
    for (q, word) in [(-PI, "\u{2212}\u{3c0}"), (0.0, "0"), (PI, "\u{3c0}")] {
        let x = left + along(q);
        put!(text, "<path d=\"M{x:.1} {bottom}v7\" stroke=\"{INK}\"/>\n");
        put!(text, "<text x=\"{x:.1}\" y=\"{}\" text-anchor=\"middle\">{word}</text>\n", bottom + 28.0);
    }
    put!(text, "<text x=\"{}\" y=\"{}\" text-anchor=\"middle\">{name}</text>\n", left + 0.5 * SIDE, bottom + 52.0);
    put!(text, "<text x=\"{left}\" y=\"{}\">{other}</text>\n", TOP - 16.0);
}

fn map(text: &mut String, plot: &BlochPlot<'_>) {
    let values = plot.polynomial.map([SQUARES, SQUARES]);
    let real = !plot.lines.is_empty();
    let shown = |k: usize| if real { values[k].re } else { values[k].norm() };
    let largest = (0..values.len()).map(|k| shown(k).abs()).fold(f64::MIN_POSITIVE, f64::max);
    let side = SIDE / SQUARES as f64;
    text.push_str("<g shape-rendering=\"crispEdges\">\n");
    for row in 0..SQUARES {
        let y = TOP + SIDE - side * (row as f64 + 1.0);
        let colours: Vec<String> = (0..SQUARES).map(|k| colour(shown(row * SQUARES + k) / largest)).collect();
        let mut column = 0;
        // neighbours of one colour are one rectangle
        for run in colours.chunk_by(|a, b| a == b) {
            let (x, width) = (LEFT[1] + side * column as f64, side * run.len() as f64);
            put!(text, "<path d=\"M{x:.1} {y:.1}h{width:.1}v{side:.1}h-{width:.1}z\" fill=\"{}\"/>\n", run[0]);
            column += run.len();
        }
    }
    text.push_str("</g>\n");
    let name =
        if real { "determinant: blue positive, red negative, zero lines" } else { "magnitude of the determinant" };
    axes(text, 1, "q1", name);
    for (q, word) in [(-PI, "\u{2212}\u{3c0}"), (0.0, "q2"), (PI, "\u{3c0}")] {
        let y = TOP + SIDE - along(q) + 6.5;
        put!(text, "<text x=\"{}\" y=\"{y:.1}\" text-anchor=\"end\">{word}</text>\n", LEFT[1] - 10.0);
    }
}

/// From pale at zero to deep at one.
fn colour(value: f64) -> String {
    let deep = if value < 0.0 { NEGATIVE } else { POSITIVE };
    let part = (SHADES * value.abs().powf(0.25)).round() / SHADES;
    let [red, green, blue] = [0, 1, 2].map(|i| (PALE[i] + (deep[i] - PALE[i]) * part).round() as u8);
    format!("#{red:02x}{green:02x}{blue:02x}")
}

/// Lines of zeros, cut where they leave the zone.
fn lines(text: &mut String, plot: &BlochPlot<'_>) {
    for line in &plot.lines {
        text.push_str("<path fill=\"none\" stroke=\"#1b1c1e\" stroke-width=\"2.2\" d=\"");
        let mut home = [f64::NAN; 2];
        for pair in line.windows(2) {
            let middle = [0, 1].map(|a| TAU * (0.5 * (pair[0][a] + pair[1][a]) / TAU).round());
            let at = |q: [f64; 2]| {
                let within = [0, 1].map(|a| (q[a] - middle[a]).clamp(-PI, PI));
                [LEFT[1] + along(within[0]), TOP + SIDE - along(within[1])]
            };
            let [from, to] = [at(pair[0]), at(pair[1])];
            if middle != home {
                put!(text, "M{:.1} {:.1}", from[0], from[1]);
            }
            put!(text, "L{:.1} {:.1}", to[0], to[1]);
            home = middle;
        }
        text.push_str("\"/>\n");
    }
}

/// Rings at the marked wavenumbers.
fn marks(text: &mut String, plot: &BlochPlot<'_>) {
    for q in &plot.marks {
        let [x, y] = q.map(|q| along((q + PI).rem_euclid(TAU) - PI));
        let (x, y) = (LEFT[1] + x, TOP + SIDE - y);
        put!(text, "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"9\" fill=\"none\" stroke=\"{INK}\" stroke-width=\"2\"/>\n");
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::DenseMatrix;

    /// Claim: a picture has a dot for every rate within the range, a square for every part of the map, and a path for
    /// every line, which is cut where it leaves the zone; a determinant without lines is said to be drawn by its
    /// magnitude.
    #[test]
    fn everything_is_drawn() {
        let polynomial =
            Laurent { coefficients: DenseMatrix::from_row_slice(1, 3, &[0.5, 0.2, 0.5]), lowest: [0.0, -1.0] };
        let rates = vec![(0.5, 0.3, false), (0.5, -0.3, false), (0.7, 0.0, true), (1.0, 40.0, false)];
        let across = vec![[PI - 0.1, 0.0], [PI - 0.01, 0.1], [PI + 0.1, 0.2]];
        let plot = BlochPlot { rates, polynomial: &polynomial, lines: vec![across], marks: vec![[0.3, -0.2 + TAU]] };
        let text = svg(&plot, "a < b");
        assert!(text.contains("<title>a &lt; b</title>") && !text.contains("NaN"));
        assert_eq!(text.matches("<circle").count(), 3 + 1);
        let ring = format!("cx=\"{:.1}\" cy=\"{:.1}\"", LEFT[1] + along(0.3), TOP + SIDE - along(-0.2));
        assert!(text.contains(&ring), "{ring}");
        let squares = |path: &str| {
            let width: f64 = path.split_once('M')?.1.split_once('h')?.1.split_once('v')?.0.parse().ok()?;
            Some((width * SQUARES as f64 / SIDE).round() as usize)
        };
        let painted: usize = text.lines().filter(|line| line.contains("z\" fill=\"#")).filter_map(squares).sum();
        assert_eq!(painted, SQUARES * SQUARES);
        let path = text.lines().find(|line| line.contains("stroke-width=\"2.2\"")).unwrap();
        assert_eq!(path.matches('M').count(), 2, "{path}");
        let magnitude = svg(&BlochPlot { lines: vec![], ..plot }, "");
        assert!(magnitude.contains("magnitude") && !magnitude.contains("negative"));
    }
}
