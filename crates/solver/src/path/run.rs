//! A path with all its branches, from where each begins to where it ends.

use super::bordered::Hyperplane;
use super::events::{Marks, Watch};
use super::exits::{Exit, SAME_STATE};
use super::follower::{Follower, SHRINK};
use super::outcome::{Branch, BranchEnd, Found, MarkedState, PathError, PathMark, PathSettings};
use super::problem::{Ends, ParametrizedProblem, PathState};
use super::record::{PathEntry, PathObserver, PathRecord};
use super::work::PathStep;
use crate::newton::Start;
use crate::tension;
use std::collections::BTreeMap;

/// A path on its way, with all its branches.
pub(super) struct PathRun<'a, P: ParametrizedProblem> {
    pub follower: Follower<'a, P>,
    pub watch: &'a mut dyn Watch<P>,
    observer: &'a mut dyn PathObserver<P>,
    /// Results of an interrupted run.
    record: PathRecord,
    pub branches: Vec<Branch>,
    /// Branch points that branches have left, which end others, and the ways out of them.
    pub points: Vec<MarkedState>,
    pub exits: Vec<Exit>,
}

/// The data from which a branch is continued.
#[derive(Default)]
struct Way {
    /// The last two ordinary states, or those with which the branch begins.
    known: Vec<PathState>,
    /// Values of the watched functions at the last one.
    watched: Vec<f64>,
    /// Length of the next step.
    length: f64,
}

impl<'a, P: ParametrizedProblem> PathRun<'a, P> {
    /// A path that has not begun.
    pub fn new(
        problem: &'a mut P,
        settings: &PathSettings,
        watch: &'a mut dyn Watch<P>,
        observer: &'a mut dyn PathObserver<P>,
        record: PathRecord,
    ) -> Found<Self> {
        let follower = Follower::new(problem, settings.clone())?;
        let (branches, points, exits) = (vec![], vec![], vec![]);
        Ok(Self { follower, watch, observer, record, branches, points, exits })
    }

    /// Follows the branch from a start towards the target.
    pub fn main_branch(&mut self, start: Start) -> Found<()> {
        let state = self.follower.begin(start)?;
        let first = self.marked(state, None, 0.0);
        self.branch(vec![first], None)
    }

    /// Follows one branch from its first states to its end, which they may reach already; of what is recorded nothing is
    /// computed again.
    pub fn branch(&mut self, states: Vec<MarkedState>, end: Option<BranchEnd>) -> Found<()> {
        let number = self.branches.len();
        self.branches.push(Branch { states: vec![], end: BranchEnd::Interrupted, half_branches: BTreeMap::new() });
        let (recorded, mut way) = (self.record.take(number, &states), Way::default());
        let next_step = self.follower.first_step();
        let begin = PathEntry { branch: number, begins: true, states, next_step, end };
        let mut goes_on = if recorded.is_empty() {
            self.found(begin, None, &mut way)
        } else {
            let mut states = recorded.into_iter();
            states.try_fold(true, |on, entry| Ok::<_, PathError>(on && self.was_found(entry, &mut way)?))?
        };
        while goes_on {
            let before = self.follower.newton_steps;
            let (mut entry, watched) = self.step(number, &way)?;
            // the last state counts what was refused on the way to it, and what the states between cost
            let others: usize = entry.states.iter().rev().skip(1).map(|marked| marked.state.iterations).sum();
            if let Some(last) = entry.states.last_mut() {
                last.state.iterations = self.follower.newton_steps.saturating_sub(before + others);
            }
            goes_on = self.found(entry, Some(watched), &mut way);
        }
        Ok(())
    }

    /// Shows new states, as many as the branch may have, to the observer and appends them to their branch; returns whether
    /// the branch goes on.
    fn found(&mut self, mut entry: PathEntry, watched: Option<Vec<f64>>, way: &mut Way) -> bool {
        let room = self.follower.settings.steps.saturating_sub(self.branches[entry.branch].states.len());
        if entry.states.len() > room || (entry.states.len() == room && entry.end.is_none()) {
            entry.states.truncate(room);
            entry.end = Some(BranchEnd::Steps);
        }
        if !self.observer.entry(&entry) {
            return false;
        }
        for marked in &entry.states {
            // states in between may have been visited since
            self.follower.problem.set_parameter(marked.state.parameter);
            self.follower.problem.set_reference(&marked.reference);
            let go_on = self.observer.state(entry.branch, self.follower.problem, marked);
            self.branches[entry.branch].states.push(marked.clone());
            if !go_on {
                return false;
            }
        }
        self.goes_on(entry, watched, way)
    }

    /// Appends recorded states to their branch; returns whether the branch goes on.
    fn was_found(&mut self, entry: PathEntry, way: &mut Way) -> Found<bool> {
        for marked in &entry.states {
            self.follower.problem.set_parameter(marked.state.parameter);
            self.follower.go_to(&marked.state, &marked.reference)?;
            self.observer.known_state(entry.branch, self.follower.problem, marked);
            if !entry.begins {
                self.follower.measure(&marked.state);
            }
            self.branches[entry.branch].states.push(marked.clone());
        }
        Ok(self.goes_on(entry, None, way))
    }

    /// Moves to the end of new states; returns whether their branch goes on from there.
    fn goes_on(&mut self, entry: PathEntry, watched: Option<Vec<f64>>, way: &mut Way) -> bool {
        if let Some(end) = entry.end {
            self.branches[entry.branch].end = end;
            return false;
        }
        let turned = entry.states.iter().rposition(|marked| marked.mark == Some(PathMark::Turned));
        if turned.is_some() {
            way.known.clear();
        }
        let states = entry.states.into_iter().skip(turned.unwrap_or(0));
        let ordinary = states.filter(|marked| entry.begins || matches!(marked.mark, None | Some(PathMark::Turned)));
        way.known.extend(ordinary.map(|marked| marked.state));
        way.known.drain(..way.known.len().saturating_sub(2));
        way.length = entry.next_step;
        let Some(last) = way.known.last() else { return false };
        way.watched = watched.unwrap_or_else(|| self.watch.values(self.follower.problem, last));
        true
    }

    /// One step of a branch with all that lies in it, and the values of the watched functions at its end.
    fn step(&mut self, number: usize, way: &Way) -> Found<(PathEntry, Vec<f64>)> {
        let ended = |states: Vec<MarkedState>, end: BranchEnd| {
            (PathEntry { branch: number, begins: false, states, next_step: way.length, end: Some(end) }, vec![])
        };
        let [.., last] = &way.known[..] else { return Ok(ended(vec![], BranchEnd::Failed)) };
        let chosen_anew = self.follower.chosen_anew(last)?;
        let last = chosen_anew.as_ref().unwrap_or(last);
        let before =
            way.known.len().checked_sub(2).map(|k| &way.known[k]).filter(|before| before.choice == last.choice);
        let reference = self.follower.problem.reference(&last.x);
        let Some(PathStep { state: next, middle, work, longer }) =
            self.follower.balanced_step(before, last, way.length, &reference)?
        else {
            return Ok(ended(vec![], BranchEnd::Failed));
        };
        if let Some(point) = self.follower.reached(number, &self.exits, [last, &next])?.cloned() {
            let state = self.follower.arrival(last, &point);
            return Ok(ended(vec![self.worked(number, &[], last, state, point.mark, None)?], BranchEnd::Returned));
        }
        // beyond its end a path may mean nothing: marks are sought before it
        let (to, end, work) = match self.end_between(number, [last, &next], 0.0)? {
            Some((state, end)) => (state, Some(end), None),
            None if self.retraces(number, &next)? => (next, Some(BranchEnd::Retraced), Some(work)),
            None => (next, None, Some(work)),
        };
        let values = self.watched(&to);
        let watched = [&way.watched[..], &values];
        let (marks, is_one_curve) = self.follower.marks([last, &to], middle.as_ref(), watched, self.watch)?;
        let length = to.arc_length - last.arc_length;
        // another curve next to this one, which a shorter step does not meet
        if !is_one_curve && length > SAME_STATE {
            self.follower.problem.set_reference(&reference);
            let known = before.into_iter().chain([last]).cloned().collect();
            // states may be farther apart than the step was long
            let length = SHRINK * length.min(way.length);
            return self.step(number, &Way { known, watched: way.watched.clone(), length });
        }
        let (mut states, mut from) = (vec![], last.clone());
        if self.meets(number, &mut states, &mut from, marks)? {
            return Ok(ended(states, BranchEnd::Marked));
        }
        let work = work.filter(|_| states.is_empty());
        states.push(self.worked(number, &states, &from, to, None, work)?);
        if end == Some(BranchEnd::Target)
            && let Some(sign) = self.turn(number)
        {
            let (next_step, turned) = (self.follower.first_step(), self.turned(&mut states, sign)?);
            let end = (!turned).then_some(BranchEnd::Failed);
            return Ok((PathEntry { branch: number, begins: false, states, next_step, end }, values));
        }
        Ok((PathEntry { branch: number, begins: false, states, next_step: longer, end }, values))
    }

    /// Appends the marked states of a step in order to those before, and moves `from` to the last of them; returns whether
    /// the branch ends there.
    pub fn meets(
        &mut self,
        number: usize,
        states: &mut Vec<MarkedState>,
        from: &mut PathState,
        mut marks: Marks,
    ) -> Found<bool> {
        marks.sort_by(|a, b| a.0.arc_length.total_cmp(&b.0.arc_length));
        for (state, mark) in marks {
            states.push(self.worked(number, states, from, state.clone(), Some(mark), None)?);
            let before = self.states(number).iter().chain(&*states);
            if self.watch.ends(&before.filter_map(|marked| marked.mark).collect::<Vec<_>>()) {
                return Ok(true);
            }
            *from = state;
        }
        Ok(false)
    }

    /// Values of the watched functions at a state.
    pub fn watched(&mut self, state: &PathState) -> Vec<f64> {
        self.follower.problem.set_parameter(state.parameter);
        self.watch.values(self.follower.problem, state)
    }

    /// The states of a branch; none of one that has not begun.
    fn states(&self, number: usize) -> &[MarkedState] {
        self.branches.get(number).map_or(&[], |branch| &branch.states)
    }

    /// How often the parameter of a branch has begun to go another way.
    fn turns(&self, number: usize) -> usize {
        self.states(number).iter().filter(|marked| marked.mark == Some(PathMark::Turned)).count()
    }

    /// The parameter to which a branch goes now.
    fn target(&self, number: usize) -> f64 {
        let PathSettings { target, then, .. } = &self.follower.settings;
        self.turns(number).checked_sub(1).map_or(*target, |turn| then[turn])
    }

    /// The sign of the way that the parameter goes from the present target of a branch; `None` where it ends there.
    fn turn(&self, number: usize) -> Option<f64> {
        let next = self.follower.settings.then.get(self.turns(number))?;
        Some((next - self.target(number)).signum())
    }

    /// Lets the path go on from the last of these states towards larger (`1.0`) or smaller parameters. Returns whether
    /// it does.
    fn turned(&mut self, states: &mut [MarkedState], sign: f64) -> Found<bool> {
        let Some(last) = states.last_mut() else { return Ok(false) };
        self.follower.problem.set_parameter(last.state.parameter);
        self.follower.problem.set_reference(&last.reference);
        let plane = Hyperplane::of_parameter(last.state.x.len(), sign);
        let found = self.follower.settle(last.state.place(), &plane, last.state.arc_length)?;
        let Some((state, _)) = found else { return Ok(false) };
        (last.state, last.mark) = (state, Some(PathMark::Turned));
        Ok(true)
    }

    /// Whether a branch passed a state before, so that it goes on over its own states. Its last step is not asked.
    fn retraces(&mut self, number: usize, state: &PathState) -> Found<bool> {
        let between = |pair: &[&PathState]| {
            let [low, high] = [pair[0].parameter.min(pair[1].parameter), pair[0].parameter.max(pair[1].parameter)];
            (low..=high).contains(&state.parameter)
        };
        let all = &self.branches[number].states;
        let turned = all.iter().rposition(|marked| marked.mark == Some(PathMark::Turned)).unwrap_or(0);
        let ordinary = all[turned..].iter().filter(|marked| matches!(marked.mark, None | Some(PathMark::Turned)));
        let states: Vec<&PathState> = ordinary.map(|marked| &marked.state).collect();
        let passed: Vec<[PathState; 2]> = states[..states.len().saturating_sub(1)]
            .windows(2)
            .filter(|pair| between(pair) && self.follower.beside([pair[0], pair[1]], state).is_some())
            .map(|pair| [pair[0].clone(), pair[1].clone()])
            .collect();
        for [from, to] in &passed {
            if self.follower.passes(from, to, state)? {
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// The state between two others at which the branch ends, if there is one. It does not end at a parameter from which
    /// the first of them is no farther than `beside`.
    pub fn end_between(
        &mut self,
        number: usize,
        [last, next]: Ends<'_>,
        beside: f64,
    ) -> Found<Option<(PathState, BranchEnd)>> {
        let [from, to] = [last.parameter, next.parameter];
        let passed = |value: f64| (from - value) * (to - value) <= 0.0 && (from - value).abs() > beside;
        let (target, most) = (self.target(number), self.follower.settings.length);
        let (origin, returns) = (self.follower.origin, number > 0 || self.follower.settings.returns);
        for (value, end, applies) in [(target, BranchEnd::Target, true), (origin, BranchEnd::Returned, returns)] {
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

    /// A state with the work up to it, that from the state before it included, which may be known; `states` are those of
    /// the same step so far.
    pub fn worked(
        &mut self,
        number: usize,
        states: &[MarkedState],
        from: &PathState,
        state: PathState,
        mark: Option<PathMark>,
        known: Option<f64>,
    ) -> Found<MarkedState> {
        self.follower.measure(&state);
        let work = known.map_or_else(|| self.follower.work(from, &state).map(|worked| worked.on_path()), Ok)?;
        let before = states.last().or(self.states(number).last()).map_or(0.0, |marked| marked.work);
        Ok(self.marked(state, mark, before + work))
    }

    /// A state with what the problem knows at it.
    pub fn marked(&mut self, state: PathState, mark: Option<PathMark>, work: f64) -> MarkedState {
        self.follower.problem.set_parameter(state.parameter);
        let reference = self.follower.problem.reference(&state.x);
        let negative_eigenvalues = match state.negative_eigenvalues {
            None | Some(0) => state.negative_eigenvalues,
            Some(_) => tension::negative_eigenvalues(self.follower.problem, &state.x, &state.tension),
        };
        MarkedState { state, mark, negative_eigenvalues, work, reference }
    }
}
