//! A path with all its branches, from where each begins to where it ends.

use super::events::Watch;
use super::follower::Follower;
use super::interpolant::Cubic;
use super::outcome::{Branch, BranchEnd, MarkedState, PathError, PathMark, PathSettings};
use super::problem::{ParametrizedProblem, PathState, Rates};
use crate::numerics::vector::{add_scaled, dot, norm_blocked};

/// Distance in arc length below which two branch points are one.
const SAME_POINT: f64 = 1e-6;
/// Distance from the interpolated path between two states, relative to their own, up to which a state is on it.
const ON_PATH: f64 = 5e-2;

/// A path on its way, with all its branches.
pub(super) struct Run<'a, P: ParametrizedProblem> {
    follower: Follower<'a, P>,
    watch: &'a mut dyn Watch<P>,
    observe: &'a mut dyn FnMut(usize, &P, &MarkedState) -> bool,
    origin: f64,
    pub branches: Vec<Branch>,
    /// Branch points that branches have left, which end others.
    points: Vec<MarkedState>,
    /// Largest rate of the conjugate quantity, and largest work or product of conjugate and parameter's way.
    largest: [f64; 2],
}

impl<'a, P: ParametrizedProblem> Run<'a, P> {
    /// A path that has not begun.
    pub fn new(
        problem: &'a mut P,
        settings: &PathSettings,
        watch: &'a mut dyn Watch<P>,
        observe: &'a mut dyn FnMut(usize, &P, &MarkedState) -> bool,
    ) -> Result<Self, PathError> {
        let origin = problem.parameter();
        let follower = Follower::new(problem, settings.clone())?;
        Ok(Self { follower, watch, observe, origin, branches: vec![], points: vec![], largest: [0.0; 2] })
    }

    /// Follows the branch from a start towards larger (`1.0`) or smaller parameters.
    pub fn main_branch(&mut self, x: Vec<f64>, tension: Vec<f64>, sign: f64) -> Result<(), PathError> {
        let state = self.follower.begin(x, tension, sign)?;
        self.branch(vec![MarkedState { state, mark: None, work: 0.0 }])
    }

    /// Follows one branch from its first states to its end.
    fn branch(&mut self, states: Vec<MarkedState>) -> Result<(), PathError> {
        let number = self.branches.len();
        self.branches.push(Branch { states: vec![], end: BranchEnd::Interrupted });
        let mut known: Vec<PathState> = states.iter().map(|marked| marked.state.clone()).collect();
        for marked in states {
            if !self.push(number, marked) {
                return Ok(());
            }
        }
        let mut watched = self.watch.values(self.follower.problem, &known[known.len() - 1]);
        let mut length = self.follower.first_step();
        while self.branches[number].states.len() < self.follower.settings.steps {
            let last = known[known.len() - 1].clone();
            let before = known.len().checked_sub(2).map(|k| known[k].clone());
            let Some((next, longer)) = self.follower.step(before.as_ref(), &last, length)? else {
                self.branches[number].end = BranchEnd::Failed;
                return Ok(());
            };
            length = longer;
            if let Some(point) = self.known_point(number, &last, &next) {
                return self.arrive(number, &last, point);
            }
            // beyond its end a path may mean nothing: marks are sought before it
            let (to, end) = match self.end_between(number, &last, &next)? {
                Some((state, end)) => (state, Some(end)),
                None => (next.clone(), None),
            };
            self.follower.problem.set_parameter(to.parameter);
            let values = self.watch.values(self.follower.problem, &to);
            let marks = self.follower.marks([&last, &to], self.largest[0], [&watched, &values], self.watch)?;
            if self.advance(number, &last, to, marks)? {
                return Ok(());
            }
            if let Some(end) = end {
                self.branches[number].end = end;
                return Ok(());
            }
            watched = values;
            known = vec![last, next];
        }
        self.branches[number].end = BranchEnd::Steps;
        Ok(())
    }

    /// Appends what lies between two states, and the second of them; returns whether the branch has ended before it, or
    /// the observer asks to stop.
    fn advance(
        &mut self,
        number: usize,
        last: &PathState,
        to: PathState,
        marks: Vec<(PathState, PathMark)>,
    ) -> Result<bool, PathError> {
        let mut from = last.clone();
        for (state, mark) in marks {
            if !self.add(number, &from, state.clone(), Some(mark))? {
                return Ok(true);
            }
            if let PathMark::Watched(function) = mark
                && self.watch.ends(function)
            {
                self.branches[number].end = BranchEnd::Watched(function);
                return Ok(true);
            }
            from = state;
        }
        Ok(!self.add(number, &from, to, None)?)
    }

    /// The branch point of another branch that lies between two states of this one.
    fn known_point(&self, number: usize, last: &PathState, next: &PathState) -> Option<MarkedState> {
        let between = |point: &&MarkedState| number > 0 && self.between(last, next, &point.state);
        self.points.iter().find(between).cloned()
    }

    /// Ends a branch at a branch point that is known.
    fn arrive(&mut self, number: usize, last: &PathState, point: MarkedState) -> Result<(), PathError> {
        let chord = Cubic::new(last, &point.state).chord();
        let way = self.size(&chord);
        let tangent = chord.scaled(1.0 / way);
        let conjugate = [point.state.conjugate[0], (point.state.conjugate[0] - last.conjugate[0]) / way];
        let state = PathState { arc_length: last.arc_length + way, tangent, conjugate, ..point.state };
        if self.add(number, last, state, point.mark)? {
            self.branches[number].end = BranchEnd::Returned;
        }
        Ok(())
    }

    /// The state between two others at which the branch ends, if there is one.
    fn end_between(
        &mut self,
        number: usize,
        last: &PathState,
        next: &PathState,
    ) -> Result<Option<(PathState, BranchEnd)>, PathError> {
        let passed = |value: f64| (last.parameter - value) * (next.parameter - value) <= 0.0 && last.parameter != value;
        let (target, most) = (self.follower.settings.target, self.follower.settings.length);
        for (value, end, applies) in [(target, BranchEnd::Target, true), (self.origin, BranchEnd::Returned, number > 0)]
        {
            if applies && passed(value) {
                let state = self.follower.at_parameter(last, next, value)?;
                return Ok(Some(state.map_or((next.clone(), BranchEnd::Failed), |state| (state, end))));
            }
        }
        if next.arc_length < most {
            return Ok(None);
        }
        let part = (most - last.arc_length) / (next.arc_length - last.arc_length);
        let state = self.follower.between(last, next, part)?;
        Ok(state.map(|state| (PathState { arc_length: most, ..state }, BranchEnd::Length)))
    }

    /// Appends a state with the work from the state before it; returns whether to go on.
    fn add(
        &mut self,
        number: usize,
        from: &PathState,
        state: PathState,
        mark: Option<PathMark>,
    ) -> Result<bool, PathError> {
        let way = (state.parameter - self.origin).abs();
        self.largest[0] = self.largest[0].max(state.conjugate[1].abs());
        self.largest[1] = self.largest[1].max(way * state.conjugate[0].abs());
        let work = self.follower.work(from, &state, self.largest[1])?;
        let before = self.branches[number].states.last().map_or(0.0, |marked| marked.work);
        Ok(self.push(number, MarkedState { state, mark, work: before + work }))
    }

    fn push(&mut self, number: usize, marked: MarkedState) -> bool {
        // states in between may have been visited since
        self.follower.problem.set_parameter(marked.state.parameter);
        let go_on = (self.observe)(number, self.follower.problem, &marked);
        self.branches[number].states.push(marked);
        if !go_on {
            self.branches[number].end = BranchEnd::Interrupted;
        }
        go_on
    }

    /// Follows the branches that leave at the branch points found, theirs too.
    pub fn other_branches(&mut self) -> Result<(), PathError> {
        let mut number = 0;
        while self.follower.settings.switch && number < self.branches.len() {
            let new = self.new_points(number);
            self.points.extend(new.iter().cloned());
            for point in new {
                let Some(PathMark::BranchPoint(multiplicity)) = point.mark else { continue };
                for first in self.follower.leaving(&point.state, multiplicity)? {
                    let full = self.branches.len() >= self.follower.settings.branches;
                    if full || self.branches.last().is_some_and(|branch| branch.end == BranchEnd::Interrupted) {
                        return Ok(());
                    }
                    if !self.known(&first) {
                        self.leave(&point, first)?;
                    }
                }
            }
            number += 1;
        }
        Ok(())
    }

    /// The branch points of a branch that no other one has.
    fn new_points(&self, number: usize) -> Vec<MarkedState> {
        let mut new: Vec<MarkedState> = vec![];
        for marked in &self.branches[number].states {
            let branches = matches!(marked.mark, Some(PathMark::BranchPoint(_)));
            if branches && !self.points.iter().chain(&new).any(|point| self.same(&point.state, &marked.state)) {
                new.push(marked.clone());
            }
        }
        new
    }

    /// Whether a state is on a branch that has been followed.
    fn known(&self, state: &PathState) -> bool {
        let pairs = self.branches.iter().flat_map(|branch| branch.states.windows(2));
        pairs.into_iter().any(|pair| self.between(&pair[0].state, &pair[1].state, state))
    }

    /// Whether a state is on the path from one state to the next.
    fn between(&self, from: &PathState, to: &PathState, state: &PathState) -> bool {
        let unit = self.follower.bordered.unit();
        let product = |a: &Rates, b: &Rates| dot(&a.x, &b.x) + a.parameter * b.parameter / (unit * unit);
        let cubic = Cubic::new(from, to);
        let (chord, way) = (cubic.chord(), Cubic::new(from, state).chord());
        let part = product(&way, &chord) / product(&chord, &chord);
        if !(0.0..=1.0).contains(&part) {
            return false;
        }
        let guess = cubic.at(part);
        let mut off = Rates { x: guess.x, tension: vec![], parameter: guess.parameter - state.parameter };
        add_scaled(&mut off.x, -1.0, &state.x);
        self.size(&off) <= ON_PATH * self.size(&chord)
    }

    /// Size of a change in arc length.
    fn size(&self, change: &Rates) -> f64 {
        norm_blocked(&change.x).hypot(change.parameter / self.follower.bordered.unit())
            / self.follower.bordered.length()
    }

    /// Follows the branch from a branch point through its first state.
    fn leave(&mut self, point: &MarkedState, first: PathState) -> Result<(), PathError> {
        let from = PathState { arc_length: 0.0, ..point.state.clone() };
        // the tangent at the branch point is that of the other path
        let chord = Cubic::new(&from, &first).chord();
        let rate = (first.conjugate[0] - from.conjugate[0]) / first.arc_length;
        let conjugate = [from.conjugate[0], rate];
        let begin = PathState { tangent: chord.scaled(1.0 / first.arc_length), conjugate, ..from };
        let work = point.work + self.follower.work(&begin, &first, self.largest[1])?;
        let states = [MarkedState { state: begin, ..point.clone() }, MarkedState { state: first, mark: None, work }];
        self.branch(states.to_vec())
    }

    /// Whether two states are the same.
    fn same(&self, a: &PathState, b: &PathState) -> bool {
        let chord = Cubic::new(a, b).chord();
        let apart = norm_blocked(&chord.x) / self.follower.bordered.length();
        apart.hypot(chord.parameter / self.follower.problem.parameter_scale()) <= SAME_POINT
    }
}
