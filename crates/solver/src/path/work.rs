//! The work along a path: the integral of the conjugate quantity over the parameter, and steps of which it is checked.

use super::follower::{Follower, LEAST_TANGENT_COSINE, SHRINK};
use super::interpolant::Cubic;
use super::outcome::Found;
use super::problem::{Ends, ParametrizedProblem, PathState};
use foldwell_numerics::larger;

/// How often a piece is halved at most.
const MOST_HALVINGS: usize = 7;
/// Difference of the potential's change and the work, relative to the largest product of conjugate and parameter's way, above
/// which a step has left its path; and part of the longest step below which none is asked.
const UNBALANCED: f64 = 1e-8;
const SHORTEST_CHECKED: f64 = 1e-3;
/// Rounding error of a sum of energies, and of work that is integrated, relative to their size.
const ROUNDING: f64 = 1e-12;

/// A step along a path.
pub(super) struct PathStep {
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
    /// The integral of the conjugate over the parameter, as well as it is known.
    work: f64,
    /// The change of the potential, and whether it is the work.
    change: f64,
    balanced: bool,
    /// The state half way if it was sought and found.
    middle: Option<PathState>,
}

impl Worked {
    /// The work between two states of which it is known that they are on one path: next to others no states between them
    /// may be found.
    pub(super) fn on_path(&self) -> f64 {
        if self.balanced || !self.change.is_finite() { self.work } else { self.change }
    }
}

impl<P: ParametrizedProblem> Follower<'_, P> {
    /// One step as [`Follower::step`] takes it. Along a path the potential changes by the work; where it does not, the
    /// step led to another curve of equilibria next to the path, and a shorter one is taken, from the reference of `last`.
    pub(super) fn balanced_step(
        &mut self,
        before: Option<&PathState>,
        last: &PathState,
        mut length: f64,
        reference: &[f64],
    ) -> Found<Option<PathStep>> {
        loop {
            let Some((state, longer)) = self.step(before, last, length)? else { return Ok(None) };
            let (largest, way) = (self.largest, state.arc_length - last.arc_length);
            self.measure(&state);
            let Worked { work, balanced, middle, .. } = self.work(last, &state)?;
            self.largest = largest;
            if balanced || way < SHORTEST_CHECKED * self.settings.max_step {
                // another branch, or motions that cost nothing, may be met half way
                let is_along = |end: &PathState, middle: &PathState| {
                    self.cosine(&end.tangent, &middle.tangent) >= LEAST_TANGENT_COSINE
                };
                let middle = middle.filter(|middle| is_along(last, middle) && is_along(&state, middle));
                return Ok(Some(PathStep { state, middle, work, longer }));
            }
            length = SHRINK * length.min(way);
            self.problem.set_reference(reference);
        }
    }

    /// The work from one state to the next. It is integrated by cubic interpolation between them and as many states of the
    /// path in between as it takes until the potential changes by it, as far as both are known; the better known of the
    /// two is the work. Where stiffness jumps no interpolation is good, and it is the change of the potential.
    pub(super) fn work(&mut self, from: &PathState, to: &PathState) -> Found<Worked> {
        let potentials = [self.potential(from), self.potential(to)];
        if self.problem.has_kinks() {
            let change = potentials[1] - potentials[0];
            return Ok(Worked { work: change, change, balanced: true, middle: None });
        }
        self.divided([from, to], potentials, MOST_HALVINGS)
    }

    fn divided(&mut self, ends: Ends<'_>, known: [f64; 2], left: usize) -> Found<Worked> {
        let [from, to] = ends;
        let whole = Cubic::new(from, to).work();
        let middle = if to.arc_length > from.arc_length { self.between(from, to, 0.5)? } else { None };
        let Some(middle) = middle else {
            return Ok(self.compared(ends, known, whole));
        };
        let halves = Cubic::new(from, &middle).work() + Cubic::new(&middle, to).work();
        // the error of a cubic falls with the fourth power of the length and more
        let change = halves - whole;
        let is_final = left == 0 || change.abs() <= noise(from, to).max(ROUNDING * self.largest[1].max(halves.abs()));
        let found = self.compared(ends, known, halves + change / 15.0);
        let is_known = found.balanced && known.iter().all(|potential| potential.is_finite());
        if is_known || is_final {
            return Ok(Worked { middle: Some(middle), ..found });
        }
        let at_middle = self.potential(&middle);
        let first = self.divided([from, &middle], [known[0], at_middle], left - 1)?;
        let second = self.divided([&middle, to], [at_middle, known[1]], left - 1)?;
        let (work, balanced) = (first.work + second.work, first.balanced && second.balanced);
        Ok(Worked { work, change: first.change + second.change, balanced, middle: Some(middle) })
    }

    /// Compares integrated work with the change of the potential, which is known but for rounding errors of sums, and for
    /// measures and forces that are not quite met.
    fn compared(&mut self, [from, to]: Ends<'_>, [before, after]: [f64; 2], integrated: f64) -> Worked {
        let change = after - before;
        let rounding = self.rounding(from, before) + self.rounding(to, after);
        let unbalanced = (change - integrated).abs();
        // what is left of forces works too
        let left = larger(from.residual_force, to.residual_force) * self.bordered.tangent.at.largest_force;
        let left = left * from.x.iter().zip(&to.x).map(|(x, y)| (y - x).abs()).sum::<f64>();
        let known = noise(from, to) + rounding + left + UNBALANCED * self.largest[1];
        let balanced = unbalanced.is_nan() || unbalanced <= known;
        let work = if balanced && unbalanced > rounding { change } else { integrated };
        Worked { work, change, balanced, middle: None }
    }

    /// The rounding error of the potential of a state.
    fn rounding(&mut self, state: &PathState, potential: f64) -> f64 {
        let pulls = state.tension.iter().zip(self.problem.gap_scale()).map(|(t, scale)| (t * scale).abs());
        ROUNDING * (potential.abs() + self.problem.energy(&state.x).abs()) + state.residual_length * pulls.sum::<f64>()
    }

    fn potential(&mut self, state: &PathState) -> f64 {
        self.problem.set_parameter(state.parameter);
        self.problem.conjugate_integral(&state.x, &state.tension)
    }
}

/// The work between two states that errors of the rates make.
fn noise(from: &PathState, to: &PathState) -> f64 {
    to.rate_errors[1] * (to.arc_length - from.arc_length) * (to.parameter - from.parameter).abs()
}
