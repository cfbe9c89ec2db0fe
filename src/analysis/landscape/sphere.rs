//! Energies over the sphere of the modes that curvature tensors name.
//!
//! A tensor `K` is the point `(k11, k22, sqrt(2) k12)`, so that distances are those of tensors and do not depend on
//! axes. The sphere is laid out round the tensors of equal curvature in all directions, `u = (k11 + k22)/sqrt(2)`:
//! rings of equal polar angle, on which `2 (k11 k22 - k12^2) = u^2 - (1 - u^2)` is constant. So the linear cone of
//! cylinders is the rings at 45 degrees and the equator has opposite curvatures.

use super::samples::{Sample, SampleError, Samples};
use super::{HeldSheet, TaylorPaths};
use crate::math::Vec3;
use crate::numerics::parallel;
use std::f64::consts::{FRAC_PI_2, PI, SQRT_2, TAU};

/// A direction: polar angle from `k11 = k22 > 0`, and azimuth (of which half is the direction of the larger curvature).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Direction {
    /// From 0 to pi.
    pub polar: f64,
    /// From 0 to 2 pi.
    pub azimuth: f64,
}

impl Direction {
    /// The point on the unit sphere: `(k11 + k22, k11 - k22, 2 k12) / sqrt(2)`.
    pub fn point(&self) -> Vec3 {
        let (sin, cos) = self.polar.sin_cos();
        Vec3::new(cos, sin * self.azimuth.cos(), sin * self.azimuth.sin())
    }

    /// Of a point.
    pub fn of(point: &Vec3) -> Self {
        let across = point.y.hypot(point.z);
        Self { polar: across.atan2(point.x), azimuth: point.z.atan2(point.y).rem_euclid(TAU) }
    }
}

/// The curvature tensor of a point.
pub fn curvature(point: &Vec3) -> [f64; 3] {
    [(point.x + point.y) / SQRT_2, (point.x - point.y) / SQRT_2, point.z / SQRT_2]
}

/// The point of a curvature tensor.
pub fn point([k11, k22, k12]: [f64; 3]) -> Vec3 {
    Vec3::new((k11 + k22) / SQRT_2, (k11 - k22) / SQRT_2, SQRT_2 * k12)
}

/// A net on the sphere: `rings` from each pole to the equator.
pub struct SphereNet {
    /// Its directions: a pole, ring after ring, the other pole.
    pub directions: Vec<Direction>,
    /// Triangles, seen from outside counter-clockwise.
    pub triangles: Vec<[usize; 3]>,
}

impl SphereNet {
    /// With this number of rings from pole to equator, and four times as many points on each.
    pub fn new(rings: usize) -> Self {
        let (around, between) = (4 * rings, 2 * rings - 1);
        let ring = |r: usize| {
            (0..around).map(move |k| Direction {
                polar: (r + 1) as f64 * FRAC_PI_2 / rings as f64,
                azimuth: k as f64 * TAU / around as f64,
            })
        };
        let pole = |polar| Direction { polar, azimuth: 0.0 };
        let directions: Vec<Direction> =
            std::iter::once(pole(0.0)).chain((0..between).flat_map(ring)).chain([pole(PI)]).collect();
        let at = |r: usize, k: usize| 1 + r * around + k % around;
        let last = directions.len() - 1;
        let mut triangles = Vec::new();
        for k in 0..around {
            triangles.push([0, at(0, k), at(0, k + 1)]);
            for r in 0..between - 1 {
                triangles.push([at(r, k), at(r + 1, k), at(r + 1, k + 1)]);
                triangles.push([at(r, k), at(r + 1, k + 1), at(r, k + 1)]);
            }
            triangles.push([at(between - 1, k), last, at(between - 1, k + 1)]);
        }
        Self { directions, triangles }
    }
}

/// The sample in a direction, relaxed from where third order says it is: nothing of other samples enters.
pub(crate) fn sample(
    held: &HeldSheet,
    courses: &TaylorPaths,
    direction: &Vec3,
    amplitude: f64,
) -> Result<Sample, SampleError> {
    let rates = held.named(curvature(direction))?;
    let course = courses.along(held, &rates);
    Samples::new(held, course).at(amplitude, &mut |_| true)
}

/// Samples at points of the unit sphere, shared out over the threads; the same numbers for any number of threads.
/// `go_on` is asked before each; those that come after it said no are `None`.
pub fn samples(
    held: &HeldSheet,
    courses: &TaylorPaths,
    points: &[Vec3],
    amplitude: f64,
    go_on: &(dyn Fn() -> bool + Sync),
) -> Vec<Option<Result<Sample, SampleError>>> {
    parallel::map_with_state(points.len(), || (), |(), k| go_on().then(|| sample(held, courses, &points[k], amplitude)))
}
