//! Zeros of the determinant without the determinant: Bloch factors at which the rigidity matrix itself is singular.
//!
//! With borders `b` and `c` near its null vectors, the bordered system
//!
//! `[R b; c^H 0] [v; g] = [0; 1]` has `g = det R / det [R b; c^H 0]` (Cramer's rule).
//!
//! A zero of `g` is one of the determinant, simple where that one is. But `g` is of the size of the smallest singular
//! value, so its rounding is that of `R`, not that of a product of all singular values. With the solution `[w; h]` of
//! the transposed conjugate system, `g = -w^H R v`, its derivatives are `-w^H dR v`, and with `w` and `v` held it is
//! right to second order near by: one factorization gives a Newton step and the error of the point where it leads
//! (A. Griewank, G. W. Reddien, IMA J. Numer. Anal. 4, 295 (1984)).

use super::rigidity::RigidityProduct;
use super::root::Root;
use super::{Rigidity, exact_pairing};
use crate::numerics::complex::{ComplexVector, solve_with_adjoint};
use nalgebra::{Complex, DMatrix};

/// Factorizations at most.
const ROUNDS: usize = 8;
/// Newton steps with one pair of null vectors.
const STEPS: usize = 3;
/// A round that moves `log z` by less than this, or by rounding, is the last: what it leaves is of its square.
const LAST_LOG_CHANGE: f64 = 1e-12;
/// Longest way of `log z` from where a search begins.
const FARTHEST: f64 = 0.2;
/// Borders are taken anew where null vectors have more than this of their squared norm across them.
const LEANING: f64 = 4.0;

/// A search for singular matrices; it keeps the borders of the last, which serve near by.
pub(crate) struct SingularSearch<'a> {
    rigidity: &'a Rigidity,
    borders: [ComplexVector; 2],
}

impl<'a> SingularSearch<'a> {
    /// For a square rigidity matrix.
    pub(crate) fn new(rigidity: &'a Rigidity) -> Self {
        // directions that no symmetry of a cell prefers
        let part = |k: usize| (k as f64 * 0.618_033_988_75).fract() - 0.5;
        let any = |shift: usize| {
            let vector = (0..rigidity.columns()).map(|k| Complex::new(part(2 * k + shift), part(2 * k + 1 + shift)));
            ComplexVector::from_iterator(rigidity.columns(), vector).normalize()
        };
        Self { rigidity, borders: [any(1), any(2)] }
    }

    /// The root `z_a` near `z[a]`, the other factor held; its condition is the change of `log z_a` per relative change
    /// of the entries of the matrix. `None` where Newton's method does not settle near by.
    pub(crate) fn root(&mut self, mut z: [Complex<f64>; 2], a: usize) -> Option<Root> {
        let start = z[a];
        for _ in 0..ROUNDS {
            let pair = self.null_pair(z)?;
            let (before, mut at) = (z[a], RigidityProduct::default());
            for _ in 0..STEPS {
                at = self.pairing(z, &pair);
                z[a] *= (-at.value / at.slopes[a]).exp();
            }
            if !((z[a] / start).ln().norm() <= FARTHEST) {
                return None;
            }
            let condition = at.size / at.slopes[a].norm();
            if (z[a] / before - 1.0).norm() <= LAST_LOG_CHANGE.max(f64::EPSILON * condition) {
                return Some(Root { z: z[a], condition, multiplicity: 1 });
            }
        }
        None
    }

    /// The point near real wavenumbers at which a determinant that is real there vanishes, along its gradient, and the
    /// error of that point. `None` where Newton's method does not settle near by.
    ///
    /// Up to a phase `g` is real there: the step is that of least squares for its two parts. It is taken to
    /// [twice the digits](super::double_double), since the gradient may be as small as it likes.
    pub(crate) fn on_zone(&mut self, start: [f64; 2]) -> Option<([f64; 2], f64)> {
        let mut q = start;
        for _ in 0..ROUNDS {
            let z = q.map(|q| Complex::from_polar(1.0, q));
            let pair = self.null_pair(z)?;
            let slopes = self.pairing(z, &pair).slopes;
            let squared = slopes[0].norm_sqr() + slopes[1].norm_sqr();
            let (before, mut last) = (q, f64::NAN);
            for _ in 0..STEPS {
                let value = exact_pairing::pairing(self.rigidity, q, pair[0].as_slice(), pair[1].as_slice());
                let step = slopes.map(|slope| (-(Complex::<f64>::I * slope).conj() * value / squared).re);
                q = [0, 1].map(|a| q[a] + step[a]);
                last = step[0].hypot(step[1]);
            }
            let moved = |from: [f64; 2]| (q[0] - from[0]).hypot(q[1] - from[1]);
            if !(moved(start) <= FARTHEST) {
                return None;
            }
            if moved(before) <= LAST_LOG_CHANGE {
                return Some((q, last.max(f64::EPSILON)));
            }
        }
        None
    }

    fn pairing(&self, z: [Complex<f64>; 2], [left, right]: &[ComplexVector; 2]) -> RigidityProduct {
        self.rigidity.pairing(z, left.as_slice(), right.as_slice())
    }

    /// Nearly null vectors `w` and `v`. Rows are scaled to one size, and scaled back in `w`.
    fn null_pair(&mut self, z: [Complex<f64>; 2]) -> Option<[ComplexVector; 2]> {
        let mut matrix = self.rigidity.at(z);
        let n = matrix.nrows();
        let scales = self.rigidity.scales(z);
        matrix.row_iter_mut().zip(&scales).for_each(|(mut row, &scale)| row.scale_mut(scale));
        for _ in 0..3 {
            let [left, right] = solved(&matrix, &self.borders)?;
            let leans = left.norm_squared() * right.norm_squared() > LEANING;
            self.borders = [left.normalize(), right.normalize()];
            if !leans {
                let scaled = ComplexVector::from_iterator(n, left.iter().zip(&scales).map(|(w, scale)| w * *scale));
                return Some([scaled, right]);
            }
        }
        None
    }
}

/// `w` and `v` of the bordered system; `None` where it is singular.
fn solved(matrix: &DMatrix<Complex<f64>>, [b, c]: &[ComplexVector; 2]) -> Option<[ComplexVector; 2]> {
    let n = matrix.nrows();
    let mut bordered = DMatrix::zeros(n + 1, n + 1);
    bordered.view_mut((0, 0), (n, n)).copy_from(matrix);
    bordered.view_mut((0, n), (n, 1)).copy_from(b);
    bordered.view_mut((n, 0), (1, n)).copy_from(&c.adjoint());
    let mut right = ComplexVector::zeros(n + 1);
    right[n] = Complex::ONE;
    let pair = solve_with_adjoint(bordered, &right)?;
    Some(pair.map(|vector| vector.rows(0, n).into_owned()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::dense::full_svd;
    use crate::sheet::generate::{Pattern, Random, generate};

    const Z: [Complex<f64>; 2] = [Complex::new(0.6, 0.8), Complex::new(-1.1, 0.3)];

    fn random(seed: u64) -> Rigidity {
        let sheet = generate(&Pattern::Random(Random { seed, ..Random::default() })).unwrap();
        Rigidity::of_sheet(&sheet, false).unwrap()
    }

    /// Claim: `-w^H R v` is `det R / det [R b; c^H 0]` of the borders that were used, with another library's
    /// determinants. Tolerance: rounding of determinants of order 13.
    #[test]
    fn cramers_rule() {
        let rigidity = random(3);
        let search = SingularSearch::new(&rigidity);
        let matrix = rigidity.at(Z);
        let [b, c] = &search.borders;
        let pair = solved(&matrix, &search.borders).unwrap();
        let mut bordered = matrix.clone().resize(13, 13, Complex::ZERO);
        bordered.view_mut((0, 12), (12, 1)).copy_from(b);
        bordered.view_mut((12, 0), (1, 12)).copy_from(&c.adjoint());
        let expected = -matrix.determinant() / bordered.determinant();
        let found = search.pairing(Z, &pair).value;
        assert!((found - expected).norm() <= 1e-12 * expected.norm(), "{found} {expected}");
    }

    /// Claim: from a start a twentieth away the search ends where the smallest singular value is rounding, and the
    /// slope is that of differences of the pairing.
    #[test]
    fn roots_are_singular() {
        let rigidity = random(4);
        let mut search = SingularSearch::new(&rigidity);
        let pair = search.null_pair(Z).unwrap();
        for a in 0..2 {
            let moved = |step: f64| {
                let mut z = Z;
                z[a] *= Complex::new(step, 0.0).exp();
                search.pairing(z, &pair).value
            };
            let difference = (moved(1e-5) - moved(-1e-5)) / 2e-5;
            assert!((difference - search.pairing(Z, &pair).slopes[a]).norm() <= 1e-9);
        }
        let determinant = super::super::Determinant::new(&rigidity).unwrap();
        let decay = super::super::Decay::new(&determinant, 0, 0.9).unwrap();
        let z1 = Complex::from_polar(1.0, 0.9);
        for root in decay.roots.iter().filter(|root| root.condition < 1e3) {
            let found = search.root([z1, root.z * Complex::new(1.0, 0.002)], 1).unwrap();
            let values = full_svd(&rigidity.at([z1, found.z])).unwrap().singular_values;
            assert!(values[11] <= 1e-15 * values[0] * found.condition.max(1.0), "{values:?}");
            assert!((found.z / root.z - 1.0).norm() <= 1e-12, "{found:?} {root:?}");
        }
    }
}
