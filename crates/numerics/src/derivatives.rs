//! The one check of hand-written derivatives: entry by entry, against extrapolated central differences.
//!
//! Every entry is judged alone, because a test along one direction lets a small fault in a single entry pass. The
//! difference quotients at steps `h, h/2, h/4, ...` are extrapolated to `h = 0` (Richardson; the choice of the best
//! value by its own error estimate is Ridders', Advances in Engineering Software 4, 75, 1982), so that they are good
//! to about 1e-12 and a relative fault of 1e-6 stands out by orders of magnitude.
//!
//! An entry passes when `|found - expected| <= tolerance * max(|expected|, 1e-4 * largest) + 1e-12 * size`, where
//! `largest` is the largest entry of the gradient, or of the same row of the Jacobian, and `size` (which only matters
//! where a whole row is zero but for rounding) is the largest of all entries and of `|function| / |x|`. With
//! [`TOLERANCE`] a relative fault of 1e-6 is caught in every entry that is larger than 1e-4 times `largest` (and 1e-5
//! times `size`). Where the differences themselves are not good enough to judge an entry, that is an error too.

use super::DenseMatrix;

/// The usual relative tolerance, for gradients and for Hessians.
pub const TOLERANCE: f64 = 1e-7;

/// Size of an entry relative to the largest one below which its error is measured relative to the latter.
const SMALL_ENTRY: f64 = 1e-4;

/// Relative size, compared with the function and its derivative, below which differences are rounding.
const ROUNDING: f64 = 1e-12;

/// First step of the differences relative to the largest coordinate, and the number of steps, each half of the one
/// before.
const FIRST_STEP: f64 = 0.125;
const LEVELS: usize = 16;
const HIGHEST_ORDER: usize = 7;

/// The reason for which a derivative did not pass.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[allow(missing_docs)] // each variant is documented by its message
pub enum DerivativeError {
    #[error("entry ({row}, {column}) is {found:e}, differences give {expected:e}: off by more than {allowed:e}")]
    Entry { row: usize, column: usize, expected: f64, found: f64, allowed: f64 },
    #[error("differences give entry ({row}, {column}) only to {error:e}; {allowed:e} is needed to judge it")]
    Unresolved { row: usize, column: usize, error: f64, allowed: f64 },
    #[error("a derivative of {rows} x {columns} entries for {components} functions of {variables} variables")]
    Shape { rows: usize, columns: usize, components: usize, variables: usize },
}

/// A derivative by extrapolated differences, with its estimated error.
#[derive(Clone, Copy, Debug)]
struct ExtrapolatedDerivative {
    value: f64,
    error: f64,
}

/// Checks every entry of the gradient of a scalar function at a point; the tolerance is relative (see the module).
///
/// # Errors
/// [`DerivativeError`] at the first entry that does not pass, one that is not a number included.
pub fn check_gradient(
    function: impl Fn(&[f64]) -> f64,
    point: &[f64],
    gradient: &[f64],
    tolerance: f64,
) -> Result<(), DerivativeError> {
    let row = DenseMatrix::from_row_slice(1, gradient.len(), gradient);
    check_jacobian(|x| vec![function(x)], point, &row, tolerance)
}

/// Checks every entry of a Jacobian (row: component of the function, column: variable) at a point.
///
/// A Hessian is the Jacobian of the gradient.
///
/// # Errors
/// As [`check_gradient`].
pub fn check_jacobian(
    function: impl Fn(&[f64]) -> Vec<f64>,
    point: &[f64],
    jacobian: &DenseMatrix,
    tolerance: f64,
) -> Result<(), DerivativeError> {
    let (rows, columns) = jacobian.shape();
    let values = function(point);
    let (components, variables) = (values.len(), point.len());
    if (rows, columns) != (components, variables) {
        return Err(DerivativeError::Shape { rows, columns, components, variables });
    }
    let estimates: Vec<Vec<ExtrapolatedDerivative>> =
        (0..columns).map(|column| differentiate(&function, point, column)).collect();
    let overall = largest(estimates.iter().flatten().map(|estimate| estimate.value));
    for (row, value) in values.iter().enumerate() {
        let in_row = largest(estimates.iter().map(|column| column[row].value));
        let size = overall.max(value.abs() / scale(point));
        for (column, estimate) in estimates.iter().map(|column| column[row]).enumerate() {
            let allowed = tolerance * estimate.value.abs().max(SMALL_ENTRY * in_row) + ROUNDING * size;
            judge(estimate, jacobian[(row, column)], allowed, [row, column])?;
        }
    }
    Ok(())
}

fn largest(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(0.0, |largest, value| largest.max(value.abs()))
}

/// The largest coordinate, or 1 where all are zero.
fn scale(point: &[f64]) -> f64 {
    let largest = largest(point.iter().copied());
    if largest > 0.0 { largest } else { 1.0 }
}

fn judge(
    estimate: ExtrapolatedDerivative,
    found: f64,
    allowed: f64,
    [row, column]: [usize; 2],
) -> Result<(), DerivativeError> {
    let ExtrapolatedDerivative { value: expected, error } = estimate;
    match (error <= allowed, (found - expected).abs() <= allowed) {
        (false, _) => Err(DerivativeError::Unresolved { row, column, error, allowed }),
        (true, false) => Err(DerivativeError::Entry { row, column, expected, found, allowed }),
        (true, true) => Ok(()),
    }
}

/// The derivative of all components along one variable.
fn differentiate(
    function: &impl Fn(&[f64]) -> Vec<f64>,
    point: &[f64],
    variable: usize,
) -> Vec<ExtrapolatedDerivative> {
    let mut step = FIRST_STEP * scale(point);
    let mut tables: Vec<Extrapolation> = Vec::new();
    for _ in 0..LEVELS {
        let [low, high] = [-step, step].map(|shift| {
            let mut moved = point.to_vec();
            moved[variable] += shift;
            (moved[variable], function(&moved))
        });
        let width = high.0 - low.0;
        tables.resize_with(high.1.len(), Extrapolation::default);
        for (table, (a, b)) in tables.iter_mut().zip(low.1.iter().zip(&high.1)) {
            table.refine((b - a) / width, 2.0 * f64::EPSILON * a.abs().max(b.abs()) / width);
        }
        step *= 0.5;
    }
    tables.into_iter().map(|table| table.best).collect()
}

/// The triangle of extrapolated difference quotients of one component: each new row halves the step.
struct Extrapolation {
    row: Vec<f64>,
    best: ExtrapolatedDerivative,
}

impl Default for Extrapolation {
    fn default() -> Self {
        Self { row: Vec::new(), best: ExtrapolatedDerivative { value: f64::NAN, error: f64::INFINITY } }
    }
}

impl Extrapolation {
    /// Adds the quotient of the next step; `rounding` is the error it has from the rounding of the function.
    fn refine(&mut self, quotient: f64, rounding: f64) {
        let previous = std::mem::replace(&mut self.row, vec![quotient]);
        let mut weight = 1.0;
        for coarse in previous.into_iter().take(HIGHEST_ORDER) {
            weight *= 4.0;
            let fine = self.row[self.row.len() - 1];
            let value = fine + (fine - coarse) / (weight - 1.0);
            let error = (value - fine).abs().max((value - coarse).abs()) + rounding;
            if error < self.best.error {
                self.best = ExtrapolatedDerivative { value, error };
            }
            self.row.push(value);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector3;

    const POINT: [f64; 6] = [0.3, -1.1, 0.7, 2.1, 0.4, -0.6];

    /// A function with entries of very different sizes: distance, product, exponential, and a steep part.
    fn value(x: &[f64]) -> f64 {
        let [p, q] = [Vector3::from_column_slice(&x[..3]), Vector3::from_column_slice(&x[3..])];
        (p - q).norm() + x[0] * x[1] * x[5] + (0.5 * x[2]).exp() + 1e-3 * (3.0 * x[4]).sin()
    }

    fn gradient(x: &[f64]) -> Vec<f64> {
        let [p, q] = [Vector3::from_column_slice(&x[..3]), Vector3::from_column_slice(&x[3..])];
        let along = (p - q).normalize();
        let mut gradient: Vec<f64> = along.iter().copied().chain((-along).iter().copied()).collect();
        gradient[0] += x[1] * x[5];
        gradient[1] += x[0] * x[5];
        gradient[5] += x[0] * x[1];
        gradient[2] += 0.5 * (0.5 * x[2]).exp();
        gradient[4] += 3e-3 * (3.0 * x[4]).cos();
        gradient
    }

    fn hessian(x: &[f64]) -> DenseMatrix {
        let [p, q] = [Vector3::from_column_slice(&x[..3]), Vector3::from_column_slice(&x[3..])];
        let (length, along) = ((p - q).norm(), (p - q).normalize());
        let mut hessian = DenseMatrix::from_fn(6, 6, |i, j| {
            let sign = if (i < 3) == (j < 3) { 1.0 } else { -1.0 };
            let unit = if i % 3 == j % 3 { 1.0 } else { 0.0 };
            sign * (unit - along[i % 3] * along[j % 3]) / length
        });
        for [i, j, other] in [[0, 1, 5], [0, 5, 1], [1, 5, 0]] {
            hessian[(i, j)] += x[other];
            hessian[(j, i)] += x[other];
        }
        hessian[(2, 2)] += 0.25 * (0.5 * x[2]).exp();
        hessian[(4, 4)] -= 9e-3 * (3.0 * x[4]).sin();
        hessian
    }

    /// Claim: right derivatives pass, with a margin: also at a hundredth of the usual tolerance.
    #[test]
    fn right_derivatives_pass() {
        check_gradient(value, &POINT, &gradient(&POINT), 1e-2 * TOLERANCE).unwrap();
        check_jacobian(gradient, &POINT, &hessian(&POINT), 1e-2 * TOLERANCE).unwrap();
    }

    /// Claim: a relative fault of 1e-6 planted into any one entry of a gradient is caught, and named.
    #[test]
    fn every_planted_fault_in_a_gradient_is_caught() {
        for fault in [1.0 + 1e-6, 1.0 - 1e-6] {
            for entry in 0..POINT.len() {
                let mut wrong = gradient(&POINT);
                wrong[entry] *= fault;
                let error = check_gradient(value, &POINT, &wrong, TOLERANCE).unwrap_err();
                assert!(matches!(error, DerivativeError::Entry { row: 0, column, .. } if column == entry), "{error}");
            }
        }
    }

    /// Claim: a relative fault of 1e-4, and even of 1e-6, in any one entry of a Hessian is caught, and named.
    #[test]
    fn every_planted_fault_in_a_hessian_is_caught() {
        for fault in [1.0 + 1e-4, 1.0 - 1e-4, 1.0 + 1e-6] {
            for at in 0..36 {
                let (i, j) = (at / 6, at % 6);
                let mut wrong = hessian(&POINT);
                wrong[(i, j)] *= fault;
                let error = check_jacobian(gradient, &POINT, &wrong, TOLERANCE).unwrap_err();
                assert!(matches!(error, DerivativeError::Entry { row, column, .. } if (row, column) == (i, j)));
            }
        }
    }

    /// Claim: an entry that ought to be zero and is not is caught against the largest of its row.
    #[test]
    fn a_wrong_zero_is_caught() {
        let product = |x: &[f64]| x[0] * x[1];
        check_gradient(product, &[2.0, 0.0], &[0.0, 2.0], TOLERANCE).unwrap();
        check_gradient(product, &[2.0, 0.0], &[1e-10, 2.0], TOLERANCE).unwrap_err();
    }

    /// Claim: at a stationary point, where all derivatives are zero but for rounding, zero passes and a millionth of
    /// the function over the coordinate does not.
    #[test]
    fn stationary_points_are_judged() {
        let well = |x: &[f64]| (x[0] - 1.0).cos() + (x[1] - 1.0).cos();
        check_gradient(well, &[1.0, 1.0], &[1e-16, 0.0], TOLERANCE).unwrap();
        check_gradient(well, &[1.0, 1.0], &[0.0, 2e-6], TOLERANCE).unwrap_err();
    }

    /// Claim: NaN fails, in the derivative and in the function; a function without derivative is not judged.
    #[test]
    fn nan_and_roughness_fail() {
        let mut wrong = gradient(&POINT);
        wrong[3] = f64::NAN;
        let error = check_gradient(value, &POINT, &wrong, TOLERANCE).unwrap_err();
        assert!(matches!(error, DerivativeError::Entry { column: 3, .. }));
        let error = check_gradient(|_| f64::NAN, &[1.0], &[0.0], TOLERANCE).unwrap_err();
        assert!(matches!(error, DerivativeError::Unresolved { .. }));
        let error = check_gradient(|x| x[0].abs().sqrt() * x[0].signum(), &[0.0], &[1.0], TOLERANCE).unwrap_err();
        assert!(matches!(error, DerivativeError::Unresolved { .. }), "{error}");
    }

    /// Claim: steps adapt: right derivatives pass where the function changes over a thousandth of the coordinates,
    /// is undefined a little further away, has a large constant, or has all coordinates zero.
    #[test]
    fn steps_adapt() {
        check_gradient(|x| (1e3 * x[0]).sin(), &[1.0], &[1e3 * 1e3_f64.cos()], TOLERANCE).unwrap();
        check_gradient(|x| (x[0] - 0.99).sqrt(), &[1.0], &[0.5 / (1.0_f64 - 0.99).sqrt()], TOLERANCE).unwrap();
        check_gradient(|x| 1e3 + x[0].exp(), &[0.0], &[1.0], TOLERANCE).unwrap();
        check_gradient(|x| x[0].sin() * x[1].cos(), &[0.0, 0.0], &[1.0, 0.0], TOLERANCE).unwrap();
    }

    /// Claim: a derivative of another shape is refused before anything is compared.
    #[test]
    fn shapes_must_agree() {
        let error = check_gradient(value, &POINT, &[0.0; 5], TOLERANCE).unwrap_err();
        assert_eq!(error, DerivativeError::Shape { rows: 1, columns: 5, components: 1, variables: 6 });
    }
}
