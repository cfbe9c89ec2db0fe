//! All roots of a complex polynomial: eigenvalues of the companion matrix, polished by Newton's method.

use super::complex::{ComplexMatrix, eigenvalues};
use super::dense::DenseError;
use nalgebra::Complex;

/// Modulus of a coefficient relative to the largest one below which it counts as zero at both ends.
const ZERO_COEFFICIENT: f64 = 1e-14;
/// Largest number of Newton steps.
const MOST_STEPS: usize = 8;

/// The roots of a polynomial whose degree is one less than its number of coefficients.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Roots {
    /// The roots that are neither zero nor infinite, in no order.
    pub finite: Vec<Complex<f64>>,
    /// Number of roots that are zero.
    pub at_zero: usize,
    /// Number of roots that are infinite: the difference of the degree to the number of coefficients less one.
    pub at_infinity: usize,
}

/// The roots of `sum coefficients[k] z^k`.
///
/// # Errors
/// [`DenseError`] on a coefficient that is not finite, and where all are zero.
pub fn roots(coefficients: &[Complex<f64>]) -> Result<Roots, DenseError> {
    let largest = coefficients.iter().map(|c| c.norm()).fold(0.0, f64::max);
    let there = |c: &Complex<f64>| c.norm() > ZERO_COEFFICIENT * largest || !c.norm().is_finite();
    let (Some(first), Some(last)) = (coefficients.iter().position(there), coefficients.iter().rposition(there)) else {
        return Err(DenseError::NotFinite { row: 0, column: 0, value: f64::INFINITY });
    };
    let inner = &coefficients[first..=last];
    let degree = last - first;
    let companion = ComplexMatrix::from_fn(degree, degree, |i, j| match j + 1 {
        column if column == degree => -inner[i] / inner[degree],
        column if column == i => Complex::ONE,
        _ => Complex::ZERO,
    });
    let finite = eigenvalues(&companion)?.into_iter().map(|root| polished(inner, root)).collect();
    Ok(Roots { finite, at_zero: first, at_infinity: coefficients.len() - 1 - last })
}

/// Newton's method for `log p` in `log z`, as long as its steps become smaller.
fn polished(coefficients: &[Complex<f64>], mut root: Complex<f64>) -> Complex<f64> {
    let mut before = f64::INFINITY;
    for _ in 0..MOST_STEPS {
        let [value, slope] = value_and_slope(coefficients, root);
        let step = value / slope;
        if !(step.norm() < 0.5 * before && step.norm() < 0.1 * root.norm()) {
            break;
        }
        before = step.norm();
        root -= step;
    }
    root
}

/// The value `p(z)` and the derivative `p'(z)` of a polynomial.
pub fn value_and_slope(coefficients: &[Complex<f64>], z: Complex<f64>) -> [Complex<f64>; 2] {
    coefficients
        .iter()
        .rev()
        .fold([Complex::ZERO; 2], |[value, slope], coefficient| [value * z + coefficient, slope * z + value])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Claim: a polynomial made from its roots gives them back, those of zero coefficients at the ends apart.
    /// Tolerance: rounding times the condition of roots a quarter apart.
    #[test]
    fn roots_come_back() {
        let expected = [(0.3, 0.1), (-2.0, 1.0), (0.9, -0.4), (1.5, 0.0), (-0.2, -0.7)];
        let expected = expected.map(|(re, im)| Complex::new(re, im));
        let mut coefficients = vec![Complex::new(0.7, -0.2)];
        for root in expected {
            coefficients.insert(0, Complex::ZERO);
            (1..coefficients.len()).for_each(|k| {
                let above = coefficients[k];
                coefficients[k - 1] -= root * above;
            });
        }
        let padded = [&[Complex::ZERO; 2], &coefficients[..], &[Complex::ZERO]].concat();
        let found = roots(&padded).unwrap();
        assert_eq!((found.at_zero, found.at_infinity, found.finite.len()), (2, 1, 5));
        for root in expected {
            let error = found.finite.iter().map(|z| (z - root).norm()).fold(f64::INFINITY, f64::min);
            assert!(error <= 1e-14, "{error:e}");
        }
    }

    /// Claim: no roots are made up for what has none, or too many.
    #[test]
    fn constants_and_nothing() {
        assert!(roots(&[Complex::ONE]).unwrap().finite.is_empty());
        assert!(roots(&[Complex::ZERO; 3]).is_err() && roots(&[]).is_err());
        assert!(roots(&[Complex::ONE, Complex::new(f64::NAN, 0.0), Complex::ONE]).is_err());
    }
}
