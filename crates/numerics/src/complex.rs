//! Dense complex matrices: determinants, linear systems and eigenvalues. Their singular values, and the eigenvalues of
//! Hermitian ones, are in [`dense`](super::dense).

use super::dense::{DenseError, check_square, diagonal, view};
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::evd::{ComputeEigenvectors, evd_cplx, evd_scratch};
use faer::{Par, Spec};
use nalgebra::{Complex, DMatrix, DVector};

/// A dense complex matrix.
pub type ComplexMatrix = DMatrix<Complex<f64>>;

/// A complex vector.
pub type ComplexVector = DVector<Complex<f64>>;

/// The determinant of a square matrix.
///
/// # Panics
/// Panics where the matrix is not square.
pub fn determinant(matrix: ComplexMatrix) -> Complex<f64> {
    assert!(matrix.is_square(), "a determinant is that of a square matrix");
    matrix.lu().determinant()
}

/// The solutions `y` of `A^H y = right` and `x` of `A x = right`, in this order, from one elimination with row pivots;
/// `None` where the square matrix `A` is singular or a solution is not finite.
pub fn solve_with_adjoint(matrix: ComplexMatrix, right: &ComplexVector) -> Option<[ComplexVector; 2]> {
    let (rows, lower, upper) = matrix.lu().unpack();
    let (mut adjoint, mut solution) = (right.clone(), right.clone());
    rows.permute_rows(&mut solution);
    lower.solve_lower_triangular_with_diag_mut(&mut solution, Complex::ONE);
    let solvable = upper.solve_upper_triangular_mut(&mut solution)
        && upper.ad_solve_upper_triangular_mut(&mut adjoint)
        && lower.ad_solve_lower_triangular_mut(&mut adjoint);
    rows.inv_permute_rows(&mut adjoint);
    let finite = |vector: &ComplexVector| vector.iter().all(|x| x.norm_sqr().is_finite());
    (solvable && finite(&adjoint) && finite(&solution)).then_some([adjoint, solution])
}

/// All eigenvalues of a square matrix, in no order.
///
/// # Errors
/// [`DenseError`] where the matrix is not square, or an entry is not finite.
pub fn eigenvalues(matrix: &ComplexMatrix) -> Result<Vec<Complex<f64>>, DenseError> {
    let (rows, columns) = check_square(matrix)?;
    let mut values = vec![Complex::ZERO; rows];
    if rows > 0 {
        let no = ComputeEigenvectors::No;
        let scratch = evd_scratch::<Complex<f64>>(rows, no, no, Par::Seq, Spec::default());
        let mut buffer = MemBuffer::new(scratch);
        let stack = MemStack::new(&mut buffer);
        evd_cplx::<f64>(view(matrix), diagonal(&mut values), None, None, Par::Seq, stack, Spec::default())
            .map_err(|_| DenseError::NoConvergence { rows, columns })?;
    }
    Ok(values)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dense::{Svd, full_svd, symmetric_eigenvalues};

    /// Entries in the unit square that look random.
    fn scrambled(n: usize) -> ComplexMatrix {
        let part = |k: usize| ((k as f64 * 0.618_033_988_75 + 0.1 * (k * k) as f64).fract()) - 0.5;
        ComplexMatrix::from_fn(n, n, |i, j| Complex::new(part(n * i + j), part(7 * n * j + i + 3)))
    }

    /// Claim: the determinant is that of another library (nalgebra), the product of the eigenvalues, and in size that
    /// of the singular values; the singular vectors multiply back. Tolerance: some n * epsilon.
    #[test]
    fn determinants_three_ways() {
        for n in [1, 2, 5, 24, 48] {
            let matrix = scrambled(n);
            let found = determinant(matrix.clone());
            let product: Complex<f64> = eigenvalues(&matrix).unwrap().iter().product();
            let Svd { u, singular_values, v } = full_svd(&matrix).unwrap();
            let size: f64 = singular_values.iter().product();
            let middle =
                ComplexMatrix::from_fn(n, n, |i, j| Complex::new(if i == j { singular_values[i] } else { 0.0 }, 0.0));
            let bound = 1e-11 * found.norm();
            assert!((found - matrix.clone().determinant()).norm() <= bound && (found - product).norm() <= bound);
            assert!((found.norm() - size).abs() <= bound);
            assert!((u * middle * v.adjoint() - &matrix).norm() <= 1e-13 * matrix.norm());
        }
    }

    /// Claim: a Hermitian matrix with known eigenvalues gives them.
    #[test]
    fn hermitian() {
        let Svd { u, .. } = full_svd(&scrambled(9)).unwrap();
        let middle = ComplexMatrix::from_fn(9, 9, |i, j| Complex::new(if i == j { i as f64 - 3.0 } else { 0.0 }, 0.0));
        let found = symmetric_eigenvalues(&(&u * middle * u.adjoint())).unwrap();
        assert!(found.iter().enumerate().all(|(k, value)| (value - (k as f64 - 3.0)).abs() <= 1e-13), "{found:?}");
    }

    /// Claim: what cannot be decomposed is refused; a singular matrix has determinant zero.
    #[test]
    fn refusals() {
        let mut matrix = scrambled(3);
        matrix[(2, 1)].im = f64::NAN;
        assert!(matches!(eigenvalues(&matrix), Err(DenseError::NotFinite { row: 2, column: 1, .. })));
        assert!(matches!(eigenvalues(&ComplexMatrix::zeros(2, 3)), Err(DenseError::NotSquare { .. })));
        assert_eq!(determinant(ComplexMatrix::zeros(3, 3)), Complex::ZERO);
        assert!(eigenvalues(&ComplexMatrix::zeros(0, 0)).unwrap().is_empty());
    }
}
