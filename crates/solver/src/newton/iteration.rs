//! The state of the iteration.

use super::outcome::{Equilibrium, Failure, NewtonError, Step};
use crate::linearization::HessianKind;
use crate::problem::{Problem, Residuals};
use crate::tangent::Tangent;
use foldwell_numerics::factor::FactorError;
use foldwell_numerics::vector::{larger, max_abs};

/// Number of steps after which a minimisation that comes no further is given up. With thirty all points of the grid of
/// scenes that converge still do; without, a screw that stays straight takes all of its steps before another way is
/// tried.
const STALLED_STEPS: usize = 30;
/// Part of the energy by which it has to fall in these steps: rounding errors are below, what a step of Newton's method
/// gains above.
const STALLED_FALL: f64 = 1e-9;

/// The present shift, and how eagerly a lower one is tried.
pub(super) struct Shift {
    /// Shift of the last factorization, in units of the metric.
    pub(super) value: f64,
    /// Number of steps for which the shift is not lowered.
    pub(super) hold: usize,
    /// The next such number, doubled whenever lowering fails.
    pub(super) patience: usize,
}

/// The iteration's state and its workspaces.
pub(super) struct Newton<'a, P: Problem> {
    pub(super) problem: &'a mut P,
    pub(super) tangent: Tangent,
    pub(super) x: Vec<f64>,
    pub(super) tension: Vec<f64>,
    /// Merit of the state.
    pub(super) merit: f64,
    pub(super) shift: Shift,
    pub(super) kind: HessianKind,
    /// Whether the linear system of the last step was solved less exactly than was wanted.
    pub(super) inexact: bool,
    /// Scaled force where the last factorization was made, if it was of the full Hessian, without shift, and that of a
    /// minimum.
    pub(super) certified: Option<f64>,
    /// Whether the start knew its tensions.
    pub(super) restarted: bool,
    pub(super) history: Vec<Step>,
}

impl<'a, P: Problem> Newton<'a, P> {
    /// An iteration at its start. Tensions that are known make it use the full Hessian from the first step on.
    pub(super) fn new(problem: &'a mut P, x: Vec<f64>, tension: Option<Vec<f64>>) -> Result<Self, NewtonError> {
        let restarted = tension.is_some();
        let kind = if restarted { HessianKind::Full } else { HessianKind::GaussNewton };
        let tension = tension.unwrap_or_else(|| vec![0.0; problem.layout().stiff.len()]);
        let tangent = match Tangent::new(problem) {
            Ok(tangent) => tangent,
            Err(error) => return Err(NewtonError { failure: error.into(), x, tension, history: vec![] }),
        };
        let (merit, certified, history) = (f64::NAN, None, vec![]);
        let (shift, inexact) = (Shift { value: 0.0, hold: 0, patience: 1 }, false);
        Ok(Self { problem, tangent, x, tension, merit, shift, kind, inexact, certified, restarted, history })
    }

    /// The outcome of the iteration: a converged state with this number of negative eigenvalues, or a failure.
    pub(super) fn end(
        mut self,
        negative_eigenvalues: Result<Option<usize>, Failure>,
    ) -> Result<Equilibrium, NewtonError> {
        let energy = self.history.last().map_or(f64::NAN, |step| step.energy);
        match negative_eigenvalues
            .and_then(|count| if energy.is_finite() { Ok(count) } else { Err(Failure::NotFinite) })
        {
            Ok(negative_eigenvalues) => Ok(Equilibrium {
                energy,
                independent: self.rigid_measures_independent(),
                x: self.x,
                tension: self.tension,
                negative_eigenvalues,
                history: self.history,
            }),
            Err(failure) => Err(NewtonError { failure, x: self.x, tension: self.tension, history: self.history }),
        }
    }

    /// Linearizes at the present state.
    pub(super) fn linearize(&mut self) {
        self.problem.linearize(&self.x, &self.tension, self.kind, &mut self.tangent.at);
        self.problem.hold(&self.tension, &mut self.tangent.at);
    }

    /// Goes on in other unknowns where the problem chooses them anew; returns whether it does.
    pub(super) fn choose_anew(&mut self) -> Result<bool, Failure> {
        let no_rates = vec![0.0; self.x.len()];
        let Some([x, _]) = self.problem.choose_anew(&self.x, &no_rates) else { return Ok(false) };
        let made = (self.tangent.system.factorizations, self.tangent.system.solves);
        self.tangent = Tangent::new(self.problem)?;
        (self.tangent.system.factorizations, self.tangent.system.solves) = made;
        (self.x, self.certified) = (x, None);
        Ok(true)
    }

    /// The record of the present state, reached by this fraction of a Newton step.
    pub(super) fn record(&self, fraction: f64) -> Step {
        let residuals = Residuals::new(self.problem, &self.tangent.at, &self.tension);
        let before = |count: fn(&Step) -> usize| self.history.iter().map(count).sum::<usize>();
        Step {
            energy: self.merit,
            residual_force: residuals.force,
            residual_length: residuals.length,
            fraction,
            shift: self.shift.value,
            factorizations: self.tangent.system.factorizations - before(|step| step.factorizations),
            solves: self.tangent.system.solves - before(|step| step.solves),
            intrinsic: false,
        }
    }

    /// The merit of a state with these gaps: the energy. Gaps still open enter with their tension, to first order.
    pub(super) fn merit_of(&self, x: &[f64], tension: &[f64], gaps: &[f64]) -> f64 {
        let stiff =
            gaps.iter().zip(tension).zip(self.problem.compliance()).map(|((gap, t), c)| t * (gap - c * t / 2.0));
        self.problem.energy(x) + stiff.sum::<f64>()
    }

    /// The largest of these gaps, each relative to its natural size.
    pub(super) fn largest_scaled_gap(&self, gaps: &[f64]) -> f64 {
        gaps.iter().zip(self.problem.gap_scale()).fold(0.0, |m, (gap, scale)| larger(m, gap.abs() / scale))
    }

    /// The scaled force that rounding of the unknowns alone may make: a last place of the largest unknown times the
    /// largest stiffness. It is above the tolerance where all forces are tiny, or where a stiffness is huge.
    pub(super) fn rounding_force(&self) -> f64 {
        let at = &self.tangent.at;
        f64::EPSILON * max_abs(&self.x) * at.pattern().largest_diagonal(&at.hessian) / at.largest_force
    }

    /// Whether the last steps brought neither a lower energy nor residuals half as large.
    pub(super) fn stalled(&self) -> bool {
        // the start, which may meet the rigid measures as drawn, is left out
        let Some(count) = self.history.len().checked_sub(STALLED_STEPS + 1) else { return false };
        let (before, since) = self.history[1..].split_at(count);
        let (Some(from), Some(to)) = (before.last(), since.last()) else { return false };
        let is_as_large = |residual: fn(&Step) -> f64| {
            let least = |steps: &[Step]| steps.iter().map(residual).fold(f64::INFINITY, f64::min);
            least(since) > 0.5 * least(before)
        };
        let is_as_high = from.energy - to.energy <= STALLED_FALL * from.energy.abs();
        is_as_high && is_as_large(|step| step.residual_force) && is_as_large(|step| step.residual_length)
    }

    /// Whether the force is rounding error that no further step makes smaller. A start that knows its tensions is where
    /// steps ended before.
    pub(super) fn exhausted(&self, step: &Step) -> bool {
        let start = if self.restarted { 0.0 } else { f64::INFINITY };
        let before = self.history.len().checked_sub(2).map_or(start, |k| self.history[k].residual_force);
        step.residual_force > 0.5 * before && step.residual_force <= self.rounding_force()
    }
}

/// The failure of a linear system that is solved to this relative residual only.
pub(super) fn inaccurate(residual: f64) -> Failure {
    FactorError::Inaccurate { residual }.into()
}
