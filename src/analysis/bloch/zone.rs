//! A symmetric determinant as a real function on the Brillouin zone, with its gradient, also close to `q = 0`.
//!
//! It vanishes at `q = 0` to fourth order on a spatially periodic sheet, to second order on a cylinder. There the
//! cosines of `sum c_mn cos(m q1 + n q2)` cancel; near `q = 0` each is replaced by what is left of it when the terms
//! that add up to zero are taken out: `cos t - 1`, or `cos t - 1 + t^2/2` by its series. So signs, zeros and directions
//! of lines are right at any distance from `q = 0`.

use super::laurent::{Laurent, wavenumber};
use super::{BlochError, Determinant};
use crate::numerics::polynomial::roots;
use nalgebra::Complex;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Sums that vanish relative to their terms by less than this are zero.
const ZERO: f64 = 1e-9;
/// Wavenumbers below this are near `q = 0`.
const SMALL_WAVENUMBER: f64 = 0.5;
/// The sign of a value of so many times its uncertainty is certain.
const CERTAIN: f64 = 10.0;
/// Relative imaginary part of a root that is real up to rounding.
const REAL: f64 = 1e-7;

/// The determinant on the zone.
#[derive(Clone, Debug, PartialEq)]
pub struct Zone {
    /// `(m, n, c)`: one of each pair of opposite powers, with the sum of the two coefficients.
    terms: Vec<[f64; 3]>,
    /// Order to which it vanishes at `q = 0`: 0, 2 or 4.
    pub order: usize,
    /// The form of this degree with which it begins there: coefficients of `q1^(order - k) q2^k`.
    pub form: Vec<f64>,
    /// How well values are known away from `q = 0`.
    rounding: f64,
}

impl Zone {
    /// The zone of a determinant.
    ///
    /// # Errors
    /// [`BlochError`] where it is not symmetric: then it is not real.
    pub fn new(determinant: &Determinant) -> Result<Self, BlochError> {
        if !determinant.symmetric {
            return Err(BlochError::NotSymmetric { asymmetry: determinant.symmetry_error });
        }
        let polynomial = determinant.symmetrized();
        let order = order(&polynomial);
        let half = polynomial.terms().filter(|&(m, n, c)| c != 0.0 && (m, n) >= (0.0, 0.0));
        let terms = half.map(|(m, n, c)| [m, n, if (m, n) == (0.0, 0.0) { c } else { 2.0 * c }]).collect();
        let rounding = determinant.error.max(f64::EPSILON) * determinant.magnitude;
        Ok(Self { terms, order, form: form(&polynomial, order), rounding })
    }

    /// Value and gradient.
    pub fn at(&self, q: [f64; 2]) -> (f64, [f64; 2]) {
        let q = q.map(reduced);
        let parts = self.parts(q);
        let (mut value, mut gradient) = (0.0, [0.0; 2]);
        for &[m, n, c] in &self.terms {
            let (f, slope) = remainder(m * q[0] + n * q[1], parts);
            value += c * f;
            gradient[0] += c * m * slope;
            gradient[1] += c * n * slope;
        }
        (value, gradient)
    }

    /// How well the value is known: every coefficient carries the rounding of the largest value, and near `q = 0` each
    /// counts as little as what is left of its cosine.
    pub(crate) fn uncertainty(&self, q: [f64; 2]) -> f64 {
        let q = q.map(reduced);
        let parts = self.parts(q);
        let squares = self.terms.iter().map(|[m, n, _]| remainder(m * q[0] + n * q[1], parts).0.powi(2));
        self.rounding * (squares.sum::<f64>() / self.terms.len() as f64).sqrt()
    }

    /// Part of the wavenumbers of a grid at which the value is positive, among those at which its sign is certain.
    pub fn positive_fraction(&self, [n1, n2]: [usize; 2]) -> f64 {
        let mut signs = [0usize; 2];
        for k in 0..n1 * n2 {
            let q = [wavenumber(k % n1, n1), wavenumber(k / n1, n2)];
            let value = self.at(q).0;
            if value.abs() > CERTAIN * self.uncertainty(q) {
                signs[usize::from(value > 0.0)] += 1;
            }
        }
        signs[1] as f64 / (signs[0] + signs[1]).max(1) as f64
    }

    /// Second derivatives, `[11, 22, 12]`.
    pub(crate) fn curvature(&self, q: [f64; 2]) -> [f64; 3] {
        let q = q.map(reduced);
        let bent = |t: f64| match self.parts(q) {
            4 => 2.0 * (0.5 * t).sin().powi(2),
            _ => -t.cos(),
        };
        let add = |sum: [f64; 3], &[m, n, c]: &[f64; 3]| {
            let bent = c * bent(m * q[0] + n * q[1]);
            [sum[0] + m * m * bent, sum[1] + n * n * bent, sum[2] + m * n * bent]
        };
        self.terms.iter().fold([0.0; 3], add)
    }

    /// Order of the terms that are taken out of the cosines at reduced wavenumbers.
    fn parts(&self, q: [f64; 2]) -> usize {
        if q.iter().all(|q| q.abs() < SMALL_WAVENUMBER) { self.order } else { 0 }
    }

    /// Directions in which zero lines leave `q = 0`: angles to the first axis in `(-pi/2, pi/2]`, ascending; those of
    /// the real roots of the form.
    ///
    /// # Errors
    /// [`BlochError`] where the leading form of the determinant at `q = 0` is not known.
    pub fn directions(&self) -> Result<Vec<f64>, BlochError> {
        if self.order == 0 {
            return Ok(Vec::new());
        }
        let complex: Vec<Complex<f64>> = self.form.iter().map(|&c| Complex::new(c, 0.0)).collect();
        let found = roots(&complex)?;
        let real = found.finite.iter().filter(|t| t.im.abs() <= REAL * (1.0 + t.norm()));
        let mut angles: Vec<f64> = real.map(|t| t.re.atan()).collect();
        angles.extend(std::iter::repeat_n(FRAC_PI_2, found.at_infinity));
        angles.extend(std::iter::repeat_n(0.0, found.at_zero));
        angles.sort_by(f64::total_cmp);
        Ok(angles)
    }
}

/// A wavenumber in `[-pi, pi)`.
pub(crate) fn reduced(q: f64) -> f64 {
    (q + PI).rem_euclid(TAU) - PI
}

/// `cos t` less its first terms, below the power `order`, and the derivative.
fn remainder(t: f64, order: usize) -> (f64, f64) {
    match order {
        0 => (t.cos(), -t.sin()),
        2 => (-2.0 * (0.5 * t).sin().powi(2), -t.sin()),
        _ if t.abs() > 1.0 => (t.cos() - 1.0 + 0.5 * t * t, t - t.sin()),
        _ => {
            // t^4/4! - t^6/6! + .. and t^3/3! - t^5/5! + .., to the power 18
            let series = |first: usize| {
                let below = |k: f64| t * t / (k * (k - 1.0));
                (0..7).rev().fold(1.0, |sum, j| 1.0 - below((first + 2 * j + 2) as f64) * sum)
            };
            (t.powi(4) / 24.0 * series(4), t.powi(3) / 6.0 * series(3))
        }
    }
}

/// The lowest even order in which the expansion at `q = 0` is not zero, at most 4.
fn order(polynomial: &Laurent) -> usize {
    let vanishes = |power: i32| {
        (0..=power).all(|k| {
            let term = |(m, n, c): (f64, f64, f64)| c * m.powi(power - k) * n.powi(k);
            let sum: f64 = polynomial.terms().map(term).sum();
            let size: f64 = polynomial.terms().map(|t| term(t).abs()).sum();
            sum.abs() <= ZERO * size
        })
    };
    match (vanishes(0), vanishes(2)) {
        (true, true) => 4,
        (true, false) => 2,
        _ => 0,
    }
}

/// `(-1)^(order/2) / order! sum c_mn (m q1 + n q2)^order`, by powers of `q2`.
fn form(polynomial: &Laurent, order: usize) -> Vec<f64> {
    let binomials: &[f64] = match order {
        4 => &[1.0 / 24.0, 4.0 / 24.0, 6.0 / 24.0, 4.0 / 24.0, 1.0 / 24.0],
        2 => &[-0.5, -1.0, -0.5],
        _ => &[1.0],
    };
    let coefficient = |(k, binomial): (usize, &f64)| {
        let moment = |(m, n, c): (f64, f64, f64)| c * m.powi((order - k) as i32) * n.powi(k as i32);
        binomial * polynomial.terms().map(moment).sum::<f64>()
    };
    binomials.iter().enumerate().map(coefficient).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Claim: the remainders are what is left of the cosine, at both sides of where the series ends, and to all digits
    /// for small arguments, where they are their first terms. Tolerance: the rounding of the cosine above, 1e-15 of it
    /// below.
    #[test]
    fn remainders_of_the_cosine() {
        for t in [0.3f64, 0.999, 1.001, 2.5, -0.7] {
            let direct = t.cos() - 1.0 + 0.5 * t * t;
            assert!((remainder(t, 4).0 - direct).abs() <= 4e-16 && (remainder(t, 4).1 - (t - t.sin())).abs() <= 4e-16);
            assert!((remainder(t, 2).0 - (t.cos() - 1.0)).abs() <= 2e-16);
        }
        let t = 1e-5f64;
        let expected = t.powi(4) / 24.0 * (1.0 - t * t / 30.0);
        assert!((remainder(t, 4).0 / expected - 1.0).abs() <= 1e-15);
    }
}
