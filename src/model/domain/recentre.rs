//! Moves the chart of a screw away from its singular places; the sheet moves only as a rigid body.

use super::screw::I;
use super::shared::seen_along;
use nalgebra::Complex;
use std::f64::consts::TAU;

/// Rotation angle of a lattice vector above which whole turns are subtracted; it is above pi, so that an angle that
/// stays near pi is not changed back and forth.
const UNWINDING_ANGLE_RAD: f64 = 4.0;

/// Moves the axis to the height twice `length` above z = 0 if it is nearer than `length`; returns whether it was.
pub(super) fn raise_axis(points: &mut [f64], shared: &mut [f64], length: f64) -> bool {
    let kappa = shared[1];
    if kappa.abs() * length <= 1.0 {
        return false;
    }
    let moved = 1.0 / (2.0 * length * kappa.signum());
    let d = 1.0 / moved - 1.0 / kappa;
    points.iter_mut().skip(2).step_by(3).for_each(|z| *z += d);
    let lattice = seen_along(shared).map(|l| Complex::new(l.re, l.im * kappa / moved));
    shared[1] = moved;
    lay(lattice, shared);
    true
}

/// Subtracts whole turns from the rotations and from the direction of the axis; returns whether there were any.
pub(super) fn unwind(shared: &mut [f64]) -> bool {
    let around = shared[0].abs() > UNWINDING_ANGLE_RAD;
    if around {
        shared[0] -= TAU * (shared[0] / TAU).round();
    }
    let (kappa, lattice) = (shared[1], seen_along(shared));
    let wound = |l: &Complex<f64>| (kappa * l.im).abs() > UNWINDING_ANGLE_RAD;
    if !lattice.iter().any(wound) {
        return around;
    }
    let turns = |l: Complex<f64>| if wound(&l) { (kappa * l.im / TAU).round() } else { 0.0 };
    lay(lattice.map(|l| l - I * (TAU / kappa * turns(l))), shared);
    true
}

/// Rotates the sheet in the plane so that the first lattice vector lies along x again, if it lies more across x than
/// along it; returns whether it did.
pub(super) fn turn_back(points: &mut [f64], shared: &mut [f64]) -> bool {
    let first = Complex::new(shared[4], shared[2]);
    if first.im.abs() <= first.re.abs() {
        return false;
    }
    let back = first.conj() / first.norm();
    for point in points.chunks_exact_mut(3) {
        let turned = back * Complex::new(point[0], point[1]);
        (point[0], point[1]) = (turned.re, turned.im);
    }
    for k in [2, 3] {
        let turned = back * Complex::new(shared[k + 2], shared[k]);
        (shared[k + 2], shared[k]) = (turned.re, turned.im);
    }
    shared[0] += back.arg();
    true
}

/// Sets the lattice to vectors that are given by their components along and across the axis.
fn lay(lattice: [Complex<f64>; 2], shared: &mut [f64]) {
    let forth = Complex::new(shared[0].cos(), shared[0].sin());
    for (k, l) in lattice.into_iter().enumerate() {
        let l = forth * l;
        (shared[k + 4], shared[k + 2]) = (l.re, l.im);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Vec3;
    use crate::model::{Domain, ScrewTurns, Site};
    use nalgebra::Rotation3;

    /// Claim: moving the axis shifts every copy of every vertex by the same height, whatever the curvature, so that
    /// lengths and fold angles stay. Source: theory of the screw chart. Tolerance: rounding of numbers of size 1.
    #[test]
    fn recentring_moves_all_points_by_the_same_height() {
        for kappa in [3.0, -2.5, 1e4, 1e-3] {
            let old = vec![0.0, 0.0, 0.0, 0.7, -0.2, 0.4, 0.0, kappa, 0.3 / kappa, -0.9 / kappa, 1.1, 0.2];
            let mut new = old.clone();
            let (points, shared) = new.split_at_mut(6);
            assert_eq!(raise_axis(points, shared, 0.8), kappa.abs() * 0.8 > 1.0);
            assert!(new[7].abs() * 0.8 <= 1.0);
            let height = new[2] - old[2];
            for vertex in 0..2 {
                for shift in [[0, 0], [1, 0], [0, 1], [-2, 3]] {
                    let site = Site { vertex, shift };
                    let moved = Domain::Screw.point(&new, site) - Domain::Screw.point(&old, site);
                    assert!((moved - Vec3::new(0.0, 0.0, height)).norm() < 1e-14, "{kappa} {site:?} {moved}");
                }
            }
        }
    }

    /// Claim: subtracting a whole turn from a lattice rotation leaves the map unchanged, and afterwards no rotation
    /// is much larger than pi, whatever the direction of the axis. Tolerance: rounding of numbers of size 50.
    #[test]
    fn whole_turns_are_taken_back() {
        let cases =
            [(0.12, [-6.0, 12.5], 0.0), (-0.3, [5.0, 0.4], 1.1), (0.3, [3.9, -3.9], -2.0), (0.3, [0.1, 0.2], -40.0)];
        for (kappa, theta, direction) in cases {
            let mut old = vec![0.0, 0.0, 1.2, 0.7, -0.2, 0.4, direction, kappa, 0.0, 0.0, 0.0, 0.0];
            lay([Complex::new(1.1, theta[0] / kappa), Complex::new(0.2, theta[1] / kappa)], &mut old[6..]);
            let mut new = old.clone();
            let wound = theta.iter().chain([&direction]).any(|angle: &f64| angle.abs() > 4.0);
            assert_eq!(unwind(&mut new[6..]), wound);
            for vertex in 0..2 {
                for shift in [[1, 0], [0, 1], [-2, 3]] {
                    let site = Site { vertex, shift };
                    let off = Domain::Screw.point(&new, site) - Domain::Screw.point(&old, site);
                    assert!(off.norm() < 1e-12, "{kappa} {site:?} {off}");
                }
            }
            let ScrewTurns { direction, theta, .. } = ScrewTurns::new(&new[6..]);
            assert!(theta.iter().chain([&direction]).all(|angle| angle.abs() <= 4.0), "{new:?}");
        }
    }

    /// Claim: if the first lattice vector lies across x, all points are rotated about z by the same angle until it
    /// lies along x; otherwise no point moves. Tolerance: rounding of numbers of size 10.
    #[test]
    fn the_first_lattice_vector_is_kept_along_x() {
        for (x1, y1) in [(1.0, 0.9), (0.3, -1.0), (-0.2, 1.4), (-1.0, 0.1)] {
            let old = vec![0.0, 0.0, 0.3, 0.7, -0.2, 0.4, 0.6, 0.3, y1, 1.5, x1, 0.4];
            let mut new = old.clone();
            let across = f64::abs(y1) > f64::abs(x1);
            assert_eq!(Domain::Screw.recentre(&mut new, 0.8), across);
            assert!(new[8].abs() <= if across { 1e-15 } else { f64::abs(x1) });
            let turn = if across { Rotation3::new(-Vec3::z() * y1.atan2(x1)) } else { Rotation3::identity() };
            for vertex in 0..2 {
                for shift in [[0, 0], [1, 0], [0, 1], [-2, 3]] {
                    let site = Site { vertex, shift };
                    let off = Domain::Screw.point(&new, site) - turn * Domain::Screw.point(&old, site);
                    assert!(off.norm() < 1e-14, "{x1} {y1} {site:?} {off}");
                }
            }
        }
    }

    /// Claim: near zero curvature a rotation of the axis by any angle moves points by no more than the curvature
    /// times the square of the distances, with all digits: the displacement by bending equals, to rounding, a
    /// thousandth of that at a thousand times the curvature. Tolerance: the next order in the curvature.
    #[test]
    fn what_bends_keeps_its_digits_near_zero_curvature() {
        let coordinates = |kappa: f64| vec![0.0, 0.0, 0.0, 0.7, -0.2, 0.4, 0.6, kappa, 0.0, 1.5, 1.2, 0.4];
        for power in [100, 50, 20, 12] {
            let derivative = |kappa: f64| {
                let x = coordinates(kappa);
                Domain::Screw.velocity(
                    &x,
                    Site { vertex: 1, shift: [2, -1] },
                    &[&[0.0; 6][..], &[1.0], &[0.0; 5]].concat(),
                )
            };
            let kappa = 10f64.powi(-power);
            let (small, large) = (derivative(kappa) / kappa, derivative(1e3 * kappa) / (1e3 * kappa));
            let off = (small - large).norm() / small.norm();
            assert!(off <= 1e4 * kappa + 4.0 * f64::EPSILON && small.norm() > 0.1, "{kappa:e} {off:e} {small}");
        }
    }
}
