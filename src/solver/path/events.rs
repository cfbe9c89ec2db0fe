//! Special states between two states of a path: where a function of the states changes its sign.

use super::follower::Follower;
use super::interpolant::Cubic;
use super::outcome::{PathError, PathMark};
use super::problem::{ParametrizedProblem, PathState};

/// Part of a step to which sign changes are located, and the largest number of states tried.
const LOCATED_PART: f64 = 1e-12;
const MOST_ROUNDS: usize = 60;
/// Ratio of the rate of the conjugate quantity to its largest one on the path below which it is rounding error.
const LEAST_RATE: f64 = 1e-8;

/// Functions that the observer of a path watches besides the solver's own.
pub trait Watch<P> {
    /// Returns the values at a state, as many at every state, NaN where there is none.
    fn values(&mut self, problem: &P, state: &PathState) -> Vec<f64>;
    /// Whether a sign change of the function with this number ends a branch.
    fn ends(&self, function: usize) -> bool;
}

/// Whether a function changed its sign, or became zero.
pub(super) fn changed(before: f64, after: f64) -> bool {
    before * after < 0.0 || (after == 0.0 && before != 0.0)
}

impl<P: ParametrizedProblem> Follower<'_, P> {
    /// Locates the marks between two states in order. `watched` are the values of the watched functions at both.
    pub(super) fn marks(
        &mut self,
        [from, to]: [&PathState; 2],
        largest_rate: f64,
        watched: [&[f64]; 2],
        watch: &mut dyn Watch<P>,
    ) -> Result<Vec<(PathState, PathMark)>, PathError> {
        let mut found = vec![];
        let turns = changed(from.tangent.parameter, to.tangent.parameter);
        if turns && let Some(state) = self.locate([from, to], &mut |_, state| state.tangent.parameter)? {
            found.push((state, PathMark::ParameterTurns));
        }
        let rates = [from, to].map(|state| state.conjugate[1]);
        let known = rates.iter().all(|rate| rate.abs() > LEAST_RATE * largest_rate);
        if known
            && changed(rates[0], rates[1])
            && let Some(state) = self.locate([from, to], &mut |_, state| state.conjugate[1])?
        {
            found.push((state, PathMark::ConjugateTurns));
        }
        let [before, after] = [from, to].map(|state| state.negative_eigenvalues);
        let crossing = before.abs_diff(after).saturating_sub(usize::from(turns));
        if crossing > 0 {
            let half = 0.5 * (before + after) as f64;
            let middle = if half.fract() == 0.0 { half + 0.25 } else { half };
            if let Some(mut state) = self.locate([from, to], &mut |_, s| s.negative_eigenvalues as f64 - middle)? {
                // Newton's system is singular there, and its own tangent any mixture with the null vectors
                let part = (state.arc_length - from.arc_length) / (to.arc_length - from.arc_length);
                (state.tangent, state.conjugate[1]) = Cubic::new(from, to).tangent(part);
                found.push((state, PathMark::BranchPoint(crossing)));
            }
        }
        for function in (0..watched[0].len()).filter(|&k| changed(watched[0][k], watched[1][k])) {
            let mut value = |problem: &P, state: &PathState| watch.values(problem, state)[function];
            if let Some(state) = self.locate([from, to], &mut value)? {
                found.push((state, PathMark::Watched(function)));
            }
        }
        found.sort_by(|a, b| a.0.arc_length.total_cmp(&b.0.arc_length));
        Ok(found)
    }

    /// Locates the sign change of a function between two states, by the Illinois variant of the rule of false position
    /// with a bisection every third time. Returns the state on its far side, `None` where states in between are not
    /// found.
    pub(super) fn locate(
        &mut self,
        [from, to]: [&PathState; 2],
        value: &mut dyn FnMut(&P, &PathState) -> f64,
    ) -> Result<Option<PathState>, PathError> {
        let mut low = (0.0, value(self.problem, from));
        let mut high = (1.0, value(self.problem, to));
        let mut best = None;
        for round in 0..MOST_ROUNDS {
            if high.0 - low.0 <= LOCATED_PART || (high.1 == 0.0 && best.is_some()) {
                break;
            }
            let secant = (low.1 / (low.1 - high.1)).clamp(1e-3, 1.0 - 1e-3);
            let part = low.0 + if round % 3 == 2 { 0.5 } else { secant } * (high.0 - low.0);
            let Some(state) = self.between(from, to, part)? else { break };
            let here = value(self.problem, &state);
            if here * high.1 > 0.0 || here == 0.0 {
                high = (part, here);
                best = Some(state);
                low.1 *= 0.5;
            } else {
                low = (part, here);
                high.1 *= 0.5;
                // the first state of all may be the only one
                best = best.or(Some(state));
            }
        }
        Ok(best)
    }
}
