//! Where a sheet goes along a mode, to third order: the start of a relaxation.

use crate::numerics::vector::add_scaled;
use nalgebra::DVector;

/// Orders that are known.
pub(crate) const ORDERS: usize = 3;

/// A place of a held sheet, or a change of place.
#[derive(Clone, Debug)]
pub struct HeldState {
    /// The unknowns.
    pub x: Vec<f64>,
    /// Tensions of the stiff measures.
    pub tension: Vec<f64>,
    /// Rest angles, by direction across the modes.
    pub rest: DVector<f64>,
}

impl HeldState {
    /// Adds another one times a factor.
    pub(crate) fn add(&mut self, factor: f64, other: &Self) {
        add_scaled(&mut self.x, factor, &other.x);
        add_scaled(&mut self.tension, factor, &other.tension);
        add_scaled(self.rest.as_mut_slice(), factor, other.rest.as_slice());
    }
}

/// Rest angles move by `a rates` along the modes; all else by the sum of `a^d orders[d - 1]`.
#[derive(Clone, Debug)]
pub struct TaylorPath {
    /// Rates of the rest angles along the modes.
    pub rates: Vec<f64>,
    /// Coefficients of the Taylor series of the state in the amplitude, from the first power on. That of the first
    /// power has no tensions, and no rest angles other than those along the modes.
    pub orders: [HeldState; ORDERS],
}

impl TaylorPath {
    /// Adds the change from one amplitude to another.
    pub fn advance(&self, place: &mut HeldState, from: f64, to: f64) {
        for (power, order) in (1..).zip(&self.orders) {
            place.add(to.powi(power) - from.powi(power), order);
        }
    }
}
