//! Rotations of space and their rotation vectors.
//!
//! The rotation vector of a rotation is its axis times its angle. It comes from the quaternion by `atan2`, never from
//! `acos` of the trace, which loses half the digits at 0 and at pi and the sign everywhere.

use super::{Vec3, sinc::phi};
use nalgebra::Matrix3;

/// The rotation about `v` by the angle `|v|`: `I + sin(t)/t [v]x + (1 - cos t)/t^2 [v]x^2` with `t = |v|` (Rodrigues).
pub fn exp(v: &Vec3) -> Matrix3<f64> {
    let angle = v.norm();
    let (whole, half) = (phi(angle).value.re, phi(0.5 * angle).value.re);
    let cross = v.cross_matrix();
    Matrix3::identity() + whole * cross + (0.5 * half * half) * cross * cross
}

/// The rotation vector of a rotation matrix, of length at most pi; the inverse of [`exp`].
///
/// All digits are kept at 0 and near pi. At pi itself the axis is one of the two opposite ones. The matrix has to be a
/// rotation up to rounding; for any other the result means nothing (it is not a number where an entry is none).
pub fn log(rotation: &Matrix3<f64>) -> Vec3 {
    let (scalar, vector) = quaternion(rotation);
    let (scalar, vector) = if scalar < 0.0 { (-scalar, -vector) } else { (scalar, vector) };
    let length = vector.norm();
    if length == 0.0 { vector * (2.0 / scalar) } else { vector * (2.0 * length.atan2(scalar) / length) }
}

/// The quaternion of a rotation matrix, from the largest of its four components (S. W. Shepperd, "Quaternion from
/// rotation matrix", Journal of Guidance and Control 1, 223, 1978).
fn quaternion(r: &Matrix3<f64>) -> (f64, Vec3) {
    let trace = r.trace();
    let largest = (0..3).max_by(|&i, &j| r[(i, i)].total_cmp(&r[(j, j)])).unwrap_or(0);
    if trace >= r[(largest, largest)] {
        let scalar = 0.5 * (1.0 + trace).sqrt();
        return (scalar, Vec3::new(r.m32 - r.m23, r.m13 - r.m31, r.m21 - r.m12) / (4.0 * scalar));
    }
    let [i, j, k] = [largest, (largest + 1) % 3, (largest + 2) % 3];
    let main = 0.5 * (1.0 + 2.0 * r[(i, i)] - trace).sqrt();
    let mut vector = Vec3::zeros();
    vector[i] = main;
    vector[j] = (r[(i, j)] + r[(j, i)]) / (4.0 * main);
    vector[k] = (r[(i, k)] + r[(k, i)]) / (4.0 * main);
    ((r[(k, j)] - r[(j, k)]) / (4.0 * main), vector)
}

/// The inverse left Jacobian of the rotation group at a rotation vector shorter than 2 pi.
///
/// Where a rotation `R` with rotation vector `v` changes at the rate `w`, `dR = [w]x R`, its rotation vector changes at
/// the rate `J w` with `J = I - [v]x / 2 + c [v]x^2` and `c = (1 - (t/2) cot(t/2)) / t^2`, `t = |v|` (T. D. Barfoot,
/// "State Estimation for Robotics", 2017, section 7.1.5). With `s(x) = sin(x)/x` and `x = t/2` this is
/// `c = (s(x) + s''(x)) / (8 s(x))`, which has no singular point below `t = 2 pi`.
pub(crate) fn inverse_left_jacobian(v: &Vec3) -> Matrix3<f64> {
    let half = phi(0.5 * v.norm());
    let factor = (half.value.re + half.second.re) / (8.0 * half.value.re);
    let cross = v.cross_matrix();
    Matrix3::identity() - 0.5 * cross + factor * cross * cross
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    const AXES: [[f64; 3]; 6] =
        [[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 1.0], [0.6, -0.64, 0.48], [-1e-9, 1.0, 0.0], [2.0, 2.0, 1.0]];

    fn axes() -> impl Iterator<Item = Vec3> {
        AXES.into_iter().map(|axis| Vec3::from(axis).normalize())
    }

    /// Claim: exp gives rotations, agrees with nalgebra's own, and log takes it back with all digits, at 0, in between
    /// and next to pi. Tolerance: some units of rounding of the angle, and of the matrix entries for the angle's error.
    #[test]
    fn log_inverts_exp() {
        for axis in axes() {
            for angle in [0.0, 1e-300, 1e-12, 1e-4, 0.1, 1.0, 2.0, 2.2, 3.0, PI - 1e-3, PI - 1e-8, PI - 1e-13] {
                let (v, rotation) = (axis * angle, exp(&(axis * angle)));
                assert!((rotation.transpose() * rotation - Matrix3::identity()).amax() <= 1e-15);
                assert!((rotation - nalgebra::Rotation3::new(v).matrix()).amax() <= 1e-15);
                assert!(
                    (log(&rotation) - v).norm() <= 2e-15 * angle,
                    "{axis:?} {angle}: {:e}",
                    (log(&rotation) - v).norm()
                );
            }
        }
    }

    /// Claim: at a half turn, where the axis is known up to sign, log still gives a half turn about it.
    #[test]
    fn half_turns() {
        for axis in axes() {
            let half_turn = 2.0 * axis * axis.transpose() - Matrix3::identity();
            let v = log(&half_turn);
            assert!((v.norm() - PI).abs() <= 1e-15 * PI && v.cross(&axis).norm() <= 1e-15 * PI);
        }
    }

    /// Claim: longer vectors come back as the short one of the same rotation, pointing the other way beyond pi.
    #[test]
    fn beyond_pi_the_axis_turns_around() {
        for axis in axes() {
            assert!((log(&exp(&(axis * 4.0))) - axis * (4.0 - 2.0 * PI)).norm() <= 4e-15);
        }
    }

    /// Claim: the inverse left Jacobian is the derivative of log along `[w]x R`, at 0, in between and near pi, and not
    /// singular there. Extrapolated central differences of step 1e-3: error h^4 and rounding/h, below 1e-11.
    #[test]
    fn jacobian_is_the_derivative_of_log() {
        for axis in axes() {
            for angle in [0.0, 1e-9, 1e-3, 0.7, 2.0, 3.0] {
                let (v, rotation) = (axis * angle, exp(&(axis * angle)));
                let jacobian = inverse_left_jacobian(&v);
                for (column, w) in Matrix3::<f64>::identity().column_iter().enumerate() {
                    let moved = |step: f64| log(&(exp(&(w * step)) * rotation));
                    let [wide, narrow] = [2e-3, 1e-3].map(|h| (moved(h) - moved(-h)) / (2.0 * h));
                    let expected = (4.0 * narrow - wide) / 3.0;
                    assert!((jacobian.column(column) - expected).norm() <= 1e-11, "{angle} {column}");
                }
            }
        }
    }

    /// Claim: the factor without singular point is the textbook one. Tolerance: cancellation in the textbook form.
    #[test]
    fn jacobian_factor_is_the_textbook_one() {
        for t in [0.05, 0.5, 1.0, 2.0, 3.0, 3.1, PI, 5.0, 6.2] {
            let (half, axis) = (0.5 * t, Vec3::new(0.0, 0.0, 1.0));
            let textbook = 1.0 - half / half.tan();
            let entry = inverse_left_jacobian(&(axis * t))[(0, 0)];
            assert!((entry - (1.0 - textbook)).abs() <= 2e-14 * textbook.abs().max(1.0), "{t}");
        }
    }
}
