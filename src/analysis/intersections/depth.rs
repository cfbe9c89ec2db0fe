//! How deep two triangles are in each other: the length of the shortest translation after which they only touch.
//!
//! Two convex bodies overlap by the smallest overlap of their shadows on a line; for triangles in two planes it is
//! enough to look along the two normals and the nine products of an edge of each (the facets of their Minkowski
//! difference; S. Gottschalk, M. C. Lin, D. Manocha, SIGGRAPH 1996).

use super::contact::Triangle;
use crate::math::Vec3;

/// Products of edges that are shorter than this part of the product of their lengths have no direction.
const PARALLEL: f64 = 1e-12;

/// Depth of two triangles that cross, in the unit of the coordinates; error: a few roundings of their size.
pub fn depth(a: &Triangle, b: &Triangle) -> f64 {
    let origin = a[0];
    let (a, b) = (a.map(|p| p - origin), b.map(|p| p - origin));
    let (edges_a, edges_b) = (edges(&a), edges(&b));
    let normals = [(edges_a[0], edges_a[1]), (edges_b[0], edges_b[1])];
    let across = edges_a.into_iter().flat_map(|e| edges_b.into_iter().map(move |f| (e, f)));
    let directions = normals.into_iter().chain(across).filter_map(|(e, f)| direction(&e, &f));
    directions.map(|axis| overlap(&axis, &a, &b)).fold(f64::INFINITY, f64::min)
}

fn edges([a, b, c]: &Triangle) -> [Vec3; 3] {
    [b - a, c - b, a - c]
}

fn direction(e: &Vec3, f: &Vec3) -> Option<Vec3> {
    let product = e.cross(f);
    let length = product.norm();
    (length > PARALLEL * e.norm() * f.norm()).then(|| product / length)
}

/// Overlap of the shadows on a line of this direction.
fn overlap(axis: &Vec3, a: &Triangle, b: &Triangle) -> f64 {
    let shadow = |triangle: &Triangle| {
        let at = triangle.map(|p| p.dot(axis));
        [at[0].min(at[1]).min(at[2]), at[0].max(at[1]).max(at[2])]
    };
    let ([low_a, high_a], [low_b, high_b]) = (shadow(a), shadow(b));
    (high_a - low_b).min(high_b - low_a)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analysis::intersections::contact::cross;

    fn triangle(corners: [[f64; 3]; 3]) -> Triangle {
        corners.map(Vec3::from)
    }

    /// Claim: a tip pushed through a face by h is h deep; two edges that pass each other by h across are h deep.
    /// Source: the construction. Tolerance: rounding of numbers of size 4.
    #[test]
    fn depths_that_can_be_seen() {
        let base = triangle([[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]]);
        for h in [1e-12, 1e-3, 0.25] {
            let tip = triangle([[1.0, 1.0, -h], [1.0, 0.5, 2.0], [1.5, 1.0, 2.0]]);
            assert!(!((depth(&base, &tip) - h).abs() > 1e-15), "tip {h}: {}", depth(&base, &tip));
            let edge = triangle([[2.0, h, 2.0], [2.0, h, -2.0], [2.0, -3.0, 0.0]]);
            assert!(!((depth(&base, &edge) - h).abs() > 1e-15), "edge {h}: {}", depth(&base, &edge));
            assert!(cross(&base, &tip) && cross(&base, &edge));
        }
    }

    /// Claim: moved by a little more than their depth along some direction two triangles no longer cross, moved by a
    /// little less along any direction they do. Source: the definition. Directions: 2000 at random.
    #[test]
    fn the_depth_is_the_shortest_way_out() {
        use rand_chacha::rand_core::SeedableRng;
        let mut numbers = rand_chacha::ChaCha8Rng::seed_from_u64(3);
        let mut point = || Vec3::from([0; 3].map(|_| crate::numerics::random::symmetric(&mut numbers)));
        let mut crossing = 0;
        while crossing < 20 {
            let (a, b) = ([point(), point(), point()], [point(), point(), point()]);
            if !cross(&a, &b) {
                continue;
            }
            crossing += 1;
            let (found, mut freed) = (depth(&a, &b), 0);
            for _ in 0..2000 {
                let way = point().normalize();
                let after = |length: f64| cross(&a, &b.map(|p| p + way * length));
                assert!(after(0.999 * found), "{a:?} {b:?} {way}");
                freed += usize::from(!after(1.1 * found));
            }
            assert!(freed > 0, "{a:?} {b:?}: {found}");
        }
    }
}
