//! Newton's method onto a path, across a plane.

use super::bordered::{Bordered, Plane, REFUSED_RESIDUAL};
use super::problem::{ParametrizedProblem, PathState, Rates};
use crate::problem::Residuals;
use crate::self_stress::without_self_stress;
use foldwell_numerics::factor::FactorError;
use foldwell_numerics::vector::{larger, max_abs, norm_blocked};

/// Largest number of Newton steps from a predicted state.
const MOST_STEPS: usize = 12;
/// Length of a Newton step over that of the one before above which the iteration does not contract.
const SLOWEST_CONTRACTION: f64 = 0.6;
/// Relative length of Newton steps that are rounding error.
const ROUNDING: f64 = 1e-13;
/// Number of steps of that length after which a state is taken as it is.
const MOST_POLISHED: usize = 2;
/// Relative length of a Newton step that moves next to nothing: where the iteration no longer contracts and forces are
/// rounding errors, a state is taken as it is only there.
const NEXT_TO_NOTHING: f64 = 1e-9;
/// Scaled residual up to which a state that no step improves is taken where rounding errors are that large.
const MOST_ROUNDING: f64 = 1e-8;
/// Error of the stretch of stiff measures, relative to the largest one by a tension, above which tensions are not
/// known.
const STRETCH_ERROR: f64 = 1e-6;

/// A state near the path.
pub(super) type Guess = Rates;

/// A state on the path, and how it was reached.
pub(super) struct Corrected {
    pub at: Guess,
    pub residuals: Residuals,
    /// Length of the first Newton step, the error of the prediction.
    pub off: f64,
    pub iterations: usize,
}

/// Moves a guess within the plane through it onto the path. Returns `None` where the iteration does not converge,
/// or leads to a state in which derivatives tell nothing.
pub(super) fn correct<P: ParametrizedProblem>(
    problem: &mut P,
    bordered: &mut Bordered,
    mut at: Guess,
    plane: &Plane,
    tolerance: f64,
) -> Result<Option<Corrected>, FactorError> {
    let (mut last, mut off, mut polished) = (f64::INFINITY, 0.0, 0);
    for iterations in 0..=MOST_STEPS {
        problem.set_parameter(at.parameter);
        bordered.linearize(problem, &at.x, &at.tension);
        let residuals = Residuals::new(problem, &bordered.at, &at.tension);
        let size = larger(residuals.force, residuals.length);
        // no step makes residuals smaller that rounding errors of the unknowns make
        let rounding = larger(MOST_ROUNDING, bordered.rounding_force(max_abs(&at.x)));
        let rounded = residuals.length <= tolerance && size <= rounding;
        if size <= tolerance || (polished == MOST_POLISHED && rounded) {
            let found = precise(problem, bordered, Corrected { at, residuals, off, iterations }, plane)?;
            return Ok(Some(found).filter(|found| is_sound(problem, found)));
        }
        if !size.is_finite() || iterations == MOST_STEPS || polished == MOST_POLISHED {
            break;
        }
        bordered.factor()?;
        let (force, missing) = (bordered.at.force(&at.tension), bordered.at.missing(&at.tension, problem.compliance()));
        let (step, residual) = bordered.solve(&force, &missing, 0.0, plane);
        let length = norm_blocked(&step.x).hypot(step.parameter / bordered.unit());
        let small = length <= ROUNDING * larger(max_abs(&at.x), bordered.length());
        // from one side of a kink to the other steps may become longer
        let contracts = problem.may_have_kinks() || length <= SLOWEST_CONTRACTION * last;
        if residual.is_nan() || residual > REFUSED_RESIDUAL || !(small || contracts) {
            // a right-hand side of rounding errors has no exact solution; a step that is short is taken where it helps
            let is_short = length <= NEXT_TO_NOTHING * larger(max_abs(&at.x), bordered.length());
            let kept = Corrected { at, residuals, off, iterations };
            let found = (rounded && is_short).then(|| bettered(problem, bordered, kept, &step));
            return Ok(found.filter(|found| is_sound(problem, found)));
        }
        if iterations == 0 {
            off = length;
        }
        polished += usize::from(small);
        last = length;
        at.add(1.0, &step);
    }
    Ok(None)
}

/// Whether derivatives tell something about a state.
fn is_sound<P: ParametrizedProblem>(problem: &P, found: &Corrected) -> bool {
    problem.breakdown(&found.at.x).is_none() && problem.energy(&found.at.x).is_finite()
}

/// Returns a state whose gaps are within the tolerance, but not those that very stiff measures have by their tensions,
/// after one step more: a self stress of theirs would be that of the guess.
fn precise<P: ParametrizedProblem>(
    problem: &mut P,
    bordered: &mut Bordered,
    found: Corrected,
    plane: &Plane,
) -> Result<Corrected, FactorError> {
    let missing = bordered.at.missing(&found.at.tension, problem.compliance());
    let stretched =
        problem.compliance().iter().zip(&found.at.tension).fold(0.0, |most, (c, t)| f64::max(most, c * t.abs()));
    if max_abs(&missing) <= STRETCH_ERROR * stretched || stretched == 0.0 {
        return Ok(found);
    }
    bordered.factor()?;
    let force = bordered.at.force(&found.at.tension);
    let (step, residual) = bordered.solve(&force, &missing, 0.0, plane);
    Ok(if residual <= REFUSED_RESIDUAL { bettered(problem, bordered, found, &step) } else { found })
}

/// Returns the state that a step leads to if its residuals are smaller, otherwise the state as it is.
fn bettered<P: ParametrizedProblem>(
    problem: &mut P,
    bordered: &mut Bordered,
    kept: Corrected,
    step: &Rates,
) -> Corrected {
    let mut at = kept.at.clone();
    at.add(1.0, step);
    problem.set_parameter(at.parameter);
    bordered.linearize(problem, &at.x, &at.tension);
    let residuals = Residuals::new(problem, &bordered.at, &at.tension);
    if larger(residuals.force, residuals.length) < larger(kept.residuals.force, kept.residuals.length) {
        return Corrected { at, residuals, off: kept.off, iterations: kept.iterations + 1 };
    }
    problem.set_parameter(kept.at.parameter);
    bordered.linearize(problem, &kept.at.x, &kept.at.tension);
    kept
}

/// Takes a self stress of rigid measures out of a state's tensions: predictions would let it grow from state to state.
fn relieved<P: ParametrizedProblem>(
    problem: &mut P,
    bordered: &mut Bordered,
    found: Corrected,
) -> Result<Corrected, FactorError> {
    let tension = &found.at.tension;
    let least = if !problem.compliance().contains(&0.0) {
        None
    } else if bordered.is_unstressed(tension) {
        Some(vec![0.0; tension.len()]).filter(|none| none != tension)
    } else if bordered.has_self_stress(tension) {
        without_self_stress(problem, &bordered.at, tension)
    } else {
        None
    };
    let Some(tension) = least else { return Ok(found) };
    bordered.linearize(problem, &found.at.x, &tension);
    let residuals = Residuals::new(problem, &bordered.at, &tension);
    let at = Guess { tension, ..found.at.clone() };
    if residuals.force <= larger(MOST_ROUNDING, found.residuals.force) {
        bordered.factor()?;
        return Ok(Corrected { at, residuals, ..found });
    }
    bordered.linearize(problem, &found.at.x, &found.at.tension);
    bordered.factor()?;
    Ok(found)
}

/// Completes a state on the path: its tangent on the side to which the plane's normal points, its conjugate and its
/// inertia.
pub(super) fn complete<P: ParametrizedProblem>(
    problem: &mut P,
    bordered: &mut Bordered,
    found: Corrected,
    plane: &Plane,
    arc_length: f64,
) -> Result<PathState, FactorError> {
    bordered.factor()?;
    let Corrected { at: Guess { x, tension, parameter }, residuals, iterations, .. } =
        relieved(problem, bordered, found)?;
    let negative_eigenvalues = bordered.negative_eigenvalues()?;
    let (forces, stretches) = (vec![0.0; x.len()], vec![0.0; tension.len()]);
    let (mut tangent, _) = bordered.solve(&forces, &stretches, 1.0, plane);
    let speed = norm_blocked(&tangent.x).hypot(tangent.parameter / bordered.unit()) / bordered.length();
    tangent.x.iter_mut().chain(&mut tangent.tension).for_each(|rate| *rate /= speed);
    tangent.parameter /= speed;
    let conjugate =
        [problem.conjugate(&bordered.at, &x, &tension), problem.conjugate_rate(&bordered.at, &x, &tension, &tangent)];
    let (work_along, rate_errors) = (bordered.work_along(&tangent), bordered.rate_errors());
    Ok(PathState {
        arc_length,
        x,
        tension,
        parameter,
        tangent,
        conjugate,
        residual_force: residuals.force,
        residual_length: residuals.length,
        negative_eigenvalues,
        work_along,
        rate_errors,
        iterations,
        choice: problem.choice(),
    })
}

impl Plane {
    /// The plane across these rates, of which the parameter is counted in this unit of length.
    pub(super) fn across(rates: &Rates, unit: f64) -> Self {
        let parameter = rates.parameter / unit;
        let per_length = 1.0 / norm_blocked(&rates.x).hypot(parameter).max(f64::MIN_POSITIVE);
        Self { x: rates.x.iter().map(|x| x * per_length).collect(), parameter: parameter * per_length }
    }

    /// The plane of a fixed parameter, with the normal towards larger (`1.0`) or smaller ones (`-1.0`).
    pub(super) fn of_parameter(unknowns: usize, sign: f64) -> Self {
        Self { x: vec![0.0; unknowns], parameter: sign }
    }
}
