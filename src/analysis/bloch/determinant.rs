//! The determinant of the rigidity matrix as a Laurent polynomial.
//!
//! Its coefficients come from its values at roots of unity by one Fourier transform. How the cell is cut multiplies it
//! by a monomial, which is taken out: for a sheet without openings the powers are centred so that the coefficients are
//! symmetric, `c_mn = c_-m,-n` (zero modes at `z` and at `1/z`); where they are not, so that lowest and highest powers
//! are opposite.

use super::laurent::Laurent;
use super::{BlochError, Rigidity, ZeroModeCounts};
use crate::numerics::DenseMatrix;
use crate::numerics::complex::ComplexMatrix;
use nalgebra::Complex;
use std::f64::consts::TAU;

/// More roots of unity than powers, by this: what is found for powers that cannot be there is rounding.
const SPARE: usize = 2;
/// Coefficients below this part of the largest are rounding.
const ROUNDING: f64 = 1e-14;
/// Relative asymmetry up to which a determinant counts as that of a symmetric sheet.
const SYMMETRIC: f64 = 1e-6;
/// Relative error from which on there is no determinant to speak of.
const UNKNOWN: f64 = 1e-6;
/// Wavenumbers over 2 pi at which the polynomial is compared with the matrix, away from all small fractions.
const COMPARED: [[f64; 2]; 4] =
    [[0.1381966, 0.3027756], [0.4142136, 0.7639320], [0.6180340, 0.0901699], [0.8507811, 0.5413813]];

/// The centred determinant, and how well it is known.
#[derive(Clone, Debug, PartialEq)]
pub struct Determinant {
    /// The polynomial as found.
    pub polynomial: Laurent,
    /// Whether it is symmetric, up to rounding.
    pub symmetric: bool,
    /// Largest `|c_mn - c_-m,-n|` over the largest coefficient.
    pub symmetry_error: f64,
    /// Largest imaginary part of the centred determinant at the roots of unity, over its largest magnitude there.
    pub imaginary_part: f64,
    /// Largest difference of polynomial and matrix at wavenumbers that were not sampled, over the largest magnitude.
    pub error: f64,
    /// The largest magnitude at the roots of unity.
    pub magnitude: f64,
}

impl Determinant {
    /// The determinant of a rigidity matrix.
    ///
    /// # Errors
    /// [`BlochError`] where the matrix is not square, where the determinant [vanishes](BlochError::Vanishes)
    /// identically, as for a flat sheet, and where it is [nothing but rounding](BlochError::NoDeterminant).
    pub fn new(rigidity: &Rigidity) -> Result<Self, BlochError> {
        rigidity.require_square()?;
        let lowest = [0, 1].map(|a| rigidity.powers(a)[0]);
        let values = samples(rigidity)?;
        let largest = values.iter().map(|value| value.norm()).fold(0.0, f64::max);
        let coefficients = shifted(&coefficients(&values), lowest);
        let (twice, symmetric) = center(&coefficients);
        let absolute = [0, 1].map(|a| 0.5 * twice[a] as f64 + f64::from(lowest[a]));
        let polynomial = cropped(&coefficients, twice);
        let error = difference(rigidity, &polynomial, absolute)? / largest;
        if !(error <= UNKNOWN) {
            let at = |turns: [f64; 2]| ZeroModeCounts::at(rigidity, turns.map(|turn| TAU * turn));
            let counts = COMPARED.into_iter().map(at).collect::<Result<Vec<_>, _>>()?;
            return Err(match counts.iter().map(|count| count.zero_modes).min() {
                Some(zero_modes) if zero_modes > 0 => BlochError::Vanishes { compared: COMPARED.len(), zero_modes },
                _ => BlochError::NoDeterminant { error, limit: UNKNOWN },
            });
        }
        let symmetry_error = asymmetry(&polynomial);
        let imaginary_part = imaginary(&values, absolute) / largest;
        Ok(Self { polynomial, symmetric, symmetry_error, imaginary_part, error, magnitude: largest })
    }

    /// The symmetric part of the polynomial: what is left of the other is rounding where the determinant is symmetric.
    pub(crate) fn symmetrized(&self) -> Laurent {
        let c = &self.polynomial.coefficients;
        let (rows, columns) = c.shape();
        let mean = |i: usize, j: usize| 0.5 * (c[(i, j)] + c[(rows - 1 - i, columns - 1 - j)]);
        Laurent { coefficients: DenseMatrix::from_fn(rows, columns, mean), lowest: self.polynomial.lowest }
    }
}

/// Wavenumber of the `k`-th of `n` roots of unity.
fn root(k: usize, n: usize) -> f64 {
    TAU * k as f64 / n as f64
}

/// Values at all roots of unity; those at opposite wavenumbers are conjugate, since the matrix is real.
fn samples(rigidity: &Rigidity) -> Result<ComplexMatrix, BlochError> {
    let [n1, n2] = [0, 1].map(|a| {
        let [low, high] = rigidity.powers(a);
        (high - low) as usize + 1 + SPARE
    });
    let mut values = ComplexMatrix::zeros(n1, n2);
    for j in 0..n1 {
        for k in 0..n2 {
            let opposite = ((n1 - j) % n1, (n2 - k) % n2);
            values[(j, k)] = if opposite < (j, k) {
                values[opposite].conj()
            } else {
                rigidity.determinant([root(j, n1), root(k, n2)].map(|q| Complex::from_polar(1.0, q)))?
            };
        }
    }
    Ok(values)
}

/// The coefficients `c_mn` with `values_jk = sum c_mn exp(2 pi i (m j / n1 + n k / n2))`, for an `n1 x n2` matrix of
/// values, by a discrete Fourier transform: `c_mn` stands at row `m`, column `n`, which are known modulo `n1` and `n2`
/// only. A fast transform would save nothing that can be felt beside the determinants.
fn coefficients(values: &ComplexMatrix) -> ComplexMatrix {
    let turn = |j: usize, n: usize| Complex::from_polar(1.0 / n as f64, -root(j % n, n));
    let transform = |n: usize| ComplexMatrix::from_fn(n, n, |j, k| turn(j * k, n));
    transform(values.nrows()) * values * transform(values.ncols())
}

/// Real parts of the coefficients, the one of the lowest powers first.
fn shifted(coefficients: &ComplexMatrix, lowest: [i32; 2]) -> DenseMatrix {
    let (rows, columns) = coefficients.shape();
    let place = |k: usize, low: i32, count: usize| (k as i32 + low).rem_euclid(count as i32) as usize;
    DenseMatrix::from_fn(rows, columns, |i, j| {
        coefficients[(place(i, lowest[0], rows), place(j, lowest[1], columns))].re
    })
}

/// The middle about which the coefficients are symmetric, or that of their box, in half rows and columns, and whether
/// they are symmetric.
fn center(c: &DenseMatrix) -> ([usize; 2], bool) {
    let boxed = [extent(c), extent(&c.transpose())];
    let middles =
        (boxed[0][0] * 2..=boxed[0][1] * 2).flat_map(|x| (boxed[1][0] * 2..=boxed[1][1] * 2).map(move |y| [x, y]));
    let best = middles.map(|twice| (mismatch(c, twice), twice)).min_by(|a, b| a.0.total_cmp(&b.0));
    let twice = boxed.map(|[low, high]| low + high);
    match best {
        Some((mismatch, twice)) if mismatch <= SYMMETRIC * c.norm() => (twice, true),
        _ => (twice, false),
    }
}

/// First and last row with more than rounding.
fn extent(c: &DenseMatrix) -> [usize; 2] {
    let there = |row: &usize| c.row(*row).amax() > 100.0 * ROUNDING * c.amax();
    let rows = || (0..c.nrows()).filter(there);
    [rows().min().unwrap_or(0), rows().max().unwrap_or(0)]
}

/// Norm of the difference between the coefficients and those turned about a middle.
fn mismatch(c: &DenseMatrix, twice: [usize; 2]) -> f64 {
    let turned = |i: usize, j: usize| {
        let (row, column) = (twice[0].checked_sub(i)?, twice[1].checked_sub(j)?);
        c.get((row, column)).copied()
    };
    let all = (0..c.ncols()).flat_map(|j| (0..c.nrows()).map(move |i| (i, j)));
    all.map(|(i, j)| (c[(i, j)] - turned(i, j).unwrap_or(0.0)).powi(2)).sum::<f64>().sqrt()
}

/// The box about the middle that holds all that is more than rounding.
fn cropped(c: &DenseMatrix, twice: [usize; 2]) -> Laurent {
    let reach = |a: usize| {
        let away = |row: usize, column: usize| (2 * [row, column][a]).abs_diff(twice[a]);
        let all = (0..c.ncols()).flat_map(|j| (0..c.nrows()).map(move |i| (i, j)));
        let there = all.filter(|&(i, j)| c[(i, j)].abs() > ROUNDING * c.amax());
        there.map(|(i, j)| away(i, j)).max().unwrap_or(0)
    };
    let reach = [reach(0), reach(1)];
    let entry = |i: usize, j: usize| {
        let place = |k: usize, a: usize| (twice[a] + 2 * k).checked_sub(reach[a]).map(|twice| twice / 2);
        place(i, 0).zip(place(j, 1)).and_then(|at| c.get(at)).copied().unwrap_or(0.0)
    };
    Laurent {
        coefficients: DenseMatrix::from_fn(reach[0] + 1, reach[1] + 1, entry),
        lowest: reach.map(|reach| -0.5 * reach as f64),
    }
}

fn asymmetry(polynomial: &Laurent) -> f64 {
    let c = &polynomial.coefficients;
    let (rows, columns) = c.shape();
    let turned = DenseMatrix::from_fn(rows, columns, |i, j| c[(rows - 1 - i, columns - 1 - j)]);
    (c - turned).amax() / c.amax()
}

/// The largest imaginary part of the samples, centred.
fn imaginary(values: &ComplexMatrix, center: [f64; 2]) -> f64 {
    let (n1, n2) = values.shape();
    let part = |j: usize, k: usize| {
        let phase = center[0] * root(j, n1) + center[1] * root(k, n2);
        (values[(j, k)] * Complex::from_polar(1.0, -phase)).im.abs()
    };
    (0..n1).flat_map(|j| (0..n2).map(move |k| part(j, k))).fold(0.0, f64::max)
}

/// The largest difference of polynomial and centred matrix where it was not sampled.
fn difference(rigidity: &Rigidity, polynomial: &Laurent, center: [f64; 2]) -> Result<f64, BlochError> {
    let mut largest = 0.0f64;
    for turns in COMPARED {
        let q = turns.map(|turn| TAU * turn);
        let direct = rigidity.determinant(q.map(|q| Complex::from_polar(1.0, q)))?;
        let direct = direct * Complex::from_polar(1.0, -(center[0] * q[0] + center[1] * q[1]));
        let apart = (direct - polynomial.at(q)).norm();
        largest = if apart.is_nan() { f64::INFINITY } else { largest.max(apart) };
    }
    Ok(largest)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Claim: a polynomial sampled at roots of unity gives its coefficients back, negative powers at the far end; also
    /// for counts that are no powers of two. Tolerance: rounding of sums of `n1` and `n2` values of size up to 2.75.
    #[test]
    fn coefficients_come_back() {
        for [n1, n2] in [[8, 8], [5, 9], [7, 1]] {
            let terms = [(0i32, 0i32, 0.5), (1, -1, 2.0), (-2, 3, -0.25)];
            let terms = terms.map(|(m, n, c)| (m, if n2 == 1 { 0 } else { n }, c));
            let value = |j: usize, k: usize| {
                let term = |&(m, n, c): &(i32, i32, f64)| {
                    let phase = f64::from(m) * j as f64 / n1 as f64 + f64::from(n) * k as f64 / n2 as f64;
                    Complex::from_polar(c, TAU * phase)
                };
                terms.iter().map(term).sum()
            };
            let found = coefficients(&ComplexMatrix::from_fn(n1, n2, value));
            let mut expected = ComplexMatrix::zeros(n1, n2);
            for (m, n, c) in terms {
                expected[(m.rem_euclid(n1 as i32) as usize, n.rem_euclid(n2 as i32) as usize)] += c;
            }
            assert!((found - expected).norm() <= f64::EPSILON * (n1 + n2) as f64 * 2.75);
        }
    }
}
