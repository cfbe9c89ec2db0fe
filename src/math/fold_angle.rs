//! The fold angle of a hinge drawn by four points.

use super::Vec3;

/// Fold angle of the hinge `[i, j, left, right]` in radians, in `(-pi, pi]`: 0 flat, valley positive.
///
/// ```text
///            left           with e = j - i, a = left - i, b = right - i and the normals
///           /    \            n_l = e x a,  n_r = b x e:
///          i ---- j
///           \    /            rho = atan2( |e| a . n_r, n_l . n_r )
///            right
/// ```
///
/// Both faces are counter-clockwise seen from the side of their normals; the angle is positive when they rise towards
/// that side. `atan2` of a triple product and a dot product keeps all digits near 0 and near pi, where `acos` loses half
/// of them. Degenerate faces give 0 or pi, never NaN, as long as the points are finite.
///
/// Check: at a valley the left wing lies above the right face, so `a . n_r > 0`.
pub fn fold_angle(p: [Vec3; 4]) -> f64 {
    let [i, j, left, right] = p;
    let (e, a, b) = (j - i, left - i, right - i);
    let (n_left, n_right) = (e.cross(&a), b.cross(&e));
    (e.norm() * a.dot(&n_right)).atan2(n_left.dot(&n_right))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    /// A hinge along y, its left wing (x < 0) and its right wing (x > 0) both raised by half of `rho`.
    fn hinge(rho: f64) -> [Vec3; 4] {
        let (s, c) = (rho / 2.0).sin_cos();
        [Vec3::zeros(), Vec3::new(0.0, 2.0, 0.0), Vec3::new(-c, 0.7, s), Vec3::new(1.5 * c, 0.3, 1.5 * s)]
    }

    /// Claim: the angle by which both wings were turned comes back with its sign, also next to 0 and pi.
    /// Tolerance: a few units of rounding in cross products of vectors of length about 1.
    #[test]
    fn valley_is_positive() {
        for rho in [1e-9, 0.3, 1.7, 3.0, PI - 1e-9, -1e-9, -0.3, -2.9] {
            assert!((fold_angle(hinge(rho)) - rho).abs() < 4e-15, "{rho}");
        }
    }

    /// Claim: turning the hinge end for end, wings exchanged, names the same angle.
    #[test]
    fn does_not_depend_on_the_direction_of_the_edge() {
        let [i, j, l, r] = hinge(0.8);
        assert!((fold_angle([j, i, r, l]) - 0.8).abs() < 1e-15);
    }
}
