//! Leaving a path at a branch point.
//!
//! At a branch point Newton's system is singular although the path goes on, and its null vectors are the directions in
//! which other equilibria leave (H. B. Keller, "Numerical solution of bifurcation and nonlinear eigenvalue problems",
//! 1977). A state of another branch is sought in the plane across such a direction at a small distance from the branch
//! point, which the path itself does not meet there.

use super::bordered::Plane;
use super::corrector::Guess;
use super::follower::Follower;
use super::outcome::PathError;
use super::problem::{ParametrizedProblem, PathState, Rates};
use crate::numerics::random::symmetric;
use crate::numerics::vector::{add_scaled, dot, norm_blocked};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;

/// Distance from the branch point at which a state of another branch is sought, relative to the longest step, and the
/// number of halves tried.
const DISTANCE: f64 = 0.1;
const MOST_HALVINGS: usize = 8;
/// Seed of the random vectors from which inverse iteration begins.
const SEED: u64 = 7;
/// Length of what is left of a null vector across the path below which it is the path's own direction.
const LEAST_ACROSS: f64 = 1e-3;

impl<P: ParametrizedProblem> Follower<'_, P> {
    /// First states of the branches that leave at a branch point where this many eigenvalues vanish, each with the
    /// reference of the problem there: two for each null vector, where they are found. Where several eigenvalues vanish
    /// there may be more branches, in directions between the null vectors.
    pub(super) fn leaving(
        &mut self,
        point: &PathState,
        multiplicity: usize,
    ) -> Result<Vec<(PathState, Vec<f64>)>, PathError> {
        let mut found = vec![];
        for direction in self.null_vectors(point, multiplicity)? {
            for sign in [1.0, -1.0] {
                found.extend(self.leave(point, &direction, sign)?.map(|first| (first, self.problem.reference())));
            }
        }
        Ok(found)
    }

    /// The directions, across the path, of the motions whose stiffness vanishes.
    fn null_vectors(&mut self, point: &PathState, multiplicity: usize) -> Result<Vec<Rates>, PathError> {
        self.problem.set_parameter(point.parameter);
        self.bordered.linearize(self.problem, &point.x, &point.tension);
        self.bordered.factor()?;
        let mut numbers = ChaCha8Rng::seed_from_u64(SEED);
        let mut found: Vec<Rates> = vec![];
        for _ in 0..multiplicity {
            let guess: Vec<f64> = point.x.iter().map(|_| symmetric(&mut numbers)).collect();
            let null = self.bordered.softest(&guess, &found);
            found.push(null);
        }
        let unit = self.bordered.unit();
        let tangent = Plane::across(&point.tangent, unit);
        let per_length = 1.0 / self.bordered.length();
        let across = |mut null: Rates| {
            let part = dot(&null.x, &tangent.x) * per_length;
            add_scaled(&mut null.x, -part, &point.tangent.x);
            add_scaled(&mut null.tension, -part, &point.tangent.tension);
            null.parameter = -part * point.tangent.parameter;
            let length = norm_blocked(&null.x).hypot(null.parameter / unit);
            (length > LEAST_ACROSS).then_some(null)
        };
        Ok(found.into_iter().filter_map(across).collect())
    }

    /// The first state of the branch that leaves along a direction, on the side of this sign.
    fn leave(&mut self, point: &PathState, direction: &Rates, sign: f64) -> Result<Option<PathState>, PathError> {
        let mut plane = Plane::across(direction, self.bordered.unit());
        plane.x.iter_mut().for_each(|x| *x *= sign);
        plane.parameter *= sign;
        for halving in 0..MOST_HALVINGS {
            let away = DISTANCE * self.settings.max_step * 0.5f64.powi(halving as i32);
            let step = sign * away * self.bordered.length();
            let mut guess = Guess { x: point.x.clone(), tension: point.tension.clone(), parameter: point.parameter };
            add_scaled(&mut guess.x, step, &direction.x);
            add_scaled(&mut guess.tension, step, &direction.tension);
            guess.parameter += step * direction.parameter;
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
