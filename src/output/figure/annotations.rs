//! Annotations on the figure of a sheet: loads as arrows, and the numbers of vertices.

use super::axes::rounded;
use super::canvas::Canvas;
use super::palette::{Colour, INK};
use super::style::{Font, PaperPoint, Style};
use crate::math::{Vec3, bounds};

/// Length of the arrow of the largest load, relative to the diagonal of the box around the sheet.
const LONGEST: f64 = 0.15;
/// Colour of loads.
const LOAD: Colour = Colour(30, 110, 60);
/// Length and half the width of the head of an arrow.
const HEAD: [f64; 2] = [13.0, 5.0];

/// Additions to the figure of a sheet.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Annotations {
    /// Points with loads, and the forces on them.
    pub loads: Vec<(usize, Vec3)>,
    /// Whether vertices have their numbers.
    pub numbers: bool,
}

impl Annotations {
    /// Returns the start and the tip of the arrow of each load, in space; the lengths are proportional to the forces.
    pub(super) fn arrows(&self, points: &[Vec3]) -> Vec<[Vec3; 2]> {
        let finite = points.iter().filter(|point| point.iter().all(|x| x.is_finite()));
        let [low, high] = bounds(finite);
        let scale = LONGEST * (high - low).norm() / self.largest().max(f64::MIN_POSITIVE);
        self.loads.iter().map(|&(point, force)| [points[point], points[point] + force * scale]).collect()
    }

    /// Returns the magnitude of the largest load; 0 without loads.
    pub(super) fn largest(&self) -> f64 {
        self.loads.iter().map(|(_, force)| force.norm()).fold(0.0, f64::max)
    }
}

/// Draws an arrow between two places; a dot if they nearly coincide, as for a load along the line of sight.
pub(super) fn arrow(canvas: &mut Canvas, [start, tip]: [PaperPoint; 2]) {
    let along = [tip[0] - start[0], tip[1] - start[1]];
    let length = along[0].hypot(along[1]);
    if length <= HEAD[0] {
        canvas.circle(start, HEAD[1], Style::area(LOAD));
        return;
    }
    let unit = along.map(|x| x / length);
    let neck = [0, 1].map(|k| tip[k] - HEAD[0] * unit[k]);
    let corner = |side: f64| [neck[0] - side * HEAD[1] * unit[1], neck[1] + side * HEAD[1] * unit[0]];
    canvas.line(&[start, neck], Style::line(LOAD, 2.5));
    canvas.polygon(&[tip, corner(1.0), corner(-1.0)], Style::area(LOAD));
}

/// Writes beside an arrow at `place` that arrows are loads, and how large the largest is.
pub(super) fn key(canvas: &mut Canvas, place: PaperPoint, largest: f64) {
    let [x, y] = place;
    arrow(canvas, [[x, y], [x + 40.0, y]]);
    canvas.text([x + 52.0, y + 6.5], &format!("load, at most {}", rounded(largest, 3)), Font::LABEL);
}

/// Writes the numbers of vertices at their places, on a light ground.
pub(super) fn vertex_numbers(canvas: &mut Canvas, vertices: impl Iterator<Item = (usize, PaperPoint)>) {
    let font = Font { size: 14.0, ..Font::LABEL }.middle();
    for (vertex, [x, y]) in vertices.filter(|(_, place)| place.iter().all(|x| x.is_finite())) {
        let words = vertex.to_string();
        let radius = 4.0 + 0.5 * font.width(&words).max(font.size);
        let ground = Style {
            fill: Some(Colour(255, 255, 255)),
            stroke: Some((INK, 0.8)),
            opacity: Some(0.85),
            ..Style::default()
        };
        canvas.circle([x, y], radius, ground);
        canvas.text([x, y + 5.0], &words, font);
    }
}

#[cfg(test)]
mod tests {
    use super::super::canvas::Caption;
    use super::super::sheet::svg;
    use super::*;
    use crate::output::error::ShapeError;
    use crate::output::test_samples as samples;

    fn drawn(added: &Annotations) -> Result<String, ShapeError> {
        svg(&samples::hinge(0.3), added, &Caption { title: "t".into(), state: "s".into() })
    }

    /// Claim: every load has its arrow, as long as its force, and the key says how large the largest is; a load on a
    /// point that is not there is an error. Source: the arrows of a sheet whose box has the diagonal `d`.
    #[test]
    fn loads_have_arrows() {
        let points = samples::hinge(0.3).points;
        let added = Annotations { loads: vec![(0, Vec3::z()), (2, -0.5 * Vec3::x())], numbers: false };
        let lengths: Vec<f64> = added.arrows(&points).iter().map(|[start, tip]| (tip - start).norm()).collect();
        assert!((lengths[0] / lengths[1] - 2.0).abs() < 1e-12 && lengths[0] > 0.1, "{lengths:?}");
        let (bare, text) = (drawn(&Annotations::default()).unwrap(), drawn(&added).unwrap());
        let heads = |text: &str| text.matches(&format!("fill=\"{LOAD}\"")).count();
        assert_eq!((heads(&bare), heads(&text)), (0, 3));
        assert!(text.contains("load, at most 1<"), "{text}");
        let wrong = Annotations { loads: vec![(4, Vec3::z())], numbers: false };
        assert_eq!(drawn(&wrong), Err(ShapeError::NoSuchPoint { point: 4, count: 4 }));
    }

    /// Claim: every vertex has its number where it is asked for, and nowhere else.
    #[test]
    fn vertices_have_numbers() {
        let count = |numbers: bool| {
            let text = drawn(&Annotations { loads: vec![], numbers }).unwrap();
            (0..4).map(|vertex| text.matches(&format!(">{vertex}</text>")).count()).collect::<Vec<_>>()
        };
        assert_eq!((count(true), count(false)), (vec![1; 4], vec![0; 4]));
    }
}
