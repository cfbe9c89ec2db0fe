//! The outlines of SVG shapes, in the coordinates of the shape.

use kurbo::{BezPath, Ellipse, Point, Rect, RoundedRect, RoundedRectRadii, Shape};
use roxmltree::Node;
use svgtypes::{Length, LengthUnit, NumberListParser, SimplePathSegment, SimplifyingPathParser};

use crate::sheet::pattern_fault::PatternFault;

/// Largest distance of the cubic curves of a circle from it, relative to its radius.
const ROUND: f64 = 1e-6;

/// Returns the outline of a shape; `None` if the element is no shape, such as a text.
pub(super) fn outline(node: Node) -> Result<Option<BezPath>, PatternFault> {
    Ok(Some(match node.tag_name().name() {
        "line" => joined(&[point(node, "x1", "y1")?, point(node, "x2", "y2")?], false),
        "polyline" => joined(&points(node)?, false),
        "polygon" => joined(&points(node)?, true),
        "rect" => rectangle(node)?,
        "path" => path(node.attribute("d").unwrap_or_default())?,
        "circle" => {
            let radius = length(node, "r")?;
            ellipse(node, [radius; 2])?
        }
        "ellipse" => ellipse(node, [length(node, "rx")?, length(node, "ry")?])?,
        _ => return Ok(None),
    }))
}

/// Returns a length in user units, of which an inch has 96; 0 if it is not given.
pub(super) fn length(node: Node, name: &str) -> Result<f64, PatternFault> {
    let Some(text) = node.attribute(name) else { return Ok(0.0) };
    let length: Option<Length> = text.trim().parse().ok();
    let unit = |unit: LengthUnit| match unit {
        LengthUnit::None | LengthUnit::Px => Some(1.0),
        LengthUnit::Mm => Some(96.0 / 25.4),
        LengthUnit::Cm => Some(96.0 / 2.54),
        LengthUnit::In => Some(96.0),
        LengthUnit::Pt => Some(96.0 / 72.0),
        LengthUnit::Pc => Some(16.0),
        _ => None,
    };
    let number = length.and_then(|length| Some(length.number * unit(length.unit)?)).filter(|number| number.is_finite());
    number
        .ok_or_else(|| PatternFault::value(text, "length", "a number, without a unit or with px, mm, cm, in, pt or pc"))
}

fn point(node: Node, x: &str, y: &str) -> Result<Point, PatternFault> {
    Ok(Point::new(length(node, x)?, length(node, y)?))
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

fn ellipse(node: Node, radii: [f64; 2]) -> Result<BezPath, PatternFault> {
    let centre = point(node, "cx", "cy")?;
    Ok(Ellipse::new(centre, (radii[0], radii[1]), 0.0).to_path(ROUND * radii[0].abs().max(radii[1].abs())))
}

/// Returns a rectangle, whose corners are round if it has one radius or two equal ones.
fn rectangle(node: Node) -> Result<BezPath, PatternFault> {
    let rect = Rect::from_origin_size(point(node, "x", "y")?, (length(node, "width")?, length(node, "height")?));
    let mut radii = Vec::new();
    for name in ["rx", "ry"] {
        if !matches!(node.attribute(name), None | Some("auto")) {
            radii.push(length(node, name)?);
        }
    }
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
