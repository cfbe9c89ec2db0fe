//! Whether two triangles in space pass through each other, exactly for the coordinates given.
//!
//! Triangles are closed. They **cross** when they lie in two different planes and have a point in common that is
//! interior to both: there each goes through the other from side to side. Everything less is not a crossing: a corner
//! or an edge of one on the other, a shared corner or edge, and all overlap within one plane, that is, layers that lie
//! on each other. A triangle whose corners are collinear has no sides and never crosses.
//!
//! Triangles with a common corner cross when the edge opposite to it pierces the other triangle; triangles with a
//! common edge never do, since in two planes all they share is that edge.
//!
//! *Crossing* (after P. Guigue, O. Devillers, J. Graphics Tools 8, 25 (2003)): each has corners strictly on both sides
//! of the other's plane. The two then cut the common line `l` of the planes in open intervals, with end points on the
//! two edges that leave the corner alone on its side. The sign of the volume of two such edges, one of each triangle,
//! says which of their points on `l` comes first, in the same direction for all four; the intervals are apart exactly
//! when no two of the four signs oppose.
//!
//! Signs are those of exact determinants (`robust`, after J. R. Shewchuk, Discrete Comput. Geom. 18, 305 (1997)): right
//! as long as nothing over- or underflows, which coordinates that are zero or between 1e-90 and 1e100 in magnitude
//! cannot do.

use crate::math::Vec3;
use robust::{Coord3D, orient3d};

/// Corners of a triangle.
pub type Triangle = [Vec3; 3];

/// Whether two triangles cross; the same whatever the order of triangles and corners. Triangles with a coordinate that
/// is not finite cross no others.
pub fn cross(a: &Triangle, b: &Triangle) -> bool {
    if !finite(a) || !finite(b) {
        return false;
    }
    let Some([p, q, r]) = alone_first(a, b) else { return false };
    let Some([u, v, w]) = alone_first(b, a) else { return false };
    let order = |end: Vec3, other: Vec3| side(&[p, end, u], &other);
    let signs = [order(q, v), order(q, w), order(r, v), order(r, w)];
    signs.contains(&1) && signs.contains(&-1)
}

/// The corners, first the one that is alone on its side of a plane; `None` unless there are corners on both sides.
fn alone_first(corners: &Triangle, plane: &Triangle) -> Option<Triangle> {
    let signs = corners.map(|corner| side(plane, &corner));
    let alone = |&k: &usize| {
        signs[k] != 0 && signs.contains(&-signs[k]) && signs.iter().filter(|sign| **sign == signs[k]).count() == 1
    };
    let first = (0..3).find(alone)?;
    Some([0, 1, 2].map(|k| corners[(first + k) % 3]))
}

fn finite(triangle: &Triangle) -> bool {
    triangle.iter().flatten().all(|x| x.is_finite())
}

/// On which side of a plane a point lies: 1, -1, or 0 in the plane. A corner is known to lie in its plane.
fn side(plane: &Triangle, point: &Vec3) -> i8 {
    if plane.contains(point) {
        return 0;
    }
    let [a, b, c, d] = [&plane[0], &plane[1], &plane[2], point].map(|p| Coord3D { x: p.x, y: p.y, z: p.z });
    sign(orient3d(a, b, c, d))
}

fn sign(x: f64) -> i8 {
    i8::from(x > 0.0) - i8::from(x < 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn triangle(corners: [[f64; 3]; 3]) -> Triangle {
        corners.map(Vec3::from)
    }

    const ORDERS: [[usize; 3]; 6] = [[0, 1, 2], [1, 2, 0], [2, 0, 1], [0, 2, 1], [2, 1, 0], [1, 0, 2]];

    /// Whether triangles cross that can be judged by eye, against the triangle (0,0,0), (4,0,0), (0,4,0); all
    /// coordinates are small integers, so nothing is rounded.
    const SEEN: &[([[f64; 3]; 3], bool)] = &[
        // goes through its interior, and just beside it
        ([[1.0, 1.0, -1.0], [1.0, 1.0, 1.0], [9.0, 1.0, 1.0]], true),
        ([[3.0, 3.0, -1.0], [3.0, 3.0, 1.0], [9.0, 3.0, 1.0]], false),
        // a shared corner: the opposite edge pierces; passes outside; lies in the plane
        ([[0.0, 0.0, 0.0], [2.0, 1.0, 1.0], [1.0, 2.0, -1.0]], true),
        ([[0.0, 0.0, 0.0], [-2.0, 1.0, 1.0], [-1.0, 2.0, -1.0]], false),
        ([[0.0, 0.0, 0.0], [1.0, 1.0, 0.0], [1.0, 1.0, 1.0]], false),
        // a shared edge: folded by any angle, also onto each other
        ([[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [1.0, 1.0, 1.0]], false),
        ([[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]], false),
        ([[4.0, 0.0, 0.0], [0.0, 0.0, 0.0], [1.0, 1.0, 0.0]], false),
        ([[4.0, 0.0, 0.0], [0.0, 0.0, 0.0], [1.0, -1.0, 0.0]], false),
        // a corner on it, an edge on it, both from one side
        ([[1.0, 1.0, 0.0], [1.0, 1.0, 1.0], [2.0, 1.0, 1.0]], false),
        ([[1.0, 1.0, 0.0], [2.0, 1.0, 0.0], [2.0, 1.0, 1.0]], false),
        // edges that cross in one point, corner on an edge, one corner on another
        ([[2.0, -1.0, 0.0], [2.0, 1.0, 0.0], [2.0, 0.0, 3.0]], false),
        ([[2.0, 0.0, 0.0], [2.0, -1.0, 1.0], [2.0, -1.0, -1.0]], false),
        ([[0.0, 4.0, 0.0], [0.0, 5.0, 1.0], [0.0, 5.0, -1.0]], false),
        // from side to side, but only along the rim
        ([[0.0, 0.0, -1.0], [4.0, 0.0, -1.0], [2.0, 0.0, 1.0]], false),
        ([[1.0, -1.0, -1.0], [1.0, 2.0, 1.0], [9.0, 1.0, 0.0]], true),
        // in its plane: overlapping, inside, around, side by side, apart
        ([[1.0, 1.0, 0.0], [5.0, 1.0, 0.0], [1.0, 5.0, 0.0]], false),
        ([[1.0, 1.0, 0.0], [2.0, 1.0, 0.0], [1.0, 2.0, 0.0]], false),
        ([[-9.0, -9.0, 0.0], [20.0, -9.0, 0.0], [-9.0, 20.0, 0.0]], false),
        ([[4.0, 0.0, 0.0], [0.0, 4.0, 0.0], [4.0, 4.0, 0.0]], false),
        ([[3.0, 3.0, 0.0], [3.0, 2.0, 0.0], [2.0, 3.0, 0.0]], false),
        ([[1.0, 1.0, 1.0], [2.0, 1.0, 1.0], [1.0, 2.0, 1.0]], false),
        // no area: a segment through it, one beside it, one in its plane, a point on and one off it
        ([[1.0, 1.0, -1.0], [1.0, 1.0, 1.0], [1.0, 1.0, 2.0]], false),
        ([[3.0, 3.0, -1.0], [3.0, 3.0, 1.0], [3.0, 3.0, 2.0]], false),
        ([[-1.0, 1.0, 0.0], [1.0, 1.0, 0.0], [9.0, 1.0, 0.0]], false),
        ([[5.0, 0.0, 0.0], [6.0, 0.0, 0.0], [7.0, 0.0, 0.0]], false),
        ([[1.0, 1.0, 0.0]; 3], false),
        ([[5.0, 0.0, 0.0]; 3], false),
    ];

    /// Claim: the verdicts above, for every order of the corners and of the triangles, mirrored, moved, and scaled by
    /// powers of two (which round nothing; to the limits of the doubles that are named above).
    #[test]
    fn crossings_that_can_be_seen() {
        let base = triangle([[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]]);
        let maps: [fn(Vec3) -> Vec3; 6] = [
            |p| p,
            |p| -p,
            |p| Vec3::new(p.z, -p.x, p.y),
            |p| p * 2f64.powi(290) + Vec3::repeat(2f64.powi(292)),
            |p| p * 2f64.powi(-280),
            |p| Vec3::new(p.x + p.y, p.y - 3.0 * p.z, p.x - p.z) - Vec3::new(7.0, 1.0, 2.0),
        ];
        for &(corners, expected) in SEEN {
            for map in maps {
                let (a, b) = (base.map(map), triangle(corners).map(map));
                for (p, q) in ORDERS.iter().flat_map(|p| ORDERS.iter().map(move |q| (p, q))) {
                    let (a, b) = (p.map(|k| a[k]), q.map(|k| b[k]));
                    assert_eq!(cross(&a, &b), expected, "{a:?} {b:?}");
                    assert_eq!(cross(&b, &a), expected, "{b:?} {a:?}");
                }
            }
        }
    }

    /// Claim: one unit in the last place decides, where the determinants as computed in doubles are all rounding error.
    #[test]
    fn one_unit_in_the_last_place_decides() {
        let base = triangle([[0.1, 0.1, 0.1], [4.1, 0.1, 0.1], [0.1, 4.1, 0.1]]);
        let tip = |z: f64| triangle([[1.1, 1.2, z], [1.3, 1.1, 7.7], [1.7, 1.4, 8.8]]);
        let heights = [0.1, 0.1f64.next_up(), 0.1f64.next_down()];
        assert_eq!(heights.map(|z| cross(&base, &tip(z))), [false, false, true]);
    }

    /// Claim: a coordinate that is no number, or infinite, anywhere, means no crossing.
    #[test]
    fn what_is_not_finite_crosses_nothing() {
        let base = triangle([[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]]);
        let other = triangle(SEEN[0].0);
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            for k in 0..9 {
                let mut spoiled = other;
                spoiled[k / 3][k % 3] = bad;
                assert!(!cross(&base, &spoiled) && !cross(&spoiled, &base));
            }
        }
    }
}
