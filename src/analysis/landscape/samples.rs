//! Samples of a landscape: patches relaxed with their rest angles held along the modes and free across them.
//!
//! The rest angles are `p = p0 + a phi + C y`. A step of Newton's method moves the patch, its tensions and `y`
//! together; after some of them the patch relaxes at these rest angles, and where torques are left there are more. A
//! step has the gradient `dE/dy = -C^T K (rho - p)` and the Hessian from the response of the equilibrium to each
//! direction of `C`. The response also predicts where the patch relaxes to next, so that one round is mostly enough.

use super::settling::{Settling, TermValues};
use super::taylor_path::HeldState;
use super::{Expansion, HeldSheet, LandscapeError, TaylorPath};
use crate::analysis::relax::{Relaxed, relax_model};
use crate::numerics::larger;
use crate::solver::{Failure, HessianKind, Options, Start, Step};
use nalgebra::DVector;
use thiserror::Error;

/// Most rounds of rest angles.
const ROUNDS: usize = 30;
/// Torque on a direction of rest angles, over what the hinges would exert if all were off by what they are and agreed,
/// at which it is zero; hinges off by less than the least angle count as off by that.
const BALANCED: f64 = 1e-10;
const LEAST_ANGLE: f64 = 1e-4;
/// Tolerance of the relaxations: above the rounding error of forces that are much smaller than the tensions.
pub(crate) const OPTIONS: Options = Options { tolerance: 1e-11, iterations: 200 };
/// Accuracy of the linear solves for a step of the rest angles.
const ROUGH: f64 = 1e-7;
/// Most steps of a round, and the last step over the rest angles after which no other is needed: its square is left.
const JOINT: usize = 3;
const CLOSE: f64 = 1e-3;
/// Longest change of a rest angle in a step, in radians.
const LONGEST_ANGLE_STEP_RAD: f64 = 0.3;

/// Rounding errors of an angle or a length in its evaluation.
const ROUNDINGS: f64 = 4.0;
/// Energies above so many times what rounding makes are right to a fifth at least: the error of `k (off + e)^2 / 2`
/// with `e` that of `k e^2 / 2` and `off` ten times as large.
const ABOVE: f64 = 100.0;

/// One sample.
#[derive(Clone, Debug)]
pub struct Sample {
    /// The amplitude.
    pub amplitude: f64,
    /// The relaxed patch.
    pub relaxed: Relaxed,
    /// Its uniform rest angles less those drawn, by edge of the cell.
    pub rest: Vec<f64>,
    /// Newton steps of all relaxations, and relaxations.
    pub iterations: usize,
    /// How often rest angles were moved.
    pub rounds: usize,
    /// Energy that rounding of the hinges' angles and of the bars' lengths alone may make.
    pub rounding: f64,
}

impl Sample {
    /// Whether so much of the energy may be rounding that it says nothing about the mode.
    pub fn below_rounding(&self) -> bool {
        !(self.relaxed.state.total() >= ABOVE * self.rounding)
    }
}

/// Why a sample is missing.
#[derive(Debug, Error)]
#[allow(missing_docs)] // each variant is documented by its message
pub enum SampleError {
    #[error("a relaxation failed: {0}")]
    Relaxation(Failure),
    #[error(transparent)]
    Landscape(#[from] LandscapeError),
    #[error("the rest angles do not settle: a torque of {torque:.2e} of the largest is left")]
    Restless { torque: f64 },
    #[error("there is no energy beside the exact cone: its zero cannot be found")]
    NoEnergy,
}

/// Samples along one mode, each from the one before.
pub struct Samples<'a> {
    held: &'a mut HeldSheet,
    course: TaylorPath,
    /// Amplitude and place of the last one.
    last: (f64, HeldState),
}

impl<'a> Samples<'a> {
    /// Along this course, from the drawn state.
    pub fn new(held: &'a mut HeldSheet, course: TaylorPath) -> Self {
        let place = HeldState { x: held.drawn(), ..held.still() };
        Self { held, course, last: (0.0, place) }
    }

    /// The sample at an amplitude, from the last one.
    ///
    /// # Errors
    /// [`SampleError`] where the relaxation does not converge.
    pub fn at(&mut self, amplitude: f64, observe: &mut dyn FnMut(&Step) -> bool) -> Result<Sample, SampleError> {
        let (from, mut place) = self.last.clone();
        self.course.advance(&mut place, from, amplitude);
        let (mut iterations, mut torque) = (0, f64::INFINITY);
        let directions = self.held.directions();
        for rounds in 0..ROUNDS {
            match self.approach(&mut place, amplitude) {
                Ok(steps) => iterations += steps,
                Err(_) if rounds == 0 => {} // not stable where the course leads: the relaxation finds its way
                Err(error) => return Err(error.into()),
            }
            let rest = self.rest(&place, amplitude);
            self.held.set_rest(rest.as_slice());
            let start = Start { x: place.x, tension: Some(place.tension) };
            let (relaxed, model, x) = relax_model(self.held.model.clone(), start, OPTIONS, observe)
                .map_err(|error| SampleError::Relaxation(error.failure))?;
            self.held.model = model;
            iterations += relaxed.iterations;
            let tension = relaxed.configuration.tension.clone().unwrap_or_default();
            place = HeldState { x, tension, rest: place.rest };
            torque = unbalanced(self.held, &directions, &place);
            if torque <= BALANCED {
                let (rest, rounding) = (rest.as_slice().to_vec(), rounding(self.held, &place));
                self.last = (amplitude, place);
                return Ok(Sample { amplitude, relaxed, rest, iterations, rounds, rounding });
            }
        }
        Err(SampleError::Restless { torque })
    }

    /// Uniform rest angles less those drawn.
    fn rest(&self, place: &HeldState, amplitude: f64) -> DVector<f64> {
        DVector::from_column_slice(&self.course.rates) * amplitude + &self.held.free * &place.rest
    }

    /// Joint steps of rest angles, unknowns and tensions, and how many; none where all rest angles are held.
    fn approach(&mut self, place: &mut HeldState, amplitude: f64) -> Result<usize, LandscapeError> {
        if self.held.free.ncols() == 0 {
            return Ok(0);
        }
        for steps in 1..=JOINT {
            self.held.set_rest(self.rest(place, amplitude).as_slice());
            let at = (place.x.as_slice(), place.tension.as_slice());
            let step = Settling::new(self.held, at, HessianKind::Full, ROUGH)?.joint(at, LONGEST_ANGLE_STEP_RAD)?;
            place.add(1.0, &step);
            if step.rest.amax() <= CLOSE * place.rest.amax() {
                return Ok(steps);
            }
        }
        Ok(JOINT)
    }
}

/// The energy of all soft elements if each were off its rest value by the rounding of its value.
fn rounding(held: &HeldSheet, place: &HeldState) -> f64 {
    let off = |value: &f64| ROUNDINGS * f64::EPSILON * value.abs().max(1.0);
    let soft = held.model.soft().zip(held.model.values(&place.x));
    soft.map(|(element, value)| 0.5 * element.spring.stiffness * off(&value).powi(2)).sum()
}

/// The largest torque on a direction of rest angles, over its size.
fn unbalanced(held: &HeldSheet, directions: &[TermValues], place: &HeldState) -> f64 {
    let model = &held.model;
    let springs = model.soft().map(|element| element.spring.stiffness).zip(model.off_rest(&place.x));
    let (torques, least): (Vec<f64>, Vec<f64>) =
        springs.map(|(k, off)| (k * off, k * off.abs().max(LEAST_ANGLE))).unzip();
    let sum = |soft: &[f64], stiff: &[f64], weigh: fn(f64) -> f64| -> DVector<f64> {
        let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| weigh(a * b)).sum::<f64>();
        DVector::from_vec(directions.iter().map(|(on, along)| product(soft, on) + product(stiff, along)).collect())
    };
    let torque = sum(&torques, &place.tension, |value| value);
    let size = sum(&least, &place.tension, f64::abs);
    // no hinge stands over some edges: no torque is on them
    let over = |(torque, size): (&f64, &f64)| if *size == 0.0 { 0.0 } else { torque.abs() / size };
    torque.iter().zip(size.iter()).map(over).fold(0.0, larger)
}

/// What a landscape along one mode says.
pub struct Landscape {
    /// The samples, and why the last one is missing if it is.
    pub samples: Vec<Sample>,
    /// Why the next sample is missing.
    pub failure: Option<SampleError>,
    /// The coefficients without any fit.
    pub predicted: Expansion,
}

/// Samples along a mode, by rising amplitude, as far as they go.
///
/// # Errors
/// [`LandscapeError`] where the response of the sheet cannot be computed.
pub fn landscape(
    held: &mut HeldSheet,
    rates: Vec<f64>,
    amplitudes: &[f64],
    observe: &mut dyn FnMut(&Step) -> bool,
) -> Result<Landscape, LandscapeError> {
    let (predicted, course) = Expansion::with_course(held, &rates)?;
    let mut along = Samples::new(held, course);
    let (mut samples, mut failure) = (Vec::new(), None);
    for &amplitude in amplitudes {
        match along.at(amplitude, observe) {
            Ok(sample) => samples.push(sample),
            Err(error) => {
                failure = Some(error);
                break;
            }
        }
    }
    Ok(Landscape { samples, failure, predicted })
}
