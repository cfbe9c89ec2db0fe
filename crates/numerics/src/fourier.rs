//! Coefficients of a Laurent polynomial in two variables from its values at roots of unity, by fast Fourier transform.
//!
//! Reasons for rustfft: it is pure Rust, takes any length (the number of powers of a determinant is seldom a power of
//! two), is what most of the ecosystem uses (31 million downloads in all, 9 million in a quarter, when 6.4.1 of
//! September 2025 was the newest), and a search of its issues found no open report of unsound code; its paths for
//! vector instructions, where most of its `unsafe` is, are switched off here. phastft takes powers of two only, which
//! would mean up to four times as many determinants; realfft is rustfft for real values; bindings of FFTW need a C
//! library. At the lengths here, some tens, a direct sum would do as well: the determinants cost far more than the
//! transform.

use super::complex::ComplexMatrix;
use nalgebra::Complex;
use rustfft::FftPlanner;

/// The coefficients `c_mn` with `values_jk = sum c_mn exp(2 pi i (m j / n1 + n k / n2))`, for an `n1 x n2` matrix of
/// values.
///
/// Exponents are known modulo `n1` and `n2` only: `c_mn` stands at row `m`, column `n` for `0 <= m < n1`, `0 <= n <
/// n2`.
pub fn coefficients(values: &ComplexMatrix) -> ComplexMatrix {
    let mut planner = FftPlanner::new();
    let [rows, columns] = [values.nrows(), values.ncols()];
    let mut found = values.clone();
    let along_columns = planner.plan_fft_forward(rows);
    found.as_mut_slice().chunks_exact_mut(rows).for_each(|column| along_columns.process(column));
    let mut turned = found.transpose();
    let along_rows = planner.plan_fft_forward(columns);
    turned.as_mut_slice().chunks_exact_mut(columns).for_each(|row| along_rows.process(row));
    turned.transpose() / Complex::new((rows * columns) as f64, 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    /// Claim: a polynomial sampled at roots of unity gives its coefficients back, negative powers at the far end; also
    /// for counts that are no powers of two. Tolerance: rounding.
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
            assert!((found - expected).norm() <= 1e-15);
        }
    }
}
