//! The results of a study of kind `surface` in the summary.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The surface of folded states, or their curve.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct SurfaceSummary {
    /// States.
    pub points: usize,
    /// Dimension of the folded states: 2, or 1 where they are a curve, which has no triangles.
    #[serde(default = "surface_dimension")]
    pub dimension: usize,
    /// Triangles of states.
    pub triangles: usize,
    /// How the covering ended.
    #[schemars(extend("enum" = ["complete", "open", "given-up", "too-many-points", "interrupted", "no-real-branch"]))]
    pub coverage: String,
    /// Where no surface leaves the drawn state: what establishes it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub established: Option<String>,
    /// Of a complete covering: states within the largest curvature beside which triangles are missing, as where two
    /// surfaces cross at a small angle. No state is missing there.
    #[serde(default)]
    pub gaps: usize,
    /// Whether the surface has no border: it closes modulo 2 pi without meeting the largest curvature.
    pub closed: bool,
    /// Whether neighbouring triangles go the same way round everywhere.
    pub oriented: bool,
    /// Spatially periodic states at which nappes of the surface meet, each once.
    pub tips: usize,
    /// The curvature at which the surface ends.
    pub max_curvature: f64,
    /// Largest radius of a chart in fold angles.
    pub radius: f64,
    /// Largest closure residual; null where there is no state.
    pub max_residual: Option<f64>,
    /// The nappes from which the surface was begun, with the states that were reached from each.
    pub branches: Vec<PieceSummary>,
}

/// Dimension in summaries that do not say it.
fn surface_dimension() -> usize {
    2
}

/// The states that were reached from one nappe.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct PieceSummary {
    /// Number of the branch: the same for nappes opposite each other, and for those on one piece of the surface.
    pub branch: usize,
    /// Sign of the curvature with which it leaves the drawn state.
    #[schemars(with = "serde_json::Value", extend("enum" = [1, -1]))]
    pub sign: i8,
    /// States.
    pub points: usize,
}

impl SurfaceSummary {
    /// One sentence: the states, and what is established about them.
    pub(crate) fn sentence(&self) -> String {
        let SurfaceSummary { points, dimension, triangles, coverage, gaps, .. } = self;
        let shape = if *dimension == 1 { "a curve".to_owned() } else { format!("{triangles} triangles") };
        let established = self.established.iter().map(|established| format!(": {established}"));
        let gaps = (*gaps > 0).then(|| format!(", but triangles are missing beside {gaps} states"));
        format!("{points} states, {shape}, {coverage}") + &established.chain(gaps).collect::<String>()
    }
}
