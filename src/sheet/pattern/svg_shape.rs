//! The segments of SVG shapes, in the coordinates of the shape.

use roxmltree::Node;
use svgtypes::{Length, LengthUnit, NumberListParser, SimplePathSegment, SimplifyingPathParser};

use super::cp::value;
use crate::math::Vec2;
use crate::sheet::pattern_fault::PatternFault;

/// Straight pieces of a shape.
pub(super) type Segments = Vec<[Vec2; 2]>;

/// Returns the segments of a shape; `None` if the element is no shape, such as a text.
pub(super) fn segments(node: Node) -> Result<Option<Segments>, PatternFault> {
    Ok(Some(match node.tag_name().name() {
        "line" => vec![[point(node, "x1", "y1")?, point(node, "x2", "y2")?]],
        "polyline" => joined(&points(node)?, false),
        "polygon" => joined(&points(node)?, true),
        "rect" => rectangle(node)?,
        "path" => path(node.attribute("d").unwrap_or_default())?,
        name @ ("circle" | "ellipse") => return Err(curved(name)),
        _ => return Ok(None),
    }))
}

fn curved(element: &str) -> PatternFault {
    let right = "creases are straight: draw it with straight lines, or without a stroke";
    PatternFault::Element { element: format!("a curve (`{element}`)"), right }
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
    number.ok_or_else(|| value(text, "length", "a number, without a unit or with px, mm, cm, in, pt or pc"))
}

fn point(node: Node, x: &str, y: &str) -> Result<Vec2, PatternFault> {
    Ok(Vec2::new(length(node, x)?, length(node, y)?))
}

/// Returns the points of a polyline or polygon.
fn points(node: Node) -> Result<Vec<Vec2>, PatternFault> {
    let text = node.attribute("points").unwrap_or_default();
    let wrong = || value(text, "list of points", "pairs of numbers, `0,0 10,0 10,10`");
    let numbers: Vec<f64> = NumberListParser::from(text).collect::<Result<_, _>>().map_err(|_| wrong())?;
    let (pairs, rest) = numbers.as_chunks::<2>();
    if rest.is_empty() { Ok(pairs.iter().map(|&[x, y]| Vec2::new(x, y)).collect()) } else { Err(wrong()) }
}

fn joined(points: &[Vec2], closed: bool) -> Segments {
    let next = points.iter().skip(1).chain(points.first().filter(|_| closed && points.len() > 2));
    points.iter().zip(next).map(|(a, b)| [*a, *b]).collect()
}

fn rectangle(node: Node) -> Result<Segments, PatternFault> {
    let corner = point(node, "x", "y")?;
    let [width, height] = [length(node, "width")?, length(node, "height")?];
    if ["rx", "ry"].iter().any(|name| !matches!(node.attribute(*name), None | Some("0" | "auto"))) {
        return Err(curved("rect with round corners"));
    }
    let corners = [[0.0, 0.0], [width, 0.0], [width, height], [0.0, height]];
    Ok(joined(&corners.map(|[x, y]| corner + Vec2::new(x, y)), true))
}

/// Returns the segments of the commands of a path.
fn path(commands: &str) -> Result<Segments, PatternFault> {
    let mut segments = Segments::new();
    let [mut first, mut at] = [Vec2::zeros(); 2];
    for command in SimplifyingPathParser::from(commands) {
        let right = "commands and numbers, `M 0 0 L 10 0 Z`";
        match command.map_err(|_| value(commands, "path", right))? {
            SimplePathSegment::MoveTo { x, y } => {
                at = Vec2::new(x, y);
                first = at;
            }
            SimplePathSegment::LineTo { x, y } => {
                segments.push([at, Vec2::new(x, y)]);
                at = Vec2::new(x, y);
            }
            SimplePathSegment::ClosePath => {
                segments.push([at, first]);
                at = first;
            }
            SimplePathSegment::CurveTo { .. } | SimplePathSegment::Quadratic { .. } => return Err(curved("path")),
        }
    }
    Ok(segments)
}
