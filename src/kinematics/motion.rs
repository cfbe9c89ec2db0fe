//! Rigid motions `x -> S x + l`, and their velocities.
//!
//! While a motion changes, the point that it has moved to `x` has the velocity `w x x + u`: the twist `(w, u)` of the
//! motion. The product rule is `twist(A B) = twist(A) + twist(B) carried by A`, where carrying rotates `w` and `u` by
//! `S` and adds `l x (S w)` to `u` (R. M. Murray, Z. Li and S. S. Sastry, "A Mathematical Introduction to Robotic
//! Manipulation", 1994, section 2.4: spatial velocities and the adjoint). A quantity that is built from motions by
//! products and inverses is differentiated by building it from [`Moving`] ones.

use crate::math::Vec3;
use nalgebra::Matrix3;
use std::ops::{Add, Mul};

/// Types with the composition of rigid motions; `A * B` applies `B` first and `A` after it.
pub(crate) trait Rigid: Copy + Mul<Output = Self> {
    /// Returns a motion that does not change.
    fn constant(motion: Motion) -> Self;
    /// Returns the inverse motion.
    fn inverse(&self) -> Self;

    /// Returns the motion that adds a vector to every point.
    fn shift(by: Vec3) -> Self {
        Self::constant(Motion { rotation: Matrix3::identity(), translation: by })
    }

    /// Returns the motion that leaves every point unchanged.
    fn identity() -> Self {
        Self::shift(Vec3::zeros())
    }

    /// Returns the motion applied `n` times, or its inverse `-n` times if `n` is negative.
    fn power(&self, n: i32) -> Self {
        let once = if n < 0 { self.inverse() } else { *self };
        (0..n.unsigned_abs()).fold(Self::identity(), |done, _| done * once)
    }

    /// Returns the motion that applies the second motion `n2` times and then the first `n1` times.
    fn lattice_power([first, second]: &[Self; 2], [n1, n2]: [i32; 2]) -> Self {
        first.power(n1) * second.power(n2)
    }
}

/// A straight line with a direction, the axis of a rotation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Line {
    /// A point on the line.
    pub point: Vec3,
    /// Direction of the line, of length 1.
    pub direction: Vec3,
}

/// The rigid motion `x -> S x + l`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motion {
    /// The rotation `S`.
    pub rotation: Matrix3<f64>,
    /// The translation `l`, the image of the origin.
    pub translation: Vec3,
}

/// The velocities `w x x + u` of the points of a rigid body, per unit of the parameter of the motion.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Twist {
    /// The angular velocity `w`.
    pub angular: Vec3,
    /// The velocity `u` of the point at the origin.
    pub linear: Vec3,
}

/// A motion with its twist.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moving {
    /// The motion.
    pub motion: Motion,
    /// The velocities of the points at their positions after the motion.
    pub twist: Twist,
}

impl Motion {
    /// Returns the rotation about a line by an angle in radians, counter-clockwise seen against the direction of the
    /// line.
    pub(crate) fn about(line: &Line, angle: f64) -> Self {
        let (sin, cos) = angle.sin_cos();
        let [x, y, z] = (sin * line.direction).into();
        let dyad = (1.0 - cos) * line.direction * line.direction.transpose();
        let rotation = dyad + Matrix3::new(cos, -z, y, z, cos, -x, -y, x, cos);
        Self { rotation, translation: line.point - rotation * line.point }
    }

    /// Returns the image of a point.
    pub fn apply(&self, x: &Vec3) -> Vec3 {
        self.rotation * x + self.translation
    }
}

impl Rigid for Motion {
    fn constant(motion: Motion) -> Self {
        motion
    }

    fn inverse(&self) -> Self {
        let rotation = self.rotation.transpose();
        Self { rotation, translation: -(rotation * self.translation) }
    }
}

impl Mul for Motion {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        Self { rotation: self.rotation * other.rotation, translation: self.apply(&other.translation) }
    }
}

impl Twist {
    /// Returns the twist of a rotation about a line at an angular speed.
    pub(crate) fn about(line: &Line, speed: f64) -> Self {
        let angular = speed * line.direction;
        Self { angular, linear: line.point.cross(&angular) }
    }

    /// Returns the velocity of the point at `x`.
    pub fn at(&self, x: &Vec3) -> Vec3 {
        self.angular.cross(x) + self.linear
    }

    /// Returns the same velocities for a body that was displaced by a motion.
    pub(crate) fn carried_by(&self, motion: &Motion) -> Self {
        let angular = motion.rotation * self.angular;
        Self { angular, linear: motion.rotation * self.linear + motion.translation.cross(&angular) }
    }
}

impl Add for Twist {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self { angular: self.angular + other.angular, linear: self.linear + other.linear }
    }
}

impl Moving {
    /// Returns the rotation about a line by an angle that changes at an angular speed.
    pub(crate) fn about(line: &Line, angle: f64, speed: f64) -> Self {
        Self { motion: Motion::about(line, angle), twist: Twist::about(line, speed) }
    }

    /// Returns the velocity of the image of a point that itself moves with `velocity`.
    pub(crate) fn carry(&self, x: &Vec3, velocity: &Vec3) -> Vec3 {
        self.twist.at(&self.motion.apply(x)) + self.motion.rotation * velocity
    }
}

impl Rigid for Moving {
    fn constant(motion: Motion) -> Self {
        Self { motion, twist: Twist::default() }
    }

    fn inverse(&self) -> Self {
        let motion = self.motion.inverse();
        let Twist { angular, linear } = self.twist.carried_by(&motion);
        Self { motion, twist: Twist { angular: -angular, linear: -linear } }
    }
}

impl Mul for Moving {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        Self { motion: self.motion * other.motion, twist: self.twist + other.twist.carried_by(&self.motion) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kinematics::test_sheets::random_numbers;
    use crate::numerics::DenseMatrix;
    use crate::numerics::derivatives::{TOLERANCE, check_jacobian};

    fn line(seed: u64) -> Line {
        let numbers = random_numbers(seed, 6);
        Line {
            point: Vec3::from_column_slice(&numbers[..3]),
            direction: Vec3::from_column_slice(&numbers[3..]).normalize(),
        }
    }

    /// Claim: a rotation keeps its axis fixed and rotates as the rotation vector says; inverses and powers cancel each
    /// other. Tolerance: rounding of products of ten motions.
    #[test]
    fn motions_are_a_group() {
        let (a, b) = (Motion::about(&line(1), 2.1), Motion::about(&line(2), -0.4));
        let x = Vec3::new(0.3, -0.7, 1.1);
        let on_line = line(1).point + 3.0 * line(1).direction;
        assert!((a.apply(&on_line) - on_line).norm() <= 3e-15);
        assert!((a.rotation - crate::math::rotation::exp(&(2.1 * line(1).direction))).amax() <= 1e-15);
        assert!(((a * b).apply(&x) - a.apply(&b.apply(&x))).norm() <= 3e-15);
        assert!((a.inverse().apply(&a.apply(&x)) - x).norm() <= 3e-15);
        let there = Motion::lattice_power(&[a, b], [3, -2]);
        let back = b.power(2) * a.power(-3);
        assert!((back.apply(&there.apply(&x)) - x).norm() <= 1e-14);
    }

    /// Claim: the twist of products, inverses and powers is the derivative of the image of a moving point.
    #[test]
    fn twists_are_derivatives() {
        let (speeds, velocity) = ([0.7, -1.3], Vec3::new(0.2, 0.5, -0.4));
        let (x, angles) = (Vec3::new(0.3, -0.7, 1.1), [2.1, -0.4]);
        let built = |t: f64| {
            let [a, b] = [0, 1].map(|k| Moving::about(&line(k as u64), angles[k] + t * speeds[k], speeds[k]));
            a * (b * a).inverse() * Moving::lattice_power(&[b, a], [-2, 3]) * Moving::shift(Vec3::new(1.0, 2.0, 3.0))
        };
        let place = |t: &[f64]| built(t[0]).motion.apply(&(x + t[0] * velocity)).as_slice().to_vec();
        let found = DenseMatrix::from_column_slice(3, 1, built(0.0).carry(&x, &velocity).as_slice());
        check_jacobian(place, &[0.0], &found, TOLERANCE).unwrap();
    }
}
