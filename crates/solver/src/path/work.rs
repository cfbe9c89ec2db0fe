//! The work along a path: the integral of the conjugate quantity over the parameter, and steps of which it is checked.

use super::follower::{Follower, LEAST_TANGENT_COSINE, SHRINK};
use super::interpolant::Cubic;
use super::outcome::PathError;
use super::problem::{ParametrizedProblem, PathState};

/// Error of the work of a piece, relative to the largest product of conjugate and parameter's way, at which the piece
/// is not divided further; and how often one is halved at most.
const TOLERANCE: f64 = 1e-12;
const MOST_HALVINGS: usize = 8;
/// Difference of the potential's change and the work, relative to the same product, above which a step has left its
/// path; and part of the longest step below which none is asked.
const UNBALANCED: f64 = 1e-8;
const SHORTEST_CHECKED: f64 = 1e-3;
/// Rounding error of a sum of energies relative to its size.
const ROUNDING: f64 = 1e-12;

/// A step along a path.
pub(super) struct Step {
    /// The state at its end.
    pub state: PathState,
    /// The state half way, where it is found and the path goes on through it.
    pub middle: Option<PathState>,
    /// The work along it.
    pub work: f64,
    /// Length of the next step.
    pub longer: f64,
}

impl<P: ParametrizedProblem> Follower<'_, P> {
    /// One step as [`Follower::step`] takes it. Along a path the potential changes by the work; where it does not, the
    /// step led to another curve of equilibria next to the path, and a shorter one is taken.
    pub(super) fn balanced_step(
        &mut self,
        before: Option<&PathState>,
        last: &PathState,
        mut length: f64,
    ) -> Result<Option<Step>, PathError> {
        let reference = self.problem.reference(&last.x);
        loop {
            let Some((state, longer)) = self.step(before, last, length)? else { return Ok(None) };
            let (largest, way) = (self.largest, state.arc_length - last.arc_length);
            self.measure(&state);
            let (work, middle) = self.work(last, &state)?;
            let balanced = self.is_balanced([last, &state], work);
            self.largest = largest;
            if balanced || way < SHORTEST_CHECKED * self.settings.max_step {
                // another branch, or motions that cost nothing, may be met half way
                let is_along = |end: &PathState, middle: &PathState| {
                    self.cosine(&end.tangent, &middle.tangent) >= LEAST_TANGENT_COSINE
                };
                let middle = middle.filter(|middle| is_along(last, middle) && is_along(&state, middle));
                return Ok(Some(Step { state, middle, work, longer }));
            }
            length = SHRINK * length.min(way);
            self.problem.set_reference(&reference);
        }
    }

    /// Whether the potential changes by this work from one state to the next, as far as both are known: but for errors of
    /// the rates, of sums, and of measures that are not quite met.
    fn is_balanced(&mut self, [from, to]: [&PathState; 2], work: f64) -> bool {
        let [before, after] = [from, to].map(|state| self.potential(state));
        let unbalanced = (after - before - work).abs();
        let rounding = |state: &PathState, potential: f64| {
            let pulls = state.tension.iter().zip(self.problem.gap_scale()).map(|(t, scale)| (t * scale).abs());
            ROUNDING * (potential.abs() + self.problem.energy(&state.x).abs())
                + state.residual_length * pulls.sum::<f64>()
        };
        let known = noise(from, to) + rounding(from, before) + rounding(to, after) + UNBALANCED * self.largest[1];
        self.problem.has_kinks() || unbalanced.is_nan() || unbalanced <= known
    }

    fn potential(&mut self, state: &PathState) -> f64 {
        self.problem.set_parameter(state.parameter);
        self.problem.conjugate_integral(&state.x, &state.tension)
    }

    /// The work from one state to the next, and the state half way if it was sought and found: from both states alone
    /// where no interpolation is good, else by cubic interpolation between them and as many states of the path in
    /// between as that takes, but for errors of the rates.
    pub(super) fn work(&mut self, from: &PathState, to: &PathState) -> Result<(f64, Option<PathState>), PathError> {
        if self.problem.has_kinks() {
            return Ok((self.potential(to) - self.potential(from), None));
        }
        self.divided(from, to, MOST_HALVINGS)
    }

    fn divided(
        &mut self,
        from: &PathState,
        to: &PathState,
        left: usize,
    ) -> Result<(f64, Option<PathState>), PathError> {
        let whole = Cubic::new(from, to).work();
        if left == 0 || to.arc_length <= from.arc_length {
            return Ok((whole, None));
        }
        let Some(middle) = self.between(from, to, 0.5)? else { return Ok((whole, None)) };
        let halves = Cubic::new(from, &middle).work() + Cubic::new(&middle, to).work();
        // the error of a cubic falls with the fourth power of the length and more
        let work =
            if (halves - whole).abs() <= noise(from, to).max(15.0 * TOLERANCE * self.largest[1].max(halves.abs())) {
                halves + (halves - whole) / 15.0
            } else {
                self.divided(from, &middle, left - 1)?.0 + self.divided(&middle, to, left - 1)?.0
            };
        Ok((work, Some(middle)))
    }
}

/// The work between two states that errors of the rates make.
fn noise(from: &PathState, to: &PathState) -> f64 {
    to.rate_errors[1] * (to.arc_length - from.arc_length) * (to.parameter - from.parameter).abs()
}
