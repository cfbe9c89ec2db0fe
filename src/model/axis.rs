//! The initial axis of a screw: the direction about which a flat state rolls up.
//!
//! At zero curvature the direction of the axis does not affect the shape: rotating it rotates the sheet. But folding
//! starts about the axis that the chart has, and from a bad one Newton's method may end in a poor minimum. So the
//! axis is put where the first Newton step promises the largest decrease of the energy, or the least increase where it
//! turns a lock: first the best of some directions, then the maximum next to it. Near zero curvature direction and
//! curvature are polar coordinates, and Newton's method does not correct the direction there; it has to be right from
//! the start.

use super::assembly::Assembly;
use super::domain::Domain;
use super::problem::Gauge;
use crate::numerics::vector::dot;
use crate::solver::{HessianKind, Problem, Tangent};
use std::f64::consts::PI;

/// Number of directions that are tried, evenly spaced over half a turn.
const DIRECTIONS: usize = 24;
/// Shift of the Hessian, which keeps the Newton step finite along motions that cost no energy: `SHIFT` while
/// directions are compared, `LEAST_SHIFT` in the search for the maximum.
const SHIFT: f64 = 1e-2;
const LEAST_SHIFT: f64 = 1e-9;
/// Number of golden-section reductions of the interval around the maximum: they take it from a quarter of a radian to
/// 1e-8.
const REDUCTIONS: usize = 36;

/// Decrease of an energy that is not known; and the part by which one must exceed another to be clearly more.
const UNKNOWN: f64 = f64::MIN;
const CLEARLY_MORE: f64 = 1e-6;
/// Gap of a measure, over its natural size, up to which it is met but for rounding errors.
const CLOSED: f64 = 1e-10;
/// Relative residual of a step.
const CORRECTED: f64 = 1e-8;
/// Tolerance of a solve without corrections: they would take the weights of rigid measures for what they are.
pub(super) const UNCORRECTED: f64 = f64::INFINITY;

impl Assembly {
    /// Returns the same assembly with the axis of its screw motions in the direction that promises the largest
    /// decrease of the energy. Other boundary conditions are returned unchanged.
    pub fn with_best_axis(&self) -> Self {
        if *self.domain() != Domain::Screw {
            return self.clone();
        }
        let fall = |angle: f64, shift: f64| promised_fall(&self.with_axis(angle), shift).unwrap_or(UNKNOWN);
        let step = PI / DIRECTIONS as f64;
        let (mut best, mut most) = (0.0, fall(0.0, SHIFT));
        for angle in (1..DIRECTIONS).map(|k| step * k as f64) {
            let found = fall(angle, SHIFT);
            if found > most + CLEARLY_MORE * most.abs() {
                (best, most) = (angle, found);
            }
        }
        if most == 0.0 || most == UNKNOWN {
            return self.with_axis(0.0);
        }
        self.with_axis(maximum([best - step, best + step], |angle| fall(angle, LEAST_SHIFT)))
    }
}

/// Returns the direction of an axis with the largest gain, of the peaks next to all directions that are tried; `None`
/// where there is no peak.
pub(super) fn direction_of_highest_peak(gain: impl Fn(f64) -> f64) -> Option<f64> {
    let step = PI / DIRECTIONS as f64;
    let samples: Vec<f64> = (0..DIRECTIONS).map(|k| gain(step * k as f64)).collect();
    let is_peak = |k: &usize| {
        let [before, after] = [k + DIRECTIONS - 1, k + 1].map(|k| samples[k % DIRECTIONS]);
        samples[*k] > before && samples[*k] >= after
    };
    let peak = |k: usize| maximum([step * (k as f64 - 1.0), step * (k as f64 + 1.0)], &gain);
    let peaks = (0..DIRECTIONS).filter(is_peak).map(peak).map(|direction| (gain(direction), direction));
    peaks.max_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, direction)| direction)
}

/// Returns the argument of the maximum of a function with one maximum in an interval, by golden-section search.
fn maximum([mut low, mut high]: [f64; 2], function: impl Fn(f64) -> f64) -> f64 {
    let golden = 0.5 * (5f64.sqrt() - 1.0);
    let inner = |low: f64, high: f64| [high - golden * (high - low), low + golden * (high - low)];
    let mut places = inner(low, high);
    let mut values = places.map(&function);
    for _ in 0..REDUCTIONS {
        if values[0] >= values[1] {
            high = places[1];
            places = [inner(low, high)[0], places[0]];
            values = [function(places[0]), values[0]];
        } else {
            low = places[0];
            places = [places[1], inner(low, high)[1]];
            values = [values[1], function(places[1])];
        }
    }
    0.5 * (low + high)
}

/// Returns the decrease of the energy along the first Newton step, to second order; `None` if the Hessian cannot be
/// factorized. A step closes measures that are off their rest values, as a lock is that has to turn: where no motion
/// closes a rigid one, it resists by its weight in the factorization, and the energy rises a million times more than
/// about other axes.
fn promised_fall(assembly: &Assembly, shift: f64) -> Option<f64> {
    let model = assembly.model(Gauge::Held);
    let tension = vec![0.0; model.layout().stiff.len()];
    let mut tangent = Tangent::at_state(&model, &model.start(), &tension, HessianKind::GaussNewton).ok()?;
    tangent.factor(shift).ok()?;
    let (force, open) = (tangent.at.force(&tension), tangent.at.missing(&tension, model.compliance()));
    let is_open = open.iter().zip(model.gap_scale()).any(|(gap, scale)| gap.abs() > CLOSED * scale);
    // where nothing is open no weight matters, and corrections give the axis more digits
    let (stretch, tolerance) = if is_open { (open, UNCORRECTED) } else { (tension, CORRECTED) };
    Some(decrease_along_step(&mut tangent, [&force, &stretch], tolerance))
}

/// Returns the decrease of the energy, to second order, with which the state of a factored tangent problem gives way to
/// a force and a stretch; negative where the stretch costs more than the force gains.
pub(super) fn decrease_along_step(tangent: &mut Tangent, [force, stretch]: [&[f64]; 2], tolerance: f64) -> f64 {
    let step = tangent.solve(force, stretch, tolerance);
    0.5 * (dot(force, &step.dx) + dot(stretch, &step.dt))
}
