//! A surface of folded states, or trajectories alone, as a picture: strain space seen obliquely, coloured by signed curvature.
//!
//! Paths on a surface are dark, without a surface they have the colours. Every axis is scaled to its own range; the eye is on the side of the box on which the drawn state is. Triangles and
//! pieces of paths are painted from back to front. Violet is negative curvature, orange positive, pale none; the drawn
//! state, where the strain is zero, is a dot. The SVG is written directly, like that of a sheet ([`super::plot`]): the
//! same surface gives the same bytes.

use std::fmt::Write;
use std::path::Path;

use super::projection::View;
use super::strain_space::StrainSurface;
use super::{OutputError, files};
use crate::math::Vec3;

const WIDTH: f64 = 1200.0;
const HEIGHT: f64 = 900.0;
/// Middle of the box on the paper, and paper per side of the box.
const MIDDLE: [f64; 2] = [565.0, 450.0];
const SCALE: f64 = 545.0;
const PAPER: &str = "#fcfbf8";
const PANE: &str = "#f3f1ea";
const GRID: &str = "#dcd9cf";
const INK: &str = "#2e3238";
/// Colours of the curvatures from the most negative to the most positive one, evenly.
const COLOURS: [[f64; 3]; 5] =
    [[63.0, 38.0, 125.0], [150.0, 138.0, 196.0], [247.0, 244.0, 238.0], [238.0, 160.0, 78.0], [156.0, 70.0, 8.0]];
const AXES: [&str; 3] = ["strain11", "strain22", "strain12"];
/// Ticks on an axis, about.
const TICKS: f64 = 7.0;
/// Mean of the parts of the palest colour of a line.
const PALEST: f64 = 185.0;
/// How much nearer to the eye lines are painted than they are, in sides of the box.
const LIFT: f64 = 0.008;
/// Top, bottom, left and right of the colour bar.
const BAR: [f64; 4] = [230.0, 650.0, 1075.0, 1097.0];

/// Appends formatted text; writing to a string does not fail.
macro_rules! put {
    ($text:expr, $($format:tt)*) => { let _ = write!($text, $($format)*); };
}

/// A state on a path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathPoint {
    /// `(strain11, strain22, strain12)`.
    pub strain: Vec3,
    /// Signed curvature.
    pub curvature: f64,
}

/// Writes the picture of a surface with paths on it, or of paths alone where the surface is empty.
///
/// # Errors
/// [`OutputError::Shape`] where the surface's arrays do not fit together, [`OutputError::Write`].
pub fn write_svg(
    path: &Path,
    surface: &StrainSurface,
    paths: &[Vec<PathPoint>],
    title: &str,
) -> Result<(), OutputError> {
    surface.check().map_err(|fault| OutputError::Shape { path: path.into(), fault })?;
    files::write(path, svg(surface, paths, title))
}

fn svg(surface: &StrainSurface, paths: &[Vec<PathPoint>], title: &str) -> String {
    let along = || paths.iter().flatten();
    let space = Space::around(surface.points.iter().chain(along().map(|point| &point.strain)));
    let curvatures = surface.curvature.iter().chain(along().map(|point| &point.curvature));
    let largest = curvatures.filter(|k| k.is_finite()).fold(0.0f64, |most, k| most.max(k.abs()));
    let title = title.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;");
    let mut text = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {WIDTH} {HEIGHT}\" width=\"{WIDTH}\" height=\"{HEIGHT}\" \
         font-family=\"Helvetica, Arial, sans-serif\" font-size=\"19\" fill=\"{INK}\">\n<title>{title}</title>\n\
         <rect width=\"{WIDTH}\" height=\"{HEIGHT}\" rx=\"14\" fill=\"{PAPER}\"/>\n"
    );
    panes(&mut text, &space);
    paint(&mut text, &space, surface, paths, largest);
    axes(&mut text, &space);
    bar(&mut text, largest);
    text.push_str("</svg>\n");
    text
}

/// The box of strains and how it is seen.
struct Space {
    low: [f64; 3],
    high: [f64; 3],
    /// On which side of x and of y the eye is, 0.5 or -0.5; above in z.
    near: [f64; 2],
    view: View,
}

impl Space {
    /// The box around all finite points, the drawn state included.
    fn around<'a>(points: impl Iterator<Item = &'a Vec3>) -> Self {
        let (mut low, mut high) = ([-1e-9f64; 3], [1e-9f64; 3]);
        for point in points.filter(|point| point.iter().all(|x| x.is_finite())) {
            for axis in 0..3 {
                low[axis] = low[axis].min(point[axis]);
                high[axis] = high[axis].max(point[axis]);
            }
        }
        for axis in 0..3 {
            let margin = 0.03 * (high[axis] - low[axis]);
            (low[axis], high[axis]) = (low[axis] - margin, high[axis] + margin);
        }
        Self::new(low, high)
    }

    fn new(low: [f64; 3], high: [f64; 3]) -> Self {
        // the drawn state is at strain 0
        let near = [0, 1].map(|axis| if low[axis] + high[axis] > 0.0 { -0.5 } else { 0.5 });
        Self { low, high, near, view: View::axonometric(near.map(f64::signum)) }
    }

    /// A strain in the box, whose sides have length 1 and whose middle is 0.
    fn boxed(&self, strain: &Vec3) -> Vec3 {
        Vec3::from_fn(|axis, _| (strain[axis] - self.low[axis]) / (self.high[axis] - self.low[axis]) - 0.5)
    }

    fn on_paper(&self, boxed: &Vec3) -> [f64; 2] {
        let [right, up, _] = self.view.place(boxed);
        [MIDDLE[0] + SCALE * right, MIDDLE[1] - SCALE * up]
    }

    /// Round numbers on an axis.
    fn ticks(&self, axis: usize) -> Vec<f64> {
        let width = self.high[axis] - self.low[axis];
        let rough = width / TICKS;
        let ten = 10f64.powf(rough.log10().floor());
        let step = [1.0, 2.0, 5.0, 10.0].map(|k| k * ten).into_iter().find(|step| *step >= rough).unwrap_or(rough);
        let first = (self.low[axis] / step).ceil() as i64;
        (first..).map(|k| k as f64 * step).take_while(|tick| *tick <= self.high[axis]).collect()
    }

    fn along(&self, axis: usize, tick: f64) -> f64 {
        (tick - self.low[axis]) / (self.high[axis] - self.low[axis]) - 0.5
    }
}

fn line(text: &mut String, space: &Space, ends: [Vec3; 2], style: &str) {
    let [a, b] = ends.map(|end| space.on_paper(&end));
    put!(text, "<path d=\"M{:.1} {:.1} {:.1} {:.1}\" {style}/>\n", a[0], a[1], b[0], b[1]);
}

/// The three far sides of the box with their grids.
fn panes(text: &mut String, space: &Space) {
    for (flat, side) in [(0, -space.near[0]), (1, -space.near[1]), (2, -0.5)] {
        let (u, v) = ((flat + 1) % 3, (flat + 2) % 3);
        let at = |a: f64, b: f64| {
            let mut place = Vec3::zeros();
            (place[flat], place[u], place[v]) = (side, a, b);
            place
        };
        let corners = [[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]].map(|[a, b]| space.on_paper(&at(a, b)));
        put!(text, "<path fill=\"{PANE}\" stroke=\"{GRID}\" d=\"M");
        corners.iter().for_each(|[x, y]| {
            put!(text, "{x:.1} {y:.1} ");
        });
        text.push_str("Z\"/>\n");
        let style = format!("stroke=\"{GRID}\" stroke-width=\"1\"");
        for tick in space.ticks(u).iter().map(|&tick| space.along(u, tick)) {
            line(text, space, [at(tick, -0.5), at(tick, 0.5)], &style);
        }
        for tick in space.ticks(v).iter().map(|&tick| space.along(v, tick)) {
            line(text, space, [at(-0.5, tick), at(0.5, tick)], &style);
        }
    }
}

/// What is painted at some depth.
enum Item {
    Triangle(usize),
    /// Two ends, and the colour where there is no surface.
    Piece([Vec3; 2], String),
    Dot(Vec3),
}

fn paint(text: &mut String, space: &Space, surface: &StrainSurface, paths: &[Vec<PathPoint>], largest: f64) {
    let alone = surface.triangles.is_empty();
    let places: Vec<Vec3> = surface.points.iter().map(|point| space.boxed(point)).collect();
    let depth = |place: &Vec3| place.dot(&space.view.toward);
    let mut items: Vec<(f64, Item)> = Vec::new();
    for (k, triangle) in surface.triangles.iter().enumerate() {
        items.push((triangle.iter().map(|&point| depth(&places[point])).sum::<f64>() / 3.0, Item::Triangle(k)));
    }
    for ends in paths.iter().flat_map(|path| path.windows(2)) {
        let [a, b] = [0, 1].map(|k| space.boxed(&ends[k].strain));
        let mean = one_sided_mean(&[ends[0].curvature, ends[1].curvature]);
        let style = if alone {
            format!("stroke=\"{}\" stroke-width=\"4.5\"", hexadecimal(shade(mean / largest)))
        } else {
            format!("stroke=\"{INK}\" stroke-width=\"2.4\"")
        };
        items.push((0.5 * (depth(&a) + depth(&b)) + LIFT, Item::Piece([a, b], style)));
    }
    let drawn = space.boxed(&Vec3::zeros());
    items.push((depth(&drawn) + 2.0 * LIFT, Item::Dot(drawn)));
    items.retain(|(depth, _)| depth.is_finite());
    items.sort_by(|a, b| a.0.total_cmp(&b.0));
    text.push_str("<g stroke-width=\".6\" stroke-linejoin=\"round\" stroke-linecap=\"round\">\n");
    for (_, item) in items {
        match item {
            Item::Triangle(k) => triangle(text, space, surface, &places, k, largest),
            Item::Piece(ends, style) => line(text, space, ends, &style),
            Item::Dot(place) => {
                let [x, y] = space.on_paper(&place);
                put!(text, "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"6\" stroke=\"{PAPER}\" stroke-width=\"1.5\"/>\n");
            }
        }
    }
    // what of the paths is behind the surface, faintly
    let faint = format!("stroke=\"{INK}\" stroke-width=\"1.3\" stroke-opacity=\".4\"");
    for ends in paths.iter().filter(|_| !alone).flat_map(|path| path.windows(2)) {
        line(text, space, [0, 1].map(|k| space.boxed(&ends[k].strain)), &faint);
    }
    text.push_str("</g>\n");
}

/// A triangle in the colour of its mean curvature, darker where it is seen from the side of the light.
fn triangle(text: &mut String, space: &Space, surface: &StrainSurface, places: &[Vec3], k: usize, largest: f64) {
    let corners = surface.triangles[k];
    let [a, b, c] = corners.map(|point| places[point]);
    let normal = (b - a).cross(&(c - a)).try_normalize(0.0).unwrap_or(space.view.toward);
    let light = (space.view.toward * 0.5 + space.view.up * 0.8 - space.view.right * 0.4).normalize();
    let facing = if normal.dot(&space.view.toward) < 0.0 { -normal } else { normal };
    let lit = 0.78 + 0.22 * facing.dot(&light).max(0.0);
    let mean = one_sided_mean(&corners.map(|point| surface.curvature[point]));
    let paint = hexadecimal(colour(mean / largest.max(f64::MIN_POSITIVE)).map(|part| part * lit));
    let [a, b, c] = [a, b, c].map(|place| space.on_paper(&place));
    put!(text, "<path d=\"M{:.1} {:.1} {:.1} {:.1} {:.1} {:.1}Z\"", a[0], a[1], b[0], b[1], c[0], c[1]);
    put!(text, " fill=\"{paint}\" stroke=\"{paint}\"/>\n");
}

/// The mean of neighbouring curvatures; where their sign jumps, that is changes while none of them is small against the
/// others, of those that have the sign of most.
fn one_sided_mean(curvatures: &[f64]) -> f64 {
    let mean = |chosen: &[f64]| chosen.iter().sum::<f64>() / chosen.len() as f64;
    let (least, most) = curvatures.iter().fold((f64::INFINITY, 0.0f64), |(a, b), k| (a.min(k.abs()), b.max(k.abs())));
    let (up, down): (Vec<f64>, Vec<f64>) = curvatures.iter().partition(|k| **k >= 0.0);
    if up.is_empty() || down.is_empty() || least < 0.5 * most {
        return mean(curvatures);
    }
    mean(if up.len() >= down.len() { &up } else { &down })
}

/// A colour in the words of SVG.
pub(super) fn hexadecimal(colour: [f64; 3]) -> String {
    let [red, green, blue] = colour.map(|part| part.round() as u8);
    format!("#{red:02x}{green:02x}{blue:02x}")
}

/// The colour of a line: darker where it would be too pale for paper.
fn shade(part: f64) -> [f64; 3] {
    let full = colour(part);
    let brightness = full.iter().sum::<f64>() / 3.0;
    full.map(|part| part * (PALEST / brightness).min(1.0))
}

/// The colour of a curvature between -1 and 1.
fn colour(part: f64) -> [f64; 3] {
    let place = 0.5 * (part.clamp(-1.0, 1.0) + 1.0) * (COLOURS.len() - 1) as f64;
    let place = if place.is_nan() { 0.5 * (COLOURS.len() - 1) as f64 } else { place };
    let first = (place as usize).min(COLOURS.len() - 2);
    let (from, to, share) = (COLOURS[first], COLOURS[first + 1], place - first as f64);
    [0, 1, 2].map(|k| from[k] + share * (to[k] - from[k]))
}

/// Numbers and names at three edges of the box.
fn axes(text: &mut String, space: &Space) {
    let [x, y] = space.near;
    let left = [[x, -y], [-x, y]].into_iter().min_by(|a, b| {
        let [a, b] = [a, b].map(|[x, y]| space.on_paper(&Vec3::new(*x, *y, 0.0))[0]);
        a.total_cmp(&b)
    });
    let [left_x, left_y] = left.unwrap_or([x, -y]);
    // where each axis begins
    let starts = [Vec3::new(-0.5, y, -0.5), Vec3::new(x, -0.5, -0.5), Vec3::new(left_x, left_y, -0.5)];
    let centre = space.on_paper(&Vec3::new(0.0, 0.0, -0.5));
    for (axis, start) in starts.into_iter().enumerate() {
        let at = |along: f64| {
            let mut place = start;
            place[axis] = along;
            place
        };
        line(text, space, [at(-0.5), at(0.5)], &format!("stroke=\"{INK}\" stroke-width=\"1.4\""));
        let middle = space.on_paper(&at(0.0));
        let off = [middle[0] - centre[0], middle[1] - centre[1]];
        let off = if axis == 2 { [-1.0, 0.0] } else { off.map(|x| x / off[0].hypot(off[1])) };
        let anchor = if axis == 2 { "end" } else { "middle" };
        for tick in space.ticks(axis) {
            let [x, y] = space.on_paper(&at(space.along(axis, tick)));
            let (x, y) = (x + 26.0 * off[0], y + 22.0 * off[1] + 6.0);
            put!(text, "<text x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"{anchor}\">{}</text>\n", number(tick));
        }
        let (x, y) = (middle[0] + 92.0 * off[0], middle[1] + 84.0 * off[1] + 6.0);
        let name = AXES[axis];
        put!(text, "<text x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"{anchor}\" font-weight=\"bold\">{name}</text>\n");
    }
}

/// A tick with a true minus and no noise in the last digits.
fn number(tick: f64) -> String {
    let rounded = (tick * 1e9).round() / 1e9;
    format!("{}", if rounded == 0.0 { 0.0 } else { rounded }).replace('-', "\u{2212}")
}

/// The scale of colours.
fn bar(text: &mut String, largest: f64) {
    let [top, bottom, left, right] = BAR;
    text.push_str("<defs><linearGradient id=\"curvature\" x1=\"0\" y1=\"1\" x2=\"0\" y2=\"0\">");
    for (k, colour) in COLOURS.iter().enumerate() {
        let offset = k as f64 / (COLOURS.len() - 1) as f64;
        put!(text, "<stop offset=\"{offset}\" stop-color=\"{}\"/>", hexadecimal(*colour));
    }
    text.push_str("</linearGradient></defs>\n");
    let (width, height) = (right - left, bottom - top);
    put!(text, "<rect x=\"{left}\" y=\"{top}\" width=\"{width}\" height=\"{height}\" fill=\"url(#curvature)\"/>\n");
    for part in [-1.0, -0.5, 0.0, 0.5, 1.0] {
        let y = bottom - 0.5 * (part + 1.0) * height + 6.5;
        let value = number((part * largest * 1e3).round() / 1e3);
        put!(text, "<text x=\"{}\" y=\"{y:.1}\">{value}</text>\n", right + 10.0);
    }
    put!(
        text,
        "<text x=\"{}\" y=\"{}\" text-anchor=\"middle\" font-weight=\"bold\">curvature</text>\n",
        left + 22.0,
        top - 22.0
    );
}

#[cfg(test)]
mod tests {
    use super::super::strain_space::samples;
    use super::*;

    fn count(text: &str, what: &str) -> usize {
        text.lines().filter(|line| line.contains(what)).count()
    }

    /// Claim: every triangle and every piece of a path is painted once, the same picture gives the same bytes, and axes
    /// and scale have their names and numbers.
    #[test]
    fn everything_is_drawn_once() {
        let surface = samples::cap(5);
        let point = |x: f64| PathPoint { strain: Vec3::new(x, 0.0, x * x), curvature: x };
        let path = [0.0, 0.5, 1.0].map(point).to_vec();
        let text = svg(&surface, std::slice::from_ref(&path), "a & b");
        assert!(text.contains("<title>a &amp; b</title>"));
        assert_eq!(count(&text, "Z\" fill"), surface.triangles.len());
        assert_eq!(count(&text, "stroke-width=\"2.4\""), 2);
        assert_eq!(count(&text, "<circle"), 1);
        for word in ["strain11", "strain22", "strain12", "curvature", ">\u{2212}0.5<", ">1<"] {
            assert!(text.contains(word), "{word}");
        }
        assert_eq!(text, svg(&surface, std::slice::from_ref(&path), "a & b"));
        let alone = svg(&StrainSurface::default(), &[path], "");
        assert_eq!([count(&alone, "Z\" fill"), count(&alone, "stroke-width=\"4.5\"")], [0, 2]);
    }

    /// Claim: what is nearer to the eye is painted later.
    #[test]
    fn near_triangles_cover_far_ones() {
        let corners = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
        let points = [0.0, 1.0].into_iter().flat_map(|z| corners.map(|[x, y]| Vec3::new(x, y, z)));
        let surface = StrainSurface {
            points: points.collect(),
            triangles: vec![[3, 4, 5], [0, 1, 2]],
            curvature: vec![-1.0, -1.0, -1.0, 1.0, 1.0, 1.0],
            theta: vec![[0.0; 2]; 6],
            ..StrainSurface::default()
        };
        let text = svg(&surface, &[], "");
        let painted: Vec<&str> = text.lines().filter(|line| line.contains("Z\" fill")).collect();
        // orange (much red) is positive and above
        let red = |line: &str| {
            let at = line.find("fill=\"#").unwrap() + 7;
            u8::from_str_radix(&line[at..at + 2], 16).unwrap()
        };
        assert!(red(painted[0]) < red(painted[1]), "{painted:?}");
    }

    /// Claim: points that are no numbers spoil nothing else, and a surface without points is a picture too.
    #[test]
    fn what_is_not_finite_is_left_out() {
        let mut surface = samples::cap(3);
        surface.points[4].x = f64::NAN;
        for surface in [surface, StrainSurface::default()] {
            let text = svg(&surface, &[], "");
            assert!(!text.contains("NaN") && !text.contains("inf"), "{text}");
        }
    }

    /// Claim: colours go from violet over pale to orange; ticks are round numbers within the box.
    #[test]
    fn colours_and_ticks() {
        assert_eq!([-1.0, 0.0, 1.0].map(colour), [COLOURS[0], COLOURS[2], COLOURS[4]]);
        assert_eq!(colour(f64::NAN), COLOURS[2]);
        let space = Space::new([-0.83, 0.0, 0.0], [0.21, 1.0, 3e-4]);
        assert_eq!(
            space.ticks(0).iter().map(|&t| number(t)).collect::<Vec<_>>(),
            ["\u{2212}0.8", "\u{2212}0.6", "\u{2212}0.4", "\u{2212}0.2", "0", "0.2"]
        );
        assert_eq!(space.ticks(1).len(), 6);
        assert!(space.ticks(2).len() >= 3);
    }
}
