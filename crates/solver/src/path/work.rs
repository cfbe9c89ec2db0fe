//! The work along a path: the integral of the conjugate quantity over the parameter, and steps of which it is checked.

use super::follower::{Follower, LEAST_TANGENT_COSINE, SHRINK};
use super::interpolant::Cubic;
use super::outcome::PathError;
use super::problem::{ParametrizedProblem, PathState};

/// Error of the work of a piece, relative to the largest product of conjugate and parameter's way, at which the piece
/// is not divided further; and how often one is halved at most.
const TOLERANCE: f64 = 1e-12;
const MOST_HALVINGS: usize = 7;
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

/// The work from one state to another.
pub(super) struct Worked {
    pub work: f64,
    /// What pieces that are not divided further leave unknown of it.
    unknown: f64,
    /// The state half way if it was sought and found.
    middle: Option<PathState>,
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
            let Worked { work, unknown, middle } = self.work(last, &state)?;
            let balanced = self.is_balanced([last, &state], (work, unknown));
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
    fn is_balanced(&mut self, [from, to]: [&PathState; 2], (work, unknown): (f64, f64)) -> bool {
        let [before, after] = [from, to].map(|state| self.potential(state));
        let unbalanced = (after - before - work).abs();
        let rounding = |state: &PathState, potential: f64| {
            let pulls = state.tension.iter().zip(self.problem.gap_scale()).map(|(t, scale)| (t * scale).abs());
            ROUNDING * (potential.abs() + self.problem.energy(&state.x).abs())
                + state.residual_length * pulls.sum::<f64>()
        };
        let known = noise(from, to) + rounding(from, before) + rounding(to, after) + UNBALANCED * self.largest[1];
        let at_kinks = if self.kinks { unknown } else { 0.0 };
        self.problem.has_kinks() || unbalanced.is_nan() || unbalanced <= known + at_kinks
    }

    fn potential(&mut self, state: &PathState) -> f64 {
        self.problem.set_parameter(state.parameter);
        self.problem.conjugate_integral(&state.x, &state.tension)
    }

    /// The work from one state to the next: from both states alone where no interpolation is good, else by cubic
    /// interpolation between them and as many states of the path in between as that takes, but for errors of the rates.
    pub(super) fn work(&mut self, from: &PathState, to: &PathState) -> Result<Worked, PathError> {
        if self.problem.has_kinks() {
            let work = self.potential(to) - self.potential(from);
            return Ok(Worked { work, unknown: 0.0, middle: None });
        }
        self.divided(from, to, MOST_HALVINGS)
    }

    fn divided(&mut self, from: &PathState, to: &PathState, left: usize) -> Result<Worked, PathError> {
        let whole = Worked { work: Cubic::new(from, to).work(), unknown: 0.0, middle: None };
        if to.arc_length <= from.arc_length {
            return Ok(whole);
        }
        let Some(middle) = self.between(from, to, 0.5)? else { return Ok(whole) };
        let halves = Cubic::new(from, &middle).work() + Cubic::new(&middle, to).work();
        let change = halves - whole.work;
        // the error of a cubic falls with the fourth power of the length and more
        let is_known = change.abs() <= noise(from, to).max(15.0 * TOLERANCE * self.largest[1].max(halves.abs()));
        let [work, unknown] = if is_known || left == 0 {
            [halves + change / 15.0, if is_known { 0.0 } else { change.abs() }]
        } else {
            let [first, second] = [self.divided(from, &middle, left - 1)?, self.divided(&middle, to, left - 1)?];
            [first.work + second.work, first.unknown + second.unknown]
        };
        Ok(Worked { work, unknown, middle: Some(middle) })
    }
}

/// The work between two states that errors of the rates make.
fn noise(from: &PathState, to: &PathState) -> f64 {
    to.rate_errors[1] * (to.arc_length - from.arc_length) * (to.parameter - from.parameter).abs()
}
