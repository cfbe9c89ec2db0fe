//! Newton's method with retraction onto the stiff measures, uniform in their stiffness.
//!
//! One iteration: linearize; factor, with a shift raised until the inertia is that of a minimum; take the whole step in
//! `(x, t)`; pull the state back onto `m = c t` by a few chord corrections with the same factorization (in `x` *and*
//! `t`); accept when the merit `E + sum c t^2 / 2` fell. On retracted states the merit is the true energy, without
//! cancellation at any stiffness; the iterates stay on the folded surfaces, where the physics is. Far from the
//! solution soft elements enter with their Gauss-Newton Hessian, once steps contract with the full one.

use super::problem::{Curvature, Linearization, Problem};
use super::saddle::Saddle;
use crate::numerics::factor::FactorError;
use thiserror::Error;

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
    /// Fraction of the Newton step taken to get here.
    pub fraction: f64,
    /// Shift of the Hessian, relative to its largest diagonal entry.
    pub shift: f64,
    /// Factorizations made so far.
    pub factorizations: usize,
    /// Solves made so far, chord corrections included.
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
    /// Smallest over largest pivot of the last factorization: tiny where the equilibrium is not isolated.
    pub pivot_ratio: f64,
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
    #[error("not converged after {iterations} steps: residual force {force:.2e}, residual length {length:.2e}")]
    TooManySteps {
        /// Steps taken.
        iterations: usize,
        /// Scaled residual force.
        force: f64,
        /// Scaled residual length.
        length: f64,
    },
    /// The linear algebra failed.
    #[error(transparent)]
    Factor(#[from] FactorError),
    /// The observer asked to stop.
    #[error("stopped on request")]
    Interrupted,
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

/// The iteration's state and its workspaces.
struct Newton<'a, P: Problem> {
    problem: &'a mut P,
    at: Linearization,
    saddle: Saddle,
    x: Vec<f64>,
    tension: Vec<f64>,
    /// Shift of the next factorization, relative to the scale of the Hessian.
    shift: f64,
    curvature: Curvature,
    history: Vec<Step>,
}

/// A retracted trial state.
struct Trial {
    x: Vec<f64>,
    tension: Vec<f64>,
    merit: f64,
    fraction: f64,
}

/// Minimises from `x`. `observe` sees every accepted step and returns false to stop.
pub fn minimize<P: Problem>(
    problem: &mut P,
    x: Vec<f64>,
    options: Options,
    observe: &mut dyn FnMut(&Step) -> bool,
) -> Result<Equilibrium, NewtonError> {
    let at = Linearization::new(problem.layout());
    let rows = problem.layout().stiff.len();
    let saddle = match Saddle::new(problem.layout(), &at) {
        Ok(saddle) => saddle,
        Err(error) => {
            return Err(NewtonError { failure: error.into(), x, tension: vec![0.0; rows], history: vec![] });
        }
    };
    let mut newton = Newton {
        problem,
        at,
        saddle,
        x,
        tension: vec![0.0; rows],
        shift: 0.0,
        curvature: Curvature::GaussNewton,
        history: vec![],
    };
    match newton.run(options, observe) {
        Ok((negative_eigenvalues, pivot_ratio)) => Ok(Equilibrium {
            energy: newton.merit(&newton.x, &newton.tension).0,
            x: newton.x,
            tension: newton.tension,
            negative_eigenvalues,
            pivot_ratio,
            history: newton.history,
        }),
        Err(failure) => Err(NewtonError { failure, x: newton.x, tension: newton.tension, history: newton.history }),
    }
}

impl<P: Problem> Newton<'_, P> {
    fn run(&mut self, options: Options, observe: &mut dyn FnMut(&Step) -> bool) -> Result<(usize, f64), Failure> {
        self.linearize();
        self.start()?;
        let mut fraction = 1.0;
        loop {
            self.linearize();
            let step = self.step(fraction);
            self.history.push(step);
            if !observe(&step) {
                return Err(Failure::Interrupted);
            }
            let (force, length) = (step.residual_force, step.residual_length);
            if force <= options.tolerance && length <= options.tolerance {
                return self.certify();
            }
            if self.history.len() > options.iterations {
                return Err(Failure::TooManySteps { iterations: options.iterations, force, length });
            }
            fraction = self.advance(&step)?;
        }
    }

    fn linearize(&mut self) {
        self.problem.linearize(&self.x, &self.tension, self.curvature, &mut self.at);
    }

    /// Pulls the start onto the stiff measures.
    fn start(&mut self) -> Result<(), Failure> {
        self.factor()?;
        let trial = self.retract(self.x.clone(), self.tension.clone(), 1e-10, 50);
        let trial = trial.map_err(|gap| Failure::Infeasible { gap })?;
        (self.x, self.tension) = (trial.x, trial.tension);
        self.problem.accept(&mut self.x);
        Ok(())
    }

    fn step(&self, fraction: f64) -> Step {
        let force = self.at.force(self.problem.layout(), &self.tension);
        let unbalanced = force.iter().fold(0.0f64, |m, f| m.max(f.abs()));
        let (energy, gap) = self.merit(&self.x, &self.tension);
        Step {
            energy,
            residual_force: if unbalanced > 0.0 { unbalanced / self.at.largest_force } else { 0.0 },
            residual_length: gap,
            fraction,
            shift: self.shift,
            factorizations: self.saddle.factorizations,
            solves: self.saddle.solves,
        }
    }

    /// Merit and largest scaled gap of a state. The gaps still open enter with their tension, to first order.
    fn merit(&self, x: &[f64], tension: &[f64]) -> (f64, f64) {
        let mut gaps = vec![0.0; tension.len()];
        let mut merit = self.problem.evaluate(x, &mut gaps);
        let mut largest = 0.0f64;
        let (compliance, scale) = (self.problem.compliance(), self.problem.gap_scale());
        for (k, (gap, t)) in gaps.iter().zip(tension).enumerate() {
            let open = gap - compliance[k] * t;
            merit += t * (compliance[k] * t / 2.0 + open);
            largest = nan_max(largest, open.abs() / scale[k]);
        }
        (merit, largest)
    }

    /// Factors with the smallest shift, from the last one's tenth upwards, at which the Hessian is that of a minimum.
    fn factor(&mut self) -> Result<(), Failure> {
        let scale = Saddle::scale(&self.at).max(f64::MIN_POSITIVE);
        let mut shift = if self.shift > 1e-10 { self.shift / 10.0 } else { 0.0 };
        for _ in 0..40 {
            let found = self.saddle.factor(self.problem.layout(), &self.at, self.problem.compliance(), shift * scale);
            match found {
                Ok(inertia) if inertia.negative == 0 => {
                    self.shift = shift;
                    return Ok(());
                }
                Err(error @ FactorError::NotFinite) => return Err(error.into()),
                _ => shift = if shift == 0.0 { 1e-8 } else { 4.0 * shift },
            }
        }
        Err(FactorError::Singular { ratio: 0.0 }.into())
    }

    /// One accepted step; returns the fraction of the Newton step that was taken.
    fn advance(&mut self, last: &Step) -> Result<f64, Failure> {
        self.factor()?;
        for _ in 0..12 {
            let (dx, dt) = self.direction();
            let mut fraction = 1.0;
            for _ in 0..5 {
                if let Some(trial) = self.attempt(&dx, &dt, fraction, last) {
                    self.take(trial, last);
                    return Ok(fraction);
                }
                fraction /= 2.0;
            }
            self.shift = (10.0 * self.shift).max(1e-4) * 10.0;
            self.factor()?;
        }
        Err(Failure::Stuck { force: last.residual_force, length: last.residual_length })
    }

    fn direction(&mut self) -> (Vec<f64>, Vec<f64>) {
        let layout = self.problem.layout();
        let compliance = self.problem.compliance();
        let force = self.at.force(layout, &self.tension);
        let gaps: Vec<f64> =
            self.at.gaps.iter().zip(&self.tension).zip(compliance).map(|((m, t), c)| c * t - m).collect();
        let (dx, dt, size) = self.saddle.solve(layout, &self.at, compliance, (&force, &gaps), 1e-8);
        if std::env::var("FW_DEBUG").is_ok() {
            eprintln!(
                "  solve residual {size:.1e} solves {} |dx| {:.2e}",
                self.saddle.solves,
                dx.iter().fold(0.0f64, |m, v| m.max(v.abs()))
            );
        }
        (dx, dt)
    }

    fn attempt(&mut self, dx: &[f64], dt: &[f64], fraction: f64, last: &Step) -> Option<Trial> {
        let x = self.x.iter().zip(dx).map(|(x, d)| x + fraction * d).collect();
        let tension = self.tension.iter().zip(dt).map(|(t, d)| t + fraction * d).collect();
        let wanted = (1e-3 * last.residual_force).clamp(1e-14, 1e-8);
        let trial = self.retract(x, tension, wanted, 12);
        if std::env::var("FW_DEBUG").is_ok() {
            eprintln!("   fraction {fraction} retract {:?} merit {} ", trial.as_ref().map(|t| t.merit), last.energy);
        }
        let mut trial = trial.ok()?;
        trial.fraction = fraction;
        let noise = 1e-13 * last.energy.abs();
        (trial.merit <= last.energy + noise).then_some(trial)
    }

    /// Chord corrections onto `m = c t` until the largest scaled gap is `wanted` or no longer falls at `wanted`'s
    /// level. `Err`: they do not contract; the gap reached.
    fn retract(&mut self, mut x: Vec<f64>, mut tension: Vec<f64>, wanted: f64, most: usize) -> Result<Trial, f64> {
        let mut gaps = vec![0.0; tension.len()];
        let mut last = f64::INFINITY;
        for _ in 0..=most {
            self.problem.evaluate(&x, &mut gaps);
            let compliance = self.problem.compliance();
            let open: Vec<f64> = gaps.iter().zip(&tension).zip(compliance).map(|((m, t), c)| c * t - m).collect();
            let scale = self.problem.gap_scale();
            let size = open.iter().zip(scale).fold(0.0, |m, (o, s)| nan_max(m, o.abs() / s));
            if std::env::var("FW_DEBUG").is_ok_and(|v| v == "2") {
                eprintln!("     gap {size:.2e}");
            }
            if size <= wanted || (size <= 1e-12 && size > 0.5 * last) {
                let merit = self.merit(&x, &tension).0;
                return Ok(Trial { x, tension, merit, fraction: 1.0 });
            }
            if !(size < 0.9 * last) {
                return Err(size);
            }
            last = size;
            let zero = vec![0.0; x.len()];
            let (dx, dt) = self.saddle.apply(self.problem.layout(), &self.at, &zero, &open);
            x.iter_mut().zip(&dx).for_each(|(x, d)| *x += d);
            tension.iter_mut().zip(&dt).for_each(|(t, d)| *t += d);
        }
        Err(last)
    }

    fn take(&mut self, trial: Trial, last: &Step) {
        let fell = last.energy - trial.merit;
        (self.x, self.tension) = (trial.x, trial.tension);
        self.problem.accept(&mut self.x);
        if trial.fraction == 1.0 && fell < 0.5 * last.energy.abs() {
            self.curvature = Curvature::Full;
        }
    }

    /// Inertia of the full Hessian at the converged state.
    fn certify(&mut self) -> Result<(usize, f64), Failure> {
        self.curvature = Curvature::Full;
        self.linearize();
        let inertia = self.saddle.factor(self.problem.layout(), &self.at, self.problem.compliance(), 0.0)?;
        Ok((inertia.negative, inertia.ratio))
    }
}

/// Like `f64::max`, but a NaN wins.
fn nan_max(a: f64, b: f64) -> f64 {
    if a > b || a.is_nan() { a } else { b }
}
