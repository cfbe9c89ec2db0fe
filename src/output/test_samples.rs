//! Samples for the tests of output: the picture of a folded hinge, and a saddle of states.

use super::picture::Picture;
use super::strain_space::StrainSurface;
use crate::math::Vec3;
use crate::sheet::{Assignment, EdgeKind};
use std::collections::BTreeMap;

/// Returns two triangles folded by `angle` along an edge of unit length: one crease and four boundary edges.
pub(crate) fn hinge(angle: f64) -> Picture {
    let points = vec![
        Vec3::zeros(),
        Vec3::new(0.0, 1.0, 0.0),
        Vec3::new(-1.0, 0.5, 0.0),
        Vec3::new(angle.cos(), 0.5, angle.sin()),
    ];
    let none = f64::NAN;
    Picture {
        displacement: points.iter().map(|p| Vec3::new(0.0, 0.0, p.z)).collect(),
        places: (0..points.len()).map(|vertex| (vertex, [0, 0])).collect(),
        points,
        triangles: vec![[0, 1, 2], [1, 0, 3]],
        self_intersecting: vec![0, 1],
        lines: vec![[0, 1], [1, 2], [2, 0], [0, 3], [3, 1]],
        line_kinds: [vec![EdgeKind::Crease], vec![EdgeKind::Boundary; 4]].concat(),
        letters: [vec![Assignment::Valley], vec![Assignment::Boundary; 4]].concat(),
        line_edges: vec![0, 1, 2, 3, 4],
        fold_angle: vec![angle, none, none, none, none],
        rest_angle: vec![0.0, none, none, none, none],
        strain: vec![1e-3, 0.0, 0.0, -2e-5, 0.0],
        energy: vec![0.5 * angle * angle, 0.0, 0.0, 0.0, 0.0],
        tension: vec![1e-3, 0.0, 0.0, -2e-5, 0.0],
        torque: vec![angle, none, none, none, none],
        memory: BTreeMap::new(),
    }
}

/// Returns `n` x `n` states on a saddle, with a curvature proportional to x.
pub(crate) fn cap(n: usize) -> StrainSurface {
    let place = |k: usize| [k % n, k / n].map(|k| 2.0 * k as f64 / (n - 1) as f64 - 1.0);
    let squares = (0..n * n).filter(|k| k % n + 1 < n && k / n + 1 < n);
    let points: Vec<[f64; 2]> = (0..n * n).map(place).collect();
    StrainSurface {
        points: points.iter().map(|[x, y]| Vec3::new(*x, *y, x * x - y * y)).collect(),
        triangles: squares.flat_map(|k| [[k, k + 1, k + n + 1], [k, k + n + 1, k + n]]).collect(),
        segments: Vec::new(),
        curvature: points.iter().map(|p| p[0]).collect(),
        theta: points.clone(),
        folds: vec![("fold_0_1_0_0".into(), vec![0.5; n * n])],
        energy: Some(vec![1.0; n * n]),
        self_intersecting: Some(vec![0; n * n]),
    }
}
