//! Where a sheet goes along a mode, to second order: the start of a relaxation.
//!
//! Tensions are of second order too: to first order a mode stretches nothing.

use nalgebra::DVector;

/// The unknowns move by `a first + a^2 second`, the rest angles by `a rates` along the modes and by `a^2 rest` across them.
#[derive(Clone, Debug)]
pub struct Course {
    /// Rates of the rest angles along the modes.
    pub rates: Vec<f64>,
    /// Velocity of the unknowns.
    pub first: Vec<f64>,
    /// Half their acceleration.
    pub second: Vec<f64>,
    /// Half the second derivative of the tensions of the stiff measures.
    pub tension: Vec<f64>,
    /// Half the acceleration of the rest angles, by direction across the modes.
    pub rest: DVector<f64>,
}

impl Course {
    /// Change of the unknowns from one amplitude to another.
    pub fn motion(&self, from: f64, to: f64) -> impl Iterator<Item = f64> + '_ {
        let (first, second) = (to - from, to * to - from * from);
        self.first.iter().zip(&self.second).map(move |(v, w)| first * v + second * w)
    }

    /// Change of the tensions.
    pub fn pull(&self, from: f64, to: f64) -> impl Iterator<Item = f64> + '_ {
        let second = to * to - from * from;
        self.tension.iter().map(move |t| second * t)
    }

    /// Change of the rest angles across the modes.
    pub fn settling(&self, from: f64, to: f64) -> DVector<f64> {
        &self.rest * (to * to - from * from)
    }
}
