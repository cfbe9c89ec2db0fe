//! Laurent polynomials `sum c_mn z1^m z2^n` with real coefficients, and their values on the Brillouin zone.

use crate::numerics::DenseMatrix;
use nalgebra::Complex;
use std::f64::consts::{PI, TAU};

/// A Laurent polynomial in two variables; `m` and `n` may be half-integers.
#[derive(Clone, Debug, PartialEq)]
pub struct Laurent {
    /// `c_mn` at row `m - lowest[0]`, column `n - lowest[1]`.
    pub coefficients: DenseMatrix,
    /// Lowest `m` and lowest `n`.
    pub lowest: [f64; 2],
}

impl Laurent {
    /// All `(m, n, c_mn)`.
    pub fn terms(&self) -> impl Iterator<Item = (f64, f64, f64)> + '_ {
        let [rows, columns] = [self.coefficients.nrows(), self.coefficients.ncols()];
        let at = move |row: usize, column: usize| {
            (self.lowest[0] + row as f64, self.lowest[1] + column as f64, self.coefficients[(row, column)])
        };
        (0..rows).flat_map(move |row| (0..columns).map(move |column| at(row, column)))
    }

    /// The largest coefficient in magnitude.
    pub(crate) fn largest(&self) -> f64 {
        self.coefficients.amax()
    }

    /// Value at `z1 = exp(i q1)`, `z2 = exp(i q2)`.
    pub fn at(&self, q: [f64; 2]) -> Complex<f64> {
        self.terms().map(|(m, n, c)| Complex::from_polar(c, m * q[0] + n * q[1])).sum()
    }

    /// Coefficients of the powers of `z_b` at `z_a = exp(i q)`, lowest power first, `a` being 0 or 1 and `b` the other.
    pub(crate) fn along(&self, a: usize, q: f64) -> Vec<Complex<f64>> {
        let mut found = vec![Complex::ZERO; self.count(1 - a)];
        self.each(|powers, c| {
            let phase = q * (self.lowest[a] + powers[a] as f64);
            found[powers[1 - a]] += Complex::from_polar(c, phase);
        });
        found
    }

    /// Sums of the magnitudes of the terms that make each of those coefficients.
    pub(crate) fn sizes(&self, a: usize) -> Vec<f64> {
        let mut found = vec![0.0; self.count(1 - a)];
        self.each(|powers, c| found[powers[1 - a]] += c.abs());
        found
    }

    /// Number of powers of `z_a`.
    fn count(&self, a: usize) -> usize {
        [self.coefficients.nrows(), self.coefficients.ncols()][a]
    }

    fn each(&self, mut visit: impl FnMut([usize; 2], f64)) {
        for column in 0..self.coefficients.ncols() {
            for row in 0..self.coefficients.nrows() {
                visit([row, column], self.coefficients[(row, column)]);
            }
        }
    }

    /// Values at the wavenumbers [`wavenumber`]`(k1, n1)`, [`wavenumber`]`(k2, n2)`, those of equal `k2` after each
    /// other.
    pub fn map(&self, [n1, n2]: [usize; 2]) -> Vec<Complex<f64>> {
        let (rows, columns) = (self.count(0), self.count(1));
        let steps: Vec<Complex<f64>> = (0..n1).map(|k| Complex::from_polar(1.0, wavenumber(k, n1))).collect();
        let starts: Vec<Complex<f64>> =
            (0..n1).map(|k| Complex::from_polar(1.0, self.lowest[0] * wavenumber(k, n1))).collect();
        let mut values = Vec::with_capacity(n1 * n2);
        for k2 in 0..n2 {
            let q2 = wavenumber(k2, n2);
            let factors: Vec<Complex<f64>> =
                (0..columns).map(|c| Complex::from_polar(1.0, (self.lowest[1] + c as f64) * q2)).collect();
            let line: Vec<Complex<f64>> = (0..rows)
                .map(|row| factors.iter().enumerate().map(|(c, f)| f * self.coefficients[(row, c)]).sum())
                .collect();
            // Horner's rule along the line of equal q2
            let value = |(step, start): (&Complex<f64>, &Complex<f64>)| {
                line.iter().rev().fold(Complex::ZERO, |sum: Complex<f64>, c| sum * step + c) * start
            };
            values.extend(steps.iter().zip(&starts).map(value));
        }
        values
    }
}

/// The `k`-th of `n` wavenumbers that divide the zone from `-pi` to `pi` evenly, half a step away from its ends; for
/// even `n` none of them is 0.
pub(crate) fn wavenumber(k: usize, n: usize) -> f64 {
    (k as f64 + 0.5) * TAU / n as f64 - PI
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample() -> Laurent {
        let coefficients = DenseMatrix::from_row_slice(2, 3, &[1.0, -2.0, 0.5, 0.25, 3.0, -0.75]);
        Laurent { coefficients, lowest: [-0.5, -1.0] }
    }

    /// Claim: values on the map and along a line are those of the sum of terms. Tolerance: rounding.
    #[test]
    fn maps_and_lines() {
        let polynomial = sample();
        let map = polynomial.map([6, 4]);
        for (k, value) in map.iter().enumerate() {
            let q = [wavenumber(k % 6, 6), wavenumber(k / 6, 4)];
            assert!((value - polynomial.at(q)).norm() <= 1e-14);
            for a in 0..2 {
                let along = polynomial.along(a, q[a]);
                let other = |k: usize| (polynomial.lowest[1 - a] + k as f64) * q[1 - a];
                let sum: Complex<f64> =
                    along.iter().enumerate().map(|(k, c)| c * Complex::from_polar(1.0, other(k))).sum();
                assert!((sum - value).norm() <= 1e-14);
            }
        }
        assert_eq!(polynomial.sizes(0), [1.25, 5.0, 1.25]);
        assert_eq!(polynomial.sizes(1), [3.5, 4.0]);
    }

    /// Claim: wavenumbers lie evenly in the zone, symmetric about 0.
    #[test]
    fn wavenumbers_are_symmetric() {
        assert!(
            (0..8).all(|k| (wavenumber(k, 8) + wavenumber(7 - k, 8)).abs() <= 1e-15 && wavenumber(k, 8).abs() < PI)
        );
    }
}
