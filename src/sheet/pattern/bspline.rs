//! B-splines as curves of Bezier.

use kurbo::{BezPath, Point};

/// A curve of polynomials of one degree between its knots (de Boor, "A Practical Guide to Splines", 1978, chapter 9).
pub(super) struct BSpline {
    degree: usize,
    knots: Vec<f64>,
    control: Vec<Point>,
}

impl BSpline {
    /// Returns the curve of these control points; `None` where the degree is not 1 to 3, where there is not one knot
    /// more than control points and degree together, or where a knot is less than the one before.
    pub(super) fn new(degree: usize, knots: Vec<f64>, control: Vec<Point>) -> Option<Self> {
        let fits = (1..=3).contains(&degree) && control.len() > degree && knots.len() == control.len() + degree + 1;
        (fits && knots.is_sorted()).then_some(Self { degree, knots, control })
    }

    /// Returns the curve from its first to its last inner knot.
    pub(super) fn path(&self) -> BezPath {
        let (degree, mut path) = (self.degree, BezPath::new());
        for span in degree..self.control.len() {
            let [from, to] = [self.knots[span], self.knots[span + 1]];
            if from == to {
                continue;
            }
            let corner = |later: usize| {
                let at: Vec<f64> = (0..degree).map(|k| if k < later { to } else { from }).collect();
                self.blossom(span, &at)
            };
            if path.is_empty() {
                path.move_to(corner(0));
            }
            match degree {
                1 => path.line_to(corner(1)),
                2 => path.quad_to(corner(1), corner(2)),
                _ => path.curve_to(corner(1), corner(2), corner(3)),
            }
        }
        path
    }

    /// Returns the value of the symmetric function of as many arguments as the degree that is linear in each, and for
    /// equal arguments is the curve between knot `span` and the next one.
    fn blossom(&self, span: usize, at: &[f64]) -> Point {
        let mut points = self.control[span - self.degree..=span].to_vec();
        for (level, argument) in at.iter().enumerate() {
            for k in (level + 1..=self.degree).rev() {
                let [before, after] = [self.knots[span + k - self.degree], self.knots[span + k - level]];
                points[k] = points[k - 1].lerp(points[k], (argument - before) / (after - before));
            }
        }
        points[self.degree]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use kurbo::{ParamCurve, PathSeg};

    /// Returns the value of a B-spline by the recursion of Cox and de Boor, which shares nothing with blossoms.
    fn value(spline: &BSpline, at: f64) -> Point {
        fn basis(knots: &[f64], k: usize, degree: usize, at: f64) -> f64 {
            if degree == 0 {
                return f64::from(knots[k] <= at && at < knots[k + 1]);
            }
            let part = |first: usize, rising: bool| {
                let width = knots[first + degree] - knots[first];
                let along = if rising { at - knots[first] } else { knots[first + degree] - at };
                if width == 0.0 { 0.0 } else { along / width * basis(knots, first, degree - 1, at) }
            };
            part(k, true) + part(k + 1, false)
        }
        let weighted = |(k, point): (usize, &Point)| point.to_vec2() * basis(&spline.knots, k, spline.degree, at);
        spline.control.iter().enumerate().map(weighted).fold(Point::ZERO, |sum, part| sum + part)
    }

    /// Claim: curves of degree 1 to 3, clamped or not, with double knots, agree with the recursion of Cox and de Boor.
    /// Tolerance: a few roundings of coordinates below 10.
    #[test]
    fn curves_are_those_of_their_basis() {
        let control = [[0.0, 0.0], [1.0, 2.0], [3.0, -1.0], [4.0, 4.0], [7.0, 0.5], [9.0, 3.0]];
        let control = control.map(|[x, y]| Point::new(x, y)).to_vec();
        let knots = [
            (1, vec![0.0, 0.0, 1.0, 2.0, 2.5, 4.0, 5.0, 5.0]),
            (2, vec![0.0, 0.0, 0.0, 1.0, 1.0, 3.0, 4.0, 4.0, 4.0]),
            (3, vec![0.0, 0.0, 0.0, 0.0, 1.0, 2.5, 3.0, 3.0, 3.0, 3.0]),
            (3, vec![0.0, 1.0, 2.0, 3.0, 3.5, 4.0, 5.0, 6.0, 7.0, 8.0]),
        ];
        for (degree, knots) in knots {
            let spline = BSpline::new(degree, knots.clone(), control.clone()).unwrap();
            let spans: Vec<[f64; 2]> = (degree..6).map(|k| [knots[k], knots[k + 1]]).filter(|[a, b]| a < b).collect();
            let path = spline.path();
            let segments: Vec<PathSeg> = path.segments().collect();
            assert_eq!(segments.len(), spans.len());
            for (segment, [from, to]) in segments.iter().zip(spans) {
                for part in [0.0, 0.3, 0.9] {
                    let error = segment.eval(part) - value(&spline, from + part * (to - from));
                    assert!(error.hypot() < 1e-13, "degree {degree}: {error:?}");
                }
            }
        }
        assert!(BSpline::new(3, vec![0.0; 9], control.clone()).is_none());
        assert!(BSpline::new(4, vec![0.0; 11], control).is_none());
    }
}
