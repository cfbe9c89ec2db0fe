//! Charts with logarithmic or linear axes: points joined by lines, one colour and mark for each series.
//!
//! Numbers that have no place on an axis are left out: those that are not finite, and on a logarithmic one those without
//! logarithm. Series that lie on later ones are drawn wider, so that all of them can be seen.

use super::axes::{Axis, Scale};
use super::canvas::{Canvas, Caption, MARGIN, WIDTH};
use super::palette::{Colour, GREY, GRID, INK, PAPER, SERIES};
use super::style::{Area, Font, PaperPoint, Style};

/// Height of a chart alone, and of a row of panels.
const HEIGHT: f64 = 720.0;
const ROW: f64 = 420.0;
/// Room above a row, and below all.
const TOP: f64 = 92.0;
/// Room of a panel on its left for numbers and the name of the axis, on its right, above and below.
const ROOM: [f64; 4] = [100.0, 16.0, 56.0, 70.0];
/// Most panels in a row.
const COLUMNS: usize = 3;
/// Half of the size of a mark.
const MARK: f64 = 5.0;
/// Distance on the paper up to which points lie on each other.
const COINCIDENT: f64 = 3.0;

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
    /// Points that may be rounding: hollow, and not joined to others.
    pub rounding: Vec<Point>,
    /// Points with a ring and a dashed line at their level; their words stand below the title.
    pub levels: Vec<Point>,
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

/// The figure of a chart with logarithmic axes.
pub fn svg(chart: &Chart) -> String {
    alone(chart).finish()
}

/// The figure of charts with linear axes, side by side under a caption.
pub(crate) fn panels(charts: &[Chart], caption: &Caption) -> String {
    side_by_side(charts, caption).finish()
}

fn alone(chart: &Chart) -> Canvas {
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

fn side_by_side(charts: &[Chart], caption: &Caption) -> Canvas {
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
    chart: &'a Chart,
    frame: Area,
    axes: [Axis; 2],
    /// For each series the points that have a place, and their places.
    series: Vec<Vec<(PaperPoint, &'a Point)>>,
}

impl<'a> Plot<'a> {
    fn new(chart: &'a Chart, scale: Scale, frame: Area) -> Self {
        let joined = chart.series.iter().flat_map(|series| &series.points);
        let points: Vec<&Point> = joined.chain(&chart.rounding).chain(&chart.levels).collect();
        let probe = Axis::around(scale, std::iter::empty(), 0.0);
        let has = |point: &&&Point| probe.has(point.x) && probe.has(point.y);
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

    /// Where a point is; `None` where it has no place on an axis.
    fn place(&self, point: &Point) -> Option<PaperPoint> {
        let Area { low: [left, top], high: [right, bottom] } = self.frame;
        let [x, y] = &self.axes;
        let there = x.has(point.x) && y.has(point.y);
        there.then(|| [left + x.part(point.x) * (right - left), bottom - y.part(point.y) * (bottom - top)])
    }

    fn draw(&self, canvas: &mut Canvas) {
        self.grid(canvas);
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

    fn grid(&self, canvas: &mut Canvas) {
        let paper = canvas.paper();
        let Area { low: [left, top], high: [right, bottom] } = self.frame;
        for tick in self.axes[0].ticks() {
            let x = left + tick.part * (right - left);
            canvas.line(&[[x, top], [x, bottom]], Style::line(GRID, 1.0));
            canvas.text_within(paper, [([x, bottom + 25.0], Font::SMALL.middle())], &tick.label);
        }
        for tick in self.axes[1].ticks() {
            let y = bottom - tick.part * (bottom - top);
            canvas.line(&[[left, y], [right, y]], Style::line(GRID, 1.0));
            canvas.text_within(paper, [([left - 10.0, y + 5.5], Font::SMALL.end())], &tick.label);
        }
        canvas.line(&[[left, top], [left, bottom], [right, bottom]], Style::line(INK, 1.4));
        let name = |axis: &Axis, name: &str| match axis.rounding() {
            Some(rounding) => format!("{} ({rounding})", axis.named(name)),
            None => axis.named(name),
        };
        let [x, y] = &self.axes;
        let middle = [0.5 * (left + right), 0.5 * (top + bottom)];
        canvas.text([middle[0], bottom + 56.0], &name(x, &self.chart.x), Font::SMALL.middle());
        canvas.text([left - ROOM[0] + 26.0, middle[1]], &name(y, &self.chart.y), Font::SMALL.middle().turned());
    }

    /// The line and the marks of a series, wider the more of the later ones it lies on.
    fn join(&self, canvas: &mut Canvas, points: &[(PaperPoint, &Point)], number: usize) {
        let near = |[a, b]: [PaperPoint; 2]| (a[0] - b[0]).hypot(a[1] - b[1]) <= COINCIDENT;
        let lies_on = |other: &&Vec<(PaperPoint, &Point)>| {
            !points.is_empty() && points.iter().all(|(a, _)| other.iter().any(|(b, _)| near([*a, *b])))
        };
        let wider = self.series[number + 1..].iter().filter(lies_on).count() as f64;
        let places: Vec<PaperPoint> = points.iter().map(|(place, _)| *place).collect();
        if places.len() > 1 {
            canvas.line(&places, Style::line(SERIES[number % SERIES.len()], 2.2 + 4.0 * wider));
        }
        for pair in places.windows(2) {
            let [a, b] = [pair[0], pair[1]];
            let steps = ((a[0] - b[0]).hypot(a[1] - b[1]) / 6.0).ceil().max(1.0);
            let at = |k: f64| [0, 1].map(|axis| a[axis] + k / steps * (b[axis] - a[axis]));
            (0..steps as usize).for_each(|k| canvas.take(Area::around(at(k as f64), 2.0)));
        }
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

/// Words beside a point, where they cover nothing.
fn beside(canvas: &mut Canvas, room: Area, [x, y]: PaperPoint, words: &str, colour: Colour) {
    let font = Font::SMALL.colour(colour);
    let level = |by: f64| [([x + 12.0, y + by], font), ([x - 12.0, y + by], font.end()), ([x, y + by], font.middle())];
    let nearer = [-10.0, 20.0, 5.5].into_iter().flat_map(level);
    let farther = [-30.0, 40.0, -50.0, 60.0].into_iter().flat_map(level);
    canvas.text_within(room, nearer.chain(farther), words);
}

/// A disc, a square, a triangle, in turns: series differ in more than colour.
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
        let points = values.iter().map(|&(x, y)| Point { x, y, label: "a < b".into() }).collect();
        Series { name: "s".into(), points }
    }

    fn chart(values: &[(f64, f64)]) -> Chart {
        Chart { title: "t & u".into(), series: vec![series(values)], ..Chart::default() }
    }

    fn linear(values: &[(f64, f64)]) -> String {
        panels(&[chart(values)], &Caption::default())
    }

    /// Middles of the discs that are points.
    fn discs(text: &str) -> Vec<[f64; 2]> {
        let points = text.split("<g><title>").skip(1).filter(|part| part.contains("<circle"));
        let number =
            |part: &str, key: &str| part.split(key).nth(1).unwrap().split('"').next().unwrap().parse().unwrap();
        points.map(|part| [number(part, "cx=\""), number(part, "cy=\"")]).collect()
    }

    /// Claim: every point is drawn once, three decades apart are three equal distances apart, and words are escaped.
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

    /// Claim: on linear axes equal differences are equal distances, also below zero.
    #[test]
    fn linear_axes() {
        let places = discs(&linear(&[(-1.0, 0.0), (0.0, 0.5), (1.0, 1.0)]));
        assert!(places.len() == 3 && (places[2][0] - 2.0 * places[1][0] + places[0][0]).abs() <= 0.21, "{places:?}");
    }

    /// Claim: values that differ by rounding alone are a level line, and the axis says so; values that differ by more are not.
    #[test]
    fn rounding_is_level() {
        let level = linear(&[(0.0, 0.1 + 0.2), (1.0, 0.3), (2.0, 0.3 + 1e-16)]);
        let places = discs(&level);
        assert!(places.iter().all(|place| place[1] == places[0][1]), "{places:?}");
        assert!(level.contains("constant (rounding below"), "{level}");
        let rising = discs(&linear(&[(0.0, 0.3), (1.0, 0.3 + 1e-9)]));
        assert!(rising[0][1] - rising[1][1] > 100.0, "{rising:?}");
    }

    /// Claim: words beside points, levels and axes stand on nothing else, neither in a chart nor in panels of it; of two series
    /// on each other the first is wider.
    #[test]
    fn labels_stand_clear() {
        let hill = [(0.0, 0.0), (0.5, 1.0), (1.0, 0.2)];
        let pass = Point { x: 0.5, y: 1.1, label: "pass 1.1".into() };
        let mut chart = Chart { levels: vec![pass], x: "x".into(), y: "y".into(), ..chart(&hill) };
        chart.series.push(series(&hill));
        let canvas = side_by_side(&[chart.clone(), chart.clone(), chart.clone(), chart.clone()], &Caption::default());
        assert_eq!(canvas.crowded(), 0);
        let text = canvas.finish();
        assert_eq!([text.matches(">pass 1.1<").count(), text.matches(" r=\"9\"").count()], [4, 12]);
        assert!(text.matches(">a &lt; b</text>").count() >= 8);
        let steep = Chart { title: "x".repeat(200), ..self::chart(&[(1.0, 1.0), (1.1, 1e3), (1.2, 1e9)]) };
        assert_eq!(alone(&steep).crowded(), 0);
    }

    /// Claim: what has no logarithm is left out, and spoils nothing; so does a chart without points. What may be rounding is
    /// hollow.
    #[test]
    fn what_has_no_logarithm_is_left_out() {
        for values in [&[(0.0, 1.0), (f64::NAN, 1.0), (1.0, -1.0), (2.0, f64::INFINITY), (3.0, 2.0)][..], &[]] {
            let rounding = vec![Point { x: 1.0, y: 1e-17, label: "below".into() }];
            let text = svg(&Chart { rounding, ..chart(values) });
            assert!(!text.contains("NaN") && !text.contains("inf"), "{text}");
            assert_eq!(discs(&text).len(), values.len().min(1) + 1);
            assert!(text.contains(">rounding<"));
        }
    }
}
