//! Decompositions of small matrices by nalgebra: they take less time to call than faer's, and matrices of fixed size
//! need no memory.
//!
//! They say nothing of their accuracy; where a rank has to be certified use [`null_space`](super::null_space) and its
//! neighbours.

use crate::DenseMatrix;
use nalgebra::{Cholesky, DMatrix, DVector, Dyn, Matrix3, Vector3};

/// A Cholesky factorization, to solve with.
pub type CholeskyFactor = Cholesky<f64, Dyn>;

/// The Cholesky factorization of a symmetric matrix; `None` where it is not positive definite.
pub fn cholesky(matrix: DenseMatrix) -> Option<CholeskyFactor> {
    Cholesky::new(matrix)
}

/// Orthonormal columns `q` and an upper triangle `r` with `matrix = q r`, for a matrix with at least as many rows as
/// columns.
pub fn orthonormal_triangular(matrix: DenseMatrix) -> [DenseMatrix; 2] {
    let found = matrix.qr();
    [found.q(), found.r()]
}

/// The solution of `matrix * x = right`, column by column, by elimination with row pivots; `None` where the square
/// matrix is singular.
pub fn solve_square(matrix: DenseMatrix, right: &DenseMatrix) -> Option<DenseMatrix> {
    matrix.lu().solve(right)
}

/// The inverse of a square matrix, real or complex; `None` where it is singular.
pub fn inverse<T: nalgebra::ComplexField>(matrix: DMatrix<T>) -> Option<DMatrix<T>> {
    matrix.try_inverse()
}

/// Returns the rotation `Q` with the largest trace of `Q^T matrix`: it brings points `p` closest to others `q` if the
/// matrix is the sum of `q p^T` over all pairs (W. Kabsch, Acta Cryst. A 32, 922 (1976)).
pub fn nearest_rotation(matrix: &Matrix3<f64>) -> Matrix3<f64> {
    let svd = matrix.svd(true, true);
    let (Some(u), Some(v)) = (svd.u, svd.v_t) else { return Matrix3::identity() };
    let mut signs = Vector3::repeat(1.0);
    if (u * v).determinant() < 0.0 {
        signs[svd.singular_values.imin()] = -1.0;
    }
    u * Matrix3::from_diagonal(&signs) * v
}

/// The smallest over the largest singular value; not a number for a matrix of zeros.
pub fn reciprocal_condition(matrix: &DenseMatrix) -> f64 {
    let values = matrix.singular_values();
    values.min() / values.max()
}

/// The shortest vector `x` with the least residual of `matrix * x = right`, singular values up to `zero` taken for
/// zero; `None` where `zero` is negative.
pub fn shortest_solution(matrix: DenseMatrix, right: &DVector<f64>, zero: f64) -> Option<DVector<f64>> {
    matrix.svd(true, true).solve(right, zero).ok()
}

/// Eigenvalues, in no order, and orthonormal eigenvectors as columns of a symmetric 3 x 3 matrix.
pub fn symmetric_eigen_3(matrix: Matrix3<f64>) -> (Vector3<f64>, Matrix3<f64>) {
    let found = matrix.symmetric_eigen();
    (found.eigenvalues, found.eigenvectors)
}

/// The solution of a 3 x 3 system; `None` where it is singular.
pub fn solve_3(matrix: Matrix3<f64>, right: &Vector3<f64>) -> Option<Vector3<f64>> {
    matrix.lu().solve(right)
}
