//! The results of a study of kind `modes` in the summary.

use crate::analysis::modes::SeamMotions;
use crate::output::counted;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Modes of a state.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ModesSummary {
    /// Null space of the rigidity matrix of the bars.
    pub zero_modes: usize,
    /// Left null space of the rigidity matrix of the bars.
    pub self_stresses: usize,
    /// Zero modes that move the sheet as a whole.
    pub rigid_motions: usize,
    /// Null space of the closure conditions in fold angles; null where these do not say all, or are too many.
    pub folding_modes: Option<usize>,
    /// Columns minus rows of the rigidity matrix.
    pub maxwell_count: i64,
    /// Smallest singular value that was kept over the largest that was dropped; null: none was dropped, or it was 0.
    pub gap: Option<f64>,
    /// Lowest eigenvalues of the energy's Hessian, ascending.
    pub eigenvalues: Vec<f64>,
    /// Lowest angular frequencies of the sheet with its mass, ascending, in radians per time; exactly 0 where they
    /// vanish up to rounding, null for motions that grow. Left out without mass.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub frequencies: Option<Vec<Option<f64>>>,
    /// Rates at which these motions grow, one for each null among the frequencies, in the same order; left out where
    /// there are none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub growth_rates: Vec<f64>,
    /// Lowest factors of the loads, ascending, at which the state buckles to first order: 1 are the loads as given. Left out
    /// where they are not asked for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub critical_factors: Option<Vec<f64>>,
    /// Motions of a tube that its closing conditions leave free; left out on other domains.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub seam: Option<SeamMotions>,
}

impl ModesSummary {
    /// One sentence. Folding modes are counted separately, by fold angles: they are not a part of the zero modes.
    pub(crate) fn sentence(&self) -> String {
        format!(
            "{}, of which {} {} rigid; {}; {}",
            counted(self.zero_modes, "zero mode"),
            self.rigid_motions,
            if self.rigid_motions == 1 { "is" } else { "are" },
            if self.self_stresses == 1 {
                "1 self stress".into()
            } else {
                format!("{} self stresses", self.self_stresses)
            },
            match (self.folding_modes, &self.seam) {
                (Some(count), _) => counted(count, "folding mode"),
                (None, Some(SeamMotions { free, turn, rise, both, .. })) => format!(
                    "{} of the closed tube, {turn} if the seam may slip, {rise} if it may open, {free} without conditions",
                    counted(*both, "folding mode")
                ),
                (None, None) => "folding modes unknown".into(),
            },
        ) + &frequencies(self)
            + &buckling(self)
    }
}

/// Says the lowest critical factor; empty where none was asked for.
fn buckling(modes: &ModesSummary) -> String {
    let lowest = |factors: &Vec<f64>| match factors.first() {
        Some(lowest) => format!("; buckles at {lowest:.6e} times the loads"),
        None => "; buckles under no such loads".to_owned(),
    };
    modes.critical_factors.as_ref().map_or(String::new(), lowest)
}

/// Describes the lowest frequency above zero and the number of motions that grow; empty without mass.
fn frequencies(modes: &ModesSummary) -> String {
    let Some(frequencies) = &modes.frequencies else { return String::new() };
    let lowest = frequencies.iter().flatten().find(|frequency| **frequency > 0.0);
    let lowest =
        lowest.map_or("; no frequency above 0".to_owned(), |lowest| format!("; lowest frequency {lowest:.6e}"));
    match modes.growth_rates.len() {
        0 => lowest,
        count => format!("{lowest}, {} without frequency that grow", counted(count, "motion")),
    }
}
