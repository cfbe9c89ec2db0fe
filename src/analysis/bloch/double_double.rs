//! Sums of two numbers that carry twice the digits (T. J. Dekker, Numer. Math. 18, 224 (1971)), and complex numbers of
//! them.

use nalgebra::Complex;

/// The unevaluated sum of two numbers, the second of which is the rounding of the first.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct DoubleDouble {
    /// The sum, rounded.
    pub high: f64,
    /// What is left.
    pub low: f64,
}

impl DoubleDouble {
    /// `a + b`, exactly.
    pub(crate) fn sum(a: f64, b: f64) -> Self {
        let high = a + b;
        let part = high - a;
        Self { high, low: (a - (high - part)) + (b - part) }
    }

    /// `a b`, exactly.
    pub(crate) fn product(a: f64, b: f64) -> Self {
        let high = a * b;
        Self { high, low: a.mul_add(b, -high) }
    }

    /// The sum of two.
    pub(crate) fn plus(self, other: Self) -> Self {
        let sum = Self::sum(self.high, other.high);
        Self::sum(sum.high, sum.low + self.low + other.low)
    }

    /// The product of two.
    pub(crate) fn times(self, other: Self) -> Self {
        let product = Self::product(self.high, other.high);
        Self::sum(product.high, product.low + self.high * other.low + self.low * other.high)
    }

    pub(super) fn minus(self) -> Self {
        Self { high: -self.high, low: -self.low }
    }

    /// The quotient by a number.
    fn over(self, divisor: f64) -> Self {
        let first = self.high / divisor;
        let rest = self.plus(Self::product(first, divisor).minus());
        Self::sum(first, rest.high / divisor)
    }
}

/// Real and imaginary part.
pub(super) type ComplexTwice = [DoubleDouble; 2];

pub(super) fn twice(z: Complex<f64>) -> ComplexTwice {
    [z.re, z.im].map(|high| DoubleDouble { high, low: 0.0 })
}

pub(super) fn plus(a: ComplexTwice, b: ComplexTwice) -> ComplexTwice {
    [a[0].plus(b[0]), a[1].plus(b[1])]
}

pub(super) fn times(a: ComplexTwice, b: ComplexTwice) -> ComplexTwice {
    [a[0].times(b[0]).plus(a[1].times(b[1]).minus()), a[0].times(b[1]).plus(a[1].times(b[0]))]
}

/// `exp(i q)`: the series at `q / 1024`, squared ten times.
pub(super) fn factor(q: f64) -> ComplexTwice {
    let small = DoubleDouble { high: q / 1024.0, low: 0.0 };
    let mut sum = twice(Complex::ONE);
    for k in (1..=12).rev() {
        let [re, im] = sum.map(|part| part.times(small).over(f64::from(k)));
        sum = plus(twice(Complex::ONE), [im.minus(), re]);
    }
    (0..10).fold(sum, |z, _| times(z, z))
}

/// `exp(i n q)` from `exp(i q)`.
pub(super) fn power(z: ComplexTwice, n: i32) -> ComplexTwice {
    let base = if n < 0 { [z[0], z[1].minus()] } else { z };
    (0..n.abs()).fold(twice(Complex::ONE), |product, _| times(product, base))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn size(z: ComplexTwice) -> f64 {
        z[0].high.hypot(z[1].high)
    }

    /// Claim: `exp(i q)` has the sine and cosine of the standard library, length one, and obeys the addition theorem at
    /// wavenumbers whose sum is exact, to 1e-29: 2^-104 and ten squarings, each of which doubles the error.
    #[test]
    fn factors_to_twice_the_digits() {
        for [p, q] in [[0.75, 2.5], [-3.125, 1.0], [12.0, 0.0625]] {
            let [one, other, both] = [p, q, p + q].map(factor);
            assert!((one[0].high - p.cos()).abs() <= 2e-16 && (one[1].high - p.sin()).abs() <= 2e-16);
            let apart = plus(times(one, other), both.map(DoubleDouble::minus));
            let conjugate = [one[0], one[1].minus()];
            let length = plus(times(one, conjugate), twice(-Complex::ONE));
            assert!(size(apart) <= 1e-28 && size(length) <= 1e-28, "{:e} {:e}", size(apart), size(length));
            assert!(size(plus(power(conjugate, -3), times(one, times(one, one)).map(DoubleDouble::minus))) <= 1e-28);
        }
    }
}
