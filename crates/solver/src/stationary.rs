//! A stationary point near a state, of whatever index: Newton's method without shift and without descent.

use super::linearization::HessianKind;
use super::newton::{Failure, Options, Start};
use super::problem::{Problem, Residuals};
use super::tangent::Tangent;
use foldwell_numerics::factor::FactorError;
use foldwell_numerics::vector::add_scaled;

/// Relative residual to which the linear system of a step is solved, and the one above which the step is refused.
const WANTED_RESIDUAL: f64 = 1e-9;
const REFUSED_RESIDUAL: f64 = 0.1;

/// A stationary point of the energy on what the rigid measures leave free.
#[derive(Clone, Debug)]
pub struct StationaryPoint {
    /// Unknowns.
    pub x: Vec<f64>,
    /// Tensions of the stiff measures.
    pub tension: Vec<f64>,
    /// Number of negative eigenvalues of the Hessian: 0 at a minimum, 1 at a saddle point between two minima; `None`
    /// where it cannot be established.
    pub negative_eigenvalues: Option<usize>,
    /// Residuals reached.
    pub residuals: Residuals,
}

/// Finds the stationary point to which Newton's method in unknowns and tensions leads. A step is shortened where it
/// would change the measure of a soft element by more than `longest`. A start without tensions has none.
///
/// # Errors
/// [`Failure::TooManySteps`] where the iteration does not converge, [`Failure::Collapsed`] where it leads to a state in
/// which derivatives tell nothing, and [`Failure::Factor`] where a linear system cannot be solved.
pub fn stationary_point<P: Problem>(
    problem: &mut P,
    start: impl Into<Start>,
    longest: f64,
    options: Options,
) -> Result<StationaryPoint, Failure> {
    let Start { mut x, tension } = start.into();
    let mut tension = tension.unwrap_or_else(|| vec![0.0; problem.layout().stiff.len()]);
    let mut tangent = Tangent::new(problem)?;
    let mut iterations = 0;
    loop {
        problem.linearize(&x, &tension, HessianKind::Full, &mut tangent.at);
        let residuals = Residuals::new(problem, &tangent.at, &tension);
        let Residuals { force, length } = residuals;
        if let Some(collapse) = problem.breakdown(&x) {
            return Err(collapse.into());
        }
        if force <= options.tolerance && length <= options.tolerance {
            let negative_eigenvalues = tangent.negative_eigenvalues()?;
            return Ok(StationaryPoint { x, tension, negative_eigenvalues, residuals });
        }
        if iterations == options.iterations || !(force.is_finite() && length.is_finite()) {
            return Err(Failure::TooManySteps { iterations, force, length });
        }
        tangent.factor(0.0)?;
        let step = tangent.newton_step(&tension, WANTED_RESIDUAL);
        if !(step.residual <= REFUSED_RESIDUAL) {
            return Err(FactorError::Inaccurate { residual: step.residual }.into());
        }
        let part = (longest / tangent.at.largest_measure_change(&step.dx)).min(1.0);
        add_scaled(&mut x, part, &step.dx);
        add_scaled(&mut tension, part, &step.dt);
        problem.accept(&mut x);
        iterations += 1;
    }
}
