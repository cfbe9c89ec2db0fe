//! The outlines of SVG shapes, in the coordinates of the shape.

use std::f64::consts::SQRT_2;

use kurbo::{BezPath, Ellipse, Point, Rect, RoundedRect, RoundedRectRadii, Shape};
use roxmltree::Node;
use svgtypes::{Length, LengthUnit, NumberListParser, SimplePathSegment, SimplifyingPathParser};

use crate::sheet::pattern_fault::PatternFault;

/// Largest distance of the cubic curves of a circle from it, relative to its radius.
const ROUND: f64 = 1e-6;

/// Returns the outline of a shape, empty if it has no size; `None` if the element is no shape, such as a text.
pub(super) fn outline(node: Node, units: &Units) -> Result<Option<BezPath>, PatternFault> {
    Ok(Some(match node.tag_name().name() {
        "line" => joined(&[units.point(node, "x1", "y1")?, units.point(node, "x2", "y2")?], false),
        "polyline" => joined(&points(node)?, false),
        "polygon" => joined(&points(node)?, true),
        "rect" => rectangle(node, units)?,
        "path" => path(node.attribute("d").unwrap_or_default())?,
        "circle" => {
            let radius = units.length(node, "r")?;
            ellipse(units.point(node, "cx", "cy")?, [radius; 2])
        }
        "ellipse" => {
            let radii = [units.length(node, "rx")?, units.length(node, "ry")?];
            ellipse(units.point(node, "cx", "cy")?, radii)
        }
        _ => return Ok(None),
    }))
}

/// The units of lengths that depend on the place of an element in its drawing.
#[derive(Clone, Copy)]
pub(super) struct Units {
    /// Width and height of what percentages are parts of; no numbers where they are not known.
    pub viewport: [f64; 2],
    /// Size of letters.
    pub em: f64,
}

impl Units {
    /// Returns a length in user units, of which an inch has 96; 0 if it is not given.
    pub(super) fn length(&self, node: Node, name: &str) -> Result<f64, PatternFault> {
        let Some(text) = node.attribute(name) else { return Ok(0.0) };
        let [width, height] = self.viewport;
        let whole = match name {
            "x" | "x1" | "x2" | "cx" | "rx" | "width" => width,
            "y" | "y1" | "y2" | "cy" | "ry" | "height" => height,
            _ => width.hypot(height) / SQRT_2,
        };
        let right = "a number, without a unit or with px, mm, cm, in, pt, pc or em, or with % of a known size";
        self.number(text, whole).ok_or_else(|| PatternFault::value(text, "length", right))
    }

    /// Returns the number that a length says; percentages are parts of `whole`.
    pub(super) fn number(&self, text: &str, whole: f64) -> Option<f64> {
        let length: Length = text.trim().parse().ok()?;
        let unit = match length.unit {
            LengthUnit::None | LengthUnit::Px => 1.0,
            LengthUnit::Mm => 96.0 / 25.4,
            LengthUnit::Cm => 96.0 / 2.54,
            LengthUnit::In => 96.0,
            LengthUnit::Pt => 96.0 / 72.0,
            LengthUnit::Pc => 16.0,
            LengthUnit::Em => self.em,
            LengthUnit::Ex => self.em / 2.0,
            LengthUnit::Percent => whole / 100.0,
        };
        Some(length.number * unit).filter(|number| number.is_finite())
    }

    fn point(&self, node: Node, x: &str, y: &str) -> Result<Point, PatternFault> {
        Ok(Point::new(self.length(node, x)?, self.length(node, y)?))
    }
}

/// Returns the points of a polyline or polygon.
fn points(node: Node) -> Result<Vec<Point>, PatternFault> {
    let text = node.attribute("points").unwrap_or_default();
    let wrong = || PatternFault::value(text, "list of points", "pairs of numbers, `0,0 10,0 10,10`");
    let numbers: Vec<f64> = NumberListParser::from(text).collect::<Result<_, _>>().map_err(|_| wrong())?;
    let (pairs, rest) = numbers.as_chunks::<2>();
    if rest.is_empty() { Ok(pairs.iter().map(|&[x, y]| Point::new(x, y)).collect()) } else { Err(wrong()) }
}

fn joined(points: &[Point], closed: bool) -> BezPath {
    let mut path = BezPath::new();
    for (k, point) in points.iter().enumerate() {
        if k == 0 { path.move_to(*point) } else { path.line_to(*point) }
    }
    if closed && points.len() > 2 {
        path.close_path();
    }
    path
}

fn ellipse(centre: Point, radii: [f64; 2]) -> BezPath {
    if !radii.iter().all(|radius| *radius > 0.0) {
        return BezPath::new();
    }
    Ellipse::new(centre, (radii[0], radii[1]), 0.0).to_path(ROUND * radii[0].max(radii[1]))
}

/// Returns a rectangle, whose corners are round if it has one radius or two equal ones.
fn rectangle(node: Node, units: &Units) -> Result<BezPath, PatternFault> {
    let size = (units.length(node, "width")?, units.length(node, "height")?);
    if !(size.0 > 0.0 && size.1 > 0.0) {
        return Ok(BezPath::new());
    }
    let rect = Rect::from_origin_size(units.point(node, "x", "y")?, size);
    let given = ["rx", "ry"].into_iter().filter(|name| !matches!(node.attribute(*name), None | Some("auto")));
    let radii: Vec<f64> = given.map(|name| units.length(node, name)).collect::<Result<_, _>>()?;
    match radii[..] {
        [] => {
            let corners = [(rect.x0, rect.y0), (rect.x1, rect.y0), (rect.x1, rect.y1), (rect.x0, rect.y1)];
            Ok(joined(&corners.map(Point::from), true))
        }
        [first, .., last] if first != last => {
            let right = "`rx` and `ry` should be equal";
            Err(PatternFault::Element { element: "a rect with elliptic corners".into(), right })
        }
        [radius, ..] => {
            let radii = RoundedRectRadii::from_single_radius(radius);
            Ok(RoundedRect::from_rect(rect, radii).to_path(ROUND * radius.abs()))
        }
    }
}

/// Returns the outline of the commands of a path.
fn path(commands: &str) -> Result<BezPath, PatternFault> {
    let mut path = BezPath::new();
    for command in SimplifyingPathParser::from(commands) {
        let right = "commands and numbers, `M 0 0 L 10 0 Z`";
        match command.map_err(|_| PatternFault::value(commands, "path", right))? {
            SimplePathSegment::MoveTo { x, y } => path.move_to((x, y)),
            SimplePathSegment::LineTo { x, y } => path.line_to((x, y)),
            SimplePathSegment::ClosePath => path.close_path(),
            SimplePathSegment::CurveTo { x1, y1, x2, y2, x, y } => path.curve_to((x1, y1), (x2, y2), (x, y)),
            SimplePathSegment::Quadratic { x1, y1, x, y } => path.quad_to((x1, y1), (x, y)),
        }
    }
    Ok(path)
}
