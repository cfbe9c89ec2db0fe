//! The state of a path at its target, without the special states on the way.

use super::follower::Follower;
use super::outcome::{PathError, PathSettings};
use super::problem::{ParametrizedProblem, PathState};
use crate::newton::Start;

/// Follows the equilibria of a problem from a start near one, at its present parameter, until its parameter first
/// passes the target of the settings. `observe` sees every state and returns false to stop. Returns the last state, and
/// whether it is the one at the target.
///
/// # Errors
/// [`PathError`] if no equilibrium is found to begin with, or a linear system is too large.
pub fn reach<P: ParametrizedProblem>(
    problem: &mut P,
    start: Start,
    settings: &PathSettings,
    observe: &mut dyn FnMut(&P, &PathState) -> bool,
) -> Result<(PathState, bool), PathError> {
    let target = settings.target;
    let mut follower = Follower::new(problem, settings.clone())?;
    let mut last = follower.begin(start)?;
    let (mut before, mut length) = (None, follower.first_step());
    for _ in 0..settings.steps {
        if let Some(rewritten) = follower.chosen_anew(&last)? {
            (before, last) = (None, rewritten);
        }
        let Some((next, longer)) = follower.step(before.as_ref(), &last, length)? else { break };
        if (last.parameter - target) * (next.parameter - target) <= 0.0 {
            let end = follower.at_parameter(&last, &next, target)?;
            follower.problem.set_parameter(target);
            return Ok(end.map_or((last, false), |end| (end, true)));
        }
        if !observe(follower.problem, &next) {
            return Ok((next, false));
        }
        (before, last, length) = (Some(last), next, longer);
    }
    Ok((last, false))
}
