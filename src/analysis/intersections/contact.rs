//! Two triangles in space: apart, touching, or passing through each other; exact for the coordinates given.
//!
//! Triangles are closed. They are **disjoint** when they have no point in common. They **cross** when they lie in two
//! different planes and have a point in common that is interior to both: there each goes through the other from side
//! to side. Everything between is **touching**: a corner or an edge of one on the other, a shared corner or edge, and
//! all overlap within one plane, that is, layers that lie on each other. A triangle whose corners are collinear has no
//! sides and never crosses; it touches what its points meet.
//!
//! Triangles with a common corner cross when the edge opposite to it pierces the other triangle; triangles with a
//! common edge never do, since in two planes all they share is that edge.
//!
//! *Crossing* (after P. Guigue, O. Devillers, J. Graphics Tools 8, 25 (2003)): each has corners strictly on both sides
//! of the other's plane. The two then cut the common line `l` of the planes in open intervals, with end points on the
//! two edges that leave the corner alone on its side. The sign of the volume of two such edges, one of each triangle,
//! says which of their points on `l` comes first, in the same direction for all four; the intervals are apart exactly
//! when no two of the four signs oppose. *Touching*: an edge of one meets the other.
//!
//! Signs are those of exact determinants (`robust`, after J. R. Shewchuk, Discrete Comput. Geom. 18, 305 (1997)): right
//! as long as nothing over- or underflows, which coordinates that are zero or between 1e-90 and 1e100 in magnitude
//! cannot do.

use crate::math::Vec3;
use robust::{Coord, Coord3D, orient2d, orient3d};

/// Corners of a triangle.
pub type Triangle = [Vec3; 3];

/// How two triangles lie to each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Contact {
    /// No point in common.
    Disjoint,
    /// Points in common, but neither goes through the other.
    Touching,
    /// Each goes through the other.
    Crossing,
}

/// The contact of two triangles, the same whatever the order of triangles and corners. Triangles with a coordinate that
/// is not finite are disjoint from all others.
pub fn contact(a: &Triangle, b: &Triangle) -> Contact {
    if cross(a, b) {
        Contact::Crossing
    } else if finite(a) && finite(b) && meet(a, b) {
        Contact::Touching
    } else {
        Contact::Disjoint
    }
}

/// Whether two triangles cross; cheaper than the whole [`contact`].
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

/// Whether no two signs oppose.
fn agree<const N: usize>(signs: [i8; N]) -> bool {
    !(signs.contains(&1) && signs.contains(&-1))
}

/// Whether two closed triangles, degenerate or not, have a point in common.
fn meet(a: &Triangle, b: &Triangle) -> bool {
    boxes_meet(a, b) && (edges(a).iter().any(|edge| pierces(edge, b)) || edges(b).iter().any(|edge| pierces(edge, a)))
}

fn edges(&[a, b, c]: &Triangle) -> [[Vec3; 2]; 3] {
    [[a, b], [b, c], [c, a]]
}

/// Whether the smallest boxes along the axes have a point in common.
fn boxes_meet(a: &[Vec3], b: &[Vec3]) -> bool {
    (0..3).all(|axis| {
        let range = |points: &[Vec3]| {
            points.iter().map(|p| p[axis]).fold([f64::INFINITY, f64::NEG_INFINITY], |[l, h], x| [l.min(x), h.max(x)])
        };
        let ([low_a, high_a], [low_b, high_b]) = (range(a), range(b));
        low_a <= high_b && low_b <= high_a
    })
}

/// Whether a closed segment and a closed triangle have a point in common.
fn pierces(segment: &[Vec3; 2], triangle: &Triangle) -> bool {
    let [p, q] = segment;
    match [side(triangle, p), side(triangle, q)] {
        [0, 0] => segment_meets_coplanar(segment, triangle),
        [1, 1] | [-1, -1] => false,
        // the segment goes through the plane: inside where it passes all edges on the same hand
        _ => agree(edges(triangle).map(|[a, b]| side(&[*p, *q, a], &b))),
    }
}

/// The same, known to be in one plane.
fn segment_meets_coplanar(segment: &[Vec3; 2], triangle: &Triangle) -> bool {
    edges(triangle).iter().any(|edge| segments_meet(segment, edge)) || contains(triangle, &segment[0])
}

/// Whether two closed segments have a point in common: they lie in one plane, in all three projections along an axis none
/// has both ends strictly on one side of the other, and their boxes meet. One of the projections shows the plane faithfully;
/// where all four ends are collinear, the boxes decide.
fn segments_meet(a: &[Vec3; 2], b: &[Vec3; 2]) -> bool {
    let straddles = |axis, line: &[Vec3; 2], ends: &[Vec3; 2]| {
        let signs = ends.map(|end| turn(axis, &line[0], &line[1], &end));
        signs[0] * signs[1] <= 0
    };
    boxes_meet(a, b)
        && side(&[a[0], a[1], b[0]], &b[1]) == 0
        && (0..3).all(|axis| straddles(axis, a, b) && straddles(axis, b, a))
}

/// Whether a closed triangle contains a point known to lie in its plane, by the same three projections.
fn contains(triangle: &Triangle, point: &Vec3) -> bool {
    boxes_meet(triangle, &[*point]) && (0..3).all(|axis| agree(edges(triangle).map(|[a, b]| turn(axis, &a, &b, point))))
}

/// Whether `a`, `b`, `c` turn left (1) or right (-1), or are in line (0), seen along an axis.
fn turn(axis: usize, a: &Vec3, b: &Vec3, c: &Vec3) -> i8 {
    let [a, b, c] = [a, b, c].map(|p| Coord { x: p[(axis + 1) % 3], y: p[(axis + 2) % 3] });
    sign(orient2d(a, b, c))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn triangle(corners: [[f64; 3]; 3]) -> Triangle {
        corners.map(Vec3::from)
    }

    const ORDERS: [[usize; 3]; 6] = [[0, 1, 2], [1, 2, 0], [2, 0, 1], [0, 2, 1], [2, 1, 0], [1, 0, 2]];

    /// Contacts that can be seen by eye, against the triangle (0,0,0), (4,0,0), (0,4,0); all coordinates are small integers, so
    /// nothing is rounded.
    const SEEN: &[([[f64; 3]; 3], Contact)] = &[
        // goes through its interior, and just beside it
        ([[1.0, 1.0, -1.0], [1.0, 1.0, 1.0], [9.0, 1.0, 1.0]], Contact::Crossing),
        ([[3.0, 3.0, -1.0], [3.0, 3.0, 1.0], [9.0, 3.0, 1.0]], Contact::Disjoint),
        // a shared corner: the opposite edge pierces; passes outside; lies in the plane
        ([[0.0, 0.0, 0.0], [2.0, 1.0, 1.0], [1.0, 2.0, -1.0]], Contact::Crossing),
        ([[0.0, 0.0, 0.0], [-2.0, 1.0, 1.0], [-1.0, 2.0, -1.0]], Contact::Touching),
        ([[0.0, 0.0, 0.0], [1.0, 1.0, 0.0], [1.0, 1.0, 1.0]], Contact::Touching),
        // a shared edge: folded by any angle, also onto each other
        ([[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [1.0, 1.0, 1.0]], Contact::Touching),
        ([[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]], Contact::Touching),
        ([[4.0, 0.0, 0.0], [0.0, 0.0, 0.0], [1.0, 1.0, 0.0]], Contact::Touching),
        ([[4.0, 0.0, 0.0], [0.0, 0.0, 0.0], [1.0, -1.0, 0.0]], Contact::Touching),
        // a corner on it, an edge on it, both from one side
        ([[1.0, 1.0, 0.0], [1.0, 1.0, 1.0], [2.0, 1.0, 1.0]], Contact::Touching),
        ([[1.0, 1.0, 0.0], [2.0, 1.0, 0.0], [2.0, 1.0, 1.0]], Contact::Touching),
        // edges that cross in one point, corner on an edge, one corner on another
        ([[2.0, -1.0, 0.0], [2.0, 1.0, 0.0], [2.0, 0.0, 3.0]], Contact::Touching),
        ([[2.0, 0.0, 0.0], [2.0, -1.0, 1.0], [2.0, -1.0, -1.0]], Contact::Touching),
        ([[0.0, 4.0, 0.0], [0.0, 5.0, 1.0], [0.0, 5.0, -1.0]], Contact::Touching),
        // from side to side, but only along the rim
        ([[0.0, 0.0, -1.0], [4.0, 0.0, -1.0], [2.0, 0.0, 1.0]], Contact::Touching),
        ([[1.0, -1.0, -1.0], [1.0, 2.0, 1.0], [9.0, 1.0, 0.0]], Contact::Crossing),
        // in its plane: overlapping, inside, around, side by side, apart
        ([[1.0, 1.0, 0.0], [5.0, 1.0, 0.0], [1.0, 5.0, 0.0]], Contact::Touching),
        ([[1.0, 1.0, 0.0], [2.0, 1.0, 0.0], [1.0, 2.0, 0.0]], Contact::Touching),
        ([[-9.0, -9.0, 0.0], [20.0, -9.0, 0.0], [-9.0, 20.0, 0.0]], Contact::Touching),
        ([[4.0, 0.0, 0.0], [0.0, 4.0, 0.0], [4.0, 4.0, 0.0]], Contact::Touching),
        ([[3.0, 3.0, 0.0], [3.0, 2.0, 0.0], [2.0, 3.0, 0.0]], Contact::Disjoint),
        ([[1.0, 1.0, 1.0], [2.0, 1.0, 1.0], [1.0, 2.0, 1.0]], Contact::Disjoint),
        // no area: a segment through it, one beside it, one in its plane, a point on and one off it
        ([[1.0, 1.0, -1.0], [1.0, 1.0, 1.0], [1.0, 1.0, 2.0]], Contact::Touching),
        ([[3.0, 3.0, -1.0], [3.0, 3.0, 1.0], [3.0, 3.0, 2.0]], Contact::Disjoint),
        ([[-1.0, 1.0, 0.0], [1.0, 1.0, 0.0], [9.0, 1.0, 0.0]], Contact::Touching),
        ([[5.0, 0.0, 0.0], [6.0, 0.0, 0.0], [7.0, 0.0, 0.0]], Contact::Disjoint),
        ([[1.0, 1.0, 0.0]; 3], Contact::Touching),
        ([[5.0, 0.0, 0.0]; 3], Contact::Disjoint),
    ];

    /// Claim: the contacts above, for every order of the corners and of the triangles, mirrored, moved, and scaled by
    /// powers of two (which round nothing; to the limits of the doubles that are named above).
    #[test]
    fn contacts_that_can_be_seen() {
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
                    assert_eq!(contact(&a, &b), expected, "{a:?} {b:?}");
                    assert_eq!(contact(&b, &a), expected, "{b:?} {a:?}");
                }
            }
        }
    }

    /// Claim: one unit in the last place decides, where the determinants as computed in doubles are all rounding error.
    #[test]
    fn one_unit_in_the_last_place_decides() {
        let base = triangle([[0.1, 0.1, 0.1], [4.1, 0.1, 0.1], [0.1, 4.1, 0.1]]);
        let tip = |z: f64| triangle([[1.1, 1.2, z], [1.3, 1.1, 7.7], [1.7, 1.4, 8.8]]);
        assert_eq!(contact(&base, &tip(0.1)), Contact::Touching);
        assert_eq!(contact(&base, &tip(0.1f64.next_up())), Contact::Disjoint);
        assert_eq!(contact(&base, &tip(0.1f64.next_down())), Contact::Crossing);
    }

    /// Claim: a coordinate that is no number, or infinite, anywhere, means no contact.
    #[test]
    fn what_is_not_finite_meets_nothing() {
        let base = triangle([[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]]);
        let other = triangle(SEEN[0].0);
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            for k in 0..9 {
                let mut spoiled = other;
                spoiled[k / 3][k % 3] = bad;
                assert_eq!(contact(&base, &spoiled), Contact::Disjoint);
                assert_eq!(contact(&spoiled, &base), Contact::Disjoint);
            }
        }
    }
}
