//! The shift of the Hessian: as small as a factorization with the inertia of a minimum allows.

use super::iteration::Newton;
use super::outcome::{Failure, Step};
use crate::linearization::HessianKind;
use crate::problem::Problem;
use foldwell_numerics::factor::FactorError;

/// First shift tried after none, in units of the metric.
const FIRST_SHIFT: f64 = 0.25;
/// Ratio of one shift to the next.
const SHIFT_RATIO: f64 = 4.0;
/// Shift below which none is tried, and the smallest one, for small curvatures that are negative: with a larger one the
/// iteration would creep.
const LOW_SHIFT: f64 = 2e-2;
const LEAST_SHIFT: f64 = 1e-6;
/// Largest number of shifts tried at one state.
const MOST_SHIFTS: usize = 40;
/// Scaled force below which the next lower shift is none at once: a remaining shift would only slow the convergence of
/// soft modes.
const UNSHIFTED_FORCE: f64 = 1e-5;
/// Largest number of steps in a row for which a shift is not lowered.
const MOST_PATIENCE: usize = 8;
/// Smallest pivot relative to the largest one below which a factorization without shift is not used.
const SINGULAR_PIVOT_RATIO: f64 = 1e-15;

impl<P: Problem> Newton<'_, P> {
    /// Factors for a new step with a lower shift than the last one, none near a minimum. Lower shifts are tried less
    /// often the more often they were in vain.
    pub(super) fn factor_lower(&mut self, last: &Step) -> Result<(), Failure> {
        if self.shift.hold > 0 {
            self.shift.hold -= 1;
            return self.factor(self.shift.value);
        }
        let unshifted = last.residual_force <= UNSHIFTED_FORCE || self.shift.value <= LOW_SHIFT;
        let lower = if unshifted { 0.0 } else { self.shift.value / SHIFT_RATIO };
        self.factor(lower)?;
        let in_vain = self.shift.value > lower;
        self.shift.patience = if in_vain { (2 * self.shift.patience).min(MOST_PATIENCE) } else { 1 };
        self.shift.hold = if in_vain { self.shift.patience / 2 } else { 0 };
        Ok(())
    }

    /// Factors with the next larger shift.
    pub(super) fn factor_higher(&mut self) -> Result<(), Failure> {
        self.factor((SHIFT_RATIO * self.shift.value).max(FIRST_SHIFT))
    }

    /// Factors with the smallest shift, from `shift` upwards, at which the Hessian is that of a minimum.
    pub(super) fn factor(&mut self, mut shift: f64) -> Result<(), Failure> {
        for _ in 0..MOST_SHIFTS {
            match self.tangent.factor(shift) {
                Ok(inertia) if inertia.negative == 0 && (shift > 0.0 || inertia.ratio > SINGULAR_PIVOT_RATIO) => {
                    self.shift.value = shift;
                    let force = self.history.last().map_or(f64::INFINITY, |step| step.residual_force);
                    self.certified = (shift == 0.0 && self.kind == HessianKind::Full).then_some(force);
                    return Ok(());
                }
                Err(error @ FactorError::NotFinite) => return Err(error.into()),
                _ if shift > 0.0 => shift *= SHIFT_RATIO,
                _ if self.shift.value > LEAST_SHIFT => shift = self.shift.value / SHIFT_RATIO,
                _ => shift = FIRST_SHIFT,
            }
        }
        Err(FactorError::Singular { ratio: 0.0 }.into())
    }
}
