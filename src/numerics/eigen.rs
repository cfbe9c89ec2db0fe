//! A few extreme eigenpairs of a symmetric operator, by faer's restarted Lanczos iteration.

use super::factor::FactorError;
use faer::dyn_stack::{MemBuffer, MemStack, StackReq};
use faer::matrix_free::LinOp;
use faer::matrix_free::eigen::{PartialEigenParams, partial_self_adjoint_eigen, partial_self_adjoint_eigen_scratch};
use faer::{Col, Mat, MatMut, MatRef, Par};
use std::sync::Mutex;

/// Relative accuracy that is asked of every eigenpair.
const TOLERANCE: f64 = 1e-13;

/// A symmetric operator given by its product with a vector.
struct Operator<F> {
    size: usize,
    product: Mutex<F>,
}

impl<F> std::fmt::Debug for Operator<F> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "operator of size {}", self.size)
    }
}

impl<F: FnMut(&[f64]) -> Vec<f64> + Send> LinOp<f64> for Operator<F> {
    fn apply_scratch(&self, _columns: usize, _par: Par) -> StackReq {
        StackReq::EMPTY
    }

    fn nrows(&self) -> usize {
        self.size
    }

    fn ncols(&self) -> usize {
        self.size
    }

    fn apply(&self, mut out: MatMut<'_, f64>, right: MatRef<'_, f64>, _par: Par, _stack: &mut MemStack) {
        let mut product = self.product.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        for column in 0..right.ncols() {
            let x: Vec<f64> = (0..self.size).map(|row| right[(row, column)]).collect();
            for (row, value) in product(&x).into_iter().enumerate() {
                // the iteration inside never ends on a value that is not finite
                out[(row, column)] = if value.is_finite() { value } else { 0.0 };
            }
        }
    }

    fn conj_apply(&self, out: MatMut<'_, f64>, right: MatRef<'_, f64>, par: Par, stack: &mut MemStack) {
        self.apply(out, right, par, stack);
    }
}

/// The `count` eigenvalues of largest magnitude of a symmetric operator, descending, with their vectors.
///
/// Fails where the iteration does not find them all.
pub fn largest<F: FnMut(&[f64]) -> Vec<f64> + Send>(
    size: usize,
    count: usize,
    product: F,
) -> Result<(Vec<f64>, Vec<Vec<f64>>), FactorError> {
    let operator = Operator { size, product: Mutex::new(product) };
    let params = PartialEigenParams { min_dim: 2 * count + 32, max_dim: 4 * count + 64, ..Default::default() };
    let scratch = partial_self_adjoint_eigen_scratch(&operator, count, Par::Seq, params);
    let mut memory = MemBuffer::try_new(scratch).map_err(|_| FactorError::TooLarge { size })?;
    let (mut values, mut vectors) = (vec![0.0; count], Mat::<f64>::zeros(size, count));
    let start = Col::<f64>::from_fn(size, |k| 1.0 + ((k as f64) * 0.618_033_988_75).fract());
    let found = partial_self_adjoint_eigen(
        vectors.as_mut(),
        &mut values,
        &operator,
        start.as_ref(),
        TOLERANCE,
        Par::Seq,
        MemStack::new(&mut memory),
        params,
    );
    if found.n_converged_eigen < count {
        return Err(FactorError::Eigenpairs { wanted: count, found: found.n_converged_eigen });
    }
    let mut order: Vec<usize> = (0..count).collect();
    order.sort_by(|&a, &b| values[b].total_cmp(&values[a]));
    let column = |k: usize| (0..size).map(|row| vectors[(row, k)]).collect();
    Ok((order.iter().map(|&k| values[k]).collect(), order.iter().map(|&k| column(k)).collect()))
}
