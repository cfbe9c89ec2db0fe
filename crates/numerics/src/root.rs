//! Roots of systems of equations with as many unknowns or more, by Newton's method with steps of least length.

use super::dense::{DenseError, least_squares_of_sums};
use super::{DenseMatrix, larger};
use nalgebra::DVector;

/// How a root is looked for.
#[derive(Clone, Copy, Debug)]
pub struct Search {
    /// Largest number of linearizations.
    pub most_steps: usize,
    /// Largest residual of a root.
    pub residual: f64,
    /// Size of the terms that sum up to an entry of the Jacobian, against which ranks are cut; 0 where entries are no
    /// such sums.
    pub terms: f64,
}

impl Search {
    /// Looks for the root to which Newton's method leads from `x`. `equations` gives residuals and Jacobian. Returns the
    /// last point, and the largest residual that was seen last: before the last step unless it is that of a root.
    ///
    /// # Errors
    /// [`DenseError`] where a Jacobian cannot be decomposed.
    pub fn from(
        &self,
        mut x: Vec<f64>,
        mut equations: impl FnMut(&[f64]) -> (DVector<f64>, DenseMatrix),
    ) -> Result<(Vec<f64>, f64), DenseError> {
        let mut residual = f64::INFINITY;
        for _ in 0..self.most_steps {
            let (residuals, jacobian) = equations(&x);
            residual = residuals.iter().fold(0.0, |most, component| larger(most, component.abs()));
            if residual <= self.residual {
                break;
            }
            let right = DenseMatrix::from_column_slice(residuals.len(), 1, residuals.as_slice());
            let step = least_squares_of_sums(&jacobian, &right, self.terms)?.solution;
            x.iter_mut().zip(step.iter()).for_each(|(x, d)| *x -= d);
        }
        Ok((x, residual))
    }

    /// The root to which Newton's method leads from `x`; `None` where it does not lead to one.
    pub fn root(&self, x: Vec<f64>, equations: impl FnMut(&[f64]) -> (DVector<f64>, DenseMatrix)) -> Option<Vec<f64>> {
        self.from(x, equations).ok().filter(|(_, residual)| *residual <= self.residual).map(|(x, _)| x)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Claim: from (2, 1) Newton's method by shortest steps finds a point of the unit circle; where there is no root,
    /// it says so. Tolerance: rounding.
    #[test]
    fn a_root_is_found_or_not() {
        let search = Search { most_steps: 20, residual: 1e-15, terms: 0.0 };
        let circle = |radius: f64| {
            move |x: &[f64]| {
                let jacobian = DenseMatrix::from_row_slice(1, 2, &[2.0 * x[0], 2.0 * x[1]]);
                (DVector::from_element(1, x[0] * x[0] + x[1] * x[1] - radius), jacobian)
            }
        };
        let root = search.root(vec![2.0, 1.0], circle(1.0)).unwrap();
        assert!((root[0].hypot(root[1]) - 1.0).abs() < 1e-15 && (root[0] - 2.0 * root[1]).abs() < 1e-14, "{root:?}");
        assert!(search.root(vec![2.0, 1.0], circle(-1.0)).is_none());
    }
}
