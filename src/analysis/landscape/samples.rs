//! Samples of a landscape: patches relaxed with their rest angles held along the modes and free across them.
//!
//! The rest angles are `p = p0 + a phi + C y`. A step of Newton's method moves the patch, its tensions and `y` together; after some
//! of them the patch relaxes at these rest angles, and where torques are left there are more. A step has the gradient
//! `dE/dy = -C^T K (rho - p)` and the Hessian from the response of the equilibrium to each direction of `C`. The response also
//! predicts where the patch relaxes to next, so that one round is mostly enough.

use super::settling::{Both, Settling};
use super::{Course, Expansion, HeldSheet, LandscapeError};
use crate::analysis::relax::{Relaxed, relax};
use crate::solver::{Curvature, Failure, Options, Problem, Start, Step};
use nalgebra::DVector;
use thiserror::Error;

/// Most rounds of rest angles.
const ROUNDS: usize = 30;
/// Torque on a direction of rest angles, over what the hinges would exert if all were off by what they are and agreed,
/// at which it is zero; hinges off by less than the least angle count as off by that.
const BALANCED: f64 = 1e-10;
const LEAST_ANGLE: f64 = 1e-4;
/// Tolerance of the relaxations: above the rounding error of forces that are much smaller than the tensions.
pub const OPTIONS: Options = Options { tolerance: 1e-11, iterations: 200 };
/// Accuracy of the linear solves for a step of the rest angles.
const ROUGH: f64 = 1e-7;
/// Most steps of a round, and the last step over the rest angles after which no other is needed: its square is left.
const JOINT: usize = 3;
const CLOSE: f64 = 1e-5;
/// Longest change of a rest angle in a step, in radians.
const LONGEST: f64 = 0.3;

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
}

/// Why a sample is missing.
#[derive(Debug, Error)]
pub enum SampleError {
    /// A relaxation failed.
    #[error("a relaxation failed: {0}")]
    Relaxation(Failure),
    /// The response of the patch is not known.
    #[error(transparent)]
    Landscape(#[from] LandscapeError),
    /// The rest angles do not settle.
    #[error("the rest angles do not settle: a torque of {torque:.2e} of the largest is left")]
    Restless {
        /// What is left.
        torque: f64,
    },
}

/// The last sample.
struct Last {
    amplitude: f64,
    x: Vec<f64>,
    tension: Vec<f64>,
    /// Rest angles across the modes.
    rest: DVector<f64>,
}

/// Samples along one mode, each from the one before.
pub struct Samples<'a> {
    held: &'a mut HeldSheet,
    course: Course,
    last: Last,
}

impl<'a> Samples<'a> {
    /// Along this course, from the drawn state.
    pub fn new(held: &'a mut HeldSheet, course: Course) -> Self {
        let (x, tension) = (held.drawn(), vec![0.0; held.model.compliance().len()]);
        let last = Last { amplitude: 0.0, x, tension, rest: DVector::zeros(held.free.ncols()) };
        Self { held, course, last }
    }

    /// The sample at an amplitude, from the last one.
    pub fn at(&mut self, amplitude: f64, observe: &mut dyn FnMut(&Step) -> bool) -> Result<Sample, SampleError> {
        let (last, course) = (&self.last, &self.course);
        let sum = |values: &[f64], change: &mut dyn Iterator<Item = f64>| -> Vec<f64> {
            values.iter().zip(change).map(|(value, change)| value + change).collect()
        };
        let mut x = sum(&last.x, &mut course.motion(last.amplitude, amplitude));
        let mut tension = sum(&last.tension, &mut course.pull(last.amplitude, amplitude));
        let mut y = &last.rest + course.settling(last.amplitude, amplitude);
        let (mut iterations, mut torque) = (0, f64::INFINITY);
        let directions = self.held.directions();
        for rounds in 0..ROUNDS {
            for _ in 0..JOINT {
                self.held.set_rest(self.rest(amplitude, &y).as_slice());
                let (step, (motion, pull)) = match self.step((&x, &tension)) {
                    Ok(Some(step)) => step,
                    Err(error) if rounds > 0 => return Err(error.into()),
                    _ => break, // nothing to move, or the sheet is not stable where second order says that it is
                };
                x = sum(&x, &mut motion.into_iter());
                tension = sum(&tension, &mut pull.into_iter());
                y += &step;
                iterations += 1;
                if step.amax() <= CLOSE * y.amax() {
                    break;
                }
            }
            let rest = self.rest(amplitude, &y);
            self.held.set_rest(rest.as_slice());
            let edges = self.held.model.layout().soft.len() + self.held.model.layout().stiff.len();
            let start = Start { x, tension: Some(tension) };
            let relaxed = relax(&mut self.held.model, start, OPTIONS, edges, observe)
                .map_err(|error| SampleError::Relaxation(error.failure))?;
            iterations += relaxed.iterations;
            torque = unbalanced(self.held, &directions, &relaxed);
            if torque <= BALANCED {
                self.last = Last { amplitude, x: relaxed.x.clone(), tension: relaxed.tension.clone(), rest: y };
                return Ok(Sample { amplitude, relaxed, rest: rest.as_slice().to_vec(), iterations, rounds });
            }
            (x, tension) = (relaxed.x, relaxed.tension);
        }
        Err(SampleError::Restless { torque })
    }

    /// Uniform rest angles less those drawn.
    fn rest(&self, amplitude: f64, y: &DVector<f64>) -> DVector<f64> {
        DVector::from_column_slice(&self.course.rates) * amplitude + &self.held.free * y
    }

    /// A joint step of rest angles, unknowns and tensions; `None` where all rest angles are held.
    fn step(&self, (x, tension): (&[f64], &[f64])) -> Result<Option<(DVector<f64>, Both)>, LandscapeError> {
        if self.held.free.ncols() == 0 {
            return Ok(None);
        }
        Settling::new(self.held, (x, tension), Curvature::Full, ROUGH)?.joint(x, tension, LONGEST).map(Some)
    }
}

/// The largest torque on a direction of rest angles, over its size.
fn unbalanced(held: &HeldSheet, directions: &[Both], relaxed: &Relaxed) -> f64 {
    let model = &held.model;
    let stiffness = model.soft().iter().flat_map(|term| (0..term.len()).map(|k| term.spring(k).stiffness));
    let values = model.values(&relaxed.x);
    let off = values.iter().zip(model.rests()).map(|(value, rest)| value - rest);
    let (torques, least): (Vec<f64>, Vec<f64>) =
        stiffness.zip(off).map(|(k, off)| (k * off, k * off.abs().max(LEAST_ANGLE))).unzip();
    let sum = |soft: &[f64], stiff: &[f64], weigh: fn(f64) -> f64| -> DVector<f64> {
        let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| weigh(a * b)).sum::<f64>();
        DVector::from_vec(directions.iter().map(|(on, along)| product(soft, on) + product(stiff, along)).collect())
    };
    let torque = sum(&torques, &relaxed.tension, |value| value);
    let size = sum(&least, &relaxed.tension, f64::abs);
    torque.iter().zip(size.iter()).map(|(torque, size)| torque.abs() / size).fold(0.0, f64::max)
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
