//! The rigidity matrix between two vectors to twice the digits, at real wavenumbers.
//!
//! Where zero lines nearly cross, the determinant has hardly a gradient, and the rounding of `R` alone moves the line by
//! more than 1e-12. `w^H R v` is right to second order in the null vectors, so that these may be rounded when only the
//! sum is taken exactly enough: every number is a sum of two (T. J. Dekker, Numer. Math. 18, 224 (1971)), and so are the
//! directions of the bars.

use super::Rigidity;
use nalgebra::{Complex, ComplexField};

/// The unevaluated sum of two numbers, the second of which is the rounding of the first.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DoubleDouble {
    /// The sum, rounded.
    pub high: f64,
    /// What is left.
    pub low: f64,
}

impl DoubleDouble {
    /// `a + b`, exactly.
    pub fn sum(a: f64, b: f64) -> Self {
        let high = a + b;
        let part = high - a;
        Self { high, low: (a - (high - part)) + (b - part) }
    }

    /// `a b`, exactly.
    pub fn product(a: f64, b: f64) -> Self {
        let high = a * b;
        Self { high, low: a.mul_add(b, -high) }
    }

    /// The sum of two.
    pub fn plus(self, other: Self) -> Self {
        let sum = Self::sum(self.high, other.high);
        Self::sum(sum.high, sum.low + self.low + other.low)
    }

    /// The product of two.
    pub fn times(self, other: Self) -> Self {
        let product = Self::product(self.high, other.high);
        Self::sum(product.high, product.low + self.high * other.low + self.low * other.high)
    }

    fn minus(self) -> Self {
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
type ComplexTwice = [DoubleDouble; 2];

fn twice(z: Complex<f64>) -> ComplexTwice {
    [z.re, z.im].map(|high| DoubleDouble { high, low: 0.0 })
}

fn plus(a: ComplexTwice, b: ComplexTwice) -> ComplexTwice {
    [a[0].plus(b[0]), a[1].plus(b[1])]
}

fn times(a: ComplexTwice, b: ComplexTwice) -> ComplexTwice {
    [a[0].times(b[0]).plus(a[1].times(b[1]).minus()), a[0].times(b[1]).plus(a[1].times(b[0]))]
}

/// `exp(i q)`: the series at `q / 1024`, squared ten times.
fn factor(q: f64) -> ComplexTwice {
    let small = DoubleDouble { high: q / 1024.0, low: 0.0 };
    let mut sum = twice(Complex::ONE);
    for k in (1..=12).rev() {
        let [re, im] = sum.map(|part| part.times(small).over(f64::from(k)));
        sum = plus(twice(Complex::ONE), [im.minus(), re]);
    }
    (0..10).fold(sum, |z, _| times(z, z))
}

/// `exp(i n q)` from `exp(i q)`.
fn power(z: ComplexTwice, n: i32) -> ComplexTwice {
    let base = if n < 0 { [z[0], z[1].minus()] } else { z };
    (0..n.abs()).fold(twice(Complex::ONE), |product, _| times(product, base))
}

/// `left^H R right` at real wavenumbers, right to all digits of a number as long as it is no less than 1e-16 of its
/// terms.
pub fn pairing(rigidity: &Rigidity, q: [f64; 2], left: &[Complex<f64>], right: &[Complex<f64>]) -> Complex<f64> {
    let z = q.map(factor);
    let mut sum = ComplexTwice::default();
    for (row, weight) in rigidity.rows.iter().zip(left) {
        let mut stretch = ComplexTwice::default();
        for ((corner, direction), rest) in row.terms.iter().zip(&row.rests) {
            let along = |part: fn(Complex<f64>) -> f64| {
                (0..3).fold(DoubleDouble::default(), |along, axis| {
                    let moved = DoubleDouble { high: part(right[3 * corner.vertex + axis]), low: 0.0 };
                    along.plus(moved.times(DoubleDouble { high: direction[axis], low: rest[axis] }))
                })
            };
            let phase = times(power(z[0], corner.shift[0]), power(z[1], corner.shift[1]));
            stretch = plus(stretch, times(phase, [along(ComplexField::real), along(ComplexField::imaginary)]));
        }
        sum = plus(sum, times(twice(weight.conj()), stretch));
    }
    Complex::new(sum[0].high, sum[1].high)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sheet::generate::{Pattern, Random, generate};

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

    /// Claim: away from zeros the pairing is that of the matrix to rounding, and directions are those of the edges to
    /// twice the digits: what a direction with its rest is off an edge between vertices of one cell is below 1e-30.
    #[test]
    fn pairing_of_the_matrix() {
        let sheet = generate(&Pattern::Random(Random { seed: 2, ..Random::default() })).unwrap();
        let rigidity = Rigidity::of_sheet(&sheet, false).unwrap();
        let vector = |a: f64| (0..12).map(|k| Complex::from_polar(1.0, a * k as f64)).collect::<Vec<_>>();
        let (left, right, q) = (vector(1.3), vector(0.4), [0.8, -2.1]);
        let direct = rigidity.pairing(q.map(|q| Complex::from_polar(1.0, q)), &left, &right).value;
        let found = pairing(&rigidity, q, &left, &right);
        assert!((found - direct).norm() <= 1e-14, "{found} {direct}");
        for (row, edge) in rigidity.rows.iter().zip(&sheet.edges).filter(|(_, edge)| edge.key.shift == [0, 0]) {
            let [from, to] = [edge.key.i, edge.key.j].map(|v| sheet.vertices[v]);
            let along = |axis: usize| DoubleDouble::sum(to[axis], -from[axis]);
            let direction = |axis: usize| DoubleDouble { high: row.terms[1].1[axis], low: row.rests[1][axis] };
            let across = direction(0).times(along(1)).plus(direction(1).times(along(0)).minus());
            assert!(across.high.abs() <= 1e-30 && row.rests[1].norm() > 1e-18, "{across:?}");
        }
    }
}
