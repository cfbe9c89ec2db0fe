//! Positions of the vertices of a patch, from its fold angles and lengths.

use super::loops::{Directed, Topology};
use super::word::TriangleAngle;
use crate::math::{Vec2, Vec3};
use crate::numerics::dense::small::nearest_rotation;
use nalgebra::Matrix3;
use std::collections::{BTreeMap, HashSet, VecDeque};

/// Returns the coordinates of all vertices. Triangles are put together from the middle of the patch outward, so that
/// rounding errors grow with its radius; then the whole is moved as close to the drawn coordinates as a rigid motion
/// can.
pub(super) fn placed(topology: &Topology, angles: &[f64], lengths: &[f64], drawn: &[f64]) -> Vec<f64> {
    let drawn: Vec<Vec3> = drawn.chunks_exact(3).map(Vec3::from_column_slice).collect();
    let mut positions = vec![None; drawn.len()];
    if let Some(first) = topology.middle(&drawn) {
        unfold(topology, first, angles, lengths, &mut positions);
    }
    let mut positions = aligned(&positions, &drawn);
    hang(topology, lengths, &drawn, &mut positions);
    positions.iter().flat_map(|p| <[f64; 3]>::from(*p)).collect()
}

/// A frame on the edge of a triangle: its origin, and axes along the edge, into the triangle, and along the normal.
struct Frame {
    origin: Vec3,
    axes: [Vec3; 3],
}

/// Places the triangle on the left of the edge `first`, and all others from it, breadth first. Each triangle follows
/// from the frame of the one before it and not from points that were placed along another way, so that rounding errors
/// add up and do not multiply.
fn unfold(topology: &Topology, first: [usize; 2], angles: &[f64], lengths: &[f64], positions: &mut [Option<Vec3>]) {
    let length = |a: usize, b: usize| topology.get(a, b).map_or(f64::NAN, |directed| lengths[directed.edge]);
    let start = Frame { origin: Vec3::zeros(), axes: [Vec3::x(), Vec3::y(), Vec3::z()] };
    let (mut queue, mut reached) = (VecDeque::from([(first, start)]), HashSet::new());
    while let Some(([i, j], Frame { origin, axes: [along, across, normal] })) = queue.pop_front() {
        let Some(Directed { left: Some(k), .. }) = topology.get(i, j) else { continue };
        if !reached.insert([i, j]) {
            continue;
        }
        reached.extend([[j, k], [k, i]]);
        // the triangle in its own plane
        let sides = [length(i, j), length(i, k), length(j, k)];
        let corner = TriangleAngle::new(sides);
        let corners = [Vec2::zeros(), Vec2::new(sides[0], 0.0), sides[1] * Vec2::new(corner.cosine, corner.sine)];
        let direction = |v: Vec2| along * v.x + across * v.y;
        for (vertex, corner) in [i, j, k].into_iter().zip(corners) {
            positions[vertex].get_or_insert(origin + direction(corner));
        }
        for (from, to) in [(0, 1), (1, 2), (2, 0)] {
            let ends = [[i, j, k][to], [i, j, k][from]];
            let Some(Directed { edge, .. }) = topology.get(ends[0], ends[1]) else { continue };
            // over the edge, back along it: out of this triangle, and up by the fold angle
            let back = (corners[from] - corners[to]).normalize();
            let (sine, cosine) = angles[edge].sin_cos();
            let out = direction(Vec2::new(-back.y, back.x));
            let axes = [direction(back), cosine * out + sine * normal, cosine * normal - sine * out];
            queue.push_back((ends, Frame { origin: origin + direction(corners[to]), axes }));
        }
    }
}

/// Returns the positions that are known, moved by the rigid motion that brings them closest to others, and the others
/// for those that are not.
fn aligned(positions: &[Option<Vec3>], others: &[Vec3]) -> Vec<Vec3> {
    let pairs = || positions.iter().zip(others).filter_map(|(p, q)| Some((p.as_ref()?, q)));
    let count = pairs().count() as f64;
    let from = pairs().map(|(p, _)| p).sum::<Vec3>() / count;
    let to = pairs().map(|(_, q)| q).sum::<Vec3>() / count;
    let covariance: Matrix3<f64> = pairs().map(|(p, q)| (q - to) * (p - from).transpose()).sum();
    let turn = nearest_rotation(&covariance);
    positions.iter().zip(others).map(|(p, q)| p.map_or(*q, |p| turn * (p - from) + to)).collect()
}

/// Places the vertices of no triangle, which one or two edges hold: at the lengths of these, and otherwise as close as
/// possible to where they are drawn.
fn hang(topology: &Topology, lengths: &[f64], drawn: &[Vec3], positions: &mut [Vec3]) {
    let mut holders: BTreeMap<usize, Vec<(usize, f64)>> = BTreeMap::new();
    for &[i, j] in &topology.loose {
        let length = topology.get(i, j).map_or(f64::NAN, |directed| lengths[directed.edge]);
        for (free, held) in [(i, j), (j, i)] {
            if !topology.is_in_triangle(free) {
                holders.entry(free).or_default().push((held, length));
            }
        }
    }
    for (free, holders) in holders {
        let wish = positions[holders[0].0] + drawn[free] - drawn[holders[0].0];
        positions[free] = match holders[..] {
            [(a, r)] => positions[a] + (wish - positions[a]).normalize() * r,
            [(a, r), (b, s), ..] => on_both([positions[a], positions[b]], [r, s], &wish),
            [] => wish,
        };
    }
}

/// Returns the point of two spheres that is closest to a wish: on the circle in which they meet, or between them if
/// they do not.
fn on_both([a, b]: [Vec3; 2], [r, s]: [f64; 2], wish: &Vec3) -> Vec3 {
    let distance = (b - a).norm();
    let along = (b - a) / distance;
    let foot = 0.5 * (distance + (r - s) * (r + s) / distance);
    let height = ((r - foot) * (r + foot)).max(0.0).sqrt();
    let across = wish - a - along * along.dot(&(wish - a));
    a + along * foot + across.normalize() * height
}
