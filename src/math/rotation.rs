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

/// Derivatives of a vector that a rotation vector turns, by the components of that.
pub(crate) struct Turned {
    /// First derivatives.
    pub first: [Vec3; 3],
    /// Second derivatives; symmetric.
    pub second: [[Vec3; 3]; 3],
}

/// Derivatives of the vector `arm` turned by the rotation vector `v`, which may have any length.
///
/// With `s = |v|^2`, `p = v x arm` and `q = v x p` the turned vector is `arm + a(s) p + b(s) q` (Rodrigues), and its
/// derivatives follow from those of `a`, `b`, `p` and `q`.
pub(crate) fn turned(v: &Vec3, arm: &Vec3) -> Turned {
    let [[a, a1, a2], [b, b1, b2]] = rodrigues(v.norm_squared());
    let axes = [Vec3::x(), Vec3::y(), Vec3::z()];
    let (p, crossed) = (v.cross(arm), axes.map(|axis| axis.cross(arm)));
    let q = v.cross(&p);
    let turned_q = [0, 1, 2].map(|k| axes[k].cross(&p) + v.cross(&crossed[k]));
    let [lower, higher] = [a1 * p + b1 * q, a2 * p + b2 * q];
    let first = |k: usize| a * crossed[k] + b * turned_q[k] + 2.0 * v[k] * lower;
    let by_size = |k: usize| a1 * crossed[k] + b1 * turned_q[k];
    let second = |k: usize, l: usize| {
        let of_q = b * (axes[k].cross(&crossed[l]) + axes[l].cross(&crossed[k]));
        let same = if k == l { 2.0 * lower } else { Vec3::zeros() };
        of_q + 2.0 * (v[l] * by_size(k) + v[k] * by_size(l)) + same + 4.0 * v[k] * v[l] * higher
    };
    Turned { first: [0, 1, 2].map(first), second: [0, 1, 2].map(|k| [0, 1, 2].map(|l| second(k, l))) }
}

/// Square of an angle up to which the functions of [`rodrigues`] are computed by their power series, and the number of
/// its terms: the first one left out is below 1e-19.
const LARGEST_SERIES_SQUARE: f64 = 2.25;
const SERIES_TERMS: i32 = 12;

/// The functions `a(s) = sin(t)/t` and `b(s) = (1 - cos t)/t^2` of `s = t^2`, each with its first two derivatives by
/// `s`.
fn rodrigues(s: f64) -> [[f64; 3]; 2] {
    if s <= LARGEST_SERIES_SQUARE { [1.0, 2.0].map(|first| rodrigues_series(s, first)) } else { rodrigues_closed(s) }
}

/// The sum of `(-s)^k / (2k + first)!` with its first two derivatives: `a` for 1, `b` for 2.
fn rodrigues_series(s: f64, first: f64) -> [f64; 3] {
    let mut sums = [0.0; 3];
    let mut term = if first == 1.0 { 1.0 } else { 0.5 };
    // of each derivative the term with the power s^(k - derivative), from coefficients alone
    let mut powers = [1.0, 0.0, 0.0];
    for k in 0..SERIES_TERMS {
        let order = f64::from(k);
        (0..3).for_each(|n| sums[n] += term * powers[n]);
        let factor = 2.0 * order + first;
        term /= -(factor + 1.0) * (factor + 2.0);
        // s^k and its derivatives: (s^(k+1))' = (k+1) s^k, (s^(k+1))'' = (k+1) k s^(k-1)
        powers = [s * powers[0], (order + 1.0) * powers[0], (order + 1.0) * powers[1]];
    }
    sums
}

fn rodrigues_closed(s: f64) -> [[f64; 3]; 2] {
    let t = s.sqrt();
    let half = (0.5 * t).sin();
    let (a, b) = (t.sin() / t, 2.0 * half * half / s);
    let (a1, b1) = ((t.cos() - a) / (2.0 * s), (0.5 * a - b) / s);
    let (a2, b2) = ((-0.25 * a - 1.5 * a1) / s, (0.5 * a1 - 2.0 * b1) / s);
    [[a, a1, a2], [b, b1, b2]]
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
