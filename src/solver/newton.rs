//! Newton's method with retraction onto the stiff measures, uniform in their stiffness.
//!
//! One iteration: linearize; factor, with a shift raised until the inertia is that of a minimum; take the whole step in
//! `(x, t)`; pull the state back onto `m = c t` by a few chord corrections with the same factorization (in `x` *and*
//! `t`); accept when the merit `E + sum c t^2 / 2` fell. On retracted states the merit is the true energy, without
//! cancellation at any stiffness; the iterates stay on the folded surfaces, where the physics is. Far from the
//! solution soft elements enter with their Gauss-Newton Hessian, once steps contract with the full one. Near it a factorization
//! serves the next steps too, which it solves by corrections on the residual of their own system.

use super::problem::{self, Curvature, Linearization, Problem};
use super::saddle::{Saddle, Solved};
use super::tension::{residuals, self_stresses};
use crate::numerics::factor::FactorError;
use crate::numerics::random::symmetric;
use crate::numerics::{larger, largest};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use thiserror::Error;

/// Largest scaled gap of a start.
const FEASIBLE: f64 = 1e-10;
/// Chord corrections allowed for a start, and for a trial.
const START_CHORDS: i32 = 50;
/// Most Gauss-Newton steps of a start, and the part of the gap that a whole one must close.
const START_STEPS: usize = 30;
const SLOWEST: f64 = 0.3;
const CHORDS: i32 = 12;
/// Scaled gaps of this size may be rounding error.
const ROUNDING: f64 = 1e-12;
/// Shortest fraction of a step is `0.5^(HALVINGS - 1)`; then the shift is raised, at most `SHIFTS` times.
const HALVINGS: i32 = 5;
const SHIFTS: usize = 12;
/// Bounds of the relative residual of a Newton step's linear system; between them a hundredth of the scaled force. With the scaled
/// force itself large sheets take less time, but their soft motions are not found as exactly (`foldwell validate rigid-limit-distance`).
const FINEST: f64 = 1e-8;
const COARSEST: f64 = 1e-3;
/// Relative residual of a step's linear system above which the factorization is not used.
const INACCURATE: f64 = 0.1;
/// Largest scaled gap of a trial over the scaled force (1e-3 to 1e-2 take alike), and at all.
const CLOSE: f64 = 3e-3;
const LOOSEST: f64 = 1e-4;
/// First shift after none, factor from a shift to the next, and the shift below which the next lower one is none.
const FIRST_SHIFT: f64 = 0.25;
const RAISE: f64 = 4.0;
const LEAST_SHIFT: f64 = 2e-2;
/// Scaled force below which the next lower shift is none at once: by then the shift is what slows the soft motions of large sheets.
const SETTLED: f64 = 1e-5;
/// Most steps in a row for which a shift is not lowered.
const MOST_PATIENCE: usize = 8;
/// Scaled force below which the inertia of a state is that of the minimum next to it.
const NEAR: f64 = 1e-4;
/// Largest component of the step with which a start is probed, over the unit of length, and the part of its stretch that tells a singular start.
const PROBE: f64 = 1e-3;
const UNREACHABLE: f64 = 0.05;
/// What may be left of a random stretch that a motion was asked to make, over what a self stress keeps of it.
const REACHED: f64 = 1e-2;
/// Smallest pivot over the largest below which a factorization without shift is not used.
const SINGULAR: f64 = 1e-15;
/// Rise of the merit, relative, that is taken for rounding error.
const NOISE: f64 = 1e-13;

/// When to stop.
#[derive(Clone, Copy, Debug)]
pub struct Options {
    /// Largest scaled residual, of force and of length, of a converged state.
    pub tolerance: f64,
    /// Most accepted steps.
    pub iterations: usize,
}

impl Default for Options {
    fn default() -> Self {
        Self { tolerance: 1e-12, iterations: 200 }
    }
}

/// One accepted step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step {
    /// Merit: energy, stiff measures included.
    pub energy: f64,
    /// Largest unbalanced force over the largest force of an element.
    pub residual_force: f64,
    /// Largest scaled gap.
    pub residual_length: f64,
    /// Fraction of the Newton step taken to get here; 0 for a start.
    pub fraction: f64,
    /// Shift of the Hessian, relative to its largest diagonal entry.
    pub shift: f64,
    /// Factorizations made for it.
    pub factorizations: usize,
    /// Solves made for it, chord corrections included.
    pub solves: usize,
}

/// A converged state.
#[derive(Clone, Debug)]
pub struct Equilibrium {
    /// Unknowns.
    pub x: Vec<f64>,
    /// Tensions of the stiff measures.
    pub tension: Vec<f64>,
    /// Energy, stiff measures included.
    pub energy: f64,
    /// Negative eigenvalues of the energy's Hessian on what the rigid measures leave free.
    pub negative_eigenvalues: usize,
    /// Whether the stiff measures were seen to be independent: then no self stress is free.
    pub independent: bool,
    /// Steps, the start first.
    pub history: Vec<Step>,
}

/// Why there is no converged state.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
pub enum Failure {
    /// The rigid measures cannot all be met near the start.
    #[error("the rigid measures cannot be met: largest scaled gap {gap:.2e}")]
    Infeasible {
        /// Largest scaled gap reached.
        gap: f64,
    },
    /// The force does not vanish but nothing linear leads away.
    #[error(
        "singular start: to first order the rigid measures leave no motion that relieves the force; leave along a branch"
    )]
    SingularStart,
    /// No step along the Newton direction lowers the merit.
    #[error("no step lowers the energy: residual force {force:.2e}, residual length {length:.2e}")]
    Stuck {
        /// Scaled residual force.
        force: f64,
        /// Scaled residual length.
        length: f64,
    },
    /// The allowed number of steps was taken.
    #[error(
        "no convergence within {iterations} steps in a row: residual force {force:.2e}, residual length {length:.2e}"
    )]
    TooManySteps {
        /// Steps taken.
        iterations: usize,
        /// Scaled residual force.
        force: f64,
        /// Scaled residual length.
        length: f64,
    },
    /// The forces balance, but rounding errors or a direction that costs next to nothing leave the state open.
    #[error("{}", uncertain(*angle, *force, *tolerance))]
    Uncertain {
        /// Largest change of an angle that one more Newton step would make, in radians.
        angle: f64,
        /// Scaled residual force.
        force: f64,
        /// The tolerance of that.
        tolerance: f64,
    },
    /// The linear algebra failed.
    #[error(transparent)]
    Factor(#[from] FactorError),
    /// The observer asked to stop.
    #[error("stopped on request")]
    Interrupted,
}

/// Why a state is not known: in balance, or not in balance and beyond improvement.
fn uncertain(angle: f64, force: f64, tolerance: f64) -> String {
    if force <= tolerance {
        return format!(
            "the forces balance, but the angles are known to {angle:.1e} rad only: rounding, or a direction without cost"
        );
    }
    let stays = format!("the residual force {force:.2e} stays above the tolerance {tolerance:.1e}");
    if angle.is_finite() {
        format!("{stays}: no step lowers it, and one more would turn angles by {angle:.1e} rad")
    } else {
        format!("{stays}, and no step lowers it")
    }
}

/// A failure with the last accepted state.
#[derive(Debug, Error)]
#[error("{failure}")]
pub struct NewtonError {
    /// What went wrong.
    pub failure: Failure,
    /// Last accepted unknowns.
    pub x: Vec<f64>,
    /// Their tensions.
    pub tension: Vec<f64>,
    /// Steps so far.
    pub history: Vec<Step>,
}

/// Where to begin.
#[derive(Clone, Debug)]
pub struct Start {
    /// Unknowns.
    pub x: Vec<f64>,
    /// Tensions of the stiff measures near a solution, if they are known: the first steps then use the full Hessian.
    pub tension: Option<Vec<f64>>,
}

impl From<Vec<f64>> for Start {
    fn from(x: Vec<f64>) -> Self {
        Self { x, tension: None }
    }
}

/// The iteration's state and its workspaces.
struct Newton<'a, P: Problem> {
    problem: &'a mut P,
    at: Linearization,
    saddle: Saddle,
    x: Vec<f64>,
    tension: Vec<f64>,
    /// Merit of the state.
    merit: f64,
    /// Shift of the last factorization, in units of the metric.
    shift: f64,
    /// Steps for which the shift is not lowered, and for how many it will be when lowering fails again.
    hold: usize,
    patience: usize,
    curvature: Curvature,
    /// Scaled force where the last factorization was made, if it was of the full Hessian, without shift, and that of a minimum.
    certified: Option<f64>,
    /// Whether the start knew its tensions.
    restarted: bool,
    history: Vec<Step>,
}

/// A retracted trial state.
struct Trial {
    x: Vec<f64>,
    tension: Vec<f64>,
    merit: f64,
}

/// Minimises from a start. `observe` sees every accepted step and returns false to stop.
pub fn minimize<P: Problem>(
    problem: &mut P,
    start: impl Into<Start>,
    options: Options,
    observe: &mut dyn FnMut(&Step) -> bool,
) -> Result<Equilibrium, NewtonError> {
    let Start { x, tension } = start.into();
    let restarted = tension.is_some();
    let curvature = if restarted { Curvature::Full } else { Curvature::GaussNewton };
    let tension = tension.unwrap_or_else(|| vec![0.0; problem.layout().stiff.len()]);
    let at = Linearization::new(problem.layout());
    let saddle = match Saddle::new(problem.layout(), &at) {
        Ok(saddle) => saddle,
        Err(error) => return Err(NewtonError { failure: error.into(), x, tension, history: vec![] }),
    };
    let mut newton = Newton {
        problem,
        at,
        saddle,
        x,
        tension,
        merit: f64::NAN,
        shift: 0.0,
        hold: 0,
        patience: 1,
        curvature,
        certified: None,
        restarted,
        history: vec![],
    };
    match newton.run(options, observe) {
        Ok(negative_eigenvalues) => Ok(Equilibrium {
            energy: newton.history.last().map_or(f64::NAN, |step| step.energy),
            independent: newton.independent(),
            x: newton.x,
            tension: newton.tension,
            negative_eigenvalues,
            history: newton.history,
        }),
        Err(failure) => Err(NewtonError { failure, x: newton.x, tension: newton.tension, history: newton.history }),
    }
}

impl<P: Problem> Newton<'_, P> {
    fn run(&mut self, options: Options, observe: &mut dyn FnMut(&Step) -> bool) -> Result<usize, Failure> {
        self.problem.relieve(&mut self.x);
        self.linearize();
        self.start()?;
        self.merit = merit(self.problem, &self.x, &self.tension, &self.at.gaps);
        let mut fraction = 0.0;
        loop {
            let step = self.step(fraction);
            self.history.push(step);
            if !observe(&step) {
                return Err(Failure::Interrupted);
            }
            let (force, length) = (step.residual_force, step.residual_length);
            if length <= options.tolerance && (force <= options.tolerance || self.exhausted(&step)) {
                return self.certify();
            }
            if self.history.len() > options.iterations {
                return Err(Failure::TooManySteps { iterations: options.iterations, force, length });
            }
            fraction = match self.advance(&step) {
                Err(Failure::Stuck { .. }) if length <= options.tolerance && force <= self.rounding() => {
                    return self.certify();
                }
                taken => taken?,
            };
            self.linearize();
        }
    }

    /// Whether the force is rounding error that no further step makes smaller. A start that knows its tensions is where steps ended before.
    fn exhausted(&self, step: &Step) -> bool {
        let start = if self.restarted { 0.0 } else { f64::INFINITY };
        let before = self.history.len().checked_sub(2).map_or(start, |k| self.history[k].residual_force);
        step.residual_force > 0.5 * before && step.residual_force <= self.rounding()
    }

    fn linearize(&mut self) {
        self.problem.linearize(&self.x, &self.tension, self.curvature, &mut self.at);
        self.problem.hold(&self.tension, &mut self.at);
    }

    /// Pulls the start onto the stiff measures: by chord corrections, and where one linearization does not reach so far, by
    /// damped Gauss-Newton steps before.
    fn start(&mut self) -> Result<(), Failure> {
        let mut gap = residuals(self.problem, &self.at, &self.tension).1;
        for _ in 0..START_STEPS {
            if gap <= FEASIBLE {
                return Ok(());
            }
            self.factor_start()?;
            if let Ok(trial) = self.retract(self.x.clone(), self.tension.clone(), FEASIBLE, START_CHORDS) {
                (self.x, self.tension) = (trial.x, trial.tension);
                self.problem.accept(&mut self.x);
                self.linearize();
                return Ok(());
            }
            gap = self.approach(gap).ok_or(Failure::Infeasible { gap })?;
        }
        Err(Failure::Infeasible { gap })
    }

    /// Factors for the retraction of a start: near a solution, where tensions are known, it should cost the least energy; elsewhere
    /// it should be the shortest.
    fn factor_start(&mut self) -> Result<(), Failure> {
        if self.curvature == Curvature::Full {
            return self.factor(0.0);
        }
        self.saddle.factor_shortest(self.problem.layout(), &self.at, self.problem.compliance())?;
        Ok(())
    }

    /// One Gauss-Newton step towards the stiff measures, halved until it makes the largest gap clearly smaller; that gap.
    fn approach(&mut self, gap: f64) -> Option<f64> {
        let (compliance, scale) = (self.problem.compliance(), self.problem.gap_scale());
        let missing = self.at.missing(&self.tension, compliance);
        let (dx, dt) = self.saddle.apply(self.problem.layout(), &vec![0.0; self.x.len()], &missing);
        for fraction in (0..HALVINGS).map(|halving| 0.5f64.powi(halving)) {
            let moved = |from: &[f64], by: &[f64]| -> Vec<f64> {
                from.iter().zip(by).map(|(from, by)| from + fraction * by).collect()
            };
            let (x, tension) = (moved(&self.x, &dx), moved(&self.tension, &dt));
            let left = largest_gap(&problem::missing(&self.problem.gaps(&x), &tension, compliance), scale);
            if left <= (1.0 - SLOWEST * fraction) * gap {
                (self.x, self.tension) = (x, tension);
                self.problem.accept(&mut self.x);
                self.linearize();
                return Some(left);
            }
        }
        None
    }

    fn step(&self, fraction: f64) -> Step {
        let (residual_force, residual_length) = residuals(self.problem, &self.at, &self.tension);
        let before = |count: fn(&Step) -> usize| self.history.iter().map(count).sum::<usize>();
        Step {
            energy: self.merit,
            residual_force,
            residual_length,
            fraction,
            shift: self.shift,
            factorizations: self.saddle.factorizations - before(|step| step.factorizations),
            solves: self.saddle.solves - before(|step| step.solves),
        }
    }

    /// Factors for a new step: tries a lower shift than the last one, none near a minimum, less often the more often that was in vain.
    fn factor_lower(&mut self, last: &Step) -> Result<(), Failure> {
        if self.hold > 0 {
            self.hold -= 1;
            return self.factor(self.shift);
        }
        let settled = last.residual_force <= SETTLED;
        let lower = if settled || self.shift <= LEAST_SHIFT { 0.0 } else { self.shift / RAISE };
        self.factor(lower)?;
        let in_vain = self.shift > lower;
        self.patience = if in_vain { (2 * self.patience).min(MOST_PATIENCE) } else { 1 };
        self.hold = if in_vain { self.patience / 2 } else { 0 };
        Ok(())
    }

    /// Factors with the smallest shift, from `shift` upwards, at which the Hessian is that of a minimum.
    fn factor(&mut self, mut shift: f64) -> Result<(), Failure> {
        for _ in 0..40 {
            let found = self.saddle.factor(self.problem.layout(), &self.at, self.problem.compliance(), shift);
            match found {
                Ok(inertia) if inertia.negative == 0 && (shift > 0.0 || inertia.ratio > SINGULAR) => {
                    self.shift = shift;
                    let force = self.history.last().map_or(f64::INFINITY, |step| step.residual_force);
                    self.certified = (shift == 0.0 && self.curvature == Curvature::Full).then_some(force);
                    return Ok(());
                }
                Err(error @ FactorError::NotFinite) => return Err(error.into()),
                _ => shift = if shift == 0.0 { FIRST_SHIFT } else { RAISE * shift },
            }
        }
        Err(FactorError::Singular { ratio: 0.0 }.into())
    }

    /// One accepted step; returns the fraction of the Newton step that was taken.
    fn advance(&mut self, last: &Step) -> Result<f64, Failure> {
        if let Some(fraction) = self.advance_with_last(last) {
            return Ok(fraction);
        }
        self.factor_lower(last)?;
        let mut residual = 0.0;
        for _ in 0..SHIFTS {
            let step = self.direction(last);
            if self.history.len() == 1 && self.obstructed(&step.dx) {
                return Err(Failure::SingularStart);
            }
            if step.residual <= INACCURATE {
                let taken = self.halve(&step, last);
                if let Some(fraction) = taken {
                    return Ok(fraction);
                }
            }
            residual = step.residual;
            self.factor((RAISE * self.shift).max(FIRST_SHIFT))?;
        }
        if residual <= INACCURATE {
            Err(Failure::Stuck { force: last.residual_force, length: last.residual_length })
        } else {
            Err(FactorError::Inaccurate { residual }.into())
        }
    }

    /// Takes the largest fraction of a step that can be accepted, if there is one.
    fn halve(&mut self, step: &Solved, last: &Step) -> Option<f64> {
        let fractions = (self.first_halving()..HALVINGS).map(|halving| 0.5f64.powi(halving));
        for fraction in fractions {
            if let Some(trial) = self.attempt((&step.dx, &step.dt), fraction, last) {
                self.take(trial, fraction, last);
                return Some(fraction);
            }
        }
        None
    }

    /// Whether the last factorization was made a few whole steps ago and so near the minimum that its inertia is that of the minimum.
    fn near(&self) -> bool {
        self.certified.is_some_and(|force| force < NEAR) && self.history.last().is_some_and(|step| step.fraction == 1.0)
    }

    /// A whole step with the last factorization, corrected to the Hessian of this state, where that is accurate and accepted.
    fn advance_with_last(&mut self, last: &Step) -> Option<f64> {
        if !self.near() {
            return None;
        }
        let step = self.direction(last);
        let trial = (step.residual <= accuracy(last)).then(|| self.attempt((&step.dx, &step.dt), 1.0, last))??;
        self.take(trial, 1.0, last);
        Some(1.0)
    }

    /// Where the halving of steps begins: at twice the fraction that the last step took.
    fn first_halving(&self) -> i32 {
        let last = self.history.last().map_or(1.0, |step| step.fraction);
        if last > 0.0 { (-last.log2().round() as i32 - 2).max(0) } else { 0 }
    }

    /// The Newton step in unknowns and tensions.
    fn direction(&mut self, last: &Step) -> Solved {
        let (layout, compliance) = (self.problem.layout(), self.problem.compliance());
        let force = self.at.force(layout, &self.tension);
        let open = self.at.missing(&self.tension, compliance);
        self.saddle.solve(layout, &self.at, compliance, (&force, &open), accuracy(last))
    }

    /// Whether the stretch that a step makes beyond its linear part cannot be taken back by any motion: then the rigid
    /// measures hold the sheet at second order, as in the flat state. There must be self stresses for that.
    fn obstructed(&mut self, dx: &[f64]) -> bool {
        let (layout, compliance) = (self.problem.layout(), self.problem.compliance());
        let moved = |part: f64| self.x.iter().zip(dx).map(|(x, d)| x + part * d).collect::<Vec<f64>>();
        let mut linear = vec![0.0; self.tension.len()];
        self.at.rows(layout).product(dx, &mut linear);
        let whole = self.problem.gaps(&moved(1.0));
        let second: Vec<f64> = (0..whole.len()).map(|k| whole[k] - self.at.gaps[k] - linear[k]).collect();
        let scale = self.problem.gap_scale();
        if !compliance.contains(&0.0) || largest_gap(&second, scale) < 10.0 * largest_gap(&linear, scale).max(FEASIBLE)
        {
            return false;
        }
        let length = largest(dx);
        let probe = PROBE * self.problem.unit_of_length();
        let open = problem::missing(&self.problem.gaps(&moved(probe / length.max(probe))), &self.tension, compliance);
        self.saddle.unreachable(layout, &self.at, compliance, &open, UNREACHABLE) > UNREACHABLE
            && self_stresses(self.problem, &self.at).is_some_and(|count| count > 0)
    }

    fn attempt(&mut self, (dx, dt): (&[f64], &[f64]), fraction: f64, last: &Step) -> Option<Trial> {
        let x = self.x.iter().zip(dx).map(|(x, d)| x + fraction * d).collect();
        let tension = self.tension.iter().zip(dt).map(|(t, d)| t + fraction * d).collect();
        let wanted = (CLOSE * last.residual_force).clamp(1e-14, LOOSEST);
        let trial = self.retract(x, tension, wanted, CHORDS).ok()?;
        (trial.merit <= last.energy + self.uncertainty(&trial, last)).then_some(trial)
    }

    /// How much the merits of the last state and of a trial may differ for no reason: rounding error, and what the gaps
    /// still open at the last state weigh by its tension and by that of the trial.
    fn uncertainty(&self, trial: &Trial, last: &Step) -> f64 {
        let open = self.at.missing(&self.tension, self.problem.compliance());
        let tensions = trial.tension.iter().zip(&self.tension);
        let by_gaps: f64 = open.iter().zip(tensions).map(|(gap, (new, old))| (gap * (new - old)).abs()).sum();
        let size = largest(&self.x);
        let by_forces = f64::EPSILON * self.at.largest_force * size * (self.x.len() as f64).sqrt();
        NOISE * last.energy.abs() + by_gaps + 4.0 * by_forces
    }

    /// The scaled force that rounding of the unknowns alone makes: a last place of the largest unknown times the largest
    /// stiffness. It is above the tolerance only where all forces are tiny.
    fn rounding(&self) -> f64 {
        let size = largest(&self.x);
        f64::EPSILON * size * self.at.pattern().largest_diagonal(&self.at.hessian) / self.at.largest_force
    }

    /// Chord corrections onto `m = c t` until the largest scaled gap is `wanted`, or at the level of rounding error.
    /// `Err`: at the rate seen `most` corrections are not enough; the gap reached.
    fn retract(&mut self, mut x: Vec<f64>, mut tension: Vec<f64>, wanted: f64, most: i32) -> Result<Trial, f64> {
        let zero = vec![0.0; x.len()];
        let mut last = f64::INFINITY;
        for left in (0..=most).rev() {
            let gaps = self.problem.gaps(&x);
            let open = problem::missing(&gaps, &tension, self.problem.compliance());
            let size = largest_gap(&open, self.problem.gap_scale());
            let rate = size / last;
            if size <= wanted || (size <= ROUNDING && rate > 0.5) {
                let merit = merit(self.problem, &x, &tension, &gaps);
                return Ok(Trial { x, tension, merit });
            }
            if !(size.is_finite() && rate < 1.0 && size * rate.powi(left) <= wanted.max(ROUNDING)) {
                return Err(size);
            }
            last = size;
            let (dx, dt) = self.saddle.apply(self.problem.layout(), &zero, &open);
            x.iter_mut().zip(&dx).for_each(|(x, d)| *x += d);
            tension.iter_mut().zip(&dt).for_each(|(t, d)| *t += d);
        }
        Err(last)
    }

    /// Accepts a trial; from the first whole step that contracts on, soft elements enter with their full Hessian.
    fn take(&mut self, trial: Trial, fraction: f64, last: &Step) {
        if fraction == 1.0 && last.energy - trial.merit < 0.5 * last.energy.abs() {
            self.curvature = Curvature::Full;
        }
        (self.x, self.tension, self.merit) = (trial.x, trial.tension, trial.merit);
        self.problem.accept(&mut self.x);
        self.merit -= self.problem.relieve(&mut self.x);
    }

    /// Whether rigid measures are independent: then a random stretch can be made by a motion. Soft ones always are. Of `m` rigid
    /// measures' random stretch a self stress keeps about the part `1/sqrt(m)`.
    fn independent(&mut self) -> bool {
        let (layout, compliance) = (self.problem.layout(), self.problem.compliance());
        let rigid = compliance.iter().filter(|c| **c == 0.0).count();
        if rigid == 0 {
            return true;
        }
        let mut random = ChaCha8Rng::seed_from_u64(1);
        let stretch: Vec<f64> = self.at.sizes.iter().map(|size| symmetric(&mut random) * size).collect();
        let reached = REACHED / (rigid as f64).sqrt();
        self.saddle.unreachable(layout, &self.at, compliance, &stretch, reached) <= reached
    }

    /// Negative eigenvalues of the full Hessian at the converged state.
    fn certify(&mut self) -> Result<usize, Failure> {
        if self.near() {
            return Ok(0);
        }
        self.curvature = Curvature::Full;
        self.linearize();
        Ok(self.saddle.inertia(self.problem.layout(), &self.at, self.problem.compliance())?.negative)
    }
}

/// Merit of a state: the energy. Gaps still open enter with their tension, to first order.
fn merit<P: Problem>(problem: &P, x: &[f64], tension: &[f64], gaps: &[f64]) -> f64 {
    let stiff = gaps.iter().zip(tension).zip(problem.compliance()).map(|((gap, t), c)| t * (gap - c * t / 2.0));
    problem.energy(x) + stiff.sum::<f64>()
}

/// Relative residual that the linear system of a step is solved to.
fn accuracy(last: &Step) -> f64 {
    (0.01 * last.residual_force).clamp(FINEST, COARSEST)
}

/// Largest scaled gap.
fn largest_gap(open: &[f64], scale: &[f64]) -> f64 {
    open.iter().zip(scale).fold(0.0, |m, (o, s)| larger(m, o.abs() / s))
}
