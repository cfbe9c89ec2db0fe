//! Branches that leave a path at its branch points.

use super::branching::Leaving;
use super::exits::Exit;
use super::interpolant::Cubic;
use super::outcome::{BranchEnd, Found, HalfBranches, MarkedState, PathMark};
use super::problem::{ParametrizedProblem, PathState};
use super::run::PathRun;

/// Largest number of branches.
const MOST_BRANCHES: usize = 64;
/// Part of the parameter's way within which a branch point is at the end of the path itself.
const AT_THE_POINT: f64 = 1e-6;

impl<P: ParametrizedProblem> PathRun<'_, P> {
    /// Follows the branches that leave at the branch points found, theirs too.
    pub fn other_branches(&mut self) -> Found<()> {
        let mut number = 0;
        while self.follower.settings.switch && number < self.branches.len() {
            let known = self.exits.len();
            if self.is_interrupted() {
                return Ok(());
            }
            self.find_exits(number)?;
            for exit in known..self.exits.len() {
                if self.branches.len() >= MOST_BRANCHES || self.is_interrupted() {
                    return Ok(());
                }
                let Exit { first, reference, found_at: (branch, state), .. } = self.exits[exit].clone();
                self.follower.go_to(&first, &reference)?;
                let is_known = self.is_known(&first)?;
                if let Some(counted) = self.branches[branch].half_branches.get_mut(&state) {
                    counted.left -= 1;
                    counted.known += usize::from(is_known);
                }
                if !is_known {
                    self.leave(exit)?;
                }
            }
            number += 1;
        }
        Ok(())
    }

    fn is_interrupted(&self) -> bool {
        self.branches.last().is_some_and(|branch| branch.end == BranchEnd::Interrupted)
    }

    /// Finds the ways out of the branch points of a branch that no other one has.
    fn find_exits(&mut self, number: usize) -> Found<()> {
        for state in 0..self.branches[number].states.len() {
            let point = self.branches[number].states[state].clone();
            let Some(PathMark::BranchPoint(multiplicity)) = point.mark else { continue };
            if self.points.iter().any(|known| self.follower.are_same(&known.state, &point.state)) {
                continue;
            }
            self.points.push(point.clone());
            self.follower.go_to(&point.state, &point.reference)?;
            let Leaving { firsts, expected } = self.follower.leaving(&point.state, multiplicity)?;
            let found = HalfBranches { found: firsts.len(), expected, known: 0, left: firsts.len() };
            self.branches[number].half_branches.insert(state, found);
            for (first, reference) in firsts {
                self.exits.push(Exit {
                    point: point.clone(),
                    first,
                    reference,
                    found_at: (number, state),
                    taken_by: None,
                });
            }
        }
        Ok(())
    }

    /// Follows the branch that leaves through an exit.
    fn leave(&mut self, exit: usize) -> Found<()> {
        self.exits[exit].taken_by = Some(self.branches.len());
        let Exit { point, first, .. } = self.exits[exit].clone();
        let from = PathState { arc_length: 0.0, ..point.state.clone() };
        // the tangent at the branch point is that of the other path
        let chord = Cubic::new(&from, &first).chord();
        let rate = (first.conjugate[0] - from.conjugate[0]) / first.arc_length;
        let conjugate = [from.conjugate[0], rate];
        let begin = PathState { tangent: chord.scaled(1.0 / first.arc_length), conjugate, ..from };
        let number = self.branches.len();
        let beside = AT_THE_POINT * self.follower.problem.parameter_scale();
        let end = self.end_between(number, [&begin, &first], beside)?;
        let (to, end) = end.map_or((first, None), |(state, end)| (state, Some(end)));
        let watched = [self.watched(&begin), self.watched(&to)];
        let watched = [&watched[0][..], &watched[1]];
        let marks = self.follower.marks_asked_for([&begin, &to], watched, self.watch)?;
        let (mut states, mut from) = (vec![MarkedState { state: begin.clone(), ..point }], begin);
        if self.meets(number, &mut states, &mut from, marks)? {
            return self.branch(states, Some(BranchEnd::Marked));
        }
        states.push(self.worked(number, &states, &from, to, None, None)?);
        self.branch(states, end)
    }

    /// Whether a state is on a branch that has been followed.
    fn is_known(&mut self, state: &PathState) -> Found<bool> {
        for branch in 0..self.branches.len() {
            for second in 1..self.branches[branch].states.len() {
                let pair = [second - 1, second].map(|k| self.branches[branch].states[k].state.clone());
                if self.follower.passes(&pair[0], &pair[1], state)? {
                    return Ok(true);
                }
            }
        }
        Ok(false)
    }
}
