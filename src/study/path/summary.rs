//! The results of a study of kind `path` in the summary.

use crate::output::counted;
use crate::output::figure::rounded;
use crate::study::sides::RestSides;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Equilibria along a driven quantity.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct PathSummary {
    /// Name of the drive.
    pub drive: String,
    /// The kind of the driven quantity.
    #[schemars(extend("enum" = ["displacement", "rotation", "load", "pressure", "volume", "lock", "rest", "stiffness"]))]
    pub driven: String,
    /// Its value at the first end that was asked for; null: infinite stiffness.
    pub to: Option<f64>,
    /// The branches: number 0 begins at the start, the others at branch points.
    pub branches: Vec<PathBranchSummary>,
    /// Values of `at` that no branch passes: their rows are missing.
    #[serde(default)]
    pub not_passed: Vec<f64>,
}

/// A branch of equilibria.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct PathBranchSummary {
    /// Number of the branch.
    pub branch: usize,
    /// How it ended.
    #[schemars(extend("enum" = ["arrived", "stop", "returned", "retraced", "failed", "no-minimum", "too-many-steps", "interrupted"]))]
    pub end: String,
    /// Number of its states.
    pub steps: usize,
    /// Newton steps to all its states, those to states that were refused included.
    pub iterations: usize,
    /// Arc length of its last state; null where it has none.
    pub arc_length: Option<f64>,
    /// Driven value of its last state; null where it has none, or for infinite stiffness.
    pub drive: Option<f64>,
    /// Reaction at its last state; null where it has none.
    pub reaction: Option<f64>,
    /// Work of the drive up to its last state; null where it has none.
    pub work: Option<f64>,
    /// Energy of its last state; null where it has none.
    pub energy: Option<f64>,
    /// Energy dissipated up to its last state; null where nothing yields.
    #[serde(default)]
    pub dissipated: Option<f64>,
    /// The sides to which its last state is folded; null where the path does not arrive at all rest angles.
    #[serde(default)]
    pub rest_sides: Option<RestSides>,
    /// Whether all its states are stable while the driven value is held.
    pub stable: bool,
    /// Largest scaled residual of its states; null where it has none.
    pub max_residual: Option<f64>,
    /// Whether faces of one of its states pass through each other; null where that was not asked.
    pub self_intersecting: Option<bool>,
    /// Where faces first pass through each other; null where they do not, or where that was not asked.
    pub first_self_intersection: Option<FirstCrossing>,
    /// The states at which something special happens.
    pub events: Vec<PathEventSummary>,
}

/// A state of a path at which something special happens.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct PathEventSummary {
    /// The kind of the event.
    #[schemars(extend("enum" = ["limit-load", "limit-displacement", "branch-point", "self-intersection", "snap", "stop"]))]
    pub event: String,
    /// The driven value; null: infinite stiffness.
    pub drive: Option<f64>,
    /// The reaction.
    pub reaction: f64,
    /// Arc length from the beginning of the branch.
    pub arc_length: f64,
    /// Number of eigenvalues that change their sign at a branch point; null at other events.
    pub multiplicity: Option<usize>,
    /// The half branches that leave at a branch point; null at other events, and where they were not sought or were
    /// sought from another branch.
    pub half_branches: Option<HalfBranchesSummary>,
}

/// The half branches that leave at a branch point. A branch that passes through the point is two of them; that on which
/// the point was found does not count.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct HalfBranchesSummary {
    /// Number of those of which a state was found.
    pub found: usize,
    /// Number of all; null where it is not known.
    pub expected: Option<usize>,
    /// The reason for which there may be others than those found; null where there are none.
    pub reason: Option<String>,
    /// Number of those found that have no branch of their own, since they are on a branch that is listed before.
    #[serde(default)]
    pub known: usize,
    /// Number of those found that have none, since the path was interrupted or has as many branches as may be, 64.
    #[serde(default)]
    pub left: usize,
}

/// The first state of a branch whose faces pass through each other.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct FirstCrossing {
    /// Arc length from the beginning of the branch.
    pub arc_length: f64,
    /// The driven value; null: infinite stiffness.
    pub drive: Option<f64>,
}

impl PathSummary {
    /// One sentence: the end of every branch, and its events.
    pub(crate) fn sentence(&self) -> String {
        let value = |value: Option<f64>| match value {
            None => "inf".to_owned(),
            Some(value) if self.driven == "rest" => percent(value),
            Some(value) => format!("{value:.6}"),
        };
        let branches = self.branches.iter().map(|branch| {
            let events = branch.events.iter().map(|event| {
                let eigenvalues = event.multiplicity.filter(|count| *count > 1);
                let eigenvalues = eigenvalues.map_or(String::new(), |count| format!(" of {count} eigenvalues"));
                let place = format!("{}{eigenvalues} at {}", event.event, value(event.drive));
                format!("; {place}, reaction {:.6e}{}", event.reaction, half_branches(event.half_branches.as_ref()))
            });
            let number = if self.branches.len() > 1 { format!("branch {}: ", branch.branch) } else { String::new() };
            let end = format!("{number}{} at {} {}", branch.end, self.drive, value(branch.drive));
            let folded = branch.rest_sides.map_or(String::new(), |sides| {
                let (energy, off) = (branch.energy.unwrap_or(f64::NAN), sides.farthest.to_degrees());
                let said = RestSides::said([sides.on_rest_side, sides.hinges]);
                format!(", energy {energy:.9e}, {said}, at most {off:.1} degrees off")
            });
            let stable = if branch.stable { "" } else { ", not all stable" };
            format!("{end}{folded}, {}{stable}{}", counted(branch.steps, "state"), events.collect::<String>())
        });
        let said = branches.collect::<Vec<_>>().join("; ");
        let listed = |value: &f64| if self.driven == "rest" { percent(*value) } else { rounded(*value, 6) };
        let missing: Vec<String> = self.not_passed.iter().map(listed).collect();
        if missing.is_empty() { said } else { format!("{said}; not passed: {} of `at`", missing.join(", ")) }
    }
}

/// Returns a part as per cent.
pub(super) fn percent(part: f64) -> String {
    format!("{} %", rounded(100.0 * part, 6))
}

/// Describes how many half branches were found; empty where none were sought.
fn half_branches(sought: Option<&HalfBranchesSummary>) -> String {
    let Some(HalfBranchesSummary { found, expected, known, left, .. }) = sought else { return String::new() };
    let found = match expected {
        Some(expected) => format!(", {found} of {expected} half branches"),
        None => format!(", {found} half branches, not all directions sought"),
    };
    let unlisted = [(known, "on a branch that is listed before"), (left, "not followed: too many, or interrupted")];
    let unlisted = unlisted.iter().filter(|(count, _)| **count > 0).map(|(count, why)| format!(" ({count} {why})"));
    unlisted.fold(found, |said, why| said + &why)
}
