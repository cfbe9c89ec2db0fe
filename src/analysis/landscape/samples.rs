//! Samples of a landscape: patches relaxed with their rest angles held along the modes and free across them.
//!
//! The patch relaxes at given rest angles `p = p0 + a phi + C y`; then Newton's method moves `y`, with the gradient
//! `dE/dy = -C^T K (rho - p)` and the Hessian from the response of the equilibrium to each direction of `C`. The response also
//! predicts where the patch relaxes to next, so that two or three rounds are enough.

use super::settling::Settling;
use super::{Course, Expansion, HeldSheet, LandscapeError};
use crate::analysis::relax::{Relaxed, relax};
use crate::solver::{Curvature, Failure, Options, Problem, Step};
use nalgebra::DVector;
use thiserror::Error;

/// Most rounds of rest angles.
const ROUNDS: usize = 30;
/// Torque on a direction of rest angles, over what the hinges would exert if all were off by what they are and agreed,
/// at which it is zero; hinges off by less than the least angle count as off by that.
const BALANCED: f64 = 1e-10;
const LEAST_ANGLE: f64 = 1e-4;
/// Longest change of a rest angle in a round, in radians.
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

/// Samples along one mode, each from the one before.
pub struct Samples<'a> {
    held: &'a mut HeldSheet,
    course: Course,
    /// Amplitude, unknowns and rest angles across the modes of the last sample.
    last: (f64, Vec<f64>, DVector<f64>),
    options: Options,
}

impl<'a> Samples<'a> {
    /// Along this course, from the drawn state.
    pub fn new(held: &'a mut HeldSheet, course: Course, options: Options) -> Self {
        let start = held.drawn();
        let last = (0.0, start, DVector::zeros(held.free.ncols()));
        Self { held, course, last, options }
    }

    /// The sample at an amplitude, from the last one.
    pub fn at(&mut self, amplitude: f64, observe: &mut dyn FnMut(&Step) -> bool) -> Result<Sample, SampleError> {
        let (before, x, y) = &self.last;
        let mut y = y + self.course.settling(*before, amplitude);
        let mut x: Vec<f64> = x.iter().zip(self.course.motion(*before, amplitude)).map(|(x, d)| x + d).collect();
        let (mut iterations, mut torque) = (0, f64::INFINITY);
        for rounds in 0..ROUNDS {
            let rest = DVector::from_column_slice(&self.course.rates) * amplitude + &self.held.free * &y;
            self.held.set_rest(rest.as_slice());
            let edges = self.held.model.layout().soft.len() + self.held.model.layout().stiff.len();
            let relaxed = relax(&mut self.held.model, x, self.options, edges, observe)
                .map_err(|error| SampleError::Relaxation(error.failure))?;
            iterations += relaxed.iterations;
            let balance = Balance::new(self.held, &relaxed)?;
            torque = balance.unbalanced();
            if torque <= BALANCED {
                self.last = (amplitude, relaxed.x.clone(), y);
                return Ok(Sample { amplitude, relaxed, rest: rest.as_slice().to_vec(), iterations, rounds });
            }
            let (step, motion) = balance.step()?;
            x = relaxed.x.iter().zip(motion).map(|(x, d)| x + d).collect();
            y += step;
        }
        Err(SampleError::Restless { torque })
    }
}

/// The torques on the directions of rest angles at an equilibrium, and how they change.
struct Balance<'a> {
    settling: Settling<'a>,
    torque: DVector<f64>,
    size: DVector<f64>,
}

impl<'a> Balance<'a> {
    fn new(held: &'a HeldSheet, relaxed: &Relaxed) -> Result<Self, LandscapeError> {
        let model = &held.model;
        let settling = Settling::new(held, &relaxed.x, &relaxed.tension, Curvature::Full)?;
        let values = model.values(&relaxed.x);
        let off = values.iter().zip(model.rests()).map(|(value, rest)| value - rest);
        let (torques, least): (Vec<f64>, Vec<f64>) =
            settling.stiffness().iter().zip(off).map(|(k, off)| (k * off, k * off.abs().max(LEAST_ANGLE))).unzip();
        let sum = |soft: &[f64], stiff: &[f64], weigh: fn(f64) -> f64| -> DVector<f64> {
            let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| weigh(a * b)).sum::<f64>();
            let directions = settling.directions().iter();
            DVector::from_vec(directions.map(|(on, along)| product(soft, on) + product(stiff, along)).collect())
        };
        let torque = sum(&torques, &relaxed.tension, |value| value);
        let size = sum(&least, &relaxed.tension, f64::abs);
        Ok(Self { settling, torque, size })
    }

    /// The largest torque over its size.
    fn unbalanced(&self) -> f64 {
        self.torque.iter().zip(self.size.iter()).map(|(torque, size)| torque.abs() / size).fold(0.0, f64::max)
    }

    /// Newton's step of the rest angles, and the motion of the unknowns that goes with it.
    fn step(&self) -> Result<(DVector<f64>, Vec<f64>), LandscapeError> {
        let singular = crate::numerics::factor::FactorError::Singular { ratio: 0.0 };
        let factor = nalgebra::Cholesky::new(self.settling.hessian().clone()).ok_or(singular)?;
        let step = factor.solve(&self.torque);
        let step = &step * (LONGEST / step.amax()).min(1.0);
        let motion = self.settling.motion(&step);
        Ok((step, motion))
    }
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
    let mut along = Samples::new(held, course, Options::default());
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
