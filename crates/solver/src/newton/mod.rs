//! Newton's method with retraction onto the stiff measures, uniform in their stiffness.
//!
//! One iteration: linearize; factor, with a [shift] raised until the inertia is that of a minimum; take the whole step
//! in `(x, t)`, or a fraction of it ([line_search]); pull the state back onto `m = c t` by a few chord corrections with
//! the same factorization, in `x` *and* `t` ([retraction]); accept when the merit `E + sum c t^2 / 2` fell. On
//! retracted states the merit is the true energy, without cancellation at any stiffness; the iterates stay on the
//! surface that the stiff measures leave, where the soft energy decides. Far from the solution soft elements enter with
//! their Gauss-Newton Hessian, once steps contract with the full one. Near it a factorization serves the next steps
//! too, which it solves by corrections on the residual of their own system. In the end the inertia is counted
//! ([certificate]).

mod certificate;
mod iteration;
mod line_search;
mod options;
mod outcome;
mod retraction;
mod shift;
#[cfg(test)]
mod tests;

use super::problem::Problem;
use iteration::Newton;
pub use options::{Options, Start};
pub use outcome::NewtonError;
pub use outcome::{Equilibrium, Failure, Iterate, Step};

/// Minimises a problem from a start. `observe` sees every accepted step, the retracted start first, and returns false
/// to stop.
///
/// # Errors
/// [`NewtonError`] with the reason and the last accepted state.
pub fn minimize<P: Problem>(
    problem: &mut P,
    start: impl Into<Start>,
    options: Options,
    observe: &mut dyn FnMut(&Step) -> bool,
) -> Result<Equilibrium, NewtonError> {
    minimize_iterates(problem, start, options, &mut |iterate| observe(iterate.step))
}

/// Minimises as [`minimize`] does, with an observer that sees the states too.
///
/// # Errors
/// [`NewtonError`] with the reason and the last accepted state.
pub fn minimize_iterates<P: Problem>(
    problem: &mut P,
    start: impl Into<Start>,
    options: Options,
    observe: &mut dyn FnMut(&Iterate<'_, P>) -> bool,
) -> Result<Equilibrium, NewtonError> {
    let Start { x, tension } = start.into();
    let mut newton = Newton::new(problem, x, tension)?;
    let negative_eigenvalues = run(&mut newton, options, observe);
    newton.end(negative_eigenvalues)
}

/// Iterates until convergence; returns the number of negative eigenvalues there, `None` where it is not known.
fn run<P: Problem>(
    newton: &mut Newton<'_, P>,
    options: Options,
    observe: &mut dyn FnMut(&Iterate<'_, P>) -> bool,
) -> Result<Option<usize>, Failure> {
    newton.problem.relieve(&mut newton.x);
    newton.linearize();
    newton.retract_start()?;
    newton.merit = newton.merit_of(&newton.x, &newton.tension, &newton.tangent.at.gaps);
    let (mut fraction, mut finished) = (0.0, false);
    loop {
        let step = newton.record(fraction);
        newton.history.push(step);
        let Newton { problem, x, tension, .. } = &*newton;
        if !observe(&Iterate { problem, x, tension, step: &step }) {
            return Err(Failure::Interrupted);
        }
        if let Some(collapse) = newton.problem.breakdown(&newton.x) {
            return Err(collapse.into());
        }
        let (force, length) = (step.residual_force, step.residual_length);
        let met = length <= options.tolerance;
        if met && (force <= options.tolerance || (newton.exhausted(&step) && newton.is_at_rest())) {
            if newton.choose_anew()? {
                // a start may be in balance only with what it holds
                newton.linearize();
                fraction = 0.0;
                continue;
            }
            let last = if finished { None } else { newton.finishing_step(&step) };
            let Some(trial) = last else { return newton.certify() };
            newton.take(trial, 1.0, &step);
            newton.linearize();
            (fraction, finished) = (1.0, true);
            continue;
        }
        if newton.stalled() {
            return Err(Failure::Stuck { force, length });
        }
        if newton.history.len() > options.iterations {
            return Err(Failure::TooManySteps { iterations: options.iterations, force, length });
        }
        fraction = match newton.advance(&step) {
            Err(Failure::Stuck { .. }) if met && force <= newton.rounding_force() && newton.is_at_rest() => {
                return newton.certify();
            }
            taken => taken?,
        };
        newton.choose_anew()?;
        newton.linearize();
    }
}
