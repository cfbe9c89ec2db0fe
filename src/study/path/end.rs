//! The ends of branches in words.

use super::summary::percent;
use crate::analysis::path::{PathBranch, PathEnd};
use crate::output::figure::rounded;

/// Part of the way of a study of kind `fold` at which a sheet that has turned back counts as folded the other way.
pub(super) const INSIDE_OUT: f64 = -0.02;
/// Part of a value at which a path was to end at which it has done so: it ends there but for rounding.
const NEARLY: f64 = 0.999;

/// Returns the reason for which a branch did not come to its end; `None` if it did.
pub(super) fn reason(branch: &PathBranch) -> Option<String> {
    let at = branch.points.last().map_or(f64::NAN, |point| point.drive);
    match branch.end {
        PathEnd::Arrived | PathEnd::Stopped => None,
        PathEnd::Returned => {
            Some("the path came back to where it began without reaching the end of the drive".to_owned())
        }
        PathEnd::Retraced => Some(format!("the path goes back over its own states from drive {} on", rounded(at, 6))),
        PathEnd::Failed => Some(format!(
            "no step leads on from the state with drive {}, however short: the sheet is blocked there, has motions that \
             cost nothing, or a stiffness is too far from the others",
            rounded(at, 6)
        )),
        PathEnd::NoMinimum => {
            Some(format!("the sheet snaps at drive {}, and no minimum was found beyond", rounded(at, 6)))
        }
        PathEnd::TooManySteps => {
            let count = branch.points.len();
            Some(format!(
                "the drive has not arrived after {count} states, at {}: raise max_step, or give a stop",
                rounded(at, 6)
            ))
        }
        PathEnd::Interrupted => Some("interrupted".to_owned()),
    }
}

/// Returns the reason for which a sheet that is to be folded is not: it has turned back, and folds to the other side.
pub(super) fn inside_out(branch: &PathBranch) -> Option<String> {
    let last =
        branch.points.last().filter(|last| branch.end == PathEnd::Stopped && last.drive <= NEARLY * INSIDE_OUT)?;
    let most = branch.points.iter().map(|point| point.drive).fold(0.0, f64::max);
    Some(format!(
        "the sheet turned back at {} and folds the other way at {}: give a smaller max_step, bars nearer to rigid, or \
         switch = true for the branches that leave there",
        percent(most),
        percent(last.drive)
    ))
}

/// Returns the word for an end in tables and summaries.
pub(super) fn end_word(end: &PathEnd) -> &'static str {
    match end {
        PathEnd::Arrived => "arrived",
        PathEnd::Stopped => "stop",
        PathEnd::Returned => "returned",
        PathEnd::Retraced => "retraced",
        PathEnd::TooManySteps => "too-many-steps",
        PathEnd::Failed => "failed",
        PathEnd::NoMinimum => "no-minimum",
        PathEnd::Interrupted => "interrupted",
    }
}
