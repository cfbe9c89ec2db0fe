//! The ways out of branch points, and how a branch that arrives through one is told.
//!
//! Whether a state belongs to a branch that is known is decided by Newton's method: the branch's interpolant next to
//! the state is moved into the plane across the branch through the state, and corrected there, which leads to the same
//! state or to another one of that plane. The interpolant has to be nearer to its branch than other branches are. A
//! branch arrives at a branch point where it passes a state through which branches leave there; at the point itself,
//! where Newton's system is singular, nothing could be decided.

use super::bordered::Hyperplane;
use super::follower::Follower;
use super::interpolant::Cubic;
use super::outcome::{Found, MarkedState};
use super::problem::{Ends, ParametrizedProblem, PathState, Rates};
use foldwell_numerics::vector::{add_scaled, norm_blocked};

/// Distance in arc length below which two states are one.
pub(super) const SAME_STATE: f64 = 1e-6;

/// A way out of a branch point.
#[derive(Clone, Debug)]
pub(super) struct Exit {
    /// The branch point.
    pub point: MarkedState,
    /// The first state beyond it, with the reference of the problem there.
    pub first: PathState,
    pub reference: Vec<f64>,
    /// The branch on which the branch point was found, and the number of its state there.
    pub found_at: (usize, usize),
    /// The branch that began here.
    pub taken_by: Option<usize>,
}

impl<P: ParametrizedProblem> Follower<'_, P> {
    /// The branch point at which the branch with this number arrives through one of the exits, between two of its
    /// states.
    pub fn reached<'e>(
        &mut self,
        number: usize,
        exits: &'e [Exit],
        [last, next]: Ends<'_>,
    ) -> Found<Option<&'e MarkedState>> {
        for exit in exits.iter().filter(|exit| number > 0 && exit.taken_by != Some(number)) {
            if self.passes(last, next, &exit.first)? {
                return Ok(Some(&exit.point));
            }
        }
        Ok(None)
    }

    /// The last state of a branch that arrives at a branch point.
    pub fn arrival(&self, last: &PathState, point: &MarkedState) -> PathState {
        let chord = Cubic::new(last, &point.state).chord();
        let way = self.size(&chord);
        let tangent = chord.scaled(1.0 / way);
        let conjugate = [point.state.conjugate[0], (point.state.conjugate[0] - last.conjugate[0]) / way];
        PathState { arc_length: last.arc_length + way, tangent, conjugate, ..point.state.clone() }
    }

    /// Whether a state is on the branch between two states that follow each other on it. One with another number of
    /// negative eigenvalues than both is not, however near: the parameter may turn within a tiny way, as where faces
    /// touch.
    pub fn passes(&mut self, from: &PathState, to: &PathState, state: &PathState) -> Found<bool> {
        let counts = [from, to, state].map(|state| state.negative_eigenvalues);
        if let [Some(first), Some(second), Some(own)] = counts
            && first != own
            && second != own
        {
            return Ok(false);
        }
        let Some((mut guess, off)) = self.beside([from, to], state) else { return Ok(false) };
        let chord = Cubic::new(from, to).chord();
        let along = self.product(&off, &chord) / self.product(&chord, &chord);
        guess.add(along, &chord);
        let found = self.settle(guess, &Hyperplane::across(&chord, self.bordered.unit), 0.0)?;
        Ok(found.is_some_and(|(found, _)| self.are_same(&found, state)))
    }

    /// The interpolant between two states beside another one, and what leads from it to that; `None` where the other
    /// state is not beside the way, farther from it than the two from each other, or written in another way.
    pub fn beside(&self, [from, to]: Ends<'_>, state: &PathState) -> Option<(Rates, Rates)> {
        if [from, to].iter().any(|end| end.choice != state.choice) {
            return None;
        }
        let cubic = Cubic::new(from, to);
        let (chord, way) = (cubic.chord(), Cubic::new(from, state).chord());
        let part = self.product(&way, &chord) / self.product(&chord, &chord);
        if !(0.0..=1.0).contains(&part) {
            return None;
        }
        let guess = cubic.at(part);
        let mut off = Rates { x: state.x.clone(), tension: vec![], parameter: state.parameter - guess.parameter };
        add_scaled(&mut off.x, -1.0, &guess.x);
        (self.size(&off) <= self.size(&chord)).then_some((guess, off))
    }

    /// Whether two states are the same.
    pub fn are_same(&self, a: &PathState, b: &PathState) -> bool {
        a.choice == b.choice && self.size(&Cubic::new(a, b).chord()) <= SAME_STATE
    }

    /// Size of a change in arc length.
    pub(super) fn size(&self, change: &Rates) -> f64 {
        norm_blocked(&change.x).hypot(change.parameter / self.bordered.unit) / self.bordered.length
    }
}
