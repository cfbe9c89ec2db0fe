//! Choice of other held coordinates, where those that hold a sheet against rigid motions would hold its shape.

use crate::analysis::relax::run::{Ending, Run};
use crate::solver::Start;

/// How often the choice is made again.
const MOST_CHOICES: usize = 20;

/// Whether the held coordinates, which were chosen in the drawn state, may hold a shape in the one that was found:
/// where the sheet stays then is no equilibrium.
pub(super) fn is_needed(run: &Run<'_>, ending: &Ending) -> bool {
    ending.as_ref().is_ok_and(|found| !run.model.gauge_is_valid(&found.x))
}

/// The equilibrium, once what holds the sheet against rigid motions does nothing else.
pub(super) fn relaxed(run: &mut Run<'_>, ending: Ending) -> Ending {
    let mut found = ending?;
    for _ in 0..MOST_CHOICES {
        if run.model.gauge_is_valid(&found.x) {
            break;
        }
        let x = run.model.rebase_gauge(run.model.coordinates(&found.x));
        found = run.minimize(Start { x, tension: Some(found.tension) })?;
    }
    Ok(found)
}
