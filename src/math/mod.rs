//! Geometry of points and rotations, and what else of mathematics knows no sheet.
//!
//! | file | what it is for |
//! |---|---|
//! | [`fold_angle`](mod@fold_angle) | the fold angle of a hinge, its gradient, Hessian and Taylor series |
//! | [`rotation`] | rotation matrices and rotation vectors |
//! | [`sinc`] | `(e^{it} - 1) / (it)` and its derivatives without a singular point |
//! | [`taylor`] | Taylor series of the fourth degree |
//!
//! # Example
//!
//! Two triangles that share the edge from `i` to `j`, the left one turned about it by a rotation vector:
//!
//! ```
//! use foldwell::math::{Vec3, fold_angle::fold_angle, rotation};
//!
//! let [i, j, right] = [Vec3::zeros(), Vec3::new(1.0, 0.0, 0.0), Vec3::new(0.5, -1.0, 0.0)];
//! let flat = Vec3::new(0.5, 1.0, 0.0);
//! assert_eq!(fold_angle([i, j, flat, right]), 0.0);
//!
//! let turn = rotation::exp(&Vec3::new(0.3, 0.0, 0.0));
//! // a valley: the faces rise towards the side of their normals
//! assert!((fold_angle([i, j, turn * flat, right]) - 0.3).abs() < 1e-15);
//! assert!((rotation::log(&turn) - Vec3::new(0.3, 0.0, 0.0)).norm() < 1e-15);
//! ```

pub(crate) mod expression;
pub mod fold_angle;
pub(crate) mod pieces;
pub(crate) mod quadrature;
pub mod rotation;
pub(crate) mod sinc;
pub(crate) mod taylor;

/// A point or a vector in space, in the user's unit of length.
pub type Vec3 = nalgebra::Vector3<f64>;

/// Returns point `k` of a list of coordinates, three for each point.
pub(crate) fn point(coordinates: &[f64], k: usize) -> Vec3 {
    Vec3::from_column_slice(&coordinates[3 * k..3 * k + 3])
}

/// Returns the place of the entry of a row and a column, or of the column and the row, in a lower triangle that is kept
/// row by row.
pub(crate) fn in_lower_triangle(row: usize, column: usize) -> usize {
    let (high, low) = (row.max(column), row.min(column));
    high * (high + 1) / 2 + low
}

/// Returns the rows and columns of the entries of a lower triangle, row by row.
pub(crate) fn lower_triangle(size: usize) -> impl Iterator<Item = (usize, usize)> {
    (0..size).flat_map(|row| (0..=row).map(move |column| (row, column)))
}

/// Returns a number as messages show it, with up to eight significant digits.
pub(crate) fn short(value: f64) -> String {
    let rounded = format!("{value:.7e}").parse().unwrap_or(value);
    let plain = rounded == 0.0 || (1e-4..1e15).contains(&rounded.abs());
    if plain { format!("{rounded}") } else { format!("{rounded:e}") }
}

/// A point or vector in the plane.
pub(crate) type Vec2 = nalgebra::Vector2<f64>;

/// Returns the corners of the box around points; without any, the first is infinite and the second minus infinite.
pub(crate) fn bounds<'a>(points: impl IntoIterator<Item = &'a Vec3>) -> [Vec3; 2] {
    let none = [Vec3::repeat(f64::INFINITY), Vec3::repeat(f64::NEG_INFINITY)];
    points.into_iter().fold(none, |[low, high], point| [low.inf(point), high.sup(point)])
}
