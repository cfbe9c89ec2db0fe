//! The screw lattice: two commuting motions about one axis, which move vertex 0 on a cylinder.
//!
//! Let `theta_a s` be the rotation vectors of the lattice rotations with the common axis `s`, and `l_a` the chords from
//! vertex 0 (at the origin) to its copies, split into `s (s . l_a)` along and `p_a` across the axis:
//!
//! - **Towards the axis.** `k = sum of (1 - cos theta_a) p_a + sin theta_a s x p_a, over sum of |p_a|^2`. It points
//!   from vertex 0 to the axis, and its length is the inverse of the distance: for a point at `c` from the axis both
//!   lattice motions give `p = c - S c`. It passes smoothly through zero where the sheet becomes spatially periodic,
//!   and its computation needs only a rotation vector, which is accurate there.
//! - **Motion to any cell.** The sum of `S^k l` over `k < n` is, in the complex plane across the axis,
//!   `(e^(i n theta) - 1)/(e^(i theta) - 1) p = n phi(n theta)/phi(theta) p` with `phi(t) = (e^(it) - 1)/(it)`, which
//!   is `n` at `theta = 0` and has no singular point up to `|theta| = pi`. Copies of `x` are at
//!   `S1^n1 S2^n2 x + sum over k < n1 of S1^k l1 + S1^n1 sum over k < n2 of S2^k l2` (J. McInerney, B. G. Chen, L.
//!   Theran, C. D. Santangelo and D. Z. Rocklin, "Hidden symmetries generate rigid folding mechanisms in periodic
//!   origami", PNAS 117, 30252 (2020), appendix on vertex positions, where the last term has its powers interchanged).

use super::motion::{Motion, Moving};
use crate::math::{Vec3, rotation, sinc::phi};
use nalgebra::Complex;

/// Two commuting screw motions, relative to vertex 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Screw {
    /// Direction of the common axis, of length 1, such that the angle of larger absolute value is positive; `None` if
    /// there is no rotation. The error of the direction grows as the angles become small.
    pub axis: Option<Vec3>,
    /// Rotation angles about the axis from a cell to the next, in radians: the larger one in `[0, pi]`, the other one
    /// not larger in absolute value.
    pub theta: [f64; 2],
    /// Chords from vertex 0 to its two copies.
    pub chords: [Vec3; 2],
}

/// Rates of a screw with nonzero rotation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ScrewRate {
    /// Rate of the direction of the axis, in the frame of the embedding.
    pub axis: Vec3,
    /// Rates of the two angles.
    pub theta: [f64; 2],
    /// Rates of the chords.
    pub chords: [Vec3; 2],
    /// Rate of [`Screw::towards_axis`].
    pub towards_axis: Vec3,
}

impl Screw {
    /// Returns the screw of two lattice motions that commute up to rounding.
    pub(crate) fn new(lattice: &[Motion; 2]) -> Self {
        let turns = lattice.map(|motion| rotation::log(&motion.rotation));
        let larger = turns[dominant(&turns)];
        let angle = larger.norm();
        let axis = if angle > 0.0 { Some(larger / angle) } else { None };
        let theta = turns.map(|turn| axis.map_or(0.0, |axis| axis.dot(&turn)));
        Self { axis, theta, chords: lattice.map(|motion| motion.translation) }
    }

    /// Returns the vector from vertex 0 towards the axis, whose length is the inverse of the distance.
    ///
    /// It is zero if there is no rotation, and NaN if vertex 0 is on the axis.
    pub fn towards_axis(&self) -> Vec3 {
        let Some(axis) = self.axis else { return Vec3::zeros() };
        let parts = [0, 1].map(|a| {
            let across = self.chords[a] - axis * axis.dot(&self.chords[a]);
            let (sin, cos) = self.theta[a].sin_cos();
            ((1.0 - cos) * across + sin * axis.cross(&across), across.norm_squared())
        });
        (parts[0].0 + parts[1].0) / (parts[0].1 + parts[1].1)
    }

    /// Returns the translations along the axis from a cell to the next, along both lattice vectors.
    pub fn rise(&self) -> [f64; 2] {
        self.chords.map(|chord| self.axis.map_or(0.0, |axis| axis.dot(&chord)))
    }

    /// Returns the motion from cell (0, 0) to the cell `[n1, n2]`, by closed sums.
    pub fn motion(&self, [n1, n2]: [i32; 2]) -> Motion {
        let [n1, n2] = [f64::from(n1), f64::from(n2)];
        let turn = |angle: f64| self.axis.map_or_else(Vec3::zeros, |axis| axis * angle);
        let first = rotation::exp(&turn(n1 * self.theta[0]));
        Motion {
            rotation: rotation::exp(&turn(n1 * self.theta[0] + n2 * self.theta[1])),
            translation: self.sum(0, n1) + first * self.sum(1, n2),
        }
    }

    /// Returns the sum of `S^k l` over `k < n`, where `n` may be negative.
    fn sum(&self, a: usize, n: f64) -> Vec3 {
        let (chord, theta) = (self.chords[a], self.theta[a]);
        let Some(axis) = self.axis else { return n * chord };
        let along = axis * axis.dot(&chord);
        let ratio: Complex<f64> = phi(n * theta).value / phi(theta).value * n;
        n * along + ratio.re * (chord - along) + ratio.im * axis.cross(&chord)
    }

    /// Returns all rates, from those of the lattice motions; `None` if there is no rotation.
    ///
    /// The rate of a rotation vector is the inverse left Jacobian of the rotation group times the angular velocity. For
    /// the axis alone this is `(1 - S) ds = W x s` across the axis (appendix on displacements of the paper above).
    pub(crate) fn rate(&self, lattice: &[Moving; 2]) -> Option<ScrewRate> {
        let s = self.axis?;
        let turns = lattice.map(|moving| rotation::log(&moving.motion.rotation));
        let a = dominant(&turns);
        let turning = rotation::inverse_left_jacobian(&turns[a]) * lattice[a].twist.angular;
        let axis = (turning - s * s.dot(&turning)) / self.theta[a];
        let theta = lattice.map(|moving| s.dot(&moving.twist.angular));
        let chords = lattice.map(|moving| moving.twist.at(&moving.motion.translation));
        let (mut numerator, mut size, mut size_rate) = (Vec3::zeros(), 0.0, 0.0);
        for a in [0, 1] {
            let (l, dl, (sin, cos)) = (self.chords[a], chords[a], self.theta[a].sin_cos());
            let across = l - s * s.dot(&l);
            let rate = dl - axis * s.dot(&l) - s * (axis.dot(&l) + s.dot(&dl));
            numerator += theta[a] * (sin * across + cos * s.cross(&l));
            numerator += (1.0 - cos) * rate + sin * (axis.cross(&l) + s.cross(&dl));
            size += across.norm_squared();
            size_rate += 2.0 * across.dot(&rate);
        }
        let towards_axis = (numerator - self.towards_axis() * size_rate) / size;
        Some(ScrewRate { axis, theta, chords, towards_axis })
    }
}

/// Returns the index of the longer vector.
fn dominant(turns: &[Vec3; 2]) -> usize {
    usize::from(turns[1].norm_squared() > turns[0].norm_squared())
}

#[cfg(test)]
mod tests {
    use super::super::motion::{Line, Rigid};
    use super::*;
    use std::f64::consts::PI;

    /// Returns screw motions about an axis at some distance from the origin.
    fn about(distance: f64, theta: [f64; 2], rise: [f64; 2]) -> [Motion; 2] {
        let direction = Vec3::new(0.6, -0.64, 0.48);
        let line = Line { point: distance * Vec3::new(0.8, 0.48, -0.36), direction };
        [0, 1].map(|a| Motion::about(&line, theta[a]) * Motion::shift(rise[a] * direction))
    }

    /// Returns cylinders with chords of length about one: the radius grows as the angles decrease.
    fn unrolled(scale: f64) -> [Motion; 2] {
        if scale == 0.0 {
            return [Vec3::new(1.0, 0.2, 0.3), Vec3::new(-0.3, 1.0, 0.1)].map(Motion::shift);
        }
        about(1.0 / scale, [scale, -0.3 * scale], [0.5, 0.7])
    }

    /// Claim: axis, angles, distance and rise are those from which the motions were made, at angles from 1e-9 to nearly
    /// a half turn, with the axis reversed if the larger angle is negative; the vector ends on the axis. Tolerance:
    /// rounding of the motions divided by the angle.
    #[test]
    fn screw_is_as_made() {
        for (theta, sign) in [([0.3, -0.2], 1.0), ([0.2, -0.3], -1.0), ([PI - 1e-9, 1.0], 1.0), ([1e-9, -2e-9], -1.0)] {
            let screw = Screw::new(&about(2.0, theta, [0.5, 0.7]));
            let size = theta[0].abs().max(theta[1].abs());
            let tolerance = 1e-14 / size.min(1.0);
            assert!((screw.axis.unwrap() - sign * Vec3::new(0.6, -0.64, 0.48)).norm() <= tolerance);
            assert!((0..2).all(|a| (screw.theta[a] - sign * theta[a]).abs() <= 1e-15 * 4.0), "{:?}", screw.theta);
            assert!((screw.towards_axis() - Vec3::new(0.8, 0.48, -0.36) / 2.0).norm() <= tolerance);
            assert!((0..2).all(|a| (screw.rise()[a] - sign * [0.5, 0.7][a]).abs() <= tolerance));
        }
    }

    /// Claim: a lattice without rotation has no axis and no curvature, and cells are translated by the lattice vectors.
    #[test]
    fn nothing_turns() {
        let motions = unrolled(0.0);
        let screw = Screw::new(&motions);
        assert_eq!((screw.axis, screw.theta, screw.towards_axis()), (None, [0.0; 2], Vec3::zeros()));
        let far = screw.motion([3, -2]);
        assert_eq!(far.rotation, nalgebra::Matrix3::identity());
        let expected = 3.0 * motions[0].translation - 2.0 * motions[1].translation;
        assert!((far.translation - expected).norm() <= 1e-15);
    }

    /// Claim: the closed sums agree with the motions applied one by one, up to 50 cells each way, without rotation,
    /// with very small rotations, at an angle of one and at half turns. Tolerance: rounding of an angle, 2e-16, times
    /// the number of cells, times the distance of as many cells; both computations have this error.
    #[test]
    fn closed_sums_are_the_motions_done_one_by_one() {
        let half = |scale: f64| about(1.0, [PI, scale], [0.5, 0.7]);
        let cases = [unrolled(0.0), unrolled(1e-12), unrolled(1e-6), unrolled(1.0), unrolled(PI), half(1.0), half(PI)];
        let cells = [[0, 0], [1, 0], [0, -1], [2, 3], [-7, 5], [50, 0], [-50, 1], [50, -50], [49, 50], [-50, -50]];
        let x = Vec3::new(0.3, -0.4, 0.2);
        for motions in &cases {
            let screw = Screw::new(motions);
            for cell in cells {
                let way = cell.map(|n: i32| f64::from(n.abs())).iter().sum::<f64>() + 1.0;
                let expected = Motion::lattice_power(motions, cell).apply(&x);
                let error = (screw.motion(cell).apply(&x) - expected).norm();
                assert!(error <= 4e-16 * way * way, "{:?} {cell:?}: {error:e}", screw.theta);
            }
        }
    }
}
