//! A few extreme eigenpairs of a symmetric operator, by faer's restarted Lanczos iteration.
//!
//! The iteration has no way out before its end. A product that asks to stop, or is not finite, leaves it by unwinding,
//! as a panic does but without a message; where a program is built with `panic = "abort"` stopping ends the program.

use super::factor::FactorError;
use faer::dyn_stack::{MemBuffer, MemStack, StackReq};
use faer::matrix_free::LinOp;
use faer::matrix_free::eigen::{PartialEigenParams, partial_self_adjoint_eigen, partial_self_adjoint_eigen_scratch};
use faer::{Col, Mat, MatMut, MatRef, Par};
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::Mutex;
use thiserror::Error;

/// Relative residual that is asked of every eigenpair.
const RELATIVE_RESIDUAL: f64 = 1e-13;

/// The reason for which no eigenpairs were found.
#[derive(Debug, Error, Clone, Copy, PartialEq)]
#[allow(missing_docs)] // each variant is documented by its message
pub enum EigenError {
    #[error(transparent)]
    Factor(#[from] FactorError),
    #[error("stopped on request")]
    Stopped,
}

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

impl<F: FnMut(&[f64]) -> Option<Vec<f64>> + Send> LinOp<f64> for Operator<F> {
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
            let found = product(&x).unwrap_or_else(|| resume_unwind(Box::new(EigenError::Stopped)));
            // the iteration inside never ends on a value that is not finite
            if found.iter().any(|value| !value.is_finite()) {
                resume_unwind(Box::new(EigenError::Factor(FactorError::NotFinite)));
            }
            for (row, value) in found.into_iter().enumerate() {
                out[(row, column)] = value;
            }
        }
    }

    fn conj_apply(&self, out: MatMut<'_, f64>, right: MatRef<'_, f64>, par: Par, stack: &mut MemStack) {
        self.apply(out, right, par, stack);
    }
}

/// The `count` eigenvalues of largest magnitude of a symmetric operator, descending, with their vectors.
///
/// # Errors
/// [`EigenError::Stopped`] where `product` gives `None`. [`EigenError::Factor`] where a product is not finite, where
/// the iteration does not find all eigenpairs, and where the operator is too small for its `4 count + 64` vectors.
pub fn largest<F: FnMut(&[f64]) -> Option<Vec<f64>> + Send>(
    size: usize,
    count: usize,
    product: F,
) -> Result<(Vec<f64>, Vec<Vec<f64>>), EigenError> {
    if 4 * count + 64 > size {
        return Err(FactorError::Eigenpairs { wanted: count, found: 0 }.into());
    }
    let operator = Operator { size, product: Mutex::new(product) };
    let params = PartialEigenParams { min_dim: 2 * count + 32, max_dim: 4 * count + 64, ..Default::default() };
    let scratch = partial_self_adjoint_eigen_scratch(&operator, count, Par::Seq, params);
    let mut memory = MemBuffer::try_new(scratch).map_err(|_| FactorError::TooLarge { size })?;
    let (mut values, mut vectors) = (vec![0.0; count], Mat::<f64>::zeros(size, count));
    let start = Col::<f64>::from_fn(size, |k| 1.0 + ((k as f64) * 0.618_033_988_75).fract());
    let iterate = AssertUnwindSafe(|| {
        let (vectors, start, stack) = (vectors.as_mut(), start.as_ref(), MemStack::new(&mut memory));
        partial_self_adjoint_eigen(vectors, &mut values, &operator, start, RELATIVE_RESIDUAL, Par::Seq, stack, params)
    });
    let found = match catch_unwind(iterate) {
        Ok(found) => found.n_converged_eigen,
        Err(reason) => match reason.downcast::<EigenError>() {
            Ok(why) => return Err(*why),
            Err(panic) => resume_unwind(panic),
        },
    };
    if found < count {
        return Err(FactorError::Eigenpairs { wanted: count, found }.into());
    }
    let mut order: Vec<usize> = (0..count).collect();
    order.sort_by(|&a, &b| values[b].total_cmp(&values[a]));
    let column = |k: usize| (0..size).map(|row| vectors[(row, k)]).collect();
    Ok((order.iter().map(|&k| values[k]).collect(), order.iter().map(|&k| column(k)).collect()))
}
