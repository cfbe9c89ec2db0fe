//! Contours: the regions of the plane in which a function, given at points and linear on triangles, reaches a level.
//! The borders are a few long polygons, so that a map is smooth at every size and its file is small.

use std::collections::{HashMap, HashSet};

use super::style::PaperPoint;

/// A side of a triangle that the border crosses, or a step from a point of the outer rim to `BEYOND`.
type Crossing = [usize; 2];
/// Index that stands for the outside of the triangulated domain, where the function counts as below every level.
const BEYOND: usize = usize::MAX;

/// Returns the polygons around the regions in which the function is at least `level`; holes have the opposite
/// orientation. Triangles with a corner at which the function is NaN are left out.
pub(crate) fn regions(
    points: &[PaperPoint],
    triangles: &[[usize; 3]],
    values: &[f64],
    level: f64,
) -> Vec<Vec<PaperPoint>> {
    let known = |triangle: &&[usize; 3]| triangle.iter().all(|&corner| !values[corner].is_nan());
    let mut rim: HashSet<Crossing> = HashSet::new();
    let mut next: HashMap<Crossing, Crossing> = HashMap::new();
    let mut order = Vec::new();
    let inside = |corner: usize| corner != BEYOND && values[corner] >= level;
    let mut step = |triangle: [usize; 3]| {
        let side = |k: usize| [triangle[k], triangle[(k + 1) % 3]];
        let leaves = (0..3).map(side).find(|[a, b]| inside(*a) && !inside(*b));
        let enters = (0..3).map(side).find(|[a, b]| !inside(*a) && inside(*b));
        if let (Some([a, b]), Some([c, d])) = (leaves, enters) {
            let (from, to) = ([a.min(b), a.max(b)], [c.min(d), c.max(d)]);
            next.insert(from, to);
            order.push(from);
        }
    };
    for &[a, b, c] in triangles.iter().filter(known) {
        step([a, b, c]);
        // a side that is outside altogether is crossed nowhere, on the rim or not
        for [from, to] in [[a, b], [b, c], [c, a]].into_iter().filter(|side| side.iter().any(|&corner| inside(corner)))
        {
            if !rim.remove(&[to, from]) {
                rim.insert([from, to]);
            }
        }
    }
    let mut sides: Vec<Crossing> = rim.into_iter().collect();
    sides.sort_unstable();
    sides.into_iter().for_each(|[from, to]| step([to, from, BEYOND]));
    let place = |[a, b]: Crossing| {
        let (p, q) = (points[a], if b == BEYOND { points[a] } else { points[b] });
        let part = if b == BEYOND { 0.0 } else { (level - values[a]) / (values[b] - values[a]) };
        [0, 1].map(|k| p[k] + part * (q[k] - p[k]))
    };
    let mut found = Vec::new();
    for start in order {
        let (mut polygon, mut at) = (Vec::new(), start);
        while let Some(after) = next.remove(&at) {
            polygon.push(place(at));
            at = after;
        }
        if polygon.len() > 2 {
            found.push(polygon);
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns points and triangles of a square of side 2 around the origin; all triangles are counter-clockwise.
    fn square(n: usize) -> (Vec<PaperPoint>, Vec<[usize; 3]>) {
        let place = |k: usize| 2.0 * k as f64 / n as f64 - 1.0;
        let points = (0..=n).flat_map(|j| (0..=n).map(move |i| [place(i), place(j)])).collect();
        let corners = (0..n).flat_map(|j| (0..n).map(move |i| j * (n + 1) + i));
        (points, corners.flat_map(|k| [[k, k + 1, k + n + 2], [k, k + n + 2, k + n + 1]]).collect())
    }

    fn area(polygons: &[Vec<PaperPoint>]) -> f64 {
        let turn = |p: &[PaperPoint], k: usize| {
            let [a, b] = [p[k], p[(k + 1) % p.len()]];
            a[0] * b[1] - b[0] * a[1]
        };
        polygons.iter().map(|p| (0..p.len()).map(|k| 0.5 * turn(p, k)).sum::<f64>()).sum()
    }

    /// Claim: the areas of a ring, a disc and the whole square are found, with the right number of borders. The
    /// tolerance is the error of straight lines on 40 x 40 squares.
    #[test]
    fn rings_and_discs() {
        let (points, triangles) = square(40);
        let values: Vec<f64> = points.iter().map(|[x, y]| -(x.hypot(*y) - 0.5).abs()).collect();
        let ring = regions(&points, &triangles, &values, -0.2);
        let exact = std::f64::consts::PI * (0.49 - 0.09);
        assert!(ring.len() == 2 && (area(&ring).abs() - exact).abs() <= 0.01, "{} {}", ring.len(), area(&ring));
        let all = regions(&points, &triangles, &values, -9.0);
        assert!(all.len() == 1 && (area(&all).abs() - 4.0).abs() <= 1e-12);
        let outside = regions(&points, &triangles, &values.iter().map(|v| -v).collect::<Vec<_>>(), 0.2);
        assert!((area(&outside).abs() - (4.0 - exact)).abs() <= 0.01, "{}", area(&outside));
        assert_eq!(regions(&points, &triangles, &values, 1.0), Vec::<Vec<PaperPoint>>::new());
    }

    /// Claim: a corner at which the function is NaN leaves out only the triangles at this corner.
    #[test]
    fn gaps() {
        let (points, triangles) = square(4);
        let mut values = vec![1.0; points.len()];
        values[12] = f64::NAN;
        let all = regions(&points, &triangles, &values, 0.0);
        assert!(all.len() == 2 && (area(&all).abs() - (4.0 - 6.0 * 0.125)).abs() <= 1e-12, "{all:?}");
    }
}
