//! Dense complex matrices: determinants, eigenvalues, singular values and vectors.

use super::dense::{DenseError, binary_unit};
use faer::diag::DiagMut;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::evd::{ComputeEigenvectors, evd_cplx, evd_scratch, self_adjoint_evd, self_adjoint_evd_scratch};
use faer::linalg::svd::{ComputeSvdVectors, svd, svd_scratch};
use faer::{ColMut, MatMut, MatRef, Par, Spec};
use nalgebra::{Complex, DMatrix, DVector};

/// A dense complex matrix.
pub type ComplexMatrix = DMatrix<Complex<f64>>;

/// A complex vector.
pub type ComplexVector = DVector<Complex<f64>>;

/// `matrix = u * diag(singular_values) * v^H` of a square matrix.
#[derive(Clone, Debug)]
pub struct ComplexSvd {
    /// Left singular vectors.
    pub u: ComplexMatrix,
    /// Singular values, descending.
    pub singular_values: Vec<f64>,
    /// Right singular vectors.
    pub v: ComplexMatrix,
}

/// The determinant of a square matrix, by elimination with row pivots of the largest modulus. (nalgebra's LU
/// factorization chooses them by `|re| + |im|`, and its determinants differ in the last digits.)
///
/// # Panics
/// Panics where the matrix is not square.
pub fn determinant(mut matrix: ComplexMatrix) -> Complex<f64> {
    assert!(matrix.is_square(), "a determinant is that of a square matrix");
    let n = matrix.nrows();
    let mut product = Complex::new(1.0, 0.0);
    for k in 0..n {
        let pivot = (k..n).max_by(|&a, &b| matrix[(a, k)].norm_sqr().total_cmp(&matrix[(b, k)].norm_sqr()));
        let Some(pivot) = pivot.filter(|&row| matrix[(row, k)] != Complex::ZERO) else { return Complex::ZERO };
        if pivot != k {
            matrix.swap_rows(pivot, k);
            product = -product;
        }
        product *= matrix[(k, k)];
        eliminate(matrix.as_mut_slice(), n, k);
    }
    product
}

/// One step of elimination below the pivot `(k, k)`, on columns of length `n`.
fn eliminate(entries: &mut [Complex<f64>], n: usize, k: usize) {
    let (left, right) = entries.split_at_mut((k + 1) * n);
    let column = &mut left[k * n..];
    let inverse = column[k].inv();
    column[k + 1..].iter_mut().for_each(|entry| *entry *= inverse);
    let factors = &column[k + 1..];
    for other in right.chunks_exact_mut(n) {
        let top = other[k];
        if top != Complex::ZERO {
            other[k + 1..].iter_mut().zip(factors).for_each(|(entry, factor)| *entry -= factor * top);
        }
    }
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
    let (rows, columns) = check(matrix)?;
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

/// Eigenvalues of a Hermitian matrix, ascending; only the lower triangle is read.
///
/// # Errors
/// As [`eigenvalues`].
pub fn hermitian_eigenvalues(matrix: &ComplexMatrix) -> Result<Vec<f64>, DenseError> {
    let (rows, columns) = check(matrix)?;
    let mut values = vec![Complex::ZERO; rows];
    let unit = binary_unit(matrix.iter().map(|entry| entry.re.abs().max(entry.im.abs())));
    if rows > 0 {
        let matrix = matrix.map(|entry| entry / unit);
        let no = ComputeEigenvectors::No;
        let scratch = self_adjoint_evd_scratch::<Complex<f64>>(rows, no, Par::Seq, Spec::default());
        let mut buffer = MemBuffer::new(scratch);
        let stack = MemStack::new(&mut buffer);
        self_adjoint_evd(view(&matrix), diagonal(&mut values), None, Par::Seq, stack, Spec::default())
            .map_err(|_| DenseError::NoConvergence { rows, columns })?;
    }
    Ok(values.into_iter().map(|value| value.re * unit).collect())
}

/// Singular values and vectors of a square matrix.
///
/// # Errors
/// As [`eigenvalues`].
pub fn complex_svd(matrix: &ComplexMatrix) -> Result<ComplexSvd, DenseError> {
    let (rows, columns) = check(matrix)?;
    let (mut u, mut v) = (ComplexMatrix::identity(rows, rows), ComplexMatrix::identity(rows, rows));
    let mut values = vec![Complex::ZERO; rows];
    if rows > 0 {
        let full = ComputeSvdVectors::Full;
        let scratch = svd_scratch::<Complex<f64>>(rows, rows, full, full, Par::Seq, Spec::default());
        let mut buffer = MemBuffer::new(scratch);
        let (left, right) = (Some(view_mut(&mut u)), Some(view_mut(&mut v)));
        let stack = MemStack::new(&mut buffer);
        svd(view(matrix), diagonal(&mut values), left, right, Par::Seq, stack, Spec::default())
            .map_err(|_| DenseError::NoConvergence { rows, columns })?;
    }
    Ok(ComplexSvd { u, singular_values: values.into_iter().map(|value| value.re).collect(), v })
}

/// The sizes of a square matrix of finite entries.
fn check(matrix: &ComplexMatrix) -> Result<(usize, usize), DenseError> {
    let (rows, columns) = matrix.shape();
    if rows != columns {
        return Err(DenseError::NotSquare { rows, columns });
    }
    match matrix.iter().position(|value| !(value.re.is_finite() && value.im.is_finite())) {
        None => Ok((rows, columns)),
        Some(at) => {
            let (row, column) = (at % rows, at / rows);
            Err(DenseError::NotFinite { row, column, value: matrix[(row, column)].norm() })
        }
    }
}

fn view(matrix: &ComplexMatrix) -> MatRef<'_, Complex<f64>> {
    MatRef::from_column_major_slice(matrix.as_slice(), matrix.nrows(), matrix.ncols())
}

fn view_mut(matrix: &mut ComplexMatrix) -> MatMut<'_, Complex<f64>> {
    let (rows, columns) = matrix.shape();
    MatMut::from_column_major_slice_mut(matrix.as_mut_slice(), rows, columns)
}

fn diagonal(values: &mut [Complex<f64>]) -> DiagMut<'_, Complex<f64>> {
    ColMut::from_slice_mut(values).as_diagonal_mut()
}

#[cfg(test)]
mod tests {
    use super::*;

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
            let ComplexSvd { u, singular_values, v } = complex_svd(&matrix).unwrap();
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
        let ComplexSvd { u, .. } = complex_svd(&scrambled(9)).unwrap();
        let middle = ComplexMatrix::from_fn(9, 9, |i, j| Complex::new(if i == j { i as f64 - 3.0 } else { 0.0 }, 0.0));
        let found = hermitian_eigenvalues(&(&u * middle * u.adjoint())).unwrap();
        assert!(found.iter().enumerate().all(|(k, value)| (value - (k as f64 - 3.0)).abs() <= 1e-13), "{found:?}");
    }

    /// Claim: what cannot be decomposed is refused; a singular matrix has determinant zero.
    #[test]
    fn refusals() {
        let mut matrix = scrambled(3);
        matrix[(2, 1)].im = f64::NAN;
        assert!(matches!(eigenvalues(&matrix), Err(DenseError::NotFinite { row: 2, column: 1, .. })));
        assert!(matches!(complex_svd(&ComplexMatrix::zeros(2, 3)), Err(DenseError::NotSquare { .. })));
        assert_eq!(determinant(ComplexMatrix::zeros(3, 3)), Complex::ZERO);
        assert!(eigenvalues(&ComplexMatrix::zeros(0, 0)).unwrap().is_empty());
    }
}
