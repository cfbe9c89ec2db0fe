//! Measures: scalar functions of a few points, the length of a bar and the fold angle of a hinge, with gradient and
//! Hessian.

use crate::math::taylor::{Path, Taylor, difference, dot};
use crate::math::{Vec3, fold_angle};
use nalgebra::SVector;

/// A scalar function of `N` points, which have `D = 3 N` coordinates: x, y and z of the first point, then those of the
/// next ones.
///
/// A [term of one's own](super::OwnTerm) has a measure of one's own.
pub trait Measure<const N: usize, const D: usize>: Send + Sync {
    /// Whether values are angles in radians, determined modulo 2 pi, that must continue from the last accepted state.
    const ANGLE: bool = false;
    /// Whether the points are `[i, j, left, right]` of a hinge and the Hessian does not couple `left` with `right`.
    const HINGE: bool = false;
    /// Returns the scalar.
    fn value(&self, points: &[Vec3; N]) -> f64;
    /// Returns the scalar and its gradient.
    fn gradient(&self, points: &[Vec3; N]) -> (f64, SVector<f64, D>);
    /// Returns the scalar and its gradient, and replaces `lower` by the lower triangle of its Hessian, row by row.
    fn hessian(&self, points: &[Vec3; N], lower: &mut Vec<f64>) -> (f64, SVector<f64, D>);
    /// Returns the Taylor series of the scalar while its points move along these paths; `None` for measures that
    /// landscapes do not know.
    fn along(&self, _paths: &[[Taylor; 3]; N]) -> Option<Taylor> {
        None
    }
}

/// The length of the bar between two points; not differentiable where they coincide.
#[derive(Clone, Copy, Debug, Default)]
pub struct Length;

impl Measure<2, 6> for Length {
    fn value(&self, [a, b]: &[Vec3; 2]) -> f64 {
        (b - a).norm()
    }

    fn gradient(&self, points: &[Vec3; 2]) -> (f64, SVector<f64, 6>) {
        let length = self.value(points);
        let unit = (1.0 / length) * (points[1] - points[0]);
        let mut gradient = SVector::<f64, 6>::zeros();
        gradient.fixed_rows_mut::<3>(0).copy_from(&-unit);
        gradient.fixed_rows_mut::<3>(3).copy_from(&unit);
        (length, gradient)
    }

    /// The Hessian is `(I - u u^T)/L` between the ends, `u` the direction of the bar.
    #[inline(always)]
    fn hessian(&self, points: &[Vec3; 2], lower: &mut Vec<f64>) -> (f64, SVector<f64, 6>) {
        let (length, gradient) = self.gradient(points);
        let [x, y, z] = [gradient[3], gradient[4], gradient[5]];
        let per_length = 1.0 / length;
        let [xx, yy, zz] = [x, y, z].map(|u| per_length * (1.0 - u * u));
        let [xy, xz, yz] = [x * y, x * z, y * z].map(|uv| -per_length * uv);
        lower.clear();
        #[rustfmt::skip]
        lower.extend_from_slice(&[
             xx,
             xy,  yy,
             xz,  yz,  zz,
            -xx, -xy, -xz, xx,
            -xy, -yy, -yz, xy, yy,
            -xz, -yz, -zz, xz, yz, zz,
        ]);
        (length, gradient)
    }

    fn along(&self, [a, b]: &[Path; 2]) -> Option<Taylor> {
        let bar = difference(b, a);
        Some(dot(&bar, &bar).sqrt())
    }
}

/// The fold angle of the hinge `[i, j, left, right]`; see [`crate::math::fold_angle`].
#[derive(Clone, Copy, Debug, Default)]
pub struct FoldAngle;

impl Measure<4, 12> for FoldAngle {
    const ANGLE: bool = true;
    const HINGE: bool = true;

    fn value(&self, points: &[Vec3; 4]) -> f64 {
        fold_angle::fold_angle(*points)
    }

    fn gradient(&self, points: &[Vec3; 4]) -> (f64, SVector<f64, 12>) {
        fold_angle::fold_angle_gradient(points)
    }

    #[inline(always)]
    fn hessian(&self, points: &[Vec3; 4], lower: &mut Vec<f64>) -> (f64, SVector<f64, 12>) {
        fold_angle::fold_angle_hessian(points, lower)
    }

    fn along(&self, points: &[Path; 4]) -> Option<Taylor> {
        Some(fold_angle::fold_angle_along(points))
    }
}
