//! Special states between two states of a path: where a function of the states changes its sign.

use super::bordered::Hyperplane;
use super::branching::guesses;
use super::exits::SAME_STATE;
use super::follower::{Follower, LEAST_TANGENT_COSINE};
use super::interpolant::Cubic;
use super::outcome::{Found, PathMark};
use super::problem::{Ends, ParametrizedProblem, PathState};

/// Part of a step to which sign changes are located, and the largest number of states tried.
const LOCATED_PART: f64 = 1e-12;
const MOST_ROUNDS: usize = 60;
/// Ratio of the rate of the conjugate quantity to its largest one on the path below which it is rounding error.
const LEAST_RATE: f64 = 1e-8;
/// Distance in arc length between states around a branch point at which it is interpolated.
const AROUND: f64 = 1e-4;
/// How often those states are moved to where a stiffness would vanish that does not change its sign among them, and how
/// far in units of the way to there.
const MOST_SHIFTS: usize = 5;
const BEYOND: f64 = 1.2;
/// Ratio of a rate within a step to those at both ends below which it may turn twice, and the largest number of states
/// in a step that are found to see it.
const NEARER: f64 = 0.5;
const MOST_ADDED: usize = 8;
/// Rate of the parameter at its located extremum, over that at the end of the step, above which the extremum is a corner.
const CORNER: f64 = 1e-3;
/// Largest number of changes of the level that are sought in a step.
const MOST_BRANCH_POINTS: usize = 16;

/// States at which something happens, and what.
pub(super) type Marks = Vec<(PathState, PathMark)>;

/// Functions that the observer of a path watches besides the solver's own.
pub trait Watch<P> {
    /// Returns the values at a state, as many at every state, NaN where there is none.
    fn values(&mut self, problem: &P, state: &PathState) -> Vec<f64>;
    /// Whether a branch with these marks ends at the last of them.
    fn ends(&self, marks: &[PathMark]) -> bool;
}

/// Whether a function changed its sign, or became zero.
pub(super) fn changed(before: f64, after: f64) -> bool {
    before * after < 0.0 || (after == 0.0 && before != 0.0)
}

/// Whether a rate changed its sign, where neither value is an error of the linear algebra.
fn turned([before, after]: [f64; 2], errors: [f64; 2]) -> bool {
    before.abs() > errors[0] && after.abs() > errors[1] && changed(before, after)
}

/// The part of the way between two states at which a rate of one sign at both, that of the parameter or of its conjugate,
/// is much nearer to zero or beyond it, by the cubic through both.
fn least_rate(from: &PathState, to: &PathState) -> Option<f64> {
    let length = to.arc_length - from.arc_length;
    let parameters = [from.tangent.parameter, (to.parameter - from.parameter) / length, to.tangent.parameter];
    let conjugates = [from.conjugate[1], (to.conjugate[0] - from.conjugate[0]) / length, to.conjugate[1]];
    [parameters, conjugates].into_iter().zip([0, 1]).find_map(|([before, mean, after], quantity)| {
        let errors = [from, to].map(|state| state.rate_errors[quantity]);
        let (linear, square) = (6.0 * mean - 4.0 * before - 2.0 * after, 3.0 * (before + after - 2.0 * mean));
        // the rate of a cubic is the parabola `before + linear t + square t^2`
        let part = -0.5 * linear / square;
        let least = (before + 0.5 * linear * part) * before.signum();
        let small = least < NEARER * f64::min(before.abs(), after.abs());
        let known = before.abs() > errors[0] && after.abs() > errors[1] && before * after > 0.0;
        (known && small && 0.0 < part && part < 1.0).then_some(part)
    })
}

/// Sign of the parameter's rate at the beginning of a piece of a path, and the change of the number of negative
/// eigenvalues where it turns; none where it does not.
type Turn = Option<(f64, i64)>;

/// The number of negative eigenvalues along a piece of a path, less what the extremum of the parameter in it makes.
/// Other than the number itself, this one does not change where the parameter turns: it is that of the bordered matrix.
fn level(state: &PathState, turn: Turn) -> Option<i64> {
    let count = state.negative_eigenvalues? as i64;
    let beyond = |(sign, change): (f64, i64)| if state.tangent.parameter * sign < 0.0 { change } else { 0 };
    Some(count - turn.map_or(0, beyond))
}

/// The verdict on a supposed branch point by the stiffness of its softest motion across the path, which vanishes at a
/// true one.
enum BranchPointVerdict {
    /// It vanishes at this part of the way, in this state.
    At(f64, Box<PathState>),
    /// It does not change its sign: it left what counts as zero.
    Nowhere,
    /// States around the point are not found.
    Unknown,
}

/// Where a quantity vanishes of which four values at four places are given, by inverse interpolation.
fn zero_of(values: &[[f64; 2]]) -> f64 {
    let weight = |k: usize, other: usize| values[other][1] / (values[other][1] - values[k][1]);
    let place =
        |k: usize| values[k][0] * (0..4).filter(|&other| other != k).map(|other| weight(k, other)).product::<f64>();
    (0..4).map(place).sum()
}

impl<P: ParametrizedProblem> Follower<'_, P> {
    /// Locates the marks between two states, of which one in the middle may be known: two in one step may leave
    /// what tells of them as it was. `watched` are the values of the watched functions at both ends. Returns too whether
    /// the step stays on one curve, as far as changes of the number of negative eigenvalues tell.
    pub(super) fn marks(
        &mut self,
        [from, to]: Ends<'_>,
        middle: Option<&PathState>,
        watched: [&[f64]; 2],
        watch: &mut dyn Watch<P>,
    ) -> Found<(Marks, bool)> {
        let (mut found, mut is_one_curve) = (vec![], true);
        let inner = middle.filter(|middle| middle.arc_length < to.arc_length);
        let states = self.with_least_rates([from].into_iter().chain(inner).chain([to]).cloned().collect())?;
        for piece in states.windows(2) {
            is_one_curve &= self.own_marks([from, to], [&piece[0], &piece[1]], &mut found)?;
        }
        found.extend(self.marks_asked_for([from, to], watched, watch)?);
        Ok((found, is_one_curve))
    }

    /// Locates the sign changes of the watched functions between two states, and the listed parameters, function by
    /// function.
    pub(super) fn marks_asked_for(
        &mut self,
        [from, to]: Ends<'_>,
        watched: [&[f64]; 2],
        watch: &mut dyn Watch<P>,
    ) -> Found<Marks> {
        let mut found = vec![];
        for function in (0..watched[0].len()).filter(|&k| changed(watched[0][k], watched[1][k])) {
            let mut value = |problem: &P, state: &PathState| watch.values(problem, state)[function];
            if let Some(state) = self.locate([from, to], &mut value)? {
                found.push((state, PathMark::Watched(function)));
            }
        }
        for parameter in self.settings.listed.clone() {
            // the state at the end of the step is one of its own in any case
            if changed(from.parameter - parameter, to.parameter - parameter)
                && to.parameter != parameter
                && let Some(state) = self.at_parameter(from, to, parameter)?
            {
                found.push((state, PathMark::Listed));
            }
        }
        Ok(found)
    }

    /// Returns the states of a step, and between two neighbours one where a rate is far smaller than at both, by the cubic
    /// through them: it may turn on either side of it.
    fn with_least_rates(&mut self, mut states: Vec<PathState>) -> Found<Vec<PathState>> {
        let (mut first, mut added) = (0, 0);
        while first + 1 < states.len() {
            let [from, to] = [&states[first], &states[first + 1]];
            let part = if added < MOST_ADDED { least_rate(from, to) } else { None };
            let between = part.map_or(Ok(None), |part| self.between(from, to, part))?;
            match between.filter(|state| self.cosine(&states[first].tangent, &state.tangent) >= LEAST_TANGENT_COSINE) {
                Some(state) => states.insert(first + 1, state),
                None => first += 1,
            }
            added += usize::from(part.is_some());
        }
        Ok(states)
    }

    /// Locates the extrema and branch points between two states of a step, or of a piece of it. Returns whether it stays
    /// on one curve.
    fn own_marks(&mut self, step: Ends<'_>, [from, to]: Ends<'_>, found: &mut Marks) -> Found<bool> {
        let mut turn = None;
        let rates = [from, to].map(|state| state.tangent.parameter);
        if turned(rates, [from, to].map(|state| state.rate_errors[0]))
            && let Some(state) = self.locate([from, to], &mut |_, state| state.tangent.parameter)?
        {
            let change = match [from.negative_eigenvalues, to.negative_eigenvalues] {
                // at a corner the stiffness jumps over zero
                [Some(before), Some(after)] if state.tangent.parameter.abs() > CORNER * rates[1].abs() => {
                    (after as i64 - before as i64).signum()
                }
                _ => (state.work_along * rates[1]).signum() as i64,
            };
            turn = Some((rates[0].signum(), change));
            found.push((state, PathMark::ParameterTurns));
        }
        let rates = [from, to].map(|state| state.conjugate[1]);
        let least = [from, to].map(|state| state.rate_errors[1].max(LEAST_RATE * self.largest[0]));
        if turned(rates, least)
            && let Some(state) = self.locate([from, to], &mut |_, state| state.conjugate[1])?
        {
            found.push((state, PathMark::ConjugateTurns));
        }
        self.branch_points(step, [from, to], turn, found)
    }

    /// Locates all states between two of a step at which the level changes. Changes that are nearer to each other than
    /// states that are taken for one are one, of higher multiplicity. Returns whether states are
    /// found where the level changes.
    fn branch_points(&mut self, [from, to]: Ends<'_>, ends: Ends<'_>, turn: Turn, found: &mut Marks) -> Found<bool> {
        let (Some(mut before), Some(last)) = (level(ends[0], turn), level(ends[1], turn)) else { return Ok(true) };
        if self.problem.has_kinks() {
            return Ok(true); // where stiffness jumps, a change of the level is no zero of it
        }
        let length = to.arc_length - from.arc_length;
        let [mut part, end] = ends.map(|state| (state.arc_length - from.arc_length) / length);
        let beside = SAME_STATE / length;
        for _ in 0..MOST_BRANCH_POINTS {
            if before == last {
                break;
            }
            let mut differs = |state: &PathState| level(state, turn).is_some_and(|here| here != before);
            let Some((at, state)) = self.bisect([from, to], [part, end], &mut differs)? else { return Ok(false) };
            let beyond = if at + beside < end { self.between(from, to, at + beside)? } else { None };
            let after = beyond.and_then(|state| level(&state, turn)).unwrap_or(last);
            let crossing = if after == before { BranchPointVerdict::Nowhere } else { self.refined([from, to], at)? };
            let point = match crossing {
                BranchPointVerdict::At(at, state) => Some((at, *state)),
                BranchPointVerdict::Nowhere => None,
                BranchPointVerdict::Unknown => Some((at, state)),
            };
            if let Some((at, mut state)) = point {
                // Newton's system is singular there, and its own tangent any mixture with the null vectors
                (state.tangent, state.conjugate[1]) = Cubic::new(from, to).tangent(at);
                found.push((state, PathMark::BranchPoint(before.abs_diff(after) as usize)));
            }
            (part, before) = (at + beside, after);
        }
        Ok(true)
    }

    /// Locates a branch point near this part of the way where the stiffness of the softest motion across the path
    /// vanishes, by inverse interpolation between states around it. At the point itself neither Newton's method nor a
    /// count of signs is exact: rounding errors move a state along the null vector, and stiffnesses that are rounding
    /// errors count as positive.
    fn refined(&mut self, [from, to]: Ends<'_>, mut at: f64) -> Found<BranchPointVerdict> {
        let (cubic, mut guess) = (Cubic::new(from, to), guesses(from.x.len()).next().unwrap_or_default());
        for _ in 0..MOST_SHIFTS {
            let apart = f64::min(AROUND / (to.arc_length - from.arc_length), 0.4 * f64::min(at, 1.0 - at));
            let mut around: Vec<[f64; 2]> = vec![];
            for place in [-2.0, -1.0, 1.0, 2.0] {
                let part = at + place * apart;
                let plane = Hyperplane::across(&cubic.tangent(part).0, self.bordered.unit);
                if self.between(from, to, part)?.is_none() {
                    return Ok(BranchPointVerdict::Unknown);
                }
                let (softest, stiffness) = self.bordered.softest(&guess, &plane, &[]);
                guess = softest.x;
                around.push([part, stiffness]);
            }
            if around[0][1] * around[3][1] < 0.0 {
                let part = zero_of(&around);
                if !((part - at).abs() <= 2.0 * apart) {
                    return Ok(BranchPointVerdict::Unknown);
                }
                let state = self.between(from, to, part)?;
                return Ok(
                    state.map_or(BranchPointVerdict::Unknown, |state| BranchPointVerdict::At(part, Box::new(state)))
                );
            }
            let way = (around[3][0] - around[0][0]) / (around[3][1] - around[0][1]);
            at -= BEYOND * way * 0.5 * (around[1][1] + around[2][1]);
            if !(0.0 < at && at < 1.0) {
                break;
            }
        }
        Ok(BranchPointVerdict::Nowhere)
    }

    /// Locates the first state found, between these parts of the way between two others, of which something holds that
    /// holds where the search ends, and not where it begins; with its part of the way. `None` where no state in
    /// between is found.
    fn bisect(
        &mut self,
        [from, to]: Ends<'_>,
        [mut low, mut high]: [f64; 2],
        holds: &mut dyn FnMut(&PathState) -> bool,
    ) -> Found<Option<(f64, PathState)>> {
        let (mut best, mut around) = (None, [None, None]);
        while high - low > LOCATED_PART {
            let middle = 0.5 * (low + high);
            let Some(state) = self.between(from, to, middle)? else {
                // next to a double branch point only states nearer to it lead there
                let [Some(from), Some(to)] = &around else { break };
                let nearer = self.bisect([from, to], [0.0, 1.0], holds)?;
                return Ok(nearer.map(|(part, state)| (low + part * (high - low), state)).or(best));
            };
            let is_beyond = holds(&state);
            around[usize::from(is_beyond)] = Some(state.clone());
            if is_beyond {
                high = middle;
                best = Some((middle, state));
            } else {
                low = middle;
                // the first state of all may be the only one
                best = best.or(Some((middle, state)));
            }
        }
        Ok(best)
    }

    /// Locates the sign change of a function between two states, by the Illinois variant of the rule of false position
    /// with a bisection every third time. Returns the state on its far side, `None` where states in between are not
    /// found.
    pub(super) fn locate(
        &mut self,
        [from, to]: Ends<'_>,
        value: &mut dyn FnMut(&P, &PathState) -> f64,
    ) -> Found<Option<PathState>> {
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
