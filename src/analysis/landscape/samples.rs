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
use crate::numerics::vector::{moved, norm_blocked};
use crate::solver::{Failure, HessianKind, Options, Start, Step};
use nalgebra::DVector;
use std::ops::RangeInclusive;
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

/// Exponents of the energy between the drawn state and the first sample, about 4 or 6 where the sheet stays in its
/// minimum; and what the energy may be off a power of the amplitude between two others, as its logarithm: other minima
/// are off by 3 and more.
const EXPONENTS: RangeInclusive<f64> = 3.0..=7.0;
const OFF_POWER: f64 = 0.2;
/// Distance from the predicted place, over that from the drawn one, within which the first sample is on its course.
const ON_COURSE: f64 = 0.1;
/// Largest number of amplitudes tried on the way to a sample.
const MOST_BETWEEN: usize = 16;

/// Rounding errors of an angle or a length in its evaluation.
const ROUNDINGS: f64 = 4.0;
/// Energies above so many times what rounding makes are right to a fifth at least: the error of `k (off + e)^2 / 2`
/// with `e` that of `k e^2 / 2` and `off` ten times as large.
const ABOVE: f64 = 100.0;
/// Torque on the mode over what rounding may make of it above which it tells the power of the energy.
const CLEAR: f64 = 10.0;

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
    /// Whether it is in another minimum than the sample before: no smaller steps led on in that one.
    pub other_minimum: bool,
}

impl Sample {
    /// Whether so much of the energy may be rounding that it says nothing about the mode.
    pub fn below_rounding(&self) -> bool {
        !(self.relaxed.state.total() >= ABOVE * self.rounding)
    }

    /// Whether fits of energies by powers of the amplitude take it in.
    pub fn is_fitted(&self) -> bool {
        !self.below_rounding() && !self.other_minimum
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
pub struct Samples {
    held: HeldSheet,
    course: TaylorPath,
    /// Coordinates that are held against rigid motions in the drawn sheet: the course is one of the others.
    gauge: Vec<bool>,
    last: SettledState,
}

/// Where a sheet settles at an amplitude.
#[derive(Clone)]
struct SettledState {
    amplitude: f64,
    at: HeldState,
    /// The energy and its rate by the amplitude, the torque on the mode; not numbers where they may be rounding.
    energy: f64,
    rate: f64,
    /// Distance from where its course predicted it, over that from the place before.
    off_course: f64,
}

impl SettledState {
    /// Whether the energy can have grown as a power of the amplitude from that at another place on: the sheet has then
    /// not gone over to another minimum. From the drawn state on it grows about as the fourth power, or the sixth.
    fn continues(&self, from: &Self) -> bool {
        let exponent = |place: &Self| place.amplitude * place.rate / place.energy;
        if [self, from].iter().any(|place| place.energy.is_nan() || place.rate.is_nan()) {
            return true;
        }
        if from.amplitude == 0.0 {
            // next to a mode that costs nothing the energy is no power, but the course is known
            return self.off_course <= ON_COURSE || EXPONENTS.contains(&exponent(self));
        }
        let growth = 0.5 * (exponent(from) + exponent(self)) * (self.amplitude / from.amplitude).ln();
        ((self.energy / from.energy).ln() - growth).abs() <= OFF_POWER
    }
}

impl Samples {
    /// Along this course, from the drawn state.
    pub fn new(held: &HeldSheet, course: TaylorPath) -> Self {
        let mut held = held.clone();
        let at = HeldState { x: held.drawn(), ..held.still() };
        let gauge = held.model.held();
        Self { held, course, gauge, last: SettledState { amplitude: 0.0, at, energy: 0.0, rate: 0.0, off_course: 0.0 } }
    }

    /// The sample at an amplitude, from the last one; by way of amplitudes in between where one step leads to another
    /// minimum than the one that the sheet is in, or to none.
    ///
    /// # Errors
    /// [`SampleError`] where the relaxation does not converge.
    pub fn at(&mut self, amplitude: f64, observe: &mut dyn FnMut(&Step) -> bool) -> Result<Sample, SampleError> {
        let (mut next, mut left, mut iterations) = (amplitude, MOST_BETWEEN, 0);
        // the first sample at the amplitude that is another minimum, should no smaller steps lead there
        let mut elsewhere = None;
        loop {
            let (model, from) = (self.held.model.clone(), self.last.clone());
            let found = self.step_to(next, observe);
            let is_interrupted = matches!(found, Err(SampleError::Relaxation(Failure::Interrupted)));
            let continues = found.is_ok() && self.last.continues(&from);
            iterations += found.as_ref().map_or(0, |sample| sample.iterations);
            if !continues && left > 0 && !is_interrupted {
                if let (Ok(sample), true, None) = (found, next == amplitude, &elsewhere) {
                    elsewhere = Some((sample, self.held.model.clone(), self.last.clone()));
                }
                next = if from.amplitude > 0.0 { (from.amplitude * next).sqrt() } else { 0.5 * next };
                (self.held.model, self.last, left) = (model, from, left - 1);
            } else if found.is_err()
                && !is_interrupted
                && let Some((sample, model, last)) = elsewhere.take()
            {
                (self.held.model, self.last) = (model, last);
                return Ok(Sample { iterations, other_minimum: true, ..sample });
            } else if next == amplitude || found.is_err() {
                return found.map(|sample| Sample { iterations, other_minimum: !continues, ..sample });
            } else {
                next = amplitude;
            }
        }
    }

    /// The sample at an amplitude, in one step from the last one.
    fn step_to(&mut self, amplitude: f64, observe: &mut dyn FnMut(&Step) -> bool) -> Result<Sample, SampleError> {
        let SettledState { amplitude: from, at: mut place, .. } = self.last.clone();
        let before = self.held.model.coordinates(&place.x);
        if self.held.model.held() == self.gauge {
            self.course.advance(&mut place, from, amplitude);
        }
        let predicted = self.held.model.coordinates(&place.x);
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
            torque = unbalanced(&self.held, &directions, &place);
            if torque <= BALANCED {
                let (rest, rounding) = (rest.as_slice().to_vec(), rounding(&self.held, &place));
                let sample = Sample { amplitude, relaxed, rest, iterations, rounds, rounding, other_minimum: false };
                let energy = if sample.below_rounding() { f64::NAN } else { sample.relaxed.state.total() };
                let rate = self.rate(&place);
                let off = |other: &[f64]| norm_blocked(&moved(&sample.relaxed.state.coordinates, -1.0, other));
                let off_course = off(&predicted) / off(&before);
                self.last = SettledState { amplitude, at: place, energy, rate, off_course };
                return Ok(sample);
            }
        }
        Err(SampleError::Restless { torque })
    }

    /// Rate of the energy by the amplitude: what the hinges exert on rest angles that move along the mode. Not a number
    /// where rounding of their angles may make a good part of it.
    fn rate(&self, place: &HeldState) -> f64 {
        let (model, (soft, stiff)) = (&self.held.model, self.held.spread(&self.course.rates));
        let by_hinge: Vec<f64> = model.soft().zip(&soft).map(|(hinge, along)| hinge.spring.stiffness * along).collect();
        let of_soft = by_hinge.iter().zip(model.off_rest(&place.x)).map(|(torque, off)| torque * off).sum::<f64>();
        let of_stiff = place.tension.iter().zip(&stiff).map(|(tension, along)| tension * along).sum::<f64>();
        let rate = -of_soft - of_stiff;
        let errors = model.values(&place.x).into_iter().map(rounding_of);
        let noise = by_hinge.iter().zip(errors).map(|(torque, error)| torque.abs() * error).sum::<f64>();
        if rate.abs() > CLEAR * noise { rate } else { f64::NAN }
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
            let step = Settling::new(&self.held, at, HessianKind::Full, ROUGH)?.joint(at, LONGEST_ANGLE_STEP_RAD)?;
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
    let soft = held.model.soft().zip(held.model.values(&place.x));
    soft.map(|(element, value)| 0.5 * element.spring.stiffness * rounding_of(value).powi(2)).sum()
}

/// The rounding error of an angle or a length.
fn rounding_of(value: f64) -> f64 {
    ROUNDINGS * f64::EPSILON * value.abs().max(1.0)
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
    held: &HeldSheet,
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
