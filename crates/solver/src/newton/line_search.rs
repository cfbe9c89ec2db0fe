//! One accepted step: a direction, the largest fraction of it that lowers the merit, and a larger shift where none
//! does.

use super::super::corrections::PATIENT;
use super::iteration::{Newton, inaccurate};
use super::outcome::{Failure, Step};
use super::retraction::RetractedState;
use crate::kkt::Increment;
use crate::linearization::{HessianKind, missing};
use crate::problem::Problem;
use foldwell_numerics::vector::{max_abs, moved};

/// Bounds of the relative residual to which the linear system of a step is solved; between them it is a hundredth of
/// the scaled force. With the scaled force itself large problems take less time, but their soft motions are not found
/// as exactly (claim `rigid-limit-distance` of `validation/`).
const FINEST_RESIDUAL: f64 = 1e-8;
const COARSEST_RESIDUAL: f64 = 1e-3;
const RESIDUAL_PER_FORCE: f64 = 0.01;
/// Relative residual of the linear system of a step above which the step is not used.
const REFUSED_RESIDUAL: f64 = 0.1;
/// Number of fractions tried of a step, each half of the one before; then the shift is raised.
const HALVINGS: i32 = 5;
/// Number of halvings up to which the retracted part of a step is taken at once: with shorter ones the iteration
/// creeps.
const MOST_RETRACTED_HALVINGS: i32 = 4;
/// Largest number of shifts with which a step is tried.
const MOST_SHIFTS: usize = 12;
/// Largest number of chord corrections of a trial.
const TRIAL_CHORDS: i32 = 12;
/// Allowed scaled gap of a trial relative to the scaled force (1e-3 to 1e-2 need equally many iterations), and its
/// bounds.
const GAP_PER_FORCE: f64 = 3e-3;
const SMALLEST_GAP: f64 = 1e-14;
const LARGEST_GAP: f64 = 1e-4;
/// Rise of the merit, relative, that is taken for rounding error.
const ROUNDING_OF_MERIT: f64 = 1e-13;

impl<P: Problem> Newton<'_, P> {
    /// Takes one step; returns the fraction of the Newton step that was taken.
    pub(super) fn advance(&mut self, last: &Step) -> Result<f64, Failure> {
        if let Some(fraction) = self.advance_with_last_factorization(last) {
            return Ok(fraction);
        }
        self.factor_lower(last)?;
        let mut residual = 0.0;
        for _ in 0..MOST_SHIFTS {
            let step = self.direction(last);
            if self.history.len() == 1 && self.obstructed(&step.dx) {
                return Err(Failure::SingularStart);
            }
            if step.residual <= REFUSED_RESIDUAL
                && let Some(fraction) = self.take_largest_fraction(&step, last)
            {
                return Ok(fraction);
            }
            residual = step.residual;
            self.factor_higher()?;
        }
        if residual <= REFUSED_RESIDUAL {
            Err(Failure::Stuck { force: last.residual_force, length: last.residual_length })
        } else {
            Err(inaccurate(residual))
        }
    }

    /// A whole step with the last factorization, corrected to the Hessian of this state, where that is accurate and
    /// accepted.
    fn advance_with_last_factorization(&mut self, last: &Step) -> Option<f64> {
        if !self.near_certified_minimum() {
            return None;
        }
        let step = self.direction(last);
        let trial = (step.residual <= wanted_residual(last)).then(|| self.attempt(&step, 0, last))??;
        self.take(trial, 1.0, last);
        Some(1.0)
    }

    /// The Newton step in unknowns and tensions.
    fn direction(&mut self, last: &Step) -> Increment {
        let wanted = wanted_residual(last);
        let step = self.tangent.newton_step(&self.tension, wanted);
        self.inexact = step.residual > wanted;
        step
    }

    /// Takes the largest fraction of a step that can be accepted, if there is one: retracted, or where only short ones
    /// can be retracted, with the stretch that measures of finite stiffness have there.
    fn take_largest_fraction(&mut self, step: &Increment, last: &Step) -> Option<f64> {
        let first = self.first_halving().max(self.halvings_of_angles(&step.dx));
        let retracted =
            (first..first + HALVINGS).find_map(|halving| Some((halving, self.attempt(step, halving, last)?)));
        let longer = match &retracted {
            Some((halving, _)) if *halving <= MOST_RETRACTED_HALVINGS => first..first,
            Some((halving, _)) => first..*halving,
            None => first..first + HALVINGS,
        };
        let stretched =
            longer.into_iter().find_map(|halving| Some((halving, self.attempt_stretched(step, halving, last)?)));
        let (halving, trial) = stretched.or(retracted)?;
        self.take(trial, fraction(halving), last);
        Some(fraction(halving))
    }

    /// Number of halvings with which the search begins: at twice the fraction that the last step took.
    fn first_halving(&self) -> i32 {
        let last = self.history.last().map_or(1.0, |step| step.fraction);
        if last > 0.0 { (-last.log2().round() as i32 - 2).max(0) } else { 0 }
    }

    /// Number of halvings after which a step changes the measure of no soft element too much, to first order.
    fn halvings_of_angles(&self, dx: &[f64]) -> i32 {
        let change = self.tangent.at.largest_measure_change(dx) / self.problem.largest_change();
        if change > 1.0 { change.log2().ceil() as i32 } else { 0 }
    }

    /// The retracted state after a step halved so often, where its merit is lower.
    fn attempt(&mut self, step: &Increment, halving: i32, last: &Step) -> Option<RetractedState> {
        let (x, tension) = self.moved(step, halving);
        let trial = self.retract(x, tension, allowed_gap(last), TRIAL_CHORDS).ok()?;
        self.is_acceptable(&trial, last).then_some(trial)
    }

    /// The state after a step halved so often as it is, where its merit is lower and rigid measures are met.
    fn attempt_stretched(&mut self, step: &Increment, halving: i32, last: &Step) -> Option<RetractedState> {
        let (x, tension) = self.moved(step, halving);
        let trial = self.stretched(x, tension, allowed_gap(last))?;
        self.is_acceptable(&trial, last).then_some(trial)
    }

    /// Unknowns and tensions after a step halved so often.
    fn moved(&self, step: &Increment, halving: i32) -> (Vec<f64>, Vec<f64>) {
        let part = fraction(halving);
        (moved(&self.x, part, &step.dx), moved(&self.tension, part, &step.dt))
    }

    fn is_acceptable(&self, trial: &RetractedState, last: &Step) -> bool {
        self.problem.admits(&self.x, &trial.x) && trial.merit <= last.energy + self.merit_uncertainty(trial, last)
    }

    /// Uncertainty of the difference between the merits of the last state and of a trial: rounding error, and the
    /// weight of the gaps still open at the last state by its tension and by that of the trial.
    fn merit_uncertainty(&self, trial: &RetractedState, last: &Step) -> f64 {
        let at = &self.tangent.at;
        let open = at.missing(&self.tension, self.problem.compliance());
        let tensions = trial.tension.iter().zip(&self.tension);
        let by_gaps: f64 = open.iter().zip(tensions).map(|(gap, (new, old))| (gap * (new - old)).abs()).sum();
        let by_forces = f64::EPSILON * at.largest_force * max_abs(&self.x) * (self.x.len() as f64).sqrt();
        ROUNDING_OF_MERIT * last.energy.abs() + by_gaps + 4.0 * by_forces
    }

    /// One more step from a converged state whose last step was solved less exactly than was wanted, as those of large
    /// sheets are: their softest motions are then off by much more than the residuals say. `None` where it does not
    /// help.
    pub(super) fn finishing_step(&mut self, last: &Step) -> Option<RetractedState> {
        if !self.inexact || !self.near_certified_minimum() {
            return None;
        }
        let step = self.tangent.newton_step_with(&self.tension, (FINEST_RESIDUAL, PATIENT));
        let (x, tension) = (moved(&self.x, 1.0, &step.dx), moved(&self.tension, 1.0, &step.dt));
        let gaps = self.problem.gaps(&x);
        let open = self.largest_scaled_gap(&missing(&gaps, &tension, self.problem.compliance()));
        let merit = self.merit_of(&x, &tension, &gaps);
        let trial = RetractedState { x, tension, merit };
        let lower = merit <= last.energy + self.merit_uncertainty(&trial, last);
        (step.residual <= COARSEST_RESIDUAL && open <= last.residual_length && lower).then_some(trial)
    }

    /// Accepts a trial; from the first whole step that contracts on, soft elements enter with their full Hessian.
    pub(super) fn take(&mut self, trial: RetractedState, fraction: f64, last: &Step) {
        if fraction == 1.0 && last.energy - trial.merit < 0.5 * last.energy.abs() {
            self.kind = HessianKind::Full;
        }
        (self.x, self.tension, self.merit) = (trial.x, trial.tension, trial.merit);
        self.problem.accept(&mut self.x);
        self.merit -= self.problem.relieve(&mut self.x);
    }
}

fn fraction(halving: i32) -> f64 {
    0.5f64.powi(halving)
}

/// Scaled gap that is left open by the retraction of a trial.
fn allowed_gap(last: &Step) -> f64 {
    (GAP_PER_FORCE * last.residual_force).clamp(SMALLEST_GAP, LARGEST_GAP)
}

/// Relative residual to which the linear system of a step is solved.
fn wanted_residual(last: &Step) -> f64 {
    (RESIDUAL_PER_FORCE * last.residual_force).clamp(FINEST_RESIDUAL, COARSEST_RESIDUAL)
}
