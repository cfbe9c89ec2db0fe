//! A problem with a parameter, and its states.

use crate::linearization::Linearization;
use crate::problem::Problem;
use foldwell_numerics::vector::add_scaled;
use serde::{Deserialize, Serialize};

/// A problem that depends on one parameter.
pub trait ParametrizedProblem: Problem {
    /// The parameter.
    fn parameter(&self) -> f64;
    /// Sets the parameter.
    fn set_parameter(&mut self, value: f64);
    /// Returns what the way up to the state with these unknowns, at the present parameter, has changed in the problem:
    /// values from which measures continue, and what elements remember.
    fn reference(&self, _x: &[f64]) -> Vec<f64> {
        vec![]
    }
    /// Restores what [`ParametrizedProblem::reference`] returned.
    fn set_reference(&mut self, _reference: &[f64]) {}
    /// Returns how states are written as unknowns, by a choice made at a state of the path; empty for that of the
    /// beginning.
    fn choice(&self) -> Vec<f64> {
        vec![]
    }
    /// Restores what [`ParametrizedProblem::choice`] returned; the layout may be another one then, as after
    /// [`Problem::choose_anew`].
    fn set_choice(&mut self, _choice: &[f64]) {}
    /// Whether stiffness jumps along paths, as where elements yield: no interpolation between states is good there.
    fn has_kinks(&self) -> bool {
        false
    }
    /// Whether stiffness jumps at some states: steps to there need not look smooth.
    fn may_have_kinks(&self) -> bool {
        self.has_kinks()
    }
    /// The integral of the conjugate over the parameter along equilibria, up to a constant: the potential; NaN if it is
    /// not known.
    fn conjugate_integral(&self, _x: &[f64], _tension: &[f64]) -> f64 {
        f64::NAN
    }
    /// Natural size of a change of the parameter; positive.
    fn parameter_scale(&self) -> f64;
    /// Rates by the parameter, at fixed unknowns and tensions, of the gradient of the energy (tensions of stiff
    /// measures included) and of the stretches `m - c t` of the stiff measures.
    fn parameter_rates(&self, at: &Linearization, x: &[f64], tension: &[f64]) -> [Vec<f64>; 2];
    /// The quantity that is conjugate to the parameter in these states.
    fn conjugate(&self, at: &Linearization, x: &[f64], tension: &[f64]) -> f64;
    /// Rate of [`ParametrizedProblem::conjugate`] for these rates of unknowns, tensions and parameter.
    fn conjugate_rate(&self, at: &Linearization, x: &[f64], tension: &[f64], rates: &Rates) -> f64;
}

/// Rates of a state, or a difference of two states, or a state by itself.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Rates {
    /// Rates of the unknowns.
    pub x: Vec<f64>,
    /// Rates of the tensions of the stiff measures.
    pub tension: Vec<f64>,
    /// Rate of the parameter.
    pub parameter: f64,
}

/// An equilibrium on a path.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PathState {
    /// Arc length from the beginning of the branch. Its square is that of the unknowns' root mean square, in their unit
    /// of length, plus that of the parameter in units of its scale.
    pub arc_length: f64,
    /// Unknowns.
    pub x: Vec<f64>,
    /// Tensions of the stiff measures.
    pub tension: Vec<f64>,
    /// The parameter.
    pub parameter: f64,
    /// Unit tangent of the path, by arc length.
    pub tangent: Rates,
    /// The conjugate quantity, and its rate by arc length.
    pub conjugate: [f64; 2],
    /// Scaled residual force.
    pub residual_force: f64,
    /// Scaled residual length.
    pub residual_length: f64,
    /// Negative eigenvalues of the Hessian at fixed parameter with these tensions; `None` where their number cannot be
    /// established.
    pub negative_eigenvalues: Option<usize>,
    /// Work of the rates by the parameter along the tangent. Its sign tells which way an eigenvalue goes where the
    /// parameter turns.
    pub work_along: f64,
    /// Rates of the parameter and of the conjugate quantity up to which they are rounding errors.
    pub rate_errors: [f64; 2],
    /// Number of Newton steps that led to the state, those to states that were refused before it included.
    pub iterations: usize,
    /// How the state is written; see [`ParametrizedProblem::choice`].
    pub choice: Vec<f64>,
}

/// Both ends of a piece of a path.
pub(super) type Ends<'a> = [&'a PathState; 2];

impl PathState {
    /// Unknowns, tensions and parameter.
    pub(super) fn place(&self) -> Rates {
        Rates { x: self.x.clone(), tension: self.tension.clone(), parameter: self.parameter }
    }

    /// The state with a tangent this many times as long, and the rates along it; backwards for `-1.0`.
    pub(super) fn scaled(mut self, factor: f64) -> Self {
        self.tangent = self.tangent.scaled(factor);
        self.conjugate[1] *= factor;
        self.work_along *= factor;
        self
    }
}

impl Rates {
    /// Adds a multiple of other rates.
    pub(super) fn add(&mut self, part: f64, other: &Self) {
        add_scaled(&mut self.x, part, &other.x);
        add_scaled(&mut self.tension, part, &other.tension);
        self.parameter += part * other.parameter;
    }

    /// These rates times a factor.
    pub(super) fn scaled(mut self, factor: f64) -> Self {
        self.x.iter_mut().chain(&mut self.tension).for_each(|rate| *rate *= factor);
        self.parameter *= factor;
        self
    }
}
