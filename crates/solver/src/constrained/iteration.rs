//! The iteration: steps of Gauss and Newton, damped so that the simplified correction shrinks.

use super::outcome::{ConstrainedError, ConstrainedFailure, ConstrainedIterate, Minimum};
use super::problem::{ConstrainedProblem, Derivatives};
use super::reduced::{PrimalDualStep, Reduced, energy_norm};
use crate::newton::Step;
use foldwell_numerics::vector::{dot_blocked, larger, max_abs, moved};

/// Largest change of a variable by a Gauss-Newton step at a converged state, relative to the largest variable where that
/// is above 1.
const TOLERANCE: f64 = 1e-10;
/// Largest number of steps.
const MOST_STEPS: usize = 100;
/// Least fraction of a step that is tried.
const LEAST_FRACTION: f64 = 1e-4;
/// Factor by which a whole Gauss-Newton step has to shrink the correction before the full Hessian is used.
const CONTRACTION_FOR_NEWTON: f64 = 0.5;
/// Largest change of a variable, relative to the largest one, at which a correction that no longer shrinks is rounding
/// error.
const ROUNDING: f64 = 1e-6;
/// Accuracy of conjugate gradients: this, or the contraction of the step before if that is smaller.
const GRADIENT_ACCURACY: f64 = 0.1;
/// Least accuracy that is asked of conjugate gradients.
const FINEST_ACCURACY: f64 = 1e-4;

/// Shifts of the Hessian, in units of `D^-1`, that are tried in turn beside a saddle point.
const SHIFTS: [f64; 5] = [0.0, 0.25, 1.0, 4.0, 16.0];
/// Part of the expected fall of the merit that a step downhill must reach.
const LEAST_DESCENT: f64 = 1e-4;

/// The state of an iteration.
pub(super) struct Iteration<'a, P: ConstrainedProblem> {
    problem: &'a P,
    system: Reduced<'a, P>,
    z: Vec<f64>,
    multipliers: Vec<f64>,
    at: Derivatives,
    /// Ratio of the last two corrections; infinite before the first step.
    contraction: f64,
    /// Whether steps use the full Hessian.
    full: bool,
    fraction: f64,
    /// Size of the last Gauss-Newton step, and the simplified correction after it.
    last: Option<(f64, Vec<f64>)>,
    history: Vec<Step>,
}

/// A state that is tried, its derivatives, and the correction there by the factorization of the state before.
struct Trial {
    z: Vec<f64>,
    multipliers: Vec<f64>,
    at: Derivatives,
    correction: Vec<f64>,
}

impl<'a, P: ConstrainedProblem> Iteration<'a, P> {
    pub(super) fn new(problem: &'a P, z: Vec<f64>) -> Result<Self, ConstrainedError> {
        let system = match Reduced::new(problem, z.len()) {
            Ok(system) => system,
            Err(error) => return Err(ConstrainedError { failure: error.into(), z, history: vec![] }),
        };
        let multipliers = vec![0.0; problem.blocks().total_rows()];
        let mut at = Derivatives::new(problem.blocks());
        at.evaluate(problem, &z, None);
        let (contraction, full, fraction, last, history) = (f64::INFINITY, false, 1.0, None, vec![]);
        Ok(Self { problem, system, z, multipliers, at, contraction, full, fraction, last, history })
    }

    /// Iterates until convergence.
    pub(super) fn run(
        mut self,
        observe: &mut dyn FnMut(&ConstrainedIterate<'_>) -> bool,
    ) -> Result<Minimum, ConstrainedError> {
        match self.converge(observe) {
            Ok(()) => Ok(Minimum { z: self.z, multipliers: self.multipliers, history: self.history }),
            Err(failure) => Err(ConstrainedError { failure, z: self.z, history: self.history }),
        }
    }

    fn converge(&mut self, observe: &mut dyn FnMut(&ConstrainedIterate<'_>) -> bool) -> Result<(), ConstrainedFailure> {
        let (mut taken, largest) = (0.0, max_abs(&self.z).max(1.0));
        loop {
            self.system.factor(&self.at)?;
            let pull = self.pull(&self.z, &self.multipliers, &self.at);
            let gauss = self.system.gauss_newton(&self.at, &pull, &self.at.values);
            let correction = max_abs(&gauss.dz);
            self.record(&pull, taken, observe)?;
            if !correction.is_finite() {
                return Err(ConstrainedFailure::NotFinite);
            }
            if correction <= TOLERANCE * largest {
                return Ok(());
            }
            if self.history.len() > MOST_STEPS {
                return Err(ConstrainedFailure::TooManySteps { iterations: MOST_STEPS });
            }
            let Some(next) = self.advance(&gauss) else {
                // a correction of rounding error does not shrink
                let rounding = correction <= ROUNDING * largest;
                return if rounding { Ok(()) } else { Err(ConstrainedFailure::Stuck { correction }) };
            };
            taken = self.fraction;
            if next <= TOLERANCE * largest {
                let pull = self.pull(&self.z, &self.multipliers, &self.at);
                return self.record(&pull, taken, observe);
            }
        }
    }

    /// Goes along the step from the present state: that of Gauss and Newton at first, with the full Hessian next to a
    /// solution and where the former leads nowhere, and downhill where neither shrinks the correction. Returns the
    /// largest change of a variable by the correction that is left; `None` if no way leads on.
    fn advance(&mut self, gauss: &PrimalDualStep) -> Option<f64> {
        if !self.full {
            let predicted = self.predicted(gauss);
            if let Some(left) = self.go_along(gauss, gauss, predicted) {
                return Some(left);
            }
            self.full = true;
            self.at.evaluate(self.problem, &self.z, Some(&self.multipliers));
        }
        let accuracy = self.contraction.clamp(FINEST_ACCURACY, GRADIENT_ACCURACY);
        let newton = self.system.newton(&self.at, gauss.clone(), (0.0, accuracy));
        let gone = newton.and_then(|newton| self.go_along(&newton, gauss, 1.0));
        gone.or_else(|| self.go_down(gauss))
    }

    /// Goes along the step with the least shift of the Hessian that makes it positive definite along the constraints,
    /// as far as the merit falls: the function, plus the multipliers times the constraints, plus half of what closing
    /// these costs. The correction may grow on the way, as it does beside a saddle point.
    fn go_down(&mut self, gauss: &PrimalDualStep) -> Option<f64> {
        for shift in SHIFTS {
            let step = self.system.newton(&self.at, gauss.clone(), (shift, GRADIENT_ACCURACY));
            let Some(step) = step else { continue };
            let multipliers = moved(&self.multipliers, 1.0, &step.dl);
            let cost = self.system.cost_of_closing(&self.at.values);
            let merit = self.value(&self.z) + dot_blocked(&multipliers, &self.at.values) + 0.5 * cost;
            let slope = self.curvature(&step.dz, shift) + cost;
            let mut fraction = 1.0;
            while fraction >= LEAST_FRACTION {
                let trial = self.trial(&step, fraction);
                let cost = self.system.cost_of_closing(&trial.at.values);
                let below = self.value(&trial.z) + dot_blocked(&multipliers, &trial.at.values) + 0.5 * cost;
                if below <= merit - LEAST_DESCENT * fraction * slope {
                    let left = energy_norm(&trial.correction, self.problem.compliance());
                    let next = self.accept(trial, fraction, [left.max(f64::MIN_POSITIVE), left]);
                    (self.full, self.contraction, self.last) = (true, f64::INFINITY, None);
                    self.at.evaluate(self.problem, &self.z, Some(&self.multipliers));
                    return Some(next);
                }
                fraction /= 2.0;
            }
        }
        None
    }

    /// Returns `dz . ((1 + shift) D^-1 + W) dz`.
    fn curvature(&self, dz: &[f64], shift: f64) -> f64 {
        let mut image: Vec<f64> =
            dz.iter().zip(self.problem.compliance()).map(|(dz, c)| (1.0 + shift) * dz / c).collect();
        self.at.add_hessian_product(self.problem.blocks(), dz, &mut image);
        dot_blocked(dz, &image)
    }

    /// Returns the function that is minimised.
    fn value(&self, z: &[f64]) -> f64 {
        let terms = z.iter().zip(self.problem.target()).zip(self.problem.compliance());
        terms.map(|((z, a), c)| (z - a) * (z - a) / (2.0 * c)).sum()
    }

    /// Goes along a step as far as the simplified correction shrinks (P. Deuflhard, Newton Methods for Nonlinear
    /// Problems, section 3.3): from the size of the Gauss-Newton step `gauss` to less than `1 - fraction / 4` of it.
    /// The first fraction that is tried is given. Returns the largest change of a variable by the correction that is
    /// left; `None` if no fraction does it.
    fn go_along(&mut self, direction: &PrimalDualStep, gauss: &PrimalDualStep, mut fraction: f64) -> Option<f64> {
        let compliance = self.problem.compliance();
        let (size, mut failed) = (energy_norm(&gauss.dz, compliance), false);
        while fraction >= LEAST_FRACTION {
            let trial = self.trial(direction, fraction);
            let left = energy_norm(&trial.correction, compliance);
            let change = trial.correction.iter().zip(&gauss.dz).map(|(left, dz)| left - (1.0 - fraction) * dz);
            let bent = energy_norm(&change.collect::<Vec<f64>>(), compliance);
            let best = f64::min(1.0, 0.5 * fraction * fraction * size / bent);
            if left <= (1.0 - 0.25 * fraction) * size {
                if !failed && best >= 4.0 * fraction {
                    fraction = best;
                    continue;
                }
                return Some(self.accept(trial, fraction, [size, left]));
            }
            failed = true;
            // also where the correction is not a number
            fraction = if best < 0.5 * fraction { best.max(0.1 * fraction) } else { 0.5 * fraction };
        }
        None
    }

    /// Returns the fraction of the next step to try first: the one that the change of the correction by the last step
    /// predicts.
    fn predicted(&self, gauss: &PrimalDualStep) -> f64 {
        let Some((size, left)) = &self.last else { return 1.0 };
        let compliance = self.problem.compliance();
        let change: Vec<f64> = left.iter().zip(&gauss.dz).map(|(left, dz)| left - dz).collect();
        let ratio = size * energy_norm(left, compliance)
            / (energy_norm(&change, compliance) * energy_norm(&gauss.dz, compliance));
        (ratio * self.fraction).clamp(LEAST_FRACTION, 1.0)
    }

    /// Makes a trial the present state. Returns the largest change of a variable by the correction that is left.
    fn accept(&mut self, trial: Trial, fraction: f64, [size, left]: [f64; 2]) -> f64 {
        let contraction = left / size;
        self.contraction = contraction;
        self.full |= fraction == 1.0 && contraction < CONTRACTION_FOR_NEWTON;
        (self.z, self.multipliers, self.at, self.fraction) = (trial.z, trial.multipliers, trial.at, fraction);
        if self.full {
            self.at.evaluate(self.problem, &self.z, Some(&self.multipliers));
        }
        let change = max_abs(&trial.correction);
        self.last = Some((size, trial.correction));
        change
    }

    fn trial(&mut self, direction: &PrimalDualStep, fraction: f64) -> Trial {
        let z = moved(&self.z, fraction, &direction.dz);
        let multipliers = moved(&self.multipliers, fraction, &direction.dl);
        let mut at = Derivatives::new(self.problem.blocks());
        at.evaluate(self.problem, &z, None);
        let pull = self.pull(&z, &multipliers, &at);
        let simplified = self.system.gauss_newton(&self.at, &pull, &at.values);
        Trial { z, multipliers, at, correction: simplified.dz }
    }

    /// Returns `z - a + D J^T l`, the compliance times the residual of the first equation.
    fn pull(&self, z: &[f64], multipliers: &[f64], at: &Derivatives) -> Vec<f64> {
        let mut pull = vec![0.0; z.len()];
        at.add_transpose_product(self.problem.blocks(), multipliers, &mut pull);
        let targets = z.iter().zip(self.problem.target());
        pull.iter_mut().zip(targets).zip(self.problem.compliance()).for_each(|((p, (z, a)), c)| *p = z - a + c * *p);
        pull
    }

    /// Adds the present state to the history and shows it to the observer.
    fn record(
        &mut self,
        pull: &[f64],
        fraction: f64,
        observe: &mut dyn FnMut(&ConstrainedIterate<'_>) -> bool,
    ) -> Result<(), ConstrainedFailure> {
        let before = |count: fn(&Step) -> usize| self.history.iter().map(count).sum::<usize>();
        // forces of the terms, those of the constraints, and what is left of them together
        let own = self.z.iter().zip(self.problem.target()).map(|(z, a)| z - a);
        let forces = pull.iter().zip(own).zip(self.problem.compliance());
        let (left, largest) = forces.fold((0.0, 0.0), |(left, largest), ((pull, own), c)| {
            (larger(left, (pull / c).abs()), larger(largest, (own / c).abs().max(((pull - own) / c).abs())))
        });
        let step = Step {
            energy: self.value(&self.z),
            residual_force: if left > 0.0 { left / largest } else { left },
            residual_length: max_abs(&self.at.values),
            fraction,
            shift: 0.0,
            factorizations: self.system.factorizations - before(|step| step.factorizations),
            solves: self.system.solves - before(|step| step.solves),
            intrinsic: true,
        };
        self.history.push(step);
        let iterate = ConstrainedIterate { z: &self.z, multipliers: &self.multipliers, step: &step };
        if observe(&iterate) { Ok(()) } else { Err(ConstrainedFailure::Interrupted) }
    }
}
