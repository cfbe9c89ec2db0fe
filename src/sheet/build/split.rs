//! Splits polygons into triangles by their shorter diagonals.
//!
//! A quadrilateral is split by the shorter of its diagonals; in a tie (1e-9 relative) by the diagonal through the
//! vertex that is listed first. From a larger polygon the ear with the shortest diagonal is cut repeatedly, with the
//! same rule for ties. An ear is a corner that turns left, seen along the polygon's normal, and whose triangle
//! contains no other corner.

use super::{Defect, Drawing, Identified, MeshPart, Problem};
use crate::math::Vec3;
use crate::sheet::cell::{Corner, Triangle};

/// Least area of a triangle, relative to the square of its longest side.
const THINNEST: f64 = 1e-12;

/// A triangle, and the diagonal that separates it from its polygon.
pub(super) struct Part {
    pub triangle: Triangle,
    /// The diagonal, by corners of the polygon and by drawn vertices; `None` for the last triangle of a polygon.
    pub diagonal: Option<([Corner; 2], [usize; 2])>,
}

/// Returns all triangles of all polygons, in the order of the file.
pub(super) fn triangles(drawn: &Drawing, cell: &Identified, polygons: &[Vec<Corner>]) -> Result<Vec<Part>, Defect> {
    let mut parts = Vec::new();
    for (f, polygon) in polygons.iter().enumerate() {
        // the positions of the cell, not those of the drawn copies, so that a file and its copy split alike
        let points: Vec<Vec3> = polygon.iter().map(|&c| position(drawn, cell, c)).collect();
        let not_simple = || Defect::new(MeshPart::Face(f), Problem::NotSimple { face: drawn.name(f) });
        let cut = ears(&points).ok_or_else(not_simple)?;
        for (k, &corners) in cut.iter().enumerate() {
            check_area(drawn, f, &points, corners)?;
            let [before, _, after] = corners;
            let diagonal = (k + 1 < cut.len())
                .then(|| ([polygon[before], polygon[after]], [drawn.faces[f][before], drawn.faces[f][after]]));
            parts.push(Part { triangle: Triangle { corners: corners.map(|c| polygon[c]), polygon: f }, diagonal });
        }
    }
    Ok(parts)
}

fn position(drawn: &Drawing, cell: &Identified, corner: Corner) -> Vec3 {
    let [l1, l2] = drawn.lattice.unwrap_or_default();
    drawn.coords[cell.homes[corner.vertex]] + l1 * f64::from(corner.shift[0]) + l2 * f64::from(corner.shift[1])
}

fn check_area(drawn: &Drawing, f: usize, points: &[Vec3], corners: [usize; 3]) -> Result<(), Defect> {
    let [a, b, c] = corners.map(|k| points[k]);
    let area = (b - a).cross(&(c - a)).norm() / 2.0;
    let longest = (b - a).norm().max((c - b).norm()).max((a - c).norm());
    if area > THINNEST * longest * longest {
        return Ok(());
    }
    let triangle = corners.map(|k| drawn.name(drawn.faces[f][k]));
    Err(Defect::new(MeshPart::Face(f), Problem::ZeroArea { face: drawn.name(f), triangle, area, longest }))
}

/// Returns the triangles `[before, tip, after]` of the polygon with these corners; `None` if a step finds no ear.
fn ears(points: &[Vec3]) -> Option<Vec<[usize; 3]>> {
    let mut left: Vec<usize> = (0..points.len()).collect();
    let mut cut = Vec::with_capacity(points.len() - 2);
    if left.len() > 3 {
        let normal = newell(points);
        let mut lengths: Vec<_> = (0..left.len()).map(|k| ear(points, &left, k, normal)).collect();
        while left.len() > 3 {
            let tip = shortest(&left, &lengths)?;
            cut.push(around(&left, tip));
            left.remove(tip);
            lengths.remove(tip);
            for k in [tip + left.len() - 1, tip] {
                let k = k % left.len();
                lengths[k] = ear(points, &left, k, normal);
            }
        }
        let last = [left[0], left[1], left[2]];
        if doubled(points, last, normal) <= 0.0 {
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

/// Returns the length of the diagonal that cuts off corner `k`; `None` if `k` is not an ear.
fn ear(points: &[Vec3], left: &[usize], k: usize, normal: Vec3) -> Option<f64> {
    let [a, tip, b] = around(left, k);
    let inside = |p: usize| {
        p != a
            && p != tip
            && p != b
            && [[a, tip, p], [tip, b, p], [b, a, p]].iter().all(|&t| doubled(points, t, normal) >= 0.0)
    };
    let good = doubled(points, [a, tip, b], normal) > 0.0 && !left.iter().any(|&p| inside(p));
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
        assert_eq!(ears(&square).unwrap(), [[0, 1, 2], [0, 2, 3]]);
        let lean = points(&[[0.0, 0.0], [1.0, 0.0], [1.4, 1.0], [0.4, 1.0]]);
        assert_eq!(ears(&lean).unwrap(), [[3, 0, 1], [1, 2, 3]]);
    }

    /// Claim: at a reflex corner the inner diagonal is taken although the outer one is shorter.
    #[test]
    fn arrowhead() {
        let arrow = points(&[[0.0, 0.0], [4.0, -1.0], [3.5, 0.1], [4.0, 1.2]]);
        assert_eq!(ears(&arrow).unwrap(), [[0, 1, 2], [0, 2, 3]]);
    }

    /// Claim: the triangles of a spiral of ten corners have its area. Source: 13 unit squares, counted by hand.
    #[test]
    fn spiral() {
        let outline = [[0, 0], [5, 0], [5, 4], [1, 4], [1, 2], [3, 2], [3, 3], [4, 3], [4, 1], [0, 1]];
        let spiral = points(&outline.map(|[x, y]| [f64::from(x), f64::from(y)]));
        let cut = ears(&spiral).unwrap();
        let area: f64 = cut.iter().map(|&t| doubled(&spiral, t, Vec3::z()) / 2.0).sum();
        assert_eq!(cut.len(), 8);
        assert!((area - 13.0).abs() < 1e-12, "{area}");
    }

    /// Claim: an outline that crosses itself cannot be split into ears.
    #[test]
    fn bow_tie() {
        assert!(ears(&points(&[[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0]])).is_none());
    }
}
