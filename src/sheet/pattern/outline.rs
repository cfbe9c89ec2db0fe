//! Outlines of straight lines and curves, and the lines that draw them.

use kurbo::{BezPath, PathEl, Point, Rect};

use super::line::{DrawnLines, Line};
use crate::math::Vec2;

/// Largest distance of a polyline from its curve, relative to the extent of the drawing: a quarter of a circle as large
/// as the drawing has about twelve sides.
const FLATNESS: f64 = 1e-3;

/// A shape of a drawing: its outline in coordinates of the sheet, and the line of which each of its sides is a copy.
pub(super) type Outline = (BezPath, Line);

/// Adds the sides of outlines to the lines of a drawing; curves become polylines, and are counted.
pub(super) fn draw(outlines: &[Outline], drawn: &mut DrawnLines) {
    let finite = outlines.iter().map(|(path, _)| path.control_box()).filter(Rect::is_finite);
    let bounds = finite.reduce(|all, one| all.union(one)).unwrap_or_default();
    let tolerance = FLATNESS * bounds.width().max(bounds.height());
    let curved = outlines.iter().filter(|(path, _)| path.iter().any(|part| is_curved(&part))).count();
    if curved > 0 {
        drawn.redrawing.curves = Some((curved, tolerance));
    }
    for (path, line) in outlines {
        let [mut first, mut at] = [Point::ZERO; 2];
        let mut side = |from: Point, to: Point| {
            let ends = [from, to].map(|end| Vec2::new(end.x, end.y));
            drawn.push(Line { ends, ..*line });
        };
        kurbo::flatten(path, tolerance.max(f64::MIN_POSITIVE), |part| match part {
            PathEl::MoveTo(to) => [first, at] = [to; 2],
            PathEl::ClosePath => {
                side(at, first);
                at = first;
            }
            PathEl::LineTo(to) | PathEl::QuadTo(_, to) | PathEl::CurveTo(_, _, to) => {
                side(at, to);
                at = to;
            }
        });
    }
}

fn is_curved(part: &PathEl) -> bool {
    matches!(part, PathEl::QuadTo(..) | PathEl::CurveTo(..))
}
