//! A law that is a formula, `torque = "k*sinh(m - m0)"`.

use super::law::Law;
use crate::math::expression::{Expression, ExpressionError};
use crate::math::quadrature::integral;

/// A law whose torque or force is a closed expression: of `m`, the value of the measure, `m0`, that at rest, and `k`,
/// the spring constant, to which it is proportional; at rest it is that of the spring `k*(m - m0)`. The expression has
/// `+ - * / ^`, parentheses, `pi` and the functions `abs`, `sign`, `sqrt`, `exp`, `ln`, `sin`, `cos`, `tan`, `asin`,
/// `atan`, `sinh`, `cosh`, `tanh`. Its derivatives are exact; the energy is its integral from rest.
///
/// ```
/// use foldwell::model::{Formula, Law};
///
/// let law = Formula::of_angle("k*sinh(m - m0)")?;
/// let [energy, torque, stiffness] = law.at(1.5, 0.5);
/// assert!((energy - (1f64.cosh() - 1.0)).abs() < 1e-14);
/// assert!((torque - 1f64.sinh()).abs() < 1e-14 && (stiffness - 1f64.cosh()).abs() < 1e-14);
/// assert!(Formula::of_angle("2*k*(m - m0)").is_err());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Formula {
    force: Expression,
}

/// The reasons for which a text is no formula of a law.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[allow(missing_docs)] // each variant is documented by its message
pub enum FormulaError {
    #[error(transparent)]
    Expression(#[from] ExpressionError),
    #[error("the formula is {value} at m = {measure}, m0 = {rest}, k = 1")]
    Undefined { measure: f64, rest: f64, value: f64 },
    #[error("at m = m0 = {rest}, k = 1 the formula is {force} with the slope {slope}; it has to be 0 with the slope k")]
    NoSpring { rest: f64, force: f64, slope: f64 },
    #[error("the formula is not proportional to k")]
    NotProportional,
}

/// Difference, relative to the stiffness at rest, that counts as rounding.
const ROUNDING: f64 = 1e-9;

impl Formula {
    /// Reads the torque of a hinge; `m` and `m0` are angles in radians.
    ///
    /// # Errors
    /// [`FormulaError`] if it is no expression, or not that of a spring at rest.
    pub fn of_angle(torque: &str) -> Result<Self, FormulaError> {
        Self::checked(torque, &[-1.1, -0.3, 0.0, 0.7, 2.0], |rest| rest + 0.2)
    }

    /// Reads the force of a bar; `m` and `m0` are lengths.
    ///
    /// # Errors
    /// As those of [`of_angle`](Self::of_angle).
    pub fn of_length(force: &str) -> Result<Self, FormulaError> {
        Self::checked(force, &[0.01, 0.5, 1.0, 7.0, 300.0], |rest| 1.1 * rest)
    }

    fn checked(text: &str, rests: &[f64], nearby: impl Fn(f64) -> f64) -> Result<Self, FormulaError> {
        let formula = Self { force: Expression::parse(text, &["m", "m0", "k"])? };
        for &rest in rests {
            let ([force, slope, _], measure) = (formula.by_measure(rest, rest), nearby(rest));
            let [once, twice] = [1.0, 2.0].map(|k| formula.force.at(&[measure, rest, k].map(fixed))[0]);
            let given = [(rest, force), (rest, slope), (measure, once)];
            if let Some((measure, value)) = given.into_iter().find(|(_, value)| !value.is_finite()) {
                return Err(FormulaError::Undefined { measure, rest, value });
            }
            if force.abs() > ROUNDING * (1.0 + rest.abs()) || (slope - 1.0).abs() > ROUNDING {
                return Err(FormulaError::NoSpring { rest, force, slope });
            }
            if (twice - 2.0 * once).abs() > ROUNDING * once.abs() {
                return Err(FormulaError::NotProportional);
            }
        }
        Ok(formula)
    }

    fn by_measure(&self, measure: f64, rest: f64) -> [f64; 3] {
        self.force.at(&[[measure, 1.0, 0.0], fixed(rest), fixed(1.0)])
    }

    fn by_rest_value(&self, measure: f64, rest: f64) -> [f64; 3] {
        self.force.at(&[fixed(measure), [rest, 1.0, 0.0], fixed(1.0)])
    }
}

fn fixed(value: f64) -> [f64; 3] {
    [value, 0.0, 0.0]
}

impl Law for Formula {
    fn at(&self, value: f64, rest: f64) -> [f64; 3] {
        let [energy] = integral(|m| [self.by_measure(m, rest)[0]], rest, value);
        let [force, stiffness, _] = self.by_measure(value, rest);
        [energy, force, stiffness]
    }

    fn has_kinks(&self) -> bool {
        self.force.may_jump()
    }

    /// The lower end of the integral moves too; the force there is 0, and its derivative by rest -1.
    fn by_rest(&self, value: f64, rest: f64) -> [f64; 3] {
        let derivatives = |m: f64| {
            let [_, first, second] = self.by_rest_value(m, rest);
            [first, second]
        };
        let [first, second] = integral(derivatives, rest, value);
        [first, self.by_rest_value(value, rest)[1], 1.0 + second]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Claim: formulas that are no law are refused, with what is wrong.
    #[test]
    fn formulas_that_are_no_law_are_refused() {
        let cases = [
            ("k*(m - m0", "ends where"),
            ("k*(m - 0.3)", "at m = m0 = -1.1"),
            ("2*k*(m - m0)", "with the slope 2"),
            ("k^2*(m - m0)", "not proportional"),
            ("m - m0", "not proportional"),
            ("k*ln(m/m0)*m0", "is NaN at m = 0"),
            ("k*(m - rest)", "`rest` at character 8 is not known; there are m, m0, k"),
        ];
        for (text, message) in cases {
            let found = Formula::of_angle(text).unwrap_err().to_string();
            assert!(found.contains(message), "{text}: {found}");
        }
        assert!(Formula::of_length("k*ln(m/m0)*m0").is_ok());
    }
}
