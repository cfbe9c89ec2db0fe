//! Dense decompositions: singular values, null spaces with a certified rank, symmetric eigenpairs, least squares.
//!
//! Matrices come and go as [`DenseMatrix`], or with complex entries; everything runs on the calling thread.

pub mod small;
mod unit;

use super::DenseMatrix;
use super::sparse::{FIXED, Rows};
use super::vector::max_abs;
use faer::diag::DiagMut;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::evd::{ComputeEigenvectors, self_adjoint_evd, self_adjoint_evd_scratch};
use faer::linalg::svd::{ComputeSvdVectors, svd, svd_scratch};
use faer::{ColMut, MatMut, MatRef, Par, Spec};
use nalgebra::{Complex, DMatrix};
use unit::binary_unit;
pub use unit::eigenvalue_rounding;

/// The smallest gap between kept and dropped singular values at which a rank is believed.
pub(crate) const SMALLEST_GAP: f64 = 1e3;

/// The reason for which a matrix was not decomposed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[allow(missing_docs)] // each variant is documented by its message
pub enum DenseError {
    #[error("entry ({row}, {column}) of the matrix is {value}")]
    NotFinite { row: usize, column: usize, value: f64 },
    #[error("a matrix of {rows} rows and {columns} columns has no eigenvalues")]
    NotSquare { rows: usize, columns: usize },
    #[error("right-hand sides of {found} entries for a matrix of {rows} rows")]
    RightHandSide { rows: usize, found: usize },
    #[error("the decomposition of a {rows} x {columns} matrix did not converge")]
    NoConvergence { rows: usize, columns: usize },
    #[error(
        "no rank stands out: the largest gap between singular values is {gap:.3e}, from {kept:.3e} to {dropped:.3e} \
         after {rank} of them, less than {SMALLEST_GAP:e}"
    )]
    NoGap { rank: usize, kept: f64, dropped: f64, gap: f64, singular_values: Vec<f64> },
}

/// An entry of a matrix that is decomposed: a real number, or a complex one.
pub trait Number: Copy + nalgebra::ComplexField<RealField = f64> + faer::traits::ComplexField<Real = f64> {}

impl Number for f64 {}
impl Number for Complex<f64> {}

/// `matrix = u * diag(singular_values) * v^H` with square orthogonal, or unitary, `u` and `v`.
#[derive(Clone, Debug)]
pub struct Svd<T = f64> {
    /// Left singular vectors, `rows x rows`; those beyond the singular values span the rest.
    pub u: DMatrix<T>,
    /// `min(rows, columns)` singular values, descending.
    pub singular_values: Vec<f64>,
    /// Right singular vectors, `columns x columns`.
    pub v: DMatrix<T>,
}

/// A rank read off singular values, and how clearly.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rank {
    /// The number of singular values kept.
    pub rank: usize,
    /// Smallest kept over largest dropped singular value, the latter never taken below machine epsilon times the
    /// largest of all; so the gap is finite, at most `1 / epsilon`, also when exact zeros or nothing at all is dropped.
    pub gap: f64,
}

/// The vectors that a matrix sends to zero.
#[derive(Clone, Debug)]
pub struct NullSpace {
    /// Orthonormal columns, `columns x (columns - rank)`.
    pub basis: DenseMatrix,
    /// All singular values of the matrix, descending.
    pub singular_values: Vec<f64>,
    /// The numerical rank, at the largest gap.
    pub rank: usize,
    /// The gap at which the rank was read off, see [`Rank::gap`].
    pub gap: f64,
}

/// Eigenvalues and eigenvectors of a symmetric matrix.
#[derive(Clone, Debug)]
pub struct SymmetricEigen {
    /// Eigenvalues, ascending.
    pub values: Vec<f64>,
    /// Orthonormal eigenvectors as columns, in the order of the values.
    pub vectors: DenseMatrix,
}

/// Least-squares solutions: for every right-hand side the shortest vector with the least residual.
#[derive(Clone, Debug)]
pub struct LeastSquares {
    /// The solutions, as columns.
    pub solution: DenseMatrix,
    /// `matrix * solution - right`.
    pub residual: DenseMatrix,
    /// The rank that was used.
    pub rank: Rank,
}

/// A dense copy of sparse rows, of `columns` columns; entries of the same unknown in a row are added.
pub fn from_rows(rows: &Rows<'_>, columns: usize) -> DenseMatrix {
    let mut matrix = DenseMatrix::zeros(rows.cliques.len(), columns);
    for row in 0..rows.cliques.len() {
        let values = &rows.values[rows.cliques.range(row)];
        for (&member, value) in rows.cliques.members(row).iter().zip(values).filter(|(member, _)| **member != FIXED) {
            matrix[(row, member as usize)] += value;
        }
    }
    matrix
}

/// Singular values of a matrix, descending.
///
/// # Errors
/// [`DenseError::NotFinite`] and [`DenseError::NoConvergence`].
pub fn singular_values(matrix: &DenseMatrix) -> Result<Vec<f64>, DenseError> {
    decompose(matrix, None)
}

/// All singular values and vectors of a matrix.
///
/// # Errors
/// As [`singular_values`].
pub fn full_svd<T: Number>(matrix: &DMatrix<T>) -> Result<Svd<T>, DenseError> {
    let (rows, columns) = matrix.shape();
    let mut u = DMatrix::identity(rows, rows);
    let mut v = DMatrix::identity(columns, columns);
    let singular_values = decompose(matrix, Some((&mut u, &mut v)))?;
    Ok(Svd { u, singular_values, v })
}

/// The number of singular values before their largest gap, among `values` in descending order, of a matrix whose
/// entries are data: one of zeros has rank 0, any other has at least rank 1.
///
/// # Errors
/// [`DenseError::NoGap`] where the largest gap is below [`SMALLEST_GAP`].
pub fn rank_at_largest_gap(values: &[f64]) -> Result<Rank, DenseError> {
    rank_of_sums(values, 0.0)
}

/// The number of singular values before their largest gap, as [`rank_at_largest_gap`], of a matrix whose entries are
/// sums of terms of the magnitude `terms`. Where the terms cancel in every entry, what is left is rounding: the gap
/// before the first value counts too, and the rank may be 0.
///
/// # Errors
/// As [`rank_at_largest_gap`].
pub fn rank_of_sums(values: &[f64], terms: f64) -> Result<Rank, DenseError> {
    let largest = values.first().copied().unwrap_or(0.0);
    if largest == 0.0 {
        return Ok(Rank { rank: 0, gap: 1.0 / f64::EPSILON });
    }
    let after = |rank: usize| values.get(rank).copied().unwrap_or(0.0).max(f64::EPSILON * f64::max(largest, terms));
    let mut best = Rank { rank: 0, gap: terms / largest };
    for (position, kept) in values.iter().enumerate() {
        let gap = kept / after(position + 1);
        if gap > best.gap {
            best = Rank { rank: position + 1, gap };
        }
    }
    if best.gap >= SMALLEST_GAP {
        return Ok(best);
    }
    let Rank { rank, gap } = best;
    let kept = rank.checked_sub(1).map_or(terms, |last| values[last]);
    Err(DenseError::NoGap { rank, kept, dropped: after(rank), gap, singular_values: values.to_vec() })
}

/// An orthonormal basis of the null space, the rank chosen by [`rank_at_largest_gap`].
///
/// A matrix without rows has the whole space as null space. The left null space is that of the transpose.
///
/// # Errors
/// As [`singular_values`] and [`rank_at_largest_gap`].
pub fn null_space(matrix: &DenseMatrix) -> Result<NullSpace, DenseError> {
    null_space_of_sums(matrix, 0.0)
}

/// An orthonormal basis of the null space of a matrix whose entries are sums of terms of the magnitude `terms`, which
/// may cancel in all of them, the rank chosen by [`rank_of_sums`].
///
/// # Errors
/// As [`null_space`].
pub fn null_space_of_sums(matrix: &DenseMatrix, terms: f64) -> Result<NullSpace, DenseError> {
    let Svd { v, singular_values, .. } = full_svd(matrix)?;
    let Rank { rank, gap } = rank_of_sums(&singular_values, terms)?;
    let basis = v.columns(rank, v.ncols() - rank).into_owned();
    Ok(NullSpace { basis, singular_values, rank, gap })
}

/// An orthonormal basis of the null space of sparse rows, of `columns` columns, by [`null_space_of_sums`]: entries of
/// the same unknown in a row may cancel.
///
/// # Errors
/// As [`null_space`].
pub fn null_space_of_rows(rows: &Rows<'_>, columns: usize) -> Result<NullSpace, DenseError> {
    null_space_of_sums(&from_rows(rows, columns), max_abs(rows.values))
}

/// The minimal-norm least-squares solutions of `matrix * x = right`, a column for each of `right`, the rank chosen by
/// [`rank_at_largest_gap`].
///
/// # Errors
/// As [`null_space`], and [`DenseError::RightHandSide`].
pub fn least_squares(matrix: &DenseMatrix, right: &DenseMatrix) -> Result<LeastSquares, DenseError> {
    least_squares_of_sums(matrix, right, 0.0)
}

/// The minimal-norm least-squares solutions, as [`least_squares`], with a matrix whose entries are sums of terms of the
/// magnitude `terms`, the rank chosen by [`rank_of_sums`].
///
/// # Errors
/// As [`least_squares`].
pub fn least_squares_of_sums(
    matrix: &DenseMatrix,
    right: &DenseMatrix,
    terms: f64,
) -> Result<LeastSquares, DenseError> {
    if right.nrows() != matrix.nrows() {
        return Err(DenseError::RightHandSide { rows: matrix.nrows(), found: right.nrows() });
    }
    check_finite(right)?;
    let Svd { u, singular_values, v } = full_svd(matrix)?;
    let rank = rank_of_sums(&singular_values, terms)?;
    let mut parts = u.columns(0, rank.rank).tr_mul(right);
    parts.row_iter_mut().zip(&singular_values).for_each(|(mut part, value)| part /= *value);
    let solution = v.columns(0, rank.rank) * parts;
    let residual = matrix * &solution - right;
    Ok(LeastSquares { solution, residual, rank })
}

/// Eigenvalues and eigenvectors of a symmetric matrix; only the lower triangle is read.
///
/// # Errors
/// [`DenseError`] where the matrix is not square, or an entry is not finite.
pub fn symmetric_eigen(matrix: &DenseMatrix) -> Result<SymmetricEigen, DenseError> {
    let mut vectors = DenseMatrix::identity(matrix.nrows(), matrix.nrows());
    let values = diagonalize(matrix, Some(&mut vectors))?;
    Ok(SymmetricEigen { values, vectors })
}

/// Eigenvalues of a symmetric matrix, or a Hermitian one, ascending; only the lower triangle is read.
///
/// # Errors
/// As [`symmetric_eigen`].
pub fn symmetric_eigenvalues<T: Number>(matrix: &DMatrix<T>) -> Result<Vec<f64>, DenseError> {
    diagonalize(matrix, None)
}

/// Singular values; the vectors are written where a place for them is given.
fn decompose<T: Number>(
    matrix: &DMatrix<T>,
    vectors: Option<(&mut DMatrix<T>, &mut DMatrix<T>)>,
) -> Result<Vec<f64>, DenseError> {
    check_finite(matrix)?;
    let (rows, columns) = matrix.shape();
    let mut values = vec![T::zero(); rows.min(columns)];
    if values.is_empty() {
        return Ok(vec![]);
    }
    let (what, u, v) = match vectors {
        Some((u, v)) => (ComputeSvdVectors::Full, Some(view_mut(u)), Some(view_mut(v))),
        None => (ComputeSvdVectors::No, None, None),
    };
    let mut buffer = MemBuffer::new(svd_scratch::<T>(rows, columns, what, what, Par::Seq, Spec::default()));
    svd(view(matrix), diagonal(&mut values), u, v, Par::Seq, MemStack::new(&mut buffer), Spec::default())
        .map_err(|_| DenseError::NoConvergence { rows, columns })?;
    Ok(values.into_iter().map(T::real).collect())
}

/// Eigenvalues; the eigenvectors are written where a place for them is given.
fn diagonalize<T: Number>(matrix: &DMatrix<T>, vectors: Option<&mut DMatrix<T>>) -> Result<Vec<f64>, DenseError> {
    let (rows, columns) = check_square(matrix)?;
    let unit = binary_unit(matrix.iter().map(|&entry| entry.real().abs().max(entry.imaginary().abs())));
    let (matrix, mut values) = (matrix.map(|entry| entry.unscale(unit)), vec![T::zero(); rows]);
    let what = if vectors.is_some() { ComputeEigenvectors::Yes } else { ComputeEigenvectors::No };
    let mut buffer = MemBuffer::new(self_adjoint_evd_scratch::<T>(rows, what, Par::Seq, Spec::default()));
    let (stack, u) = (MemStack::new(&mut buffer), vectors.map(view_mut));
    self_adjoint_evd(view(&matrix), diagonal(&mut values), u, Par::Seq, stack, Spec::default())
        .map_err(|_| DenseError::NoConvergence { rows, columns })?;
    Ok(values.into_iter().map(|value| value.real() * unit).collect())
}

/// Returns the sizes of a square matrix of finite entries.
pub(super) fn check_square<T: Number>(matrix: &DMatrix<T>) -> Result<(usize, usize), DenseError> {
    check_finite(matrix)?;
    let (rows, columns) = matrix.shape();
    if rows == columns { Ok((rows, columns)) } else { Err(DenseError::NotSquare { rows, columns }) }
}

fn check_finite<T: Number>(matrix: &DMatrix<T>) -> Result<(), DenseError> {
    let wrong = matrix.iter().position(|value| !nalgebra::ComplexField::is_finite(value));
    let Some(at) = wrong else { return Ok(()) };
    let (row, column, entry) = (at % matrix.nrows(), at / matrix.nrows(), matrix[at]);
    let value = if entry.imaginary() == 0.0 { entry.real() } else { entry.modulus() };
    Err(DenseError::NotFinite { row, column, value })
}

pub(super) fn view<T: Number>(matrix: &DMatrix<T>) -> MatRef<'_, T> {
    MatRef::from_column_major_slice(matrix.as_slice(), matrix.nrows(), matrix.ncols())
}

fn view_mut<T: Number>(matrix: &mut DMatrix<T>) -> MatMut<'_, T> {
    let (rows, columns) = matrix.shape();
    MatMut::from_column_major_slice_mut(matrix.as_mut_slice(), rows, columns)
}

pub(super) fn diagonal<T: Number>(values: &mut [T]) -> DiagMut<'_, T> {
    ColMut::from_slice_mut(values).as_diagonal_mut()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Entries in [-1, 1) that look random and are the same on every machine.
    fn scrambled(rows: usize, columns: usize, seed: u64) -> DenseMatrix {
        let mut state = seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1;
        DenseMatrix::from_fn(rows, columns, |_, _| {
            state ^= state << 13;
            state ^= state >> 7;
            state ^= state << 17;
            (state >> 11) as f64 / (1u64 << 52) as f64 - 1.0
        })
    }

    fn orthogonality_defect(matrix: &DenseMatrix) -> f64 {
        (matrix.transpose() * matrix - DenseMatrix::identity(matrix.ncols(), matrix.ncols())).amax()
    }

    /// Claim: the three factors multiply back to the matrix, for tall, wide, square and rank-deficient ones, below and
    /// above the size at which the recursion starts. Tolerance: backward stability, some n * epsilon.
    #[test]
    fn factors_multiply_back() {
        for (rows, columns, rank) in [(3, 5, 2), (5, 3, 3), (36, 36, 33), (200, 150, 120), (160, 300, 100), (1, 1, 1)] {
            let matrix = scrambled(rows, rank, 1) * scrambled(rank, columns, 2);
            let Svd { u, singular_values, v } = full_svd(&matrix).unwrap();
            let mut middle = DenseMatrix::zeros(rows, columns);
            singular_values.iter().enumerate().for_each(|(k, value)| middle[(k, k)] = *value);
            let scale = singular_values[0];
            assert!((&u * middle * v.transpose() - &matrix).amax() <= 1e-13 * scale);
            assert!(orthogonality_defect(&u) <= 1e-13 && orthogonality_defect(&v) <= 1e-13);
            assert!(singular_values.windows(2).all(|pair| pair[0] >= pair[1] && pair[1] >= 0.0));
            let alone = super::singular_values(&matrix).unwrap();
            assert!(alone.iter().zip(&singular_values).all(|(a, b)| (a - b).abs() <= 1e-13 * scale));
        }
    }

    /// Claim: a product of random factors of inner size r has rank r, and its null space is orthonormal and sent to
    /// zero. Tolerance: rounding of products of 300 terms.
    #[test]
    fn null_space_of_a_product() {
        for (rows, columns, rank) in [(12, 12, 9), (12, 24, 12), (24, 12, 12), (150, 300, 140), (300, 150, 1)] {
            let matrix = scrambled(rows, rank, 3) * scrambled(rank, columns, 4);
            let found = null_space(&matrix).unwrap();
            assert_eq!((found.rank, found.basis.ncols()), (rank, columns - rank));
            assert!(found.gap > 1e8, "gap {}", found.gap);
            assert!((&matrix * &found.basis).amax() <= 1e-13 * found.singular_values[0]);
            assert!(columns == rank || orthogonality_defect(&found.basis) <= 1e-13);
        }
    }

    /// Claim: the gap is the contract's quotient where the dropped value is above rounding, and is limited by epsilon
    /// where it is zero or where nothing is dropped.
    #[test]
    fn gap_is_the_quotient() {
        let rank = |values: &[f64]| rank_at_largest_gap(values).unwrap();
        assert_eq!(rank(&[4.0, 2.0, 1e-11, 1e-12]), Rank { rank: 2, gap: 2.0 / 1e-11 });
        assert_eq!(rank(&[4.0, 2.0, 0.0]), Rank { rank: 2, gap: 0.5 / f64::EPSILON });
        assert_eq!(rank(&[4.0, 2.0]), Rank { rank: 2, gap: 0.5 / f64::EPSILON });
        assert_eq!(rank(&[0.0, 0.0]).rank, 0);
        assert_eq!(rank(&[]).rank, 0);
    }

    /// Claim: what is left where terms cancel in every entry is rounding beside the terms, and beside nothing a rank;
    /// terms no larger than the values change nothing.
    #[test]
    fn cancelled_terms_have_rank_zero() {
        let left = [4e-16, 2e-16, 1e-18];
        assert_eq!(rank_of_sums(&left, 1.0).unwrap(), Rank { rank: 0, gap: 1.0 / 4e-16 });
        assert_eq!(rank_of_sums(&left, 0.0).unwrap().rank, 3);
        assert_eq!(rank_of_sums(&[4.0, 2.0, 1e-12], 1.0).unwrap(), Rank { rank: 2, gap: 2.0 / 1e-12 });
        assert_eq!(rank_of_sums(&[1e-5, 1e-6], 1.0).unwrap().rank, 2);
        assert!(matches!(rank_of_sums(&[0.1, 0.01], 1.0).unwrap(), Rank { rank: 2, .. }));
        let falling: Vec<f64> = (1..17).map(|k| 10f64.powi(-k)).collect();
        assert!(matches!(rank_of_sums(&falling, 1.0), Err(DenseError::NoGap { .. })));
    }

    /// Claim: singular values that fall by a factor of 10 each down to rounding have no rank, and the error tells
    /// where the widest gap is.
    #[test]
    fn even_decay_has_no_rank() {
        let values: Vec<f64> = (0..16).map(|k| 10f64.powi(-k) * if k > 3 { 0.5 } else { 1.0 }).collect();
        match rank_at_largest_gap(&values) {
            Err(DenseError::NoGap { rank, gap, kept, dropped, .. }) => {
                assert_eq!(rank, 4);
                assert!((gap - 20.0).abs() < 1e-9 && kept == 1e-3 && (dropped - 5e-5).abs() < 1e-18);
            }
            other => panic!("{other:?}"),
        }
    }

    /// Claim: matrices without rows or columns are legal: no rows, no condition, everything is a null vector.
    #[test]
    fn empty_matrices() {
        let free = null_space(&DenseMatrix::zeros(0, 5)).unwrap();
        assert_eq!((free.rank, free.basis), (0, DenseMatrix::identity(5, 5)));
        assert_eq!(null_space(&DenseMatrix::zeros(5, 0)).unwrap().basis.shape(), (0, 0));
        assert_eq!(null_space(&DenseMatrix::zeros(2, 3)).unwrap().basis.ncols(), 3);
        assert!(symmetric_eigenvalues(&DenseMatrix::zeros(0, 0)).unwrap().is_empty());
    }

    /// Claim: the second difference on n points has eigenvalues 4 sin^2(k pi / 2 (n + 1)) (textbook). Tolerance:
    /// rounding of a norm-4 matrix.
    #[test]
    fn eigenvalues_of_a_chain() {
        let n = 40;
        let chain = DenseMatrix::from_fn(n, n, |i, j| [2.0, -1.0].get(i.abs_diff(j)).copied().unwrap_or(0.0));
        let SymmetricEigen { values, vectors } = symmetric_eigen(&chain).unwrap();
        for (k, value) in values.iter().enumerate() {
            let exact = 4.0 * ((k + 1) as f64 * std::f64::consts::FRAC_PI_2 / (n + 1) as f64).sin().powi(2);
            assert!((value - exact).abs() <= 1e-14 * 4.0 * 10.0);
            assert!((&chain * vectors.column(k) - vectors.column(k) * *value).amax() <= 1e-13);
        }
        let alone = symmetric_eigenvalues(&chain).unwrap();
        assert!(alone.iter().zip(&values).all(|(a, b)| (a - b).abs() <= 1e-13));
    }

    /// Claim: eigenvalues do not depend on the unit of the matrix, in which zeros are rounding errors of the largest: a
    /// matrix of rank 60, times powers of two from 2^-300 to 2^300, has bit by bit the same ones times these.
    #[test]
    fn eigenvalues_in_any_unit() {
        let factor = scrambled(80, 60, 8);
        let matrix = &factor * factor.transpose();
        let expected = symmetric_eigenvalues(&matrix).unwrap();
        assert!(expected[..20].iter().all(|value| value.abs() <= 1e-14 * expected[79]), "{expected:?}");
        for power in [-300, -40, 1, 17, 36, 300] {
            let unit = 2f64.powi(power);
            let scaled: Vec<f64> = expected.iter().map(|value| value * unit).collect();
            assert_eq!(symmetric_eigenvalues(&(&matrix * unit)).unwrap(), scaled, "2^{power}");
        }
    }

    /// Claim: with a rank-deficient matrix the solution is the shortest one: perpendicular to the null space, with the
    /// residual perpendicular to the range.
    #[test]
    fn least_squares_is_the_shortest() {
        let matrix = scrambled(9, 4, 5) * scrambled(4, 7, 6);
        let right = scrambled(9, 2, 7);
        let found = least_squares(&matrix, &right).unwrap();
        let rest = &matrix * &found.solution - &right;
        assert_eq!(found.rank.rank, 4);
        assert!((matrix.transpose() * &rest).amax() <= 1e-12);
        assert!((null_space(&matrix).unwrap().basis.transpose() * &found.solution).amax() <= 1e-12);
        assert!((found.residual - &rest).amax() <= 1e-13 && rest.norm() > 0.1);
    }

    /// Claim: what is not finite or does not fit is refused by name, never computed with.
    #[test]
    fn bad_input_is_refused() {
        let mut matrix = DenseMatrix::identity(3, 4);
        assert_eq!(symmetric_eigen(&matrix).unwrap_err(), DenseError::NotSquare { rows: 3, columns: 4 });
        let short = DenseMatrix::zeros(2, 1);
        assert_eq!(least_squares(&matrix, &short).unwrap_err(), DenseError::RightHandSide { rows: 3, found: 2 });
        matrix[(1, 3)] = f64::INFINITY;
        let refused = DenseError::NotFinite { row: 1, column: 3, value: f64::INFINITY };
        assert_eq!(null_space(&matrix).unwrap_err(), refused);
        matrix[(1, 3)] = f64::NAN;
        assert!(matches!(singular_values(&matrix), Err(DenseError::NotFinite { row: 1, column: 3, .. })));
        assert!(matches!(symmetric_eigenvalues(&matrix), Err(DenseError::NotFinite { .. })));
    }
}
