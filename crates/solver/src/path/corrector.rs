//! Newton's method onto a path, across a plane.

use super::bordered::{Hyperplane, REFUSED_RESIDUAL};
use super::follower::Follower;
use super::outcome::Found;
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
/// Scaled residual length up to which gaps are rounding errors: no motion closes those of rigid measures that depend on each
/// other, and a step that balances forces is taken without them.
const ROUNDED_GAPS: f64 = 1e-13;
/// Error of the stretch of stiff measures, relative to the largest one by a tension, above which tensions are not
/// known.
const STRETCH_ERROR: f64 = 1e-6;

/// A state on the path, and how it was reached.
struct Corrected {
    at: Rates,
    residuals: Residuals,
    /// Length of the first Newton step, the error of the prediction.
    off: f64,
    iterations: usize,
}

impl<P: ParametrizedProblem> Follower<'_, P> {
    /// The state of the path in the plane through a guess, and the error of the guess; `None` where none is found.
    pub fn settle(&mut self, guess: Rates, plane: &Hyperplane, arc: f64) -> Found<Option<(PathState, f64)>> {
        let Some(found) = self.correct(guess, plane)? else { return Ok(None) };
        let off = found.off;
        Ok(Some((self.complete(found, plane, arc)?, off)))
    }

    /// Moves a guess within the plane through it onto the path. Returns `None` where the iteration does not converge,
    /// or leads to a state in which derivatives tell nothing.
    fn correct(&mut self, mut at: Rates, plane: &Hyperplane) -> Result<Option<Corrected>, FactorError> {
        let (tolerance, mut last, mut off, mut polished) = (self.settings.tolerance, f64::INFINITY, 0.0, 0);
        for iterations in 0..=MOST_STEPS {
            self.problem.set_parameter(at.parameter);
            self.bordered.linearize(self.problem, &at.x, &at.tension);
            let residuals = Residuals::new(self.problem, &self.bordered.tangent.at, &at.tension);
            let size = larger(residuals.force, residuals.length);
            // no step makes residuals smaller that rounding errors of the unknowns make
            let rounding = larger(MOST_ROUNDING, self.bordered.rounding_force(max_abs(&at.x)));
            let rounded = residuals.length <= tolerance && size <= rounding;
            if size <= tolerance || (polished == MOST_POLISHED && rounded) {
                let found = self.precise(Corrected { at, residuals, off, iterations }, plane)?;
                return Ok(Some(found).filter(|found| self.is_sound(found)));
            }
            if !size.is_finite() || iterations == MOST_STEPS || polished == MOST_POLISHED {
                break;
            }
            self.bordered.factor()?;
            let force = self.bordered.tangent.at.force(&at.tension);
            let missing = self.bordered.tangent.at.missing(&at.tension, self.problem.compliance());
            let (mut step, mut residual) = self.bordered.solve(&force, &missing, 0.0, plane);
            if residual > REFUSED_RESIDUAL && residuals.length <= ROUNDED_GAPS && !rounded {
                (step, residual) = self.bordered.solve(&force, &vec![0.0; missing.len()], 0.0, plane);
            }
            let length = norm_blocked(&step.x).hypot(step.parameter / self.bordered.unit);
            let small = length <= ROUNDING * larger(max_abs(&at.x), self.bordered.length);
            // from one side of a kink to the other steps may become longer
            let contracts = self.problem.may_have_kinks() || length <= SLOWEST_CONTRACTION * last;
            if residual.is_nan() || residual > REFUSED_RESIDUAL || !(small || contracts) {
                // a right-hand side of rounding errors has no exact solution; a step that is short is taken where it helps
                let is_short = length <= NEXT_TO_NOTHING * larger(max_abs(&at.x), self.bordered.length);
                let kept = Corrected { at, residuals, off, iterations };
                let found = (rounded && is_short).then(|| self.bettered(kept, &step));
                return Ok(found.filter(|found| self.is_sound(found)));
            }
            if iterations == 0 {
                off = length;
            }
            polished += usize::from(small);
            last = length;
            self.newton_steps += 1;
            at.add(1.0, &step);
        }
        Ok(None)
    }

    /// Whether derivatives tell something about a state.
    fn is_sound(&self, found: &Corrected) -> bool {
        self.problem.breakdown(&found.at.x).is_none() && self.problem.energy(&found.at.x).is_finite()
    }

    /// Returns a state whose gaps are within the tolerance, but not those that very stiff measures have by their tensions,
    /// after one step more: a self stress of theirs would be that of the guess.
    fn precise(&mut self, found: Corrected, plane: &Hyperplane) -> Result<Corrected, FactorError> {
        let missing = self.bordered.tangent.at.missing(&found.at.tension, self.problem.compliance());
        let tensions = self.problem.compliance().iter().zip(&found.at.tension);
        let stretched = tensions.fold(0.0, |most, (c, t)| f64::max(most, c * t.abs()));
        if max_abs(&missing) <= STRETCH_ERROR * stretched || stretched == 0.0 {
            return Ok(found);
        }
        self.bordered.factor()?;
        let force = self.bordered.tangent.at.force(&found.at.tension);
        let (step, residual) = self.bordered.solve(&force, &missing, 0.0, plane);
        Ok(if residual <= REFUSED_RESIDUAL { self.bettered(found, &step) } else { found })
    }

    /// Returns the state that a step leads to if its residuals are smaller, otherwise the state as it is.
    fn bettered(&mut self, kept: Corrected, step: &Rates) -> Corrected {
        let mut at = kept.at.clone();
        self.newton_steps += 1;
        at.add(1.0, step);
        self.problem.set_parameter(at.parameter);
        self.bordered.linearize(self.problem, &at.x, &at.tension);
        let residuals = Residuals::new(self.problem, &self.bordered.tangent.at, &at.tension);
        if larger(residuals.force, residuals.length) < larger(kept.residuals.force, kept.residuals.length) {
            return Corrected { at, residuals, off: kept.off, iterations: kept.iterations + 1 };
        }
        self.problem.set_parameter(kept.at.parameter);
        self.bordered.linearize(self.problem, &kept.at.x, &kept.at.tension);
        kept
    }

    /// Takes a self stress of rigid measures out of a state's tensions: predictions would let it grow from state to state.
    fn relieved(&mut self, found: Corrected) -> Result<Corrected, FactorError> {
        let tension = &found.at.tension;
        let least = if !self.problem.compliance().contains(&0.0) {
            None
        } else if self.bordered.is_unstressed(tension) {
            Some(vec![0.0; tension.len()]).filter(|none| none != tension)
        } else if self.bordered.has_self_stress(tension) {
            without_self_stress(self.problem, &self.bordered.tangent.at, tension)
        } else {
            None
        };
        let Some(tension) = least else { return Ok(found) };
        self.bordered.linearize(self.problem, &found.at.x, &tension);
        let residuals = Residuals::new(self.problem, &self.bordered.tangent.at, &tension);
        let at = Rates { tension, ..found.at.clone() };
        if residuals.force <= larger(MOST_ROUNDING, found.residuals.force) {
            self.bordered.factor()?;
            return Ok(Corrected { at, residuals, ..found });
        }
        self.bordered.linearize(self.problem, &found.at.x, &found.at.tension);
        self.bordered.factor()?;
        Ok(found)
    }

    /// Completes a state on the path: its tangent on the side to which the plane's normal points, its conjugate and its
    /// inertia.
    fn complete(&mut self, found: Corrected, plane: &Hyperplane, arc_length: f64) -> Result<PathState, FactorError> {
        self.bordered.factor()?;
        let Corrected { at: Rates { x, tension, parameter }, residuals, iterations, .. } = self.relieved(found)?;
        let negative_eigenvalues = self.bordered.negative_eigenvalues()?;
        let (forces, stretches) = (vec![0.0; x.len()], vec![0.0; tension.len()]);
        let (mut tangent, _) = self.bordered.solve(&forces, &stretches, 1.0, plane);
        let speed = norm_blocked(&tangent.x).hypot(tangent.parameter / self.bordered.unit) / self.bordered.length;
        tangent.x.iter_mut().chain(&mut tangent.tension).for_each(|rate| *rate /= speed);
        tangent.parameter /= speed;
        let conjugate = [
            self.problem.conjugate(&self.bordered.tangent.at, &x, &tension),
            self.problem.conjugate_rate(&self.bordered.tangent.at, &x, &tension, &tangent),
        ];
        let (work_along, rate_errors) = (self.bordered.work_along(&tangent), self.bordered.rate_errors());
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
            choice: self.problem.choice(),
        })
    }
}

impl Hyperplane {
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
