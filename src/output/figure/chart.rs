//! Charts with logarithmic or linear axes: points joined by lines, with a colour and a mark for each series.
//!
//! Points without a position are left out: those with numbers that are not finite and, on logarithmic axes, those with
//! numbers that are not positive. A series that coincides with later ones is drawn wider, so that all of them are
//! visible.

use super::axes::{Axis, Scale};
use super::canvas::{Canvas, Caption, MARGIN, WIDTH};
use super::palette::{Colour, GREY, GRID, INK, PAPER, SERIES};
use super::style::{Area, Font, PaperPoint, Style};

/// Height of a figure with a single chart, and of a row of panels.
const HEIGHT: f64 = 720.0;
const ROW: f64 = 420.0;
/// Height above the first row.
const TOP: f64 = 92.0;
/// Margins of a panel: left (for labels and the name of the axis), right, top and bottom.
const ROOM: [f64; 4] = [100.0, 16.0, 56.0, 70.0];
/// Largest number of panels in a row.
const COLUMNS: usize = 3;
/// Half the size of a mark.
const MARK: f64 = 5.0;
/// Distance in the figure up to which points count as coincident.
const COINCIDENT: f64 = 3.0;

/// The content of a chart.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LineChart {
    /// Title.
    pub title: String,
    /// Quantity and unit along the horizontal axis.
    pub x: String,
    /// Quantity and unit along the vertical axis.
    pub y: String,
    /// The series, each drawn as marks joined by a line.
    pub series: Vec<Series>,
    /// Points whose values may be rounding errors: drawn hollow, and not joined to others.
    pub rounding: Vec<DataPoint>,
    /// Points with a ring and a dashed horizontal line; their labels are printed below the title.
    pub levels: Vec<DataPoint>,
}

/// A sequence of points.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Series {
    /// Name in the legend.
    pub name: String,
    /// The points, joined in this order.
    pub points: Vec<DataPoint>,
}

/// A point of a chart.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DataPoint {
    /// Value along the horizontal axis.
    pub x: f64,
    /// Value along the vertical axis.
    pub y: f64,
    /// Label: shown as a tooltip, and printed next to the first and the last point of a series.
    pub label: String,
}

/// Returns the figure of one chart with logarithmic axes.
pub fn svg(chart: &LineChart) -> String {
    alone(chart).finish()
}

/// Draws one chart with logarithmic axes.
pub(crate) fn alone(chart: &LineChart) -> Canvas {
    let caption = Caption { title: chart.title.clone(), state: String::new() };
    let mut canvas = Canvas::new(HEIGHT, &caption);
    let names = chart.series.iter().map(|series| Font::SMALL.width(&series.name) + 60.0);
    let legend = names.fold(120.0f64, f64::max).min(400.0);
    let frame = Area { low: [MARGIN + ROOM[0], TOP], high: [WIDTH - legend - 24.0, HEIGHT - ROOM[3] - 20.0] };
    Plot::new(chart, Scale::Logarithmic, frame).draw(&mut canvas);
    let x = frame.high[0] + 34.0;
    for (number, series) in chart.series.iter().enumerate() {
        let y = frame.low[1] + 20.0 + 32.0 * number as f64;
        mark(&mut canvas, [x, y - 5.5], number, MARK);
        canvas.text([x + 18.0, y], &series.name, Font::SMALL);
    }
    if !chart.rounding.is_empty() {
        let y = frame.low[1] + 20.0 + 32.0 * chart.series.len() as f64;
        canvas.circle([x, y - 5.5], MARK, Style::area(PAPER).outlined(GREY, 1.6));
        canvas.text([x + 18.0, y], "rounding", Font::SMALL);
    }
    canvas
}

/// Draws charts with linear axes, side by side under a common caption.
pub(crate) fn panels(charts: &[LineChart], caption: &Caption) -> Canvas {
    let columns = charts.len().clamp(1, COLUMNS);
    let rows = charts.len().div_ceil(columns).max(1);
    let mut canvas = Canvas::new(TOP + ROW * rows as f64, caption);
    let width = ((WIDTH - MARGIN) / columns as f64).min(640.0);
    for (number, chart) in charts.iter().enumerate() {
        let (left, top) = (24.0 + width * (number % columns) as f64, TOP + ROW * (number / columns) as f64);
        let frame = Area { low: [left + ROOM[0], top + ROOM[2]], high: [left + width - ROOM[1], top + ROW - ROOM[3]] };
        let left = left + 0.5 * ROOM[0];
        canvas.text([left, top + 18.0], &chart.title, Font::SMALL.bold());
        for (k, level) in chart.levels.iter().enumerate() {
            canvas.text([left, top + 40.0 + 20.0 * k as f64], &level.label, Font::SMALL);
        }
        Plot::new(chart, Scale::Linear, frame).draw(&mut canvas);
    }
    canvas
}

/// A chart in its frame.
struct Plot<'a> {
    chart: &'a LineChart,
    frame: Area,
    axes: [Axis; 2],
    /// Points of each series that have a position, and their positions.
    series: Vec<Vec<(PaperPoint, &'a DataPoint)>>,
}

impl<'a> Plot<'a> {
    fn new(chart: &'a LineChart, scale: Scale, frame: Area) -> Self {
        let joined = chart.series.iter().flat_map(|series| &series.points);
        let points: Vec<&DataPoint> = joined.chain(&chart.rounding).chain(&chart.levels).collect();
        let probe = Axis::around(scale, std::iter::empty(), 0.0);
        let has = |point: &&&DataPoint| probe.has(point.x) && probe.has(point.y);
        let axes = [
            Axis::around(scale, points.iter().filter(has).map(|point| point.x), 0.0),
            Axis::around(scale, points.iter().filter(has).map(|point| point.y), 0.0),
        ];
        let mut plot = Self { chart, frame, axes, series: Vec::new() };
        let placed = |series: &'a Series| {
            let places = series.points.iter().filter_map(|point| Some((plot.place(point)?, point)));
            places.collect::<Vec<_>>()
        };
        plot.series = chart.series.iter().map(placed).collect();
        plot
    }

    /// Returns the position of a point; `None` if it has no position on one of the axes.
    fn place(&self, point: &DataPoint) -> Option<PaperPoint> {
        let Area { low: [left, top], high: [right, bottom] } = self.frame;
        let [x, y] = &self.axes;
        let there = x.has(point.x) && y.has(point.y);
        there.then(|| [left + x.part(point.x) * (right - left), bottom - y.part(point.y) * (bottom - top)])
    }

    fn draw(&self, canvas: &mut Canvas) {
        grid(canvas, self.frame, &self.axes, [&self.chart.x, &self.chart.y]);
        for (number, points) in self.series.iter().enumerate() {
            self.join(canvas, points, number);
        }
        for (place, point) in self.chart.rounding.iter().filter_map(|point| Some((self.place(point)?, point))) {
            canvas.told(&point.label);
            canvas.circle(place, MARK, Style::area(PAPER).outlined(GREY, 1.6));
            canvas.end();
        }
        self.levels(canvas);
        for (number, points) in self.series.iter().enumerate() {
            let ends = [points.first(), points.last().filter(|_| points.len() > 1)];
            for (place, point) in ends.into_iter().flatten() {
                beside(canvas, self.frame, *place, &point.label, SERIES[number % SERIES.len()]);
            }
        }
    }

    /// Draws the line and the marks of a series; the more of the later series coincide with it, the wider they are.
    fn join(&self, canvas: &mut Canvas, points: &[(PaperPoint, &DataPoint)], number: usize) {
        let near = |[a, b]: [PaperPoint; 2]| (a[0] - b[0]).hypot(a[1] - b[1]) <= COINCIDENT;
        let lies_on = |other: &&Vec<(PaperPoint, &DataPoint)>| {
            !points.is_empty() && points.iter().all(|(a, _)| other.iter().any(|(b, _)| near([*a, *b])))
        };
        let wider = self.series[number + 1..].iter().filter(lies_on).count() as f64;
        let places: Vec<PaperPoint> = points.iter().map(|(place, _)| *place).collect();
        if places.len() > 1 {
            canvas.line(&places, Style::line(SERIES[number % SERIES.len()], 2.2 + 4.0 * wider));
        }
        places.windows(2).for_each(|ends| canvas.take_line(ends[0], ends[1], 2.0));
        for (place, point) in points {
            canvas.told(&point.label);
            mark(canvas, *place, number, MARK + 4.0 * wider);
            canvas.end();
            canvas.take(Area::around(*place, MARK + 4.0 * wider));
        }
    }

    fn levels(&self, canvas: &mut Canvas) {
        let Area { low: [left, _], high: [right, _] } = self.frame;
        for place @ [_, y] in self.chart.levels.iter().filter_map(|point| self.place(point)) {
            canvas.line(&[[left, y], [right, y]], Style::line(INK, 1.2).dashed(6.0, 4.0));
            canvas.circle(place, MARK + 2.5, Style::line(INK, 1.8));
            canvas.take(Area::around(place, MARK + 2.5));
            canvas.take(Area { low: [left, y - 2.0], high: [right, y + 2.0] });
        }
    }
}

/// Draws the grid, the ticks and the names of two axes around a frame.
pub(super) fn grid(canvas: &mut Canvas, frame: Area, axes: &[Axis; 2], names: [&str; 2]) {
    let paper = canvas.paper();
    let Area { low: [left, top], high: [right, bottom] } = frame;
    for tick in axes[0].ticks() {
        let x = left + tick.part * (right - left);
        canvas.line(&[[x, top], [x, bottom]], Style::line(GRID, 1.0));
        canvas.text_within(paper, [([x, bottom + 25.0], Font::SMALL.middle())], &tick.label);
    }
    for tick in axes[1].ticks() {
        let y = bottom - tick.part * (bottom - top);
        canvas.line(&[[left, y], [right, y]], Style::line(GRID, 1.0));
        canvas.text_within(paper, [([left - 10.0, y + 5.5], Font::SMALL.end())], &tick.label);
    }
    canvas.line(&[[left, top], [left, bottom], [right, bottom]], Style::line(INK, 1.4));
    let name = |axis: &Axis, name: &str| match axis.rounding() {
        Some(rounding) => format!("{} ({rounding})", axis.named(name)),
        None => axis.named(name),
    };
    let [x, y] = axes;
    let middle = [0.5 * (left + right), 0.5 * (top + bottom)];
    canvas.text([middle[0], bottom + 56.0], &name(x, names[0]), Font::SMALL.middle());
    canvas.text([left - ROOM[0] + 14.0, middle[1]], &name(y, names[1]), Font::SMALL.middle().turned());
}

/// Sets text next to a point where it overlaps nothing.
pub(super) fn beside(canvas: &mut Canvas, room: Area, [x, y]: PaperPoint, words: &str, colour: Colour) {
    let font = Font::SMALL.colour(colour);
    let level = |by: f64| [([x + 12.0, y + by], font), ([x - 12.0, y + by], font.end()), ([x, y + by], font.middle())];
    let nearer = [-10.0, 20.0, 5.5].into_iter().flat_map(level);
    let farther = [-30.0, 40.0, -50.0, 60.0].into_iter().flat_map(level);
    canvas.text_within(room, nearer.chain(farther), words);
}

/// Draws a disc, a square or a triangle by turns, so that series do not differ by colour only.
fn mark(canvas: &mut Canvas, [x, y]: PaperPoint, number: usize, size: f64) {
    let style = Style::area(SERIES[number % SERIES.len()]);
    let (low, high) = (-0.9 * size, 0.9 * size);
    match number % 3 {
        0 => canvas.circle([x, y], size, style),
        1 => {
            canvas.polygon(&[[x + low, y + low], [x + high, y + low], [x + high, y + high], [x + low, y + high]], style)
        }
        _ => canvas
            .polygon(&[[x, y - 1.3 * size], [x + 1.2 * size, y + 0.8 * size], [x - 1.2 * size, y + 0.8 * size]], style),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn series(values: &[(f64, f64)]) -> Series {
        let points = values.iter().map(|&(x, y)| DataPoint { x, y, label: "a < b".into() }).collect();
        Series { name: "s".into(), points }
    }

    fn chart(values: &[(f64, f64)]) -> LineChart {
        LineChart { title: "t & u".into(), series: vec![series(values)], ..LineChart::default() }
    }

    fn linear(values: &[(f64, f64)]) -> String {
        panels(&[chart(values)], &Caption::default()).finish()
    }

    /// Returns the centres of the discs that are points.
    fn discs(text: &str) -> Vec<[f64; 2]> {
        let points = text.split("<g><title>").skip(1).filter(|part| part.contains("<circle"));
        let number =
            |part: &str, key: &str| part.split(key).nth(1).unwrap().split('"').next().unwrap().parse().unwrap();
        points.map(|part| [number(part, "cx=\""), number(part, "cy=\"")]).collect()
    }

    /// Claim: every point is drawn once, equal ratios give equal distances, and text is escaped.
    #[test]
    fn points_stand_where_their_logarithms_say() {
        let text = svg(&chart(&[(1e-6, 1e-3), (1e-3, 1e-2), (1.0, 1e-1)]));
        let places = discs(&text);
        let (x, y) = ([0, 1, 2].map(|k| places[k][0]), [0, 1, 2].map(|k| places[k][1]));
        assert_eq!(places.len(), 3);
        assert!((x[1] - x[0] - (x[2] - x[1])).abs() <= 0.21 && x[1] > x[0], "{x:?}");
        assert!((y[1] - y[0] - (y[2] - y[1])).abs() <= 0.21 && y[1] < y[0], "{y:?}");
        assert!(text.contains("t &amp; u") && text.contains("a &lt; b") && !text.contains("a < b"));
    }

    /// Claim: on linear axes equal differences give equal distances, also below zero.
    #[test]
    fn linear_axes() {
        let places = discs(&linear(&[(-1.0, 0.0), (0.0, 0.5), (1.0, 1.0)]));
        assert!(places.len() == 3 && (places[2][0] - 2.0 * places[1][0] + places[0][0]).abs() <= 0.21, "{places:?}");
    }

    /// Claim: values that differ by rounding errors only are drawn at one level, which the name of the axis states;
    /// values that differ by more are not.
    #[test]
    fn rounding_is_level() {
        let level = linear(&[(0.0, 0.1 + 0.2), (1.0, 0.3), (2.0, 0.3 + 1e-16)]);
        let places = discs(&level);
        assert!(places.iter().all(|place| place[1] == places[0][1]), "{places:?}");
        assert!(level.contains("constant (rounding below"), "{level}");
        let rising = discs(&linear(&[(0.0, 0.3), (1.0, 0.3 + 1e-9)]));
        assert!(rising[0][1] - rising[1][1] > 100.0, "{rising:?}");
    }

    /// Claim: labels of points, levels and axes overlap nothing, in a single chart and in panels; of two coincident
    /// series the first is wider.
    #[test]
    fn labels_stand_clear() {
        let hill = [(0.0, 0.0), (0.5, 1.0), (1.0, 0.2)];
        let pass = DataPoint { x: 0.5, y: 1.1, label: "pass 1.1".into() };
        let mut chart = LineChart { levels: vec![pass], x: "x".into(), y: "y".into(), ..chart(&hill) };
        chart.series.push(series(&hill));
        let canvas = panels(&[chart.clone(), chart.clone(), chart.clone(), chart.clone()], &Caption::default());
        assert_eq!(canvas.crowded(), 0);
        let text = canvas.finish();
        assert_eq!([text.matches(">pass 1.1<").count(), text.matches(" r=\"9\"").count()], [4, 12]);
        assert!(text.matches(">a &lt; b</text>").count() >= 8);
        let steep = LineChart { title: "x".repeat(200), ..self::chart(&[(1.0, 1.0), (1.1, 1e3), (1.2, 1e9)]) };
        assert_eq!(alone(&steep).crowded(), 0);
    }

    /// Claim: points without a logarithm are left out, and the rest is drawn; a chart without points is allowed. Points
    /// that may be rounding errors are hollow.
    #[test]
    fn what_has_no_logarithm_is_left_out() {
        for values in [&[(0.0, 1.0), (f64::NAN, 1.0), (1.0, -1.0), (2.0, f64::INFINITY), (3.0, 2.0)][..], &[]] {
            let rounding = vec![DataPoint { x: 1.0, y: 1e-17, label: "below".into() }];
            let text = svg(&LineChart { rounding, ..chart(values) });
            assert!(!text.contains("NaN") && !text.contains("inf"), "{text}");
            assert_eq!(discs(&text).len(), values.len().min(1) + 1);
            assert!(text.contains(">rounding<"));
        }
    }
}
