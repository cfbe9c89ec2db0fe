//! Small mathematics that every floor uses: points, rotations, the sinc family.

pub mod fold_angle;

/// A point or a vector in space, in the user's unit of length.
pub type Vec3 = nalgebra::Vector3<f64>;
