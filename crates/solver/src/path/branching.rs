//! Leaving a path at a branch point.
//!
//! At a branch point Newton's system is singular although the path goes on, and its null vectors are the directions in
//! which other equilibria leave (H. B. Keller, "Numerical solution of bifurcation and nonlinear eigenvalue problems",
//! 1977). A state of another branch is sought in the plane across such a direction at a small distance from the branch
//! point, which the path itself does not meet there.

use super::bordered::Hyperplane;
use super::follower::Follower;
use super::outcome::Found;
use super::problem::{ParametrizedProblem, PathState, Rates};
use foldwell_numerics::random::numbers;

/// Distance from the branch point at which a state of another branch is sought, relative to the longest step, and the
/// number of halves tried.
const DISTANCE: f64 = 0.1;
const MOST_HALVINGS: usize = 8;
/// Seed of the random vectors from which inverse iteration begins.
const SEED: u64 = 7;
/// Length of what is left of a null vector across the path below which it is the path's own direction.
const LEAST_ACROSS: f64 = 1e-3;

/// Random vectors of this many numbers, the same whenever they are asked for.
pub(super) fn guesses(unknowns: usize) -> impl Iterator<Item = Vec<f64>> {
    let mut numbers = numbers(SEED);
    std::iter::repeat_with(move || numbers.by_ref().take(unknowns).collect())
}

/// The first states of the branches that leave at a branch point, each with the reference of the problem there.
pub(super) struct Leaving {
    pub firsts: Vec<(PathState, Vec<f64>)>,
    /// Number of half branches that leave, where it is known.
    pub expected: Option<usize>,
}

impl<P: ParametrizedProblem> Follower<'_, P> {
    /// First states of the branches that leave at a branch point where this many eigenvalues vanish. Where one vanishes
    /// there are two, one to each side; where two vanish they are found on a ring. Where more vanish, or no ring tells,
    /// they are sought along the null vectors, and there may be others in directions between these.
    pub(super) fn leaving(&mut self, point: &PathState, multiplicity: usize) -> Found<Leaving> {
        let nulls = self.null_vectors(point, multiplicity)?;
        if let Ok(pair) = <&[Rates; 2]>::try_from(&nulls[..])
            && let Some(firsts) = self.ring_of(point, pair)?
        {
            return Ok(firsts);
        }
        let mut firsts = vec![];
        for direction in &nulls {
            for sign in [1.0, -1.0] {
                if let Some(first) = self.leave(point, direction, sign)? {
                    let reference = self.problem.reference(&first.x);
                    firsts.push((first, reference));
                }
            }
        }
        Ok(Leaving { firsts, expected: (multiplicity == 1).then_some(2) })
    }

    /// The half branches that a scan of the ring between two null vectors found; `None` where no ring is large enough
    /// to tell.
    fn ring_of(&mut self, point: &PathState, nulls: &[Rates; 2]) -> Found<Option<Leaving>> {
        let reference = self.problem.reference(&point.x);
        let Some((zeros, states)) = self.half_branches(point, nulls)? else { return Ok(None) };
        let mut firsts = vec![];
        for mut first in states {
            self.problem.set_reference(&reference);
            self.problem.accept(&mut first.x);
            let reference = self.problem.reference(&first.x);
            firsts.push((first, reference));
        }
        self.problem.set_reference(&reference);
        Ok(Some(Leaving { firsts, expected: Some(zeros) }))
    }

    /// The directions, across the path, of the motions whose stiffness vanishes: orthonormal.
    fn null_vectors(&mut self, point: &PathState, multiplicity: usize) -> Found<Vec<Rates>> {
        self.problem.set_parameter(point.parameter);
        self.bordered.linearize(self.problem, &point.x, &point.tension);
        self.bordered.factor()?;
        let plane = Hyperplane::across(&point.tangent, self.bordered.unit);
        let mut found: Vec<Rates> = vec![];
        for guess in guesses(point.x.len()).take(multiplicity) {
            let (null, _) = self.bordered.softest(&guess, &plane, &found);
            found.push(null);
        }
        let mut across: Vec<Rates> = vec![point.tangent.clone().scaled(1.0 / self.bordered.length)];
        for mut null in found {
            for other in &across {
                let part = self.product(&null, other);
                null.add(-part, other);
            }
            let length = self.product(&null, &null).sqrt();
            if length > LEAST_ACROSS {
                across.push(null.scaled(1.0 / length));
            }
        }
        Ok(across.split_off(1))
    }

    /// The first state of the branch that leaves along a direction, on the side of this sign.
    fn leave(&mut self, point: &PathState, direction: &Rates, sign: f64) -> Found<Option<PathState>> {
        let plane = Hyperplane::across(&direction.clone().scaled(sign), self.bordered.unit);
        for halving in 0..MOST_HALVINGS {
            let away = DISTANCE * self.settings.max_step * 0.5f64.powi(halving as i32);
            let step = sign * away * self.bordered.length;
            let mut guess = point.place();
            guess.add(step, direction);
            if let Some((mut state, off)) = self.settle(guess, &plane, away)?
                && off <= step.abs()
            {
                self.problem.accept(&mut state.x);
                return Ok(Some(state));
            }
        }
        Ok(None)
    }
}
