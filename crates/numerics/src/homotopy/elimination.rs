//! Gaussian elimination of small complex matrices: solutions, and ranks by complete pivoting.
//!
//! Matrices of systems are stored by rows and overwritten, in memory that a path uses again at every step; nalgebra's
//! factorizations are stored by columns and own their memory.

use super::system::C;
use crate::complex::ComplexMatrix;

/// Solves `matrix x = right` in place, `matrix` square and by rows; false where a pivot is zero or not a number.
pub(super) fn solve(matrix: &mut [C], right: &mut [C]) -> bool {
    let n = right.len();
    for k in 0..n {
        let size = |row: usize| matrix[row * n + k].norm_sqr();
        let pivot = (k + 1..n).fold(k, |best, row| if size(row) > size(best) { row } else { best });
        let usable = size(pivot) > 0.0;
        if !usable {
            return false;
        }
        if pivot != k {
            (k..n).for_each(|column| matrix.swap(k * n + column, pivot * n + column));
            right.swap(k, pivot);
        }
        let inverse = matrix[k * n + k].inv();
        let (above, below) = matrix.split_at_mut((k + 1) * n);
        let (upper, lower) = right.split_at_mut(k + 1);
        let source = &above[k * n + k + 1..];
        for (row, entry) in below.chunks_exact_mut(n).zip(lower) {
            let factor = row[k] * inverse;
            row[k + 1..].iter_mut().zip(source).for_each(|(a, b)| *a -= factor * b);
            *entry -= factor * upper[k];
        }
    }
    for k in (0..n).rev() {
        let row = &matrix[k * n..][..n];
        let known: C = (k + 1..n).map(|column| row[column] * right[column]).sum();
        right[k] = (right[k] - known) / row[k];
    }
    right.iter().all(|entry| entry.re.is_finite() && entry.im.is_finite())
}

/// Number of pivots above `threshold` times the first one, in elimination with complete pivoting.
pub(super) fn rank(rows: &[Vec<C>], threshold: f64) -> usize {
    let columns = rows.first().map_or(0, Vec::len);
    let upper = ComplexMatrix::from_fn(rows.len(), columns, |i, j| rows[i][j]).full_piv_lu().u();
    let is_pivot = |k: &usize| upper[(*k, *k)].norm() > threshold * upper[(0, 0)].norm();
    (0..rows.len().min(columns)).take_while(is_pivot).count()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scrambled(count: usize, seed: u64) -> Vec<C> {
        let mut random = rand_chacha::rand_core::SeedableRng::seed_from_u64(seed);
        let mut number = || crate::random::symmetric(&mut random);
        (0..count).map(|_| C::new(number(), number())).collect()
    }

    /// Claim: solutions satisfy their equations to rounding; a matrix of rank one is refused or gives no finite
    /// numbers.
    #[test]
    fn solutions_satisfy_their_equations() {
        for n in [1, 2, 5, 9] {
            let (matrix, right) = (scrambled(n * n, n as u64), scrambled(n, 77));
            let mut x = right.clone();
            assert!(solve(&mut matrix.clone(), &mut x));
            for (row, expected) in matrix.chunks_exact(n).zip(&right) {
                let found: C = row.iter().zip(&x).map(|(a, b)| a * b).sum();
                assert!((found - expected).norm() <= 1e-13, "{found} for {expected}");
            }
        }
        let one = C::new(1.0, 0.0);
        assert!(!solve(&mut [one; 4], &mut [one, -one]));
    }

    /// Claim: the rank of a product of random factors is their inner size.
    #[test]
    fn rank_of_a_product() {
        for (rows, columns, inner) in [(4, 7, 3), (7, 4, 2), (5, 5, 5), (6, 6, 0)] {
            let (left, right) = (scrambled(rows * inner, 1), scrambled(inner * columns, 2));
            let entry = |i: usize, j: usize| (0..inner).map(|k| left[i * inner + k] * right[k * columns + j]).sum();
            let product: Vec<_> = (0..rows).map(|i| (0..columns).map(|j| entry(i, j)).collect()).collect();
            assert_eq!(rank(&product, 1e-10), inner);
        }
    }
}
