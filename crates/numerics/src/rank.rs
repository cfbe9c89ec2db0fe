//! Rank of a sparse matrix by counting: Sylvester's law instead of singular values.
//!
//! The symmetric matrix `[[0, R^T], [R, 0]]` has the eigenvalues `+sigma` and `-sigma` for every singular value of `R`
//! and zeros besides. Shifted by `-tau` it has as many positive eigenvalues as `R` has singular values above `tau`,
//! and an `L D L^T` factorization counts them.

use super::factor::{Factor, FactorError};
use super::sparse::{Cliques, RankOne, Rows, Slots, SparsityPattern};
use super::vector::max_abs;

/// Number of singular values of `rows` (a matrix of `columns` columns) above `tau` times the largest entry. `node`
/// groups the columns into blocks, see [`super::order`].
///
/// # Errors
/// [`FactorError`] where the matrix of the count cannot be factored.
pub fn count_above(rows: &Rows<'_>, columns: usize, node: &[u32], tau: f64) -> Result<usize, FactorError> {
    let count = rows.cliques.len();
    let size = columns + count;
    let mut cliques = Cliques::new();
    for (row, members) in rows.cliques.iter().enumerate() {
        cliques.push(members.iter().copied().chain([(columns + row) as u32]));
    }
    let blocks = super::order::count(node) as u32;
    let node: Vec<u32> = node.iter().copied().chain((0..count as u32).map(|row| blocks + row)).collect();
    let pattern = SparsityPattern::new(size, &[&cliques]);
    let slots = Slots::new(&pattern, &cliques);
    let scale = max_abs(rows.values);
    if scale == 0.0 {
        return Ok(0);
    }
    let mut values = vec![0.0; pattern.entries()];
    pattern.add_to_diagonal(&mut values, -tau * scale);
    for row in 0..count {
        let gradient = &rows.values[rows.cliques.range(row)];
        let width = gradient.len();
        let mut block = vec![0.0; (width + 1) * (width + 2) / 2];
        block[width * (width + 1) / 2..][..width].copy_from_slice(gradient);
        slots.add_block(row, 1.0, &block, &mut values);
    }
    let mut factor = Factor::new(&pattern, &node, &[&cliques])?;
    let inertia = factor.factor(&pattern, &values)?;
    Ok(size - inertia.negative)
}

/// Multiple of the identity that makes `R^T R` regular, relative to its largest entry: so small that singular vectors
/// of small singular values still count.
const REGULARIZATION: f64 = 1e-13;
/// Ratio of successive residuals above which another correction is not worth a solve.
const SLOWEST_CONTRACTION: f64 = 0.9;

/// The shortest vector with the same `R^T t` as `t`: its part outside of the null space of `R^T`.
///
/// `R^T R y = R^T t` is solved with a factorization of `R^T R` made regular, so that zero modes of `R` do no harm, and
/// corrected as long as that helps; then `R y` is the answer.
///
/// # Errors
/// [`FactorError`] where the regularised matrix cannot be factored.
pub fn without_null(rows: &Rows<'_>, columns: usize, node: &[u32], t: &[f64]) -> Result<Vec<f64>, FactorError> {
    let pattern = SparsityPattern::new(columns, &[rows.cliques]);
    let slots = Slots::new(&pattern, rows.cliques);
    let mut values = vec![0.0; pattern.entries()];
    for row in 0..rows.cliques.len() {
        let gradient = &rows.values[rows.cliques.range(row)];
        slots.add_outer(row, RankOne { weight: 1.0, gradient }, &mut values);
    }
    let scale = max_abs(&values);
    pattern.add_to_diagonal(&mut values, REGULARIZATION * scale);
    let mut factor = Factor::new(&pattern, node, &[rows.cliques])?;
    factor.factor(&pattern, &values)?;
    let (mut out, mut open, mut last) = (vec![0.0; t.len()], t.to_vec(), f64::INFINITY);
    loop {
        let mut y = vec![0.0; columns];
        rows.add_transpose_product(&open, &mut y);
        let pull = max_abs(&y);
        if !(pull < SLOWEST_CONTRACTION * last) {
            return Ok(out);
        }
        last = pull;
        factor.solve(&mut y);
        let mut part = vec![0.0; t.len()];
        rows.product(&y, &mut part);
        out.iter_mut().zip(&part).for_each(|(o, p)| *o += p);
        open.iter_mut().zip(&part).for_each(|(o, p)| *o -= p);
    }
}
