//! The safe sinc family: `phi(t) = (e^{it} - 1) / (it)` and its derivatives, without a singular point.
//!
//! `phi(t)` is the integral of `e^{itu}` over `u` from 0 to 1, so that its real part is `sin(t)/t`, its imaginary part
//! `(1 - cos t)/t`, and its derivatives are `i^d m_d` with the moments `m_d(t)`, the integral of `u^d e^{itu}`:
//!
//! - `|t|` at most 1.5: the power series `m_2 = sum over k of (it)^k / (k! (k + 3))`, and integration by parts
//!   downwards, `m_{d-1} = (e^{it} - it m_d) / d`;
//! - beyond: integration by parts upwards, `m_d = (e^{it} - d m_{d-1}) / (it)`.
//!
//! Both are good to some units in the last place at the switch, so that nothing jumps there.

use nalgebra::Complex;

/// Magnitude of `t` up to which the power series is used, beyond it the closed form.
const LARGEST_SERIES_ARGUMENT: f64 = 1.5;

/// Number of terms of the power series; the first one left out is below 1e-21 at the switch.
const TERMS: usize = 22;

/// `phi(t) = (e^{it} - 1) / (it)` with its first two derivatives in `t`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Phi {
    /// `e^{it}`.
    pub turn: Complex<f64>,
    /// `sin(t)/t + i (1 - cos t)/t`; 1 at 0.
    pub value: Complex<f64>,
    /// First derivative; `i/2` at 0.
    pub first: Complex<f64>,
    /// Second derivative; `-1/3` at 0.
    pub second: Complex<f64>,
}

/// The function and its first two derivatives, for every finite `t`; not a number where `t` is not finite.
pub(crate) fn phi(t: f64) -> Phi {
    let (sin, cos) = t.sin_cos();
    let turn = Complex::new(cos, sin);
    let small = t.abs() <= LARGEST_SERIES_ARGUMENT;
    let [m0, m1, m2] = if small { moments_by_series(t, turn) } else { moments_in_closed_form(t, turn) };
    Phi { turn, value: m0, first: Complex::new(-m1.im, m1.re), second: -m2 }
}

/// The coefficients `1 / (k! (k + 3))` of the power series of `m_2`.
const COEFFICIENTS: [f64; TERMS] = {
    let (mut coefficients, mut factorial, mut k) = ([0.0; TERMS], 1.0, 0);
    while k < TERMS {
        coefficients[k] = 1.0 / (factorial * (k as f64 + 3.0));
        k += 1;
        factorial *= k as f64;
    }
    coefficients
};

fn moments_by_series(t: f64, turn: Complex<f64>) -> [Complex<f64>; 3] {
    let [even, odd] = [0, 1].map(|first| {
        COEFFICIENTS[first..].iter().step_by(2).rev().fold(0.0, |rest, coefficient| coefficient - t * t * rest)
    });
    let m2 = Complex::new(even, t * odd);
    let below = |m: Complex<f64>, d: f64| (turn + t * Complex::new(m.im, -m.re)) / d;
    let m1 = below(m2, 2.0);
    [below(m1, 1.0), m1, m2]
}

fn moments_in_closed_form(t: f64, turn: Complex<f64>) -> [Complex<f64>; 3] {
    let half = (0.5 * t).sin();
    let over_it = |z: Complex<f64>| Complex::new(z.im / t, -z.re / t);
    let m0 = over_it(Complex::new(-2.0 * half * half, turn.im));
    let m1 = over_it(turn - m0);
    let m2 = over_it(turn - 2.0 * m1);
    [m0, m1, m2]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `t` and the real and imaginary parts of phi, phi' and phi'', by quadrature with 40 digits; the last row from the
    /// closed form with 60 digits.
    #[rustfmt::skip]
    #[allow(clippy::excessive_precision)]
    const REFERENCE: [(f64, [f64; 6]); 13] = [
        (0.0, [1.0, 0.0, 0.0, 0.5, -0.3333333333333333333, 0.0]),
        (
            1e-8,
            [
                0.9999999999999999833, 5.000000000000000063e-9, -3.33333333333333337e-9,
                0.4999999999999999875, -0.3333333333333333233, -2.500000000000000025e-9,
            ],
        ),
        (
            0.001,
            [
                0.9999998333333416667, 0.0004999999583333347326, -0.0003333333000000011974,
                0.4999998750000069444, -0.3333332333333392857, -0.0002499999722222232691,
            ],
        ),
        (
            0.3,
            [
                0.9850673555377985848, 0.1488783695813132624, -0.09910288804064187654,
                0.4888061236000876916, -0.3243814352668527167, -0.07425252691523120397,
            ],
        ),
        (
            1.0,
            [
                0.8414709848078965067, 0.4596976941318602826, -0.3011686789397567893,
                0.3817732906760362241, -0.2391336269283829281, -0.2232442754839327307,
            ],
        ),
        (
            1.4999,
            [
                0.6650362743492396258, 0.6194833316804379931, -0.3961592929773508728,
                0.252019852134133293, -0.1367886672056288919, -0.2888210903765287923,
            ],
        ),
        (
            1.5001,
            [
                0.6649570397551726481, 0.6195337298743265449, -0.3961866461833543735,
                0.2519620861691940137, -0.1367433924205224562, -0.2888385577780583119,
            ],
        ),
        (
            2.5,
            [
                0.2393888576415825976, 0.7204574462187734859, -0.416212989275406525,
                -0.04879412084592679675, 0.09358153377874262236, -0.2814221495420320485,
            ],
        ),
        (
            6.0,
            [
                -0.0465692496998209788, 0.006638285558272329909, 0.1677899227250311666,
                -0.04767563062619970045, -0.009360724541856076717, 0.1759202579837942369,
            ],
        ),
        (
            -2.0,
            [
                0.4546487134128408477, -0.7080734182735711935, 0.4353977749799916173,
                0.1006120042760552509, -0.01925093843284923035, 0.3086854225496264444,
            ],
        ),
        (
            40.0,
            [
                0.01862782901198371967, 0.04167345154130654611, -0.0171391472666061391,
                0.01758599272345105602, -0.01777087164865341272, -0.01755275117747909891,
            ],
        ),
        (
            -0.7,
            [
                0.9203109817681300865, -0.3359397324507308001, 0.2220982778337737736,
                0.440397078267086056, -0.2857444736716335502, 0.1656456703566909492,
            ],
        ),
        (
            1000000000000000.125,
            [
                7.875939707963493532e-16, 1.616194561129225481e-15, -6.161945611292263936e-16,
                7.87593970796347737e-16, -7.875939707963481208e-16, -6.161945611292271812e-16,
            ],
        ),
    ];

    fn parts(phi: Phi) -> [Complex<f64>; 3] {
        [phi.value, phi.first, phi.second]
    }

    /// Claim: every value is good to 4 units of rounding of its modulus, and where the series is used each of the two
    /// parts is so alone (parts have zeros at larger `t`, where no closed form keeps relative digits).
    #[test]
    fn values_agree_with_quadrature() {
        for (t, exact) in REFERENCE {
            for (found, exact) in parts(phi(t)).iter().zip(exact.chunks(2)) {
                let modulus = exact[0].hypot(exact[1]);
                for (found, exact) in [(found.re, exact[0]), (found.im, exact[1])] {
                    let scale = if t.abs() <= LARGEST_SERIES_ARGUMENT { exact.abs() } else { modulus };
                    assert!((found - exact).abs() <= 4.0 * f64::EPSILON * scale, "t = {t}: {found:e} for {exact:e}");
                }
            }
        }
    }

    /// Claim: nothing jumps at the switch: both formulas agree to 1e-15 on both sides of it.
    #[test]
    fn both_formulas_agree_around_the_switch() {
        for step in -300..=300 {
            for t in
                [LARGEST_SERIES_ARGUMENT + 1e-3 * f64::from(step), -LARGEST_SERIES_ARGUMENT - 1e-3 * f64::from(step)]
            {
                let turn = Complex::new(t.cos(), t.sin());
                let (series, closed) = (moments_by_series(t, turn), moments_in_closed_form(t, turn));
                for (a, b) in series.iter().zip(&closed) {
                    assert!((a - b).norm() <= 1e-15, "t = {t}: {:e}", (a - b).norm());
                }
            }
        }
    }

    /// Claim: phi satisfies its differential equations `t phi' = e^{it} - phi`, `t phi'' = i e^{it} - 2 phi'` (by
    /// differentiating `i t phi = e^{it} - 1`), and `phi(-t)` is the conjugate. Tolerance: rounding of terms of size 1.
    #[test]
    fn differential_equations_hold() {
        for step in -400..400 {
            let t = 0.013 * f64::from(step);
            let Phi { turn, value, first, second } = phi(t);
            assert!((first * t - (turn - value)).norm() <= 1e-15);
            assert!((second * t - (Complex::<f64>::i() * turn - first * 2.0)).norm() <= 2e-15);
            assert_eq!(phi(-t).value, value.conj());
        }
    }

    /// Claim: no argument panics; what is not finite gives no number.
    #[test]
    fn extreme_arguments() {
        assert!(parts(phi(f64::MAX)).iter().all(|z| z.norm() <= 1e-300));
        assert_eq!(phi(f64::MIN_POSITIVE).value.re, 1.0);
        assert!(phi(f64::NAN).value.re.is_nan() && phi(f64::INFINITY).first.im.is_nan());
    }
}
