//! Small mathematics that every floor uses: points, the fold angle, rotations, the sinc family.

pub mod fold_angle;
pub mod rotation;
pub mod sinc;
pub mod taylor;

/// A point or a vector in space, in the user's unit of length.
pub type Vec3 = nalgebra::Vector3<f64>;
