//! A chart with logarithmic or linear axes: points joined by lines, one colour and mark for each series.
//!
//! The SVG is written directly, like the pictures of sheets ([`super::plot`]), so that it can stand inside an HTML page and
//! the same chart gives the same bytes. Numbers that have no place on an axis are left out: those that are not finite, and on a
//! logarithmic one those without logarithm.

use std::fmt::Write;

const WIDTH: f64 = 760.0;
const HEIGHT: f64 = 470.0;
/// Left, right, top and bottom of the frame on the paper.
const FRAME: [f64; 4] = [92.0, 540.0, 56.0, 400.0];
const PAPER: &str = "#fcfbf8";
const GRID: &str = "#dcd9cf";
const INK: &str = "#2e3238";
/// Colours that stay apart also for those who see fewer of them, by brightness as well as hue.
const COLOURS: [&str; 6] = ["#1d62b0", "#c8372d", "#3f265d", "#d98a1f", "#2c8a6b", "#7d7a72"];
/// Width of a letter beside a point, at most.
const LETTER: f64 = 7.0;
/// Most numbers along an axis.
const TICKS: i32 = 9;

/// Appends formatted text; writing to a string does not fail.
macro_rules! put {
    ($text:expr, $($format:tt)*) => { let _ = write!($text, $($format)*); };
}

/// A chart.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Chart {
    /// What it shows.
    pub title: String,
    /// Quantity and unit along the horizontal axis.
    pub x: String,
    /// Quantity and unit along the vertical axis.
    pub y: String,
    /// What is drawn.
    pub series: Vec<Series>,
}

/// Points that belong together.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Series {
    /// Its name in the legend.
    pub name: String,
    /// Its points, joined in this order.
    pub points: Vec<Point>,
}

/// A point.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Point {
    /// Along the horizontal axis.
    pub x: f64,
    /// Along the vertical axis.
    pub y: f64,
    /// Which setting it is: shown when the pointer rests on it, and beside the ends of a series.
    pub label: String,
}

/// The text of a chart with logarithmic axes, an `<svg>` element.
pub fn svg(chart: &Chart) -> String {
    drawn(chart, Scale::Logarithmic)
}

/// The same with linear axes.
pub fn linear_svg(chart: &Chart) -> String {
    drawn(chart, Scale::Linear)
}

#[derive(Clone, Copy, PartialEq)]
enum Scale {
    Logarithmic,
    Linear,
}

fn drawn(chart: &Chart, scale: Scale) -> String {
    let drawable = |point: &&Point| [point.x, point.y].iter().all(|v| scale.place(*v).is_finite());
    let points = || chart.series.iter().flat_map(|series| &series.points).filter(drawable);
    let axes = [Axis::around(scale, points().map(|p| p.x)), Axis::around(scale, points().map(|p| p.y))];
    let (title, letters) = (escaped(&chart.title), chart.title.chars().count() as f64);
    // a long one in smaller letters: they are at most 0.6 as wide as high
    let size = f64::min(16.0, (WIDTH - 1.2 * FRAME[0]) / (0.6 * letters.max(1.0)));
    let mut text = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} {HEIGHT}\" width=\"{WIDTH}\" \
         height=\"{HEIGHT}\" font-family=\"Helvetica, Arial, sans-serif\" font-size=\"13\" fill=\"{INK}\">\n\
         <rect width=\"{WIDTH}\" height=\"{HEIGHT}\" rx=\"8\" fill=\"{PAPER}\"/>\n\
         <text x=\"{}\" y=\"30\" font-size=\"{size:.1}\" font-weight=\"bold\">{title}</text>\n",
        FRAME[0]
    );
    grid(&mut text, &axes, chart);
    for (number, series) in chart.series.iter().enumerate() {
        let places: Vec<([f64; 2], &Point)> =
            series.points.iter().filter(drawable).map(|point| (place(&axes, point), point)).collect();
        paint(&mut text, &places, number);
        legend(&mut text, &series.name, number);
    }
    text.push_str("</svg>\n");
    text
}

impl Scale {
    fn place(self, value: f64) -> f64 {
        match self {
            Self::Logarithmic => value.log10(),
            Self::Linear => value,
        }
    }
}

/// A range of steps: decades, or round numbers.
struct Axis {
    scale: Scale,
    /// Length of a step; of a logarithmic axis 1.
    step: f64,
    /// The ends, in steps.
    low: i32,
    high: i32,
}

impl Axis {
    fn around(scale: Scale, values: impl Iterator<Item = f64>) -> Self {
        let places = values.map(|value| scale.place(value));
        let (low, high) = places.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
        if low > high {
            return Self { scale, step: 1.0, low: -1, high: 1 };
        }
        let (step, margin) = match scale {
            Scale::Logarithmic => (1.0, 0.05),
            Scale::Linear => (round_step(high - low), 0.0),
        };
        let (low, high) = ((low / step - margin).floor() as i32, (high / step + margin).ceil() as i32);
        Self { scale, step, low, high: high.max(low + 1) }
    }

    /// From 0 at the lower end to 1 at the upper one.
    fn part(&self, value: f64) -> f64 {
        (self.scale.place(value) / self.step - f64::from(self.low)) / f64::from(self.high - self.low)
    }

    /// Steps that carry a number.
    fn ticks(&self) -> impl Iterator<Item = i32> {
        let every = (self.high - self.low + TICKS - 1) / TICKS;
        (self.low..=self.high).filter(move |step| step.rem_euclid(every) == 0)
    }

    /// Where a step is, and how it is written.
    fn tick(&self, step: i32) -> (f64, String) {
        match self.scale {
            Scale::Logarithmic => {
                (10f64.powi(step), format!("10<tspan dy=\"-5\" font-size=\"10\">{}</tspan>", signed(step)))
            }
            Scale::Linear => {
                let value = f64::from(step) * self.step;
                let digits = (-self.step.log10().floor()).clamp(0.0, 12.0) as usize;
                (value, format!("{value:.digits$}").replace('-', "\u{2212}"))
            }
        }
    }
}

/// One, two or five times a power of ten, five to twelve of them in a range.
fn round_step(range: f64) -> f64 {
    let wanted = range.max(f64::MIN_POSITIVE) / 6.0;
    let power = 10f64.powf(wanted.log10().floor());
    [1.0, 2.0, 5.0, 10.0].map(|factor| factor * power).into_iter().find(|step| *step >= wanted).unwrap_or(10.0 * power)
}

fn place(axes: &[Axis; 2], point: &Point) -> [f64; 2] {
    let [left, right, top, bottom] = FRAME;
    [left + axes[0].part(point.x) * (right - left), bottom - axes[1].part(point.y) * (bottom - top)]
}

fn grid(text: &mut String, axes: &[Axis; 2], chart: &Chart) {
    let [left, right, top, bottom] = FRAME;
    for (x, label) in axes[0].ticks().map(|step| axes[0].tick(step)) {
        let x = left + axes[0].part(x) * (right - left);
        put!(text, "<path d=\"M{x:.1} {top}V{bottom}\" stroke=\"{GRID}\"/>\n");
        put!(text, "<text x=\"{x:.1}\" y=\"{:.1}\" text-anchor=\"middle\">{label}</text>\n", bottom + 20.0);
    }
    for (y, label) in axes[1].ticks().map(|step| axes[1].tick(step)) {
        let y = bottom - axes[1].part(y) * (bottom - top);
        put!(text, "<path d=\"M{left} {y:.1}H{right}\" stroke=\"{GRID}\"/>\n");
        put!(text, "<text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"end\">{label}</text>\n", left - 8.0, y + 5.0);
    }
    put!(text, "<path d=\"M{left} {top}V{bottom}H{right}\" fill=\"none\" stroke=\"{INK}\"/>\n");
    let (middle, level) = (0.5 * (left + right), 0.5 * (top + bottom));
    put!(text, "<text x=\"{middle}\" y=\"{}\" text-anchor=\"middle\">{}</text>\n", bottom + 48.0, escaped(&chart.x));
    put!(
        text,
        "<text transform=\"translate(26 {level}) rotate(-90)\" text-anchor=\"middle\">{}</text>\n",
        escaped(&chart.y)
    );
}

fn paint(text: &mut String, places: &[([f64; 2], &Point)], number: usize) {
    let colour = COLOURS[number % COLOURS.len()];
    if let Some(([x, y], _)) = places.first() {
        put!(text, "<path fill=\"none\" stroke=\"{colour}\" stroke-width=\"1.6\" d=\"M{x:.1} {y:.1}");
        for ([x, y], _) in &places[1..] {
            put!(text, "L{x:.1} {y:.1}");
        }
        text.push_str("\"/>\n");
    }
    for (at, (place, point)) in places.iter().enumerate() {
        put!(text, "<g fill=\"{colour}\"><title>{}</title>", escaped(&point.label));
        mark(text, *place, number);
        text.push_str("</g>\n");
        if at == 0 || at + 1 == places.len() {
            let next = places.get(if at == 0 { 1 } else { at - 1 });
            label(text, *place, next.is_some_and(|(next, _)| next[1] < place[1]), &point.label, colour);
        }
    }
}

/// Beside a point, above or below it: on its right where there is room for it within the frame, else on its left.
fn label(text: &mut String, [x, y]: [f64; 2], below: bool, words: &str, colour: &str) {
    let fits = x + 7.0 + LETTER * words.chars().count() as f64 <= FRAME[1];
    let (x, anchor) = if fits { (x + 7.0, "start") } else { (x - 7.0, "end") };
    let y = if below { y + 15.0 } else { y - 7.0 };
    put!(text, "<text x=\"{x:.1}\" y=\"{y:.1}\" font-size=\"11\" text-anchor=\"{anchor}\" ");
    put!(text, "fill=\"{colour}\">{}</text>\n", escaped(words));
}

/// A disc, a square, a triangle, in turns: series differ in more than colour.
fn mark(text: &mut String, [x, y]: [f64; 2], number: usize) {
    *text += &match number % 3 {
        0 => format!("<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"4\"/>"),
        1 => format!("<rect x=\"{:.1}\" y=\"{:.1}\" width=\"7\" height=\"7\"/>", x - 3.5, y - 3.5),
        _ => format!("<path d=\"M{x:.1} {:.1}l5 8.5h-10z\"/>", y - 5.5),
    };
}

fn legend(text: &mut String, name: &str, number: usize) {
    let (x, y) = (FRAME[1] + 24.0, FRAME[2] + 14.0 + 24.0 * number as f64);
    put!(text, "<g fill=\"{}\">", COLOURS[number % COLOURS.len()]);
    mark(text, [x, y - 4.5], number);
    put!(text, "</g><text x=\"{}\" y=\"{y}\">{}</text>\n", x + 14.0, escaped(name));
}

/// With a true minus.
fn signed(number: i32) -> String {
    number.to_string().replace('-', "\u{2212}")
}

/// Text as it stands in XML and HTML.
pub fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn chart(values: &[(f64, f64)]) -> Chart {
        let points = values.iter().map(|&(x, y)| Point { x, y, label: "a < b".into() }).collect();
        Chart { title: "t & u".into(), series: vec![Series { name: "s".into(), points }], ..Chart::default() }
    }

    /// Claim: every point is drawn once, three decades apart are three equal distances apart, and words are escaped.
    #[test]
    fn points_stand_where_their_logarithms_say() {
        let text = svg(&chart(&[(1e-6, 1e-3), (1e-3, 1e-2), (1.0, 1e-1)]));
        let numbers = |key: &str| -> Vec<f64> {
            let circles = text.lines().filter(|line| line.contains("<circle") && line.contains("<title>"));
            let after = |line: &str| line.split(key).nth(1).unwrap().split('"').next().unwrap().parse().unwrap();
            circles.map(after).collect()
        };
        let (x, y) = (numbers("cx=\""), numbers("cy=\""));
        assert_eq!(x.len(), 3);
        assert!((x[1] - x[0] - (x[2] - x[1])).abs() <= 0.2 && x[1] > x[0], "{x:?}");
        assert!((y[1] - y[0] - (y[2] - y[1])).abs() <= 0.2 && y[1] < y[0], "{y:?}");
        assert!(text.contains("t &amp; u") && text.contains("a &lt; b") && !text.contains("a < b"));
    }

    /// Claim: on linear axes equal differences are equal distances, also below zero, and the numbers beside the axes are round.
    #[test]
    fn linear_axes() {
        let text = linear_svg(&chart(&[(-1.0, 0.0), (0.0, 0.5), (1.0, 1.0)]));
        let x = |line: &str| -> f64 { line.split("cx=\"").nth(1).unwrap().split('"').next().unwrap().parse().unwrap() };
        let places: Vec<f64> = text.lines().filter(|line| line.contains("<title>")).map(x).collect();
        assert!(places.len() == 3 && (places[2] - 2.0 * places[1] + places[0]).abs() <= 0.21, "{places:?}");
        assert!(text.contains(">\u{2212}1.0<") && text.contains(">0.4<"), "{text}");
        assert_eq!([0.9, 6.0, 31.0].map(round_step), [0.2, 1.0, 10.0]);
    }

    /// Claim: what stands beside a point stays within the frame, where the legend is not, and on the side where its series is not:
    /// of a rising one below the first point and above the last.
    #[test]
    fn labels_stand_clear() {
        let text = linear_svg(&chart(&[(0.0, 0.0), (1.0, 1.0)]));
        let labels: Vec<&str> = text.lines().filter(|line| line.contains("font-size=\"11\"")).collect();
        let number = |line: &str, key: &str| -> f64 {
            line.split(key).nth(1).unwrap().split('"').next().unwrap().parse().unwrap()
        };
        let (x, y) = (|line| number(line, " x=\""), |line| number(line, " y=\""));
        assert!(labels[0].contains("\"start\"") && x(labels[0]) > FRAME[0] && y(labels[0]) > FRAME[3], "{}", labels[0]);
        assert!(labels[1].contains("\"end\"") && x(labels[1]) < FRAME[1] && y(labels[1]) < FRAME[2], "{}", labels[1]);
    }

    /// Claim: a title of any length ends on the paper; letters are taken to be 0.6 as wide as high, a short one stays as it is.
    #[test]
    fn long_titles_end_on_the_paper() {
        for letters in [0, 10, 200] {
            let text = svg(&Chart { title: "x".repeat(letters), ..Chart::default() });
            let line = text.lines().find(|line| line.contains("bold")).unwrap();
            let size: f64 = line.split("font-size=\"").nth(1).unwrap().split('"').next().unwrap().parse().unwrap();
            assert!(FRAME[0] + 0.6 * size * letters as f64 <= WIDTH && (letters > 10 || size == 16.0), "{line}");
        }
    }

    /// Claim: what has no logarithm is left out, and spoils nothing; so does a chart without points.
    #[test]
    fn what_has_no_logarithm_is_left_out() {
        for values in [&[(0.0, 1.0), (f64::NAN, 1.0), (1.0, -1.0), (2.0, f64::INFINITY), (3.0, 2.0)][..], &[]] {
            let text = svg(&chart(values));
            assert!(!text.contains("NaN") && !text.contains("inf"), "{text}");
            assert_eq!(text.matches("<title>").count(), values.len().min(1));
        }
    }
}
