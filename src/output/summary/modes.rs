//! The results of a study of kind `modes` in the summary.

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
}
