//! The rigidity matrix between two vectors to twice the digits, at real wavenumbers.
//!
//! Where zero lines nearly cross, the determinant has hardly a gradient, and the rounding of `R` alone moves the line
//! by more than 1e-12. `w^H R v` is right to second order in the null vectors, so that these may be rounded when only
//! the sum is taken exactly enough: in [`double_double`](super::double_double), as are the directions of the bars.

use super::Rigidity;
use super::double_double::{ComplexTwice, DoubleDouble, factor, plus, power, times, twice};
use nalgebra::{Complex, ComplexField};

/// `left^H R right` at real wavenumbers, right to all digits of a number as long as it is no less than 1e-16 of its
/// terms.
pub(crate) fn pairing(rigidity: &Rigidity, q: [f64; 2], left: &[Complex<f64>], right: &[Complex<f64>]) -> Complex<f64> {
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
