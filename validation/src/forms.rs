//! Two other formulations of stiff terms, to compare the program's with: the plain penalty and the method of
//! multipliers.
//!
//! Both are Newton's method with backtracking on `E(x) + sum w (m + t0/gamma)^2 / 2` with `w = 1/(c + 1/gamma)`, `c =
//! 1/k`: the proximal form of the tensions, which are `t = w (m + t0/gamma)`. With `1/gamma = 0` this is the plain
//! penalty `k m^2 / 2`, whose forces carry a rounding error of `k` times that of a length. With a moderate `gamma`
//! nothing is ever multiplied by a large number; the minimisation is repeated with `t0 = t` until `m = c t` (augmented
//! form; R. T. Rockafellar, Math. Oper. Res. 1, 97, 1976). The program itself treats the tensions as unknowns in
//! addition to `x`; see [`foldwell::solver::minimize`].

use foldwell::model::Model;
use foldwell::numerics::factor::FactorError;
use foldwell::numerics::larger;
use foldwell::numerics::tearing::TornFactor;
use foldwell::numerics::vector::max_abs;
use foldwell::solver::{HessianKind, Linearization, Problem, Residuals};

/// Largest total number of Newton steps, and largest number of updates of the tensions.
const STEPS: usize = 200;
const UPDATES: usize = 200;
const TOLERANCE: f64 = 1e-12;
const HALVINGS: i32 = 40;
/// Relative increase of the energy that is attributed to rounding errors. The iteration ends if the expected decrease
/// of the next step is smaller and the force is still more than half of that before the last step.
const NOISE: f64 = 1e-14;
/// First shift of a Hessian that is not positive definite, and the factor by which the shift grows.
const FIRST_SHIFT: f64 = 1e-2;
const RAISE: f64 = 4.0;
const MOST_SHIFT: f64 = 1e30;

/// The formulation of stiff terms.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Form {
    /// The penalty `k m^2 / 2`. Infinite stiffnesses are not possible.
    Penalty,
    /// The augmented form with this weight `gamma` (force per length) and updates of the tensions.
    Augmented(f64),
}

/// The state at which a minimisation ended.
#[derive(Clone, Debug)]
pub struct Minimised {
    /// Unknowns of the model.
    pub x: Vec<f64>,
    /// Tensions of the stiff terms.
    pub tension: Vec<f64>,
    /// Number of accepted Newton steps.
    pub iterations: usize,
    /// Scaled residuals of force and length.
    pub residuals: [f64; 2],
}

/// A minimisation in progress.
struct Weighted<'a> {
    model: &'a mut Model,
    /// The inverse `1/gamma` of the weight; 0 for the plain penalty.
    softness: f64,
    before: Vec<f64>,
    at: Linearization,
    factor: TornFactor,
    x: Vec<f64>,
    iterations: usize,
}

/// Minimises the energy of a model from the drawn state.
///
/// # Errors
/// [`FactorError`] if the pattern of the matrix cannot be analysed; a minimisation that does not converge is not an
/// error.
pub fn minimize(model: &mut Model, form: Form) -> Result<Minimised, FactorError> {
    let at = Linearization::new(model.layout());
    let layout = model.layout();
    let factor = TornFactor::of(layout.tearing()?)?;
    let (x, before) = (model.start(), vec![0.0; layout.stiff.len()]);
    let (softness, updates) = match form {
        Form::Penalty => (0.0, 1),
        Form::Augmented(weight) => (1.0 / weight, UPDATES),
    };
    let mut run = Weighted { model, softness, before, at, factor, x, iterations: 0 };
    let mut best = f64::INFINITY;
    for _ in 0..updates {
        run.descend();
        run.before = run.tension(&run.x);
        let [force, length] = run.residuals();
        if larger(force, length) <= TOLERANCE || run.iterations >= STEPS || !(length < best) {
            break;
        }
        best = length;
    }
    let residuals = run.residuals();
    Ok(Minimised { residuals, tension: run.before, iterations: run.iterations, x: run.x })
}

impl Weighted<'_> {
    fn weight(&self, compliance: f64) -> f64 {
        1.0 / (compliance + self.softness)
    }

    fn tension(&self, x: &[f64]) -> Vec<f64> {
        let of = |((gap, before), c): ((&f64, &f64), &f64)| self.weight(*c) * (gap + self.softness * before);
        self.model.gaps(x).iter().zip(&self.before).zip(self.model.compliance()).map(of).collect()
    }

    fn energy(&self, x: &[f64]) -> f64 {
        let of = |(tension, c): (&f64, &f64)| 0.5 * tension * tension / self.weight(*c);
        self.model.energy(x) + self.tension(x).iter().zip(self.model.compliance()).map(of).sum::<f64>()
    }

    fn residuals(&mut self) -> [f64; 2] {
        self.model.linearize(&self.x, &self.before, HessianKind::Full, &mut self.at);
        let Residuals { force, length } = Residuals::new(&*self.model, &self.at, &self.before);
        [force, length]
    }

    /// Makes Newton steps until the force is small or no step lowers the energy.
    fn descend(&mut self) {
        let mut last = f64::INFINITY;
        while self.iterations < STEPS {
            let tension = self.tension(&self.x);
            self.model.linearize(&self.x, &tension, HessianKind::Full, &mut self.at);
            let force = self.at.force(&tension);
            if force.iter().all(|f| f.abs() <= TOLERANCE * self.at.largest_force) {
                return;
            }
            let size = max_abs(&force);
            let Some((next, gain)) = self.step(&force) else { return };
            if gain <= NOISE * self.energy(&self.x) && size > 0.5 * last {
                return;
            }
            last = size;
            self.x = next;
            self.model.accept(&mut self.x);
            self.iterations += 1;
        }
    }

    /// Returns the state after one step, and the expected decrease of the energy by the full step; `None` if no
    /// fraction of the step lowers the energy.
    fn step(&mut self, force: &[f64]) -> Option<(Vec<f64>, f64)> {
        let mut matrix = self.at.hessian.clone();
        let weights: Vec<f64> = self.model.compliance().iter().map(|c| self.weight(*c)).collect();
        for (row, weight) in weights.iter().enumerate() {
            self.at.add_outer(row, *weight, &mut matrix);
        }
        let outer = self.at.rank_one_terms(1.0, &weights);
        let mut shift = 0.0;
        while !self.factor.factor(self.at.pattern(), &matrix, &outer).is_ok_and(|inertia| inertia.negative == 0) {
            let more = if shift == 0.0 { FIRST_SHIFT } else { (RAISE - 1.0) * shift };
            self.at.pattern().add_to_diagonal(&mut matrix, more);
            shift += more;
            if !(shift < MOST_SHIFT) {
                return None;
            }
        }
        let mut step = force.to_vec();
        self.factor.solve(&mut step);
        let slope: f64 = step.iter().zip(force).map(|(d, f)| d * f).sum();
        let before = self.energy(&self.x);
        (0..HALVINGS).map(|halving| 0.5f64.powi(halving)).find_map(|fraction| {
            let trial: Vec<f64> = self.x.iter().zip(&step).map(|(x, d)| x + fraction * d).collect();
            let most = before * (1.0 + NOISE) - 1e-4 * fraction * slope;
            (self.energy(&trial) <= most).then_some((trial, 0.5 * slope))
        })
    }
}
