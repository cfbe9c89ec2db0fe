//! Diagnostics of a state besides its residuals: the inertia, whether rigid measures are independent, whether a start
//! is singular.

use super::iteration::Newton;
use super::outcome::Failure;
use super::retraction::START_GAP;
use crate::linearization::{HessianKind, missing};
use crate::problem::Problem;
use crate::self_stress::self_stresses;
use foldwell_numerics::random::numbers;
use foldwell_numerics::vector::{larger, max_abs, moved};

/// Scaled force below which the inertia of a state is that of the minimum next to it, but for eigenvalues near zero.
const FORCE_NEAR_MINIMUM: f64 = 1e-4;
/// Largest change of a measure of a soft element (an angle, in radians), and of an unknown in units of length, by one
/// more step from a state at rest; and the relative residual to which that step is known.
const AT_REST: f64 = 1e-7;
const STEP_RESIDUAL: f64 = 0.1;
/// Largest component of the step with which a start is probed, in units of length.
const PROBE_LENGTH: f64 = 1e-3;
/// Relative part of the probe's stretch that no motion makes above which a start is singular.
const SINGULAR_UNREACHABLE_PART: f64 = 0.05;
/// Ratio of second-order to first-order gaps of a step below which a start is not singular.
const LEAST_SECOND_ORDER_RATIO: f64 = 10.0;
/// Unreachable part of a random stretch above which a self stress is taken to exist, relative to the part that one self
/// stress would leave (about `1/sqrt(m)` for `m` rigid measures).
const SELF_STRESS_PART: f64 = 1e-2;
/// Seed of that random stretch.
const SEED: u64 = 1;

impl<P: Problem> Newton<'_, P> {
    /// Whether the last factorization was made a few whole steps ago and so near the minimum that its inertia is that
    /// of the minimum.
    pub(super) fn near_certified_minimum(&self) -> bool {
        self.certified.is_some_and(|force| force < FORCE_NEAR_MINIMUM)
            && self.history.last().is_some_and(|step| step.fraction == 1.0)
    }

    /// Number of negative eigenvalues of the full Hessian at the converged state; `None` where it is not known. Where
    /// the last factorization was made near by and shows a minimum, its softest motions are asked whether they are
    /// still stable.
    pub(super) fn certify(&mut self) -> Result<Option<usize>, Failure> {
        let is_near = self.near_certified_minimum();
        self.kind = HessianKind::Full;
        self.linearize();
        if is_near && !self.tangent.softest_falls() {
            return Ok(Some(0));
        }
        Ok(self.tangent.negative_eigenvalues()?)
    }

    /// Whether one more Newton step with the full Hessian would change nothing. A force above the tolerance is rounding
    /// error only then: a single huge stiffness, such as that of a fold angle beside a triangle that collapses, makes
    /// rounding errors of coordinates look like any force.
    pub(super) fn is_at_rest(&mut self) -> bool {
        self.kind = HessianKind::Full;
        self.linearize();
        if self.tangent.factor(0.0).is_err() {
            return false;
        }
        let step = self.tangent.newton_step(&self.tension, STEP_RESIDUAL);
        let length = max_abs(&step.dx) / self.problem.unit_of_length();
        let change = larger(self.tangent.at.largest_measure_change(&step.dx), length);
        step.residual <= STEP_RESIDUAL && change <= AT_REST
    }

    /// Whether the stretch that a step makes beyond its linear part cannot be taken back by any motion: then the rigid
    /// measures resist at second order, as those of a flat truss do. There must be self stresses for that.
    pub(super) fn obstructed(&mut self, dx: &[f64]) -> bool {
        let mut linear = vec![0.0; self.tension.len()];
        self.tangent.at.rows().product(dx, &mut linear);
        let whole = self.problem.gaps(&moved(&self.x, 1.0, dx));
        let second: Vec<f64> = (0..whole.len()).map(|k| whole[k] - self.tangent.at.gaps[k] - linear[k]).collect();
        let first_order = self.largest_scaled_gap(&linear).max(START_GAP);
        let small = self.largest_scaled_gap(&second) < LEAST_SECOND_ORDER_RATIO * first_order;
        if !self.problem.compliance().contains(&0.0) || small {
            return false;
        }
        let probe = PROBE_LENGTH * self.problem.unit_of_length();
        let probed = self.problem.gaps(&moved(&self.x, probe / max_abs(dx).max(probe), dx));
        let open = missing(&probed, &self.tension, self.problem.compliance());
        let (at, system) = (&self.tangent.at, &mut self.tangent.system);
        system.unreachable_part(at, &open, SINGULAR_UNREACHABLE_PART) > SINGULAR_UNREACHABLE_PART
            && self_stresses(self.problem, at).is_some_and(|count| count > 0)
    }

    /// Whether rigid measures are independent: then a random stretch can be made by a motion. Soft measures always are.
    pub(super) fn rigid_measures_independent(&mut self) -> bool {
        let rigid = self.problem.compliance().iter().filter(|c| **c == 0.0).count();
        if rigid == 0 {
            return true;
        }
        let (at, system) = (&self.tangent.at, &mut self.tangent.system);
        let stretch: Vec<f64> = at.sizes.iter().zip(numbers(SEED)).map(|(size, number)| number * size).collect();
        let reached = SELF_STRESS_PART / (rigid as f64).sqrt();
        system.unreachable_part(at, &stretch, reached) <= reached
    }
}
