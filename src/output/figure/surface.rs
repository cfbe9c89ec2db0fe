//! Figure of a surface of folded states, or of trajectories alone: an oblique view of the space of lattice strains,
//! coloured by signed curvature.
//!
//! Every axis is scaled to its own range; the eye is on the side of the box where the drawn state is. Violet means
//! negative curvature, orange positive, pale zero. Trajectories on a surface are dark; without a surface they have the
//! colours of their curvatures, and their projections are drawn on the floor of the box. If states of equal strain and
//! opposite curvature would hide each other (for example a sheet and its mirror image), the states of positive and of
//! negative curvature are drawn side by side.

use std::collections::HashMap;

use super::axes::{Axis, Scale, below, rounded, unit};
use super::canvas::{Canvas, Caption, HEAD, MARGIN, Mark};
use super::hidden::{Piece, back_to_front};
use super::palette::{CURVATURE, Colour, GRID, INK, PANE, PAPER, SHADOW};
use super::projection::Projection;
use super::style::{Area, Font, PaperPoint, Style};
use crate::math::Vec3;
use crate::numerics::larger;
use crate::output::StrainSurface;
use crate::output::error::ShapeError;

const AXES: [&str; 3] = ["strain11", "strain22", "strain12"];
/// Ranges of strain that count as rounding errors: relative to the largest range, and absolute.
const STRAIN_NOISE: [f64; 2] = [1e-7, 1e-12];
/// Rotation angle from a cell to the next (curvature times the length of a cell), in radians, that counts as rounding
/// error.
const TURN_NOISE: f64 = 1e-9;
/// Mean of the colour components of the palest line.
const PALEST: f64 = 185.0;
/// Distance, in sides of the box, by which trajectories on a surface are drawn nearer to the eye than the surface.
const LIFT: f64 = 0.008;
/// Curvature relative to the largest one below which a state counts neither as positive nor as negative.
const NO_SIDE: f64 = 0.05;
/// Least fraction of the states of each sign that lies on states of the other sign if both are drawn side by side.
const HIDDEN: f64 = 0.25;

/// A state on a trajectory.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrajectoryPoint {
    /// Lattice strains `(strain11, strain22, strain12)`.
    pub strain: Vec3,
    /// Signed curvature.
    pub curvature: f64,
    /// The larger of the two rotation angles from a cell to the next, in radians.
    pub turn: f64,
}

impl TrajectoryPoint {
    /// Returns the state with these lattice strains, signed curvature, and rotation angles from a cell to the next.
    pub(crate) fn new(strain: Vec3, curvature: f64, [theta1, theta2]: [f64; 2]) -> Self {
        Self { strain, curvature, turn: larger(theta1.abs(), theta2.abs()) }
    }
}

/// Returns the figure of a surface with trajectories on it, or of trajectories alone if the surface is empty.
///
/// # Errors
/// The first inconsistent array of the surface.
pub fn svg(surface: &StrainSurface, paths: &[Vec<TrajectoryPoint>], caption: &Caption) -> Result<String, ShapeError> {
    surface.check()?;
    Ok(drawn(surface, paths, caption).finish())
}

fn drawn(surface: &StrainSurface, paths: &[Vec<TrajectoryPoint>], caption: &Caption) -> Canvas {
    let scene = StateBox::new(surface, paths);
    let apart = [(1.0, "curvature > 0"), (-1.0, "curvature < 0")];
    let sides: &[(f64, &str)] = if scene.covers_itself() { &apart } else { &[(0.0, "")] };
    let layout = if sides.len() > 1 { &TWO } else { &ONE };
    let mut canvas = Canvas::new(layout.height, caption);
    for (&(side, title), &middle) in sides.iter().zip(layout.middles) {
        let space = DrawnBox { axes: &scene.axes, view: scene.view, near: scene.near, middle, scale: layout.scale };
        panes(&mut canvas, &space);
        scene.paint(&mut canvas, &space, side);
        axes(&mut canvas, &space);
        if !title.is_empty() {
            canvas.text([middle[0], HEAD + 22.0], title, Font::LABEL.bold().middle());
        }
    }
    scene.bar(&mut canvas, layout.bar);
    scene.legend(&mut canvas, layout.height - 54.0, sides.len() > 1);
    canvas
}

/// Positions of the panels and the colour bar.
struct FigureLayout {
    height: f64,
    middles: &'static [PaperPoint],
    /// Length of a side of the box in the figure.
    scale: f64,
    bar: Area,
}

const ONE: FigureLayout = FigureLayout {
    height: 1010.0,
    middles: &[[560.0, 498.0]],
    scale: 530.0,
    bar: Area { low: [1080.0, 280.0], high: [1102.0, 700.0] },
};
const TWO: FigureLayout = FigureLayout {
    height: 780.0,
    middles: &[[312.0, 390.0], [830.0, 390.0]],
    scale: 330.0,
    bar: Area { low: [1100.0, 230.0], high: [1118.0, 530.0] },
};

/// Whether a panel shows the states of this curvature: those of the sign of `side`, all for 0.
fn is_on(side: f64, curvature: f64) -> bool {
    side == 0.0 || (curvature >= 0.0) == (side > 0.0)
}

/// A segment of a trajectory in the box: its ends and its mean curvature.
type Stretch = ([Vec3; 2], f64);

/// The states in a box with sides of length 1 and its centre at 0.
struct StateBox<'a> {
    axes: [Axis; 3],
    view: Projection,
    /// Coordinates x and y, 0.5 or -0.5, of the sides of the box that face the eye; the eye is above the box.
    near: [f64; 2],
    surface: &'a StrainSurface,
    places: Vec<Vec3>,
    stretches: Vec<Stretch>,
    /// Largest magnitude of the curvature; if all curvatures are rounding errors, `Err` with a bound on them.
    largest: Result<f64, f64>,
}

impl<'a> StateBox<'a> {
    fn new(surface: &'a StrainSurface, paths: &[Vec<TrajectoryPoint>]) -> Self {
        let along = || paths.iter().flatten();
        let strains = || surface.points.iter().copied().chain(along().map(|point| point.strain));
        let axes = axes_around(strains);
        // the drawn state is at strain 0
        let near = [0, 1].map(|k| if axes[k].middle() > 0.0 { -0.5 } else { 0.5 });
        let boxed = |strain: &Vec3| Vec3::from_fn(|k, _| axes[k].part(strain[k]) - 0.5);
        let places = surface.points.iter().map(boxed).collect();
        let stretch = |ends: &[TrajectoryPoint]| {
            ([boxed(&ends[0].strain), boxed(&ends[1].strain)], one_sided_mean(&[ends[0].curvature, ends[1].curvature]))
        };
        let stretches = paths.iter().flat_map(|path| path.windows(2).map(stretch)).collect();
        let largest = |values: &mut dyn Iterator<Item = f64>| {
            values.filter(|value| value.is_finite()).fold(0.0f64, |most, value| most.max(value.abs()))
        };
        let turn = largest(&mut surface.theta.iter().flatten().copied().chain(along().map(|point| point.turn)));
        let curvature = largest(&mut surface.curvature.iter().copied().chain(along().map(|point| point.curvature)));
        let largest = if turn > TURN_NOISE { Ok(curvature) } else { Err(curvature) };
        Self { view: Projection::axonometric(near.map(f64::signum)), axes, near, surface, places, stretches, largest }
    }

    /// Returns a curvature relative to the largest one.
    fn part(&self, curvature: f64) -> f64 {
        self.largest.map_or(0.0, |largest| curvature / largest.max(f64::MIN_POSITIVE))
    }

    /// Returns the mean curvature of a triangle.
    fn curvature(&self, triangle: &[usize; 3]) -> f64 {
        one_sided_mean(&triangle.map(|point| self.surface.curvature[point]))
    }

    /// Whether many states of positive and of negative curvature are at the same strains.
    fn covers_itself(&self) -> bool {
        let ends = self.stretches.iter().flat_map(|([a, _], curvature)| [(*a, *curvature)]);
        let states = self.places.iter().copied().zip(self.surface.curvature.iter().copied()).chain(ends);
        let states: Vec<(Vec3, f64)> = states.filter(|(_, k)| self.part(*k).abs() > NO_SIDE).collect();
        let (up, down): (Vec<_>, Vec<_>) = states.into_iter().partition(|(_, curvature)| *curvature > 0.0);
        let triangles = self.surface.triangles.iter().map(|&[a, b, _]| self.places[a] - self.places[b]);
        let steps = triangles.chain(self.stretches.iter().map(|([a, b], _)| a - b));
        let lengths: Vec<f64> = steps.map(|step| step.norm()).filter(|length| length.is_finite()).collect();
        let near = 0.5 * lengths.iter().sum::<f64>() / lengths.len().max(1) as f64;
        let part = |of: &[(Vec3, f64)], on: &[(Vec3, f64)]| on_others(of, on, near) >= HIDDEN * of.len() as f64;
        !up.is_empty() && !down.is_empty() && part(&up, &down) && part(&down, &up)
    }

    /// Draws the triangles and segments of one sign of curvature from back to front, and the drawn state.
    fn paint(&self, canvas: &mut Canvas, panel: &DrawnBox<'_>, side: f64) {
        let alone = self.surface.triangles.is_empty();
        let lift = self.view.toward * if alone { 0.0 } else { LIFT };
        let place = |boxed: Vec3| Vec3::from(self.view.place(&boxed));
        let triangles = self.surface.triangles.iter().filter(|triangle| is_on(side, self.curvature(triangle)));
        let triangles: Vec<&[usize; 3]> = triangles.collect();
        let stretches: Vec<&Stretch> = self.stretches.iter().filter(|(_, k)| is_on(side, *k)).collect();
        let faces = triangles.iter().map(|triangle| triangle.map(|point| place(self.places[point])).to_vec());
        let lines = stretches.iter().map(|(ends, _)| ends.map(|end| place(end + lift)).to_vec());
        let pieces = faces.chain(lines).enumerate().map(|(item, corners)| Piece::new(corners, item)).collect();
        canvas.group(0.6);
        if alone {
            let floor = |end: Vec3| panel.at(Vec3::new(end.x, end.y, -0.5));
            stretches.iter().for_each(|(ends, _)| canvas.line(&ends.map(floor), Style::line(SHADOW.darker(0.9), 2.0)));
        }
        for Piece { corners, item, .. } in back_to_front(pieces) {
            let places: Vec<PaperPoint> = corners.iter().map(|corner| panel.on_paper(corner)).collect();
            match item.checked_sub(triangles.len()) {
                None => canvas.polygon(&places, Style::tile(self.lit(triangles[item]))),
                Some(line) if alone => canvas.line(&places, Style::line(self.shade(stretches[line].1), 4.5)),
                Some(_) => canvas.line(&places, Style::line(INK, 2.4)),
            }
        }
        // the hidden parts of trajectories, faint
        for (ends, _) in stretches.iter().filter(|_| !alone) {
            canvas.line(&ends.map(|end| panel.at(end)), Style::line(INK, 1.3).opacity(0.4));
        }
        canvas.end();
        let drawn = panel.at(Vec3::from_fn(|k, _| self.axes[k].part(0.0) - 0.5));
        canvas.circle(drawn, 6.0, Style::area(INK).outlined(PAPER, 1.5));
    }

    /// Returns the colour of a triangle, darker if it faces away from the light.
    fn lit(&self, triangle: &[usize; 3]) -> Colour {
        let Projection { toward, up, right, .. } = self.view;
        let [a, b, c] = triangle.map(|point| self.places[point]);
        let normal = (b - a).cross(&(c - a)).try_normalize(0.0).unwrap_or(toward);
        let light = (toward * 0.5 + up * 0.8 - right * 0.4).normalize();
        let facing = if normal.dot(&toward) < 0.0 { -normal } else { normal };
        let colour = CURVATURE.at(0.5 + 0.5 * self.part(self.curvature(triangle)));
        colour.darker(0.78 + 0.22 * facing.dot(&light).max(0.0))
    }

    /// Returns the colour of a line, darkened if it would be too pale on paper.
    fn shade(&self, curvature: f64) -> Colour {
        let full = CURVATURE.at(0.5 + 0.5 * self.part(curvature));
        full.darker((PALEST / full.brightness()).min(1.0))
    }

    /// Draws the colour bar, unless all curvatures are rounding errors.
    fn bar(&self, canvas: &mut Canvas, area: Area) {
        if let Ok(largest) = self.largest {
            let (unit, words) = unit(largest);
            let ticks = [-1.0, -0.5, 0.0, 0.5, 1.0].map(|part| (0.5 + 0.5 * part, rounded(part * largest / unit, 3)));
            canvas.colour_bar(area, CURVATURE, &format!("curvature{words}"), &ticks);
        }
    }

    fn legend(&self, canvas: &mut Canvas, level: f64, apart: bool) {
        let mut entries = vec![(Mark::Circle(6.0, Style::area(INK)), "drawn state".to_owned())];
        if self.surface.triangles.is_empty() {
            let floor = Style::line(SHADOW.darker(0.9), 2.0);
            entries.push((Mark::Line(floor), "projection on the floor".to_owned()));
        } else if !self.stretches.is_empty() {
            entries.push((Mark::Line(Style::line(INK, 2.4)), "trajectories, faint where hidden".to_owned()));
        }
        if apart {
            entries.push((Mark::None, "equal strains, opposite curvatures: drawn side by side".to_owned()));
        }
        if let Err(bound) = self.largest {
            let zero = if bound > 0.0 { format!(" (rounding {})", below(bound)) } else { String::new() };
            entries.push((Mark::None, format!("curvature = 0{zero}")));
        }
        for (axis, name) in self.axes.iter().zip(AXES) {
            let rounding = axis.rounding().map(|rounding| format!("{} ({rounding})", axis.named(name)));
            entries.extend(rounding.map(|words| (Mark::None, words)));
        }
        canvas.legend([MARGIN, level], &entries);
    }
}

/// Returns the axes that include all finite strains and the drawn state.
fn axes_around<I: Iterator<Item = Vec3>>(strains: impl Fn() -> I) -> [Axis; 3] {
    let finite = || strains().filter(|strain| strain.iter().all(|x| x.is_finite())).chain([Vec3::zeros()]);
    let extent = |k: usize| {
        let (low, high) = finite().fold((0.0f64, 0.0f64), |(low, high), s| (low.min(s[k]), high.max(s[k])));
        high - low
    };
    let [relative, least] = STRAIN_NOISE;
    let noise = (relative * extent(0).max(extent(1)).max(extent(2))).max(least);
    [0, 1, 2].map(|k| Axis::around(Scale::Linear, finite().map(|strain| strain[k]), noise))
}

/// Returns the number of `states` that have one of the `others` within the distance `near`.
fn on_others(states: &[(Vec3, f64)], others: &[(Vec3, f64)], near: f64) -> f64 {
    let cube = |place: &Vec3| [0, 1, 2].map(|k| (place[k] / near.max(f64::MIN_POSITIVE)).floor() as i64);
    let mut cubes: HashMap<[i64; 3], Vec<Vec3>> = HashMap::new();
    others.iter().for_each(|(place, _)| cubes.entry(cube(place)).or_default().push(*place));
    let around = (0..27).map(|k| [k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1]).collect::<Vec<[i64; 3]>>();
    let is_on = |place: &Vec3| {
        let [x, y, z] = cube(place);
        let within = |[a, b, c]: &[i64; 3]| cubes.get(&[x + a, y + b, z + c]);
        around.iter().filter_map(within).flatten().any(|other| (other - place).norm() <= near)
    };
    states.iter().filter(|(place, _)| is_on(place)).count() as f64
}

/// Returns the mean of neighbouring curvatures. If their sign jumps, that is, if it changes and none of them is small
/// compared with the others, it is the mean of those of the more frequent sign.
fn one_sided_mean(curvatures: &[f64]) -> f64 {
    let mean = |chosen: &[f64]| chosen.iter().sum::<f64>() / chosen.len() as f64;
    let (least, most) = curvatures.iter().fold((f64::INFINITY, 0.0f64), |(a, b), k| (a.min(k.abs()), b.max(k.abs())));
    let (up, down): (Vec<f64>, Vec<f64>) = curvatures.iter().partition(|k| **k >= 0.0);
    if up.is_empty() || down.is_empty() || least < 0.5 * most {
        return mean(curvatures);
    }
    mean(if up.len() >= down.len() { &up } else { &down })
}

/// The box in the figure.
struct DrawnBox<'a> {
    axes: &'a [Axis; 3],
    view: Projection,
    near: [f64; 2],
    middle: PaperPoint,
    scale: f64,
}

impl DrawnBox<'_> {
    /// Returns the point of the figure for a point of the box.
    fn at(&self, boxed: Vec3) -> PaperPoint {
        self.on_paper(&Vec3::from(self.view.place(&boxed)))
    }

    /// Returns the point of the figure for coordinates `(right, up, towards the eye)`.
    fn on_paper(&self, place: &Vec3) -> PaperPoint {
        [self.middle[0] + self.scale * place.x, self.middle[1] - self.scale * place.y]
    }
}

/// Draws the three far sides of the box with their grids.
fn panes(canvas: &mut Canvas, panel: &DrawnBox<'_>) {
    let [near_x, near_y] = panel.near;
    for (flat, side) in [(0, -near_x), (1, -near_y), (2, -0.5)] {
        let (u, v) = ((flat + 1) % 3, (flat + 2) % 3);
        let at = |a: f64, b: f64| {
            let mut place = Vec3::zeros();
            (place[flat], place[u], place[v]) = (side, a, b);
            panel.at(place)
        };
        let corners = [[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]].map(|[a, b]| at(a, b));
        canvas.polygon(&corners, Style::area(PANE).outlined(GRID, 1.0));
        for tick in panel.axes[u].ticks().iter().map(|tick| tick.part - 0.5) {
            canvas.line(&[at(tick, -0.5), at(tick, 0.5)], Style::line(GRID, 1.0));
        }
        for tick in panel.axes[v].ticks().iter().map(|tick| tick.part - 0.5) {
            canvas.line(&[at(-0.5, tick), at(0.5, tick)], Style::line(GRID, 1.0));
        }
    }
}

/// Draws labels and names at three edges of the box: the two nearest edges of its floor, and the left vertical one.
fn axes(canvas: &mut Canvas, panel: &DrawnBox<'_>) {
    let [x, y] = panel.near;
    let right = |[x, y]: &[f64; 2]| panel.at(Vec3::new(*x, *y, 0.0))[0];
    let left = if right(&[x, -y]) < right(&[-x, y]) { [x, -y] } else { [-x, y] };
    // the start of each axis
    let starts = [Vec3::new(-0.5, y, -0.5), Vec3::new(x, -0.5, -0.5), Vec3::new(left[0], left[1], -0.5)];
    let centre = panel.at(Vec3::new(0.0, 0.0, -0.5));
    let (mut names, paper) = (Vec::new(), canvas.paper());
    for (axis, start) in starts.into_iter().enumerate() {
        let at = |along: f64| {
            let mut place = start;
            place[axis] = along;
            panel.at(place)
        };
        canvas.line(&[at(-0.5), at(0.5)], Style::line(INK, 1.4));
        let middle = at(0.0);
        let outwards = [middle[0] - centre[0], middle[1] - centre[1]];
        let length = outwards[0].hypot(outwards[1]);
        let off = if axis == 2 { [-1.0, 0.0] } else { outwards.map(|x| x / length) };
        let font = if axis == 2 { Font::SMALL.end() } else { Font::SMALL.middle() };
        for tick in panel.axes[axis].ticks() {
            let [x, y] = at(tick.part - 0.5);
            let half = if axis == 2 { 0.0 } else { 0.35 * Font::SMALL.width(&tick.label) };
            let place = [x + (14.0 + half) * off[0], y + 20.0 * off[1] + 5.0];
            canvas.text_within(paper, [(place, font)], &tick.label);
        }
        names.push((axis, middle, off, at(0.5)));
    }
    for (axis, middle, off, top) in names {
        let name = panel.axes[axis].named(AXES[axis]);
        let font = Font::LABEL.bold().middle();
        if axis == 2 {
            canvas.text_within(paper, [([top[0], top[1] - 16.0], font)], &name);
            continue;
        }
        // as near to the axis as the labels allow
        let away = (11..30).map(|k| 8.0 * f64::from(k));
        let places = away.map(|away| [middle[0] + away * off[0], middle[1] + 0.8 * away * off[1] + 6.0]);
        canvas.text_within(paper, places.map(|place| (place, font)), &name);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::test_samples as samples;

    fn caption(title: &str) -> Caption {
        Caption { title: title.into(), state: "all states".into() }
    }

    fn count(text: &str, what: &str) -> usize {
        text.lines().filter(|line| line.contains(what)).count()
    }

    /// Returns the number of triangles that are painted.
    fn faces(text: &str) -> usize {
        let triangles = text.lines().filter(|line| line.contains("Z\" fill=") && line.matches(' ').count() == 8);
        triangles.filter(|line| line.contains("stroke=")).count()
    }

    fn point(x: f64, y: f64, curvature: f64) -> TrajectoryPoint {
        TrajectoryPoint { strain: Vec3::new(x, 0.0, y), curvature, turn: curvature }
    }

    fn alone(paths: &[Vec<TrajectoryPoint>]) -> String {
        svg(&StrainSurface::default(), paths, &caption("")).unwrap()
    }

    /// Claim: every triangle and every segment is painted once, equal data give equal bytes, and axes and colour bar
    /// have their names and labels, without overlaps.
    #[test]
    fn everything_is_drawn_once() {
        let surface = samples::cap(5);
        let path = [0.0, 0.5, 1.0].map(|x| point(x, x * x, x)).to_vec();
        let text = svg(&surface, std::slice::from_ref(&path), &caption("a & b")).unwrap();
        assert!(text.contains("<title>a &amp; b</title>"));
        assert_eq!(faces(&text), surface.triangles.len());
        assert!(count(&text, "stroke-width=\"2.4\"") > 2, "two pieces, where hidden cut, and the legend");
        assert_eq!(count(&text, "<circle"), 2);
        for word in ["strain11", "strain22", "strain12", "curvature", ">\u{2212}0.5<", ">1<"] {
            assert!(text.contains(word), "{word}");
        }
        assert_eq!(text, svg(&surface, std::slice::from_ref(&path), &caption("a & b")).unwrap());
        assert_eq!(drawn(&surface, std::slice::from_ref(&path), &caption("a")).crowded(), 0);
        let text = alone(std::slice::from_ref(&path));
        assert_eq!([faces(&text), count(&text, "stroke-width=\"4.5\"")], [0, 2]);
        let mut wrong = surface;
        wrong.theta.pop();
        assert!(svg(&wrong, &[], &caption("")).is_err());
    }

    /// Claim: triangles nearer to the eye are painted later.
    #[test]
    fn near_triangles_cover_far_ones() {
        let corners = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
        let points = [0.0, 1.0].into_iter().flat_map(|z| corners.map(|[x, y]| Vec3::new(x, y, z)));
        let surface = StrainSurface {
            points: points.collect(),
            triangles: vec![[3, 4, 5], [0, 1, 2]],
            curvature: vec![-1.0, -1.0, -1.0, 1.0, 1.0, 1.0],
            theta: vec![[0.1; 2]; 6],
            ..StrainSurface::default()
        };
        let scene = StateBox::new(&surface, &[]);
        let text = svg(&surface, &[], &caption("")).unwrap();
        let place = |face: usize| text.find(&format!("fill=\"{}\"", scene.lit(&surface.triangles[face]))).unwrap();
        assert!(place(1) < place(0), "the upper one is painted last");
    }

    /// Claim: curvatures and strains that are rounding errors are drawn as zero, are not coloured, and the legend gives
    /// their size; values that are small but above rounding are drawn.
    #[test]
    fn rounding_is_drawn_as_zero() {
        let path: Vec<TrajectoryPoint> =
            (0..9).map(|k| point(0.1 * f64::from(k), 2e-13 * f64::from(k % 3), 1e-16 * f64::from(k))).collect();
        let text = alone(std::slice::from_ref(&path));
        assert!(
            text.contains(">curvature = 0 (rounding below 8") && text.contains("strain12 = 0 (rounding below"),
            "{text}"
        );
        let colours = |text: &str| {
            let lines = text.lines().filter(|line| line.contains("stroke-width=\"4.5\""));
            lines
                .map(|line| line.split("stroke=\"").nth(1).unwrap()[..7].to_owned())
                .collect::<std::collections::HashSet<_>>()
        };
        assert_eq!(colours(&text).len(), 1);
        let small: Vec<TrajectoryPoint> = path.iter().map(|p| TrajectoryPoint { turn: 1e-3, ..*p }).collect();
        assert!(colours(&alone(&[small])).len() > 3);
    }

    /// Claim: two surfaces of equal strain and opposite curvature are drawn side by side, each triangle once and in the
    /// panel of its sign; surfaces of opposite curvature at different strains are drawn in one panel.
    #[test]
    fn coincident_sheets_are_apart() {
        let one = StrainSurface { curvature: vec![0.5; 25], ..samples::cap(5) };
        let twice = |shift: f64| StrainSurface {
            points: one.points.iter().copied().chain(one.points.iter().map(|p| p + Vec3::repeat(shift))).collect(),
            triangles: one.triangles.iter().copied().chain(one.triangles.iter().map(|t| t.map(|k| k + 25))).collect(),
            curvature: [vec![0.5; 25], vec![-0.5; 25]].concat(),
            theta: vec![[0.1; 2]; 50],
            ..StrainSurface::default()
        };
        let text = svg(&twice(0.0), &[], &caption("")).unwrap();
        assert!(
            text.contains("curvature &gt; 0") && text.contains("curvature &lt; 0") && text.contains("side by side")
        );
        assert_eq!(faces(&text), 64);
        assert_eq!(drawn(&twice(0.0), &[], &caption("a")).crowded(), 0);
        let apart = svg(&twice(1.0), &[], &caption("")).unwrap();
        assert!(!apart.contains("side by side") && faces(&apart) >= 64);
        let both =
            [1.0, -1.0].map(|sign| (0..9).map(|k| point(0.1 * f64::from(k), 0.0, sign * f64::from(k))).collect());
        assert!(alone(&both).contains("side by side"));
    }

    /// Claim: points that are not finite are left out, and the rest is drawn; a surface without points gives a figure
    /// too.
    #[test]
    fn what_is_not_finite_is_left_out() {
        let mut surface = samples::cap(3);
        surface.points[4].x = f64::NAN;
        for surface in [surface, StrainSurface::default()] {
            let text = svg(&surface, &[], &caption("")).unwrap();
            assert!(!text.contains("NaN") && !text.contains("inf"), "{text}");
        }
    }

    /// Claim: neighbouring curvatures of opposite signs, none of them small, do not average to a small value.
    #[test]
    fn jumps() {
        assert_eq!(one_sided_mean(&[1.75, -1.73]), 1.75);
        assert!((one_sided_mean(&[-0.06, 0.2, 0.1]) - 0.08).abs() <= 1e-15);
    }
}
