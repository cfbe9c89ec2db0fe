//! The work along a path: the integral of the conjugate quantity over the parameter.

use super::follower::Follower;
use super::interpolant::Cubic;
use super::outcome::PathError;
use super::problem::{ParametrizedProblem, PathState};

/// Error of the work of a piece, relative to the largest product of conjugate and parameter's way, at which the piece
/// is not divided further; and how often one is halved at most.
const TOLERANCE: f64 = 1e-12;
const MOST_HALVINGS: usize = 8;

impl<P: ParametrizedProblem> Follower<'_, P> {
    /// The work from one state to the next: from these alone where the problem knows it, else by cubic interpolation
    /// between them and as many states of the path in between as that takes, but for errors of the rates. `scale` is the
    /// size of the whole path's work.
    pub(super) fn work(&mut self, from: &PathState, to: &PathState, scale: f64) -> Result<f64, PathError> {
        if !self.problem.has_kinks() {
            return self.divided(from, to, scale, MOST_HALVINGS);
        }
        let [before, after] = [from, to].map(|state| {
            self.problem.set_parameter(state.parameter);
            self.problem.conjugate_integral(&state.x, &state.tension)
        });
        Ok(after - before)
    }

    fn divided(&mut self, from: &PathState, to: &PathState, scale: f64, left: usize) -> Result<f64, PathError> {
        let whole = Cubic::new(from, to).work();
        if left == 0 || to.arc_length <= from.arc_length {
            return Ok(whole);
        }
        let Some(middle) = self.between(from, to, 0.5)? else { return Ok(whole) };
        let halves = Cubic::new(from, &middle).work() + Cubic::new(&middle, to).work();
        let noise = to.rate_errors[1] * (to.arc_length - from.arc_length) * (to.parameter - from.parameter).abs();
        // the error of a cubic falls with the fourth power of the length and more
        if (halves - whole).abs() <= noise.max(15.0 * TOLERANCE * scale.max(halves.abs())) {
            return Ok(halves + (halves - whole) / 15.0);
        }
        Ok(self.divided(from, &middle, scale, left - 1)? + self.divided(&middle, to, scale, left - 1)?)
    }
}
