//! Outlines of straight lines and curves, and the lines that draw them.

use kurbo::{BezPath, PathEl, Point, Rect};

use super::line::{DrawnLines, PatternLine};
use crate::math::Vec2;
use crate::sheet::assignment::Assignment;

/// Largest distance of a polyline from its curve, relative to the extent of the drawing: a quarter of a circle as large
/// as the drawing has about twelve sides.
const FLATNESS: f64 = 1e-3;

/// A shape of a drawing.
pub(super) struct Outline {
    /// Its outline in coordinates of the sheet.
    pub path: BezPath,
    /// The line of which each of its sides is a copy.
    pub line: PatternLine,
    /// Whether a name says the letter of the line, and not its colour alone.
    pub named: bool,
}

impl Outline {
    /// Returns the line of the sides. In a drawing whose lines are all `boundaries` colours say nothing: a line without
    /// a name is plain.
    fn meant(&self, boundaries: bool) -> PatternLine {
        if boundaries && !self.named && !self.line.auxiliary {
            PatternLine { letter: Assignment::Unassigned, contour: true, ..self.line }
        } else {
            self.line
        }
    }
}

/// Adds the sides of outlines to the lines of a drawing; curves become polylines, and are counted.
pub(super) fn draw(outlines: &[Outline], drawn: &mut DrawnLines) {
    let finite = outlines.iter().map(|outline| outline.path.control_box()).filter(Rect::is_finite);
    let bounds = finite.reduce(|all, one| all.union(one)).unwrap_or_default();
    let tolerance = FLATNESS * bounds.width().max(bounds.height());
    let is_curved = |part: PathEl| matches!(part, PathEl::QuadTo(..) | PathEl::CurveTo(..));
    let curved = outlines.iter().filter(|outline| outline.path.iter().any(is_curved)).count();
    if curved > 0 {
        drawn.redrawing.curves = Some((curved, tolerance));
    }
    let boundaries = outlines.iter().all(|Outline { line, .. }| line.auxiliary || line.letter == Assignment::Boundary);
    for outline in outlines {
        let line = outline.meant(boundaries);
        let [mut first, mut at] = [Point::ZERO; 2];
        let mut side = |from: Point, to: Point| {
            let ends = [from, to].map(|end| Vec2::new(end.x, end.y));
            drawn.push(PatternLine { ends, ..line });
        };
        kurbo::flatten(&outline.path, tolerance.max(f64::MIN_POSITIVE), |part| match part {
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
