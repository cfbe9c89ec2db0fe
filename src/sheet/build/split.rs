//! Splits polygons into triangles by their shorter diagonals.
//!
//! A quadrilateral is split by the shorter of its diagonals; in a tie (1e-9 relative) by the diagonal through the
//! vertex that is listed first. From a larger polygon the ear with the shortest diagonal is cut repeatedly, with the
//! same rule for ties. An ear is a corner that turns left, seen along the polygon's normal, and whose triangle contains
//! no other corner. Corners at which the outline goes straight on, as crease patterns have them where a crease of a
//! neighbour ends, are no ears, so that the triangle beside them is not without area; up to [`STRAIGHT`] they count as
//! straight, since their coordinates are rounded.

use super::{Defect, Drawing, Identified, MeshPart, MeshProblem};
use crate::math::Vec3;
use crate::sheet::cell::{Corner, Triangle};

/// Least area of a triangle, relative to the square of its longest side.
const THINNEST: f64 = 1e-12;

/// Area of a triangle relative to the square of its longest side, up to which its corners count as lying on a line:
/// well above the rounding of coordinates of six digits, well below what is drawn on purpose.
const STRAIGHT: f64 = 1e-6;

/// A triangle, and the diagonal that separates it from its polygon.
pub(super) struct SplitTriangle {
    pub triangle: Triangle,
    /// The diagonal, by corners of the polygon and by drawn vertices; `None` for the last triangle of a polygon.
    pub diagonal: Option<([Corner; 2], [usize; 2])>,
}

/// Returns all triangles of all polygons, in the order of the file.
pub(super) fn triangles(
    drawn: &Drawing,
    cell: &Identified,
    polygons: &[Vec<Corner>],
) -> Result<Vec<SplitTriangle>, Defect> {
    let mut parts = Vec::new();
    for (f, polygon) in polygons.iter().enumerate() {
        // the positions of the cell, not those of the drawn copies, so that a file and its copy split alike
        let points: Vec<Vec3> = polygon.iter().map(|&c| position(drawn, cell, c)).collect();
        let not_simple = || Defect::new(MeshPart::Face(f), MeshProblem::NotSimple { face: drawn.name(f) });
        let cut = ears(&points, STRAIGHT).or_else(|| ears(&points, 0.0)).ok_or_else(not_simple)?;
        for (k, &corners) in cut.iter().enumerate() {
            check_area(drawn, f, &points, corners)?;
            let [before, _, after] = corners;
            let diagonal = (k + 1 < cut.len())
                .then(|| ([polygon[before], polygon[after]], [drawn.faces[f][before], drawn.faces[f][after]]));
            parts.push(SplitTriangle {
                triangle: Triangle { corners: corners.map(|c| polygon[c]), polygon: f },
                diagonal,
            });
        }
    }
    Ok(parts)
}

/// Returns the position of a corner in the drawing: that of the cell's vertex, moved into its cell.
pub(super) fn position(drawn: &Drawing, cell: &Identified, corner: Corner) -> Vec3 {
    drawn.copy(&drawn.coords[cell.homes[corner.vertex]], corner.shift)
}

fn check_area(drawn: &Drawing, f: usize, points: &[Vec3], corners: [usize; 3]) -> Result<(), Defect> {
    let [a, b, c] = corners.map(|k| points[k]);
    let area = (b - a).cross(&(c - a)).norm() / 2.0;
    let longest = (b - a).norm().max((c - b).norm()).max((a - c).norm());
    if area > THINNEST * longest * longest {
        return Ok(());
    }
    let triangle = corners.map(|k| drawn.name(drawn.faces[f][k]));
    Err(Defect::new(MeshPart::Face(f), MeshProblem::ZeroArea { face: drawn.name(f), triangle, area, longest }))
}

/// Returns the triangles `[before, tip, after]` of the polygon with these corners, none of them of an area of
/// `straight` or less relative to its longest side; `None` if a step finds no ear.
fn ears(points: &[Vec3], straight: f64) -> Option<Vec<[usize; 3]>> {
    let mut left: Vec<usize> = (0..points.len()).collect();
    let mut cut = Vec::with_capacity(points.len() - 2);
    if left.len() > 3 {
        let normal = newell(points);
        let mut lengths: Vec<_> = (0..left.len()).map(|k| ear(points, &left, k, (normal, straight))).collect();
        while left.len() > 3 {
            let tip = shortest(&left, &lengths)?;
            cut.push(around(&left, tip));
            left.remove(tip);
            lengths.remove(tip);
            for k in [tip + left.len() - 1, tip] {
                let k = k % left.len();
                lengths[k] = ear(points, &left, k, (normal, straight));
            }
        }
        let last = [left[0], left[1], left[2]];
        if doubled(points, last, normal) <= least(points, last, (normal, straight)) {
            return None;
        }
    }
    cut.push([left[0], left[1], left[2]]);
    Some(cut)
}

/// Returns twice the vector area of a polygon, about its first corner.
fn newell(points: &[Vec3]) -> Vec3 {
    points.windows(2).map(|w| (w[0] - points[0]).cross(&(w[1] - points[0]))).sum()
}

fn around(left: &[usize], k: usize) -> [usize; 3] {
    [left[(k + left.len() - 1) % left.len()], left[k], left[(k + 1) % left.len()]]
}

/// Returns twice the area of a triangle seen along `normal`, times the length of `normal`.
fn doubled(points: &[Vec3], [a, b, c]: [usize; 3], normal: Vec3) -> f64 {
    (points[b] - points[a]).cross(&(points[c] - points[a])).dot(&normal)
}

/// Returns the value of [`doubled`] of a triangle up to which its corners count as lying on a line.
fn least(points: &[Vec3], [a, b, c]: [usize; 3], (normal, straight): (Vec3, f64)) -> f64 {
    let sides = [points[b] - points[a], points[c] - points[b], points[a] - points[c]];
    let longest = sides.iter().map(Vec3::norm_squared).fold(0.0, f64::max);
    2.0 * straight * longest * normal.norm()
}

/// Returns the length of the diagonal that cuts off corner `k`; `None` if `k` is not an ear.
fn ear(points: &[Vec3], left: &[usize], k: usize, tolerance: (Vec3, f64)) -> Option<f64> {
    let [a, tip, b] = around(left, k);
    let (normal, least) = (tolerance.0, least(points, [a, tip, b], tolerance));
    let inside = |p: usize| {
        p != a
            && p != tip
            && p != b
            && [[a, tip, p], [tip, b, p], [b, a, p]].iter().all(|&t| doubled(points, t, normal) >= -least)
    };
    let good = doubled(points, [a, tip, b], normal) > least && !left.iter().any(|&p| inside(p));
    good.then(|| (points[b] - points[a]).norm())
}

/// Returns the position in `left` of the ear with the shortest diagonal; in a tie the one whose diagonal ends at
/// corner 0.
fn shortest(left: &[usize], lengths: &[Option<f64>]) -> Option<usize> {
    let least = lengths.iter().flatten().copied().reduce(f64::min)?;
    let equal = |k: &usize| lengths[*k].is_some_and(|l| l <= least * (1.0 + 1e-9));
    let through_first = |k: &usize| [around(left, *k)[0], around(left, *k)[2]].contains(&0);
    let mut ties = (0..left.len()).filter(equal);
    ties.clone().find(through_first).or_else(|| ties.next())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points(xy: &[[f64; 2]]) -> Vec<Vec3> {
        xy.iter().map(|p| Vec3::new(p[0], p[1], 0.0)).collect()
    }

    /// Claim: a quadrilateral is split by the shorter diagonal, in a tie by the one through the first vertex.
    #[test]
    fn quadrilaterals() {
        let square = points(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]);
        assert_eq!(ears(&square, STRAIGHT).unwrap(), [[0, 1, 2], [0, 2, 3]]);
        let lean = points(&[[0.0, 0.0], [1.0, 0.0], [1.4, 1.0], [0.4, 1.0]]);
        assert_eq!(ears(&lean, STRAIGHT).unwrap(), [[3, 0, 1], [1, 2, 3]]);
    }

    /// Claim: a corner on a straight side, up to rounding of six digits to either side, is joined to a corner that is
    /// not on that side, and no triangle is thin, also where the diagonal along the side is the shortest. A square with
    /// such corners on all sides has six triangles of its area.
    #[test]
    fn straight_corners() {
        for off in [0.0, 1e-17, -1e-17, 5e-7, -5e-7] {
            let kite = points(&[[0.0, 0.0], [1.0, off], [2.0, 0.0], [1.0, 5.0]]);
            assert_eq!(ears(&kite, STRAIGHT).unwrap(), [[3, 0, 1], [1, 2, 3]], "{off}");
            let square = [
                [0.0, 0.0],
                [1.0, off],
                [2.0, 0.0],
                [2.0 + off, 1.0],
                [2.0, 2.0],
                [1.0, 2.0 - off],
                [0.0, 2.0],
                [off, 1.0],
            ];
            let square = points(&square);
            let cut = ears(&square, STRAIGHT).unwrap();
            let areas: Vec<f64> = cut.iter().map(|&t| doubled(&square, t, Vec3::z()) / 2.0).collect();
            assert_eq!(cut.len(), 6);
            assert!(areas.iter().all(|area| *area > 0.4), "{off}: {areas:?}");
            assert!((areas.iter().sum::<f64>() - 4.0).abs() < 1e-5, "{off}: {areas:?}");
        }
    }

    /// Claim: at a reflex corner the inner diagonal is taken although the outer one is shorter.
    #[test]
    fn arrowhead() {
        let arrow = points(&[[0.0, 0.0], [4.0, -1.0], [3.5, 0.1], [4.0, 1.2]]);
        assert_eq!(ears(&arrow, STRAIGHT).unwrap(), [[0, 1, 2], [0, 2, 3]]);
    }

    /// Claim: the triangles of a spiral of ten corners have its area. Source: 13 unit squares, counted by hand.
    #[test]
    fn spiral() {
        let outline = [[0, 0], [5, 0], [5, 4], [1, 4], [1, 2], [3, 2], [3, 3], [4, 3], [4, 1], [0, 1]];
        let spiral = points(&outline.map(|[x, y]| [f64::from(x), f64::from(y)]));
        let cut = ears(&spiral, STRAIGHT).unwrap();
        let area: f64 = cut.iter().map(|&t| doubled(&spiral, t, Vec3::z()) / 2.0).sum();
        assert_eq!(cut.len(), 8);
        assert!((area - 13.0).abs() < 1e-12, "{area}");
    }

    /// Claim: an outline that crosses itself cannot be split into ears.
    #[test]
    fn bow_tie() {
        let bow = points(&[[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]]);
        assert!([STRAIGHT, 0.0].iter().all(|straight| ears(&bow, *straight).is_none()));
    }
}
