//! The results of a study of kind `wells` in the summary.

use crate::analysis::wells::rigid::RigidPass;
use crate::output::counted;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Stable states, and the barriers between them.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct WellsSummary {
    /// Random starts.
    pub starts: usize,
    /// Those in which a relaxation failed, however often it was tried.
    pub failed: usize,
    /// Why they failed, the most frequent reason first.
    #[serde(default)]
    pub failures: Vec<FailedStartsSummary>,
    /// Those that ended in an equilibrium which is no minimum.
    pub saddles: usize,
    /// By rising energy.
    pub wells: Vec<WellSummary>,
    /// Those that were asked for.
    pub barriers: Vec<BarrierSummary>,
    /// The same in fold angles alone; null where it was not asked for.
    pub rigid: Option<RigidSummary>,
}

/// Random starts that failed for one reason.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct FailedStartsSummary {
    /// The reason.
    pub reason: String,
    /// How many failed for it.
    pub starts: usize,
}

/// A stable state.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct WellSummary {
    /// Elastic energy; under loads less their work from the drawn state.
    pub energy: f64,
    /// How many starts reached it.
    pub reached: usize,
    /// Whether faces pass through each other.
    pub self_intersecting: bool,
    /// Largest unbalanced force over the largest force of any term.
    pub residual_force: f64,
    /// Largest error of a length over the mean edge.
    pub residual_length: f64,
    /// Number of the well of the rigid sheet with these fold angles; null where there is none.
    pub rigid: Option<usize>,
}

/// A barrier that was asked for; null: not found, or not asked for.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct BarrierSummary {
    /// Between which wells.
    pub between: [usize; 2],
    /// Whether a pass was found: one negative eigenvalue, two different wells on its sides, these wells or two on the way.
    pub confirmed: bool,
    /// The wells into which the sheet descends from the pass: these, or two on the way of which it is the highest pass.
    pub joins: Option<[usize; 2]>,
    /// Energy of the pass at the sheet's own stiffness; where it is singular in the rigid limit, that of the flat state
    /// if the pass is that, and otherwise what the energies at finite stiffness tend to.
    pub energy: Option<f64>,
    /// Stiffness of the bars for which energy and height hold; null: rigid bars, or no pass was found.
    #[serde(default)]
    pub bars: Option<f64>,
    /// Stiffness of the bars in which the path was found that led to the pass.
    #[serde(default)]
    pub path_bars: Option<f64>,
    /// Energy of the pass above that of either of the wells that it joins.
    pub height: Option<[f64; 2]>,
    /// Whether there is no regular pass at the sheet's own stiffness, which is infinite: branches cross there.
    pub singular: bool,
    /// Energies tend to their rigid limit as this power of 1/stiffness; null where they are too few or too close.
    pub exponent: Option<f64>,
    /// Their limit, extrapolated.
    pub limit: Option<f64>,
    /// Estimate of the limit's error.
    #[serde(default)]
    pub limit_error: Option<f64>,
    /// Whether the singular pass is the flat state, whose energy is exact.
    #[serde(default)]
    pub flat: bool,
    /// The lowest pass of the rigid sheet between these wells, in fold angles alone.
    pub rigid: Option<f64>,
    /// Largest scaled residual of the pass.
    pub residual: Option<f64>,
    /// The pass on its way from soft bars.
    pub heights: Vec<HeightSummary>,
    /// Why there is no pass, or none whose energy is known; absent where there is.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    #[schemars(with = "String")]
    pub reason: Option<String>,
}

/// A pass at one stiffness of the bars.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct HeightSummary {
    /// Stiffness of the bars; null: rigid.
    pub bars: Option<f64>,
    /// Energy of the pass.
    pub energy: f64,
}

/// Wells and passes of a rigid sheet.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct RigidSummary {
    /// Dimension of the folded states.
    pub dimension: usize,
    /// How many were sampled.
    pub states: usize,
    /// Energies of the wells.
    pub wells: Vec<f64>,
    /// Energies of states that only the contact of two panels holds, a crease being shut.
    pub contacts: Vec<f64>,
    /// The passes at which lakes around wells meet as the water rises.
    pub passes: Vec<RigidPass>,
    /// Wells and passes of the samples that could not be made exact: the study did not converge where there are any.
    pub lost: usize,
    /// Places beyond which the folded states go on, or may, and were not sampled: likewise.
    #[serde(default)]
    pub open: usize,
}

impl WellsSummary {
    /// One sentence: the wells and the passes between them, and starts that ended elsewhere.
    pub(crate) fn sentence(&self) -> String {
        let energies = self.wells.iter().map(|well| format!("{:.6e}", well.energy)).collect::<Vec<_>>().join(", ");
        let barriers = self.barriers.iter().map(|barrier| {
            let bars = barrier.bars.map_or("rigid bars".to_owned(), |bars| format!("bars of {bars:e}"));
            let known = match (barrier.singular, barrier.flat, barrier.limit_error) {
                (true, true, _) => ", the flat state".to_owned(),
                (true, false, Some(error)) => format!(", extrapolated with an error of about {error:.0e}"),
                _ => String::new(),
            };
            let energy =
                barrier.energy.map_or("not found".to_owned(), |energy| format!("{energy:.6e} with {bars}{known}"));
            let way = barrier.joins.filter(|joins| joins.iter().any(|well| !barrier.between.contains(well)));
            let way = way.map_or(String::new(), |joins| format!(", which joins {joins:?}"));
            format!("; pass {:?} {energy}{way}", barrier.between)
        });
        let count = counted(self.wells.len(), "well");
        format!("{count} ({energies}){}{}", barriers.collect::<String>(), failures(self))
    }

    /// Returns the reasons for which starts failed, each with the number of them.
    pub(super) fn reasons(&self) -> String {
        self.failures.iter().map(|one| format!("{}: {}", one.starts, one.reason)).collect::<Vec<_>>().join("; ")
    }
}

/// Describes how many random starts ended in no minimum, and how many failed with the reasons; empty if there are none.
fn failures(found: &WellsSummary) -> String {
    let saddles = match found.saddles {
        0 => String::new(),
        count => format!("; {count} of {} ended in no minimum", counted(found.starts, "start")),
    };
    if found.failed == 0 {
        return saddles;
    }
    format!("{saddles}; {} of {} failed ({})", found.failed, counted(found.starts, "start"), found.reasons())
}
