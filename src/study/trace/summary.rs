//! The results of a study of kind `trace` in the summary.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The trajectories of a study.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct TraceSummary {
    /// What is established about all directions in which folding leaves the drawn state, in the words of `branches`:
    /// whether the rays below, or those of the branch that was asked for, are all of them.
    #[serde(default)]
    #[schemars(extend("enum" = ["listed", "continuum", "not-established"]))]
    pub directions: String,
    /// One for each ray that was followed; where no ray is real, the one entry that says so.
    pub branches: Vec<TrajectorySummary>,
}

/// A trajectory along one ray.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct TrajectorySummary {
    /// Number of the branch; null where no ray is real.
    pub branch: Option<usize>,
    /// Which way along it, +1 or -1; null where no ray is real.
    #[schemars(with = "serde_json::Value", extend("enum" = [1, -1, null]))]
    pub sign: Option<i8>,
    /// Whether the fold angles come back to the start modulo 2 pi.
    pub closed: bool,
    /// Length in fold angles, radians.
    pub arc_length: f64,
    /// Accepted steps.
    pub steps: usize,
    /// Corrections of all steps.
    pub iterations: usize,
    /// Largest residual: of closure, or scaled, of the relaxations beside; null where there is no state.
    pub max_residual: Option<f64>,
    /// The ray along which it comes back; null where it does not.
    pub ends_at: Option<RayName>,
    /// How it ended.
    #[schemars(extend("enum" = ["closed", "stop", "failed", "interrupted", "no-real-branch"]))]
    pub end: String,
    /// Whether faces of a state on it pass through each other; null where that was not asked.
    #[serde(default)]
    pub self_intersecting: Option<bool>,
    /// Where faces first pass through each other; null where they do not, or it was not asked.
    pub first_self_intersection: Option<ArcLength>,
    /// Largest difference of a fold angle to the energy's; null where the two were not compared.
    pub error_to_kinematic: Option<f64>,
    /// Largest difference of a signed curvature to the energy's; left out where the two were not compared.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    #[schemars(with = "f64")]
    pub error_of_curvature: Option<f64>,
    /// Largest difference of a strain to the energy's; left out where the two were not compared.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    #[schemars(with = "f64")]
    pub error_of_strain: Option<f64>,
    /// Largest difference of a rotation angle to the energy's, in radians; left out where the two were not compared.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    #[schemars(with = "f64")]
    pub error_of_theta: Option<f64>,
    /// Where curvature and strains turn.
    pub turning_points: Vec<TurningPoint>,
    /// Where a tube that keeps one closing condition meets the other one too, after its start; left out for other
    /// sheets.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    #[schemars(with = "Vec<ClosedTube>")]
    pub closed_tubes: Option<Vec<ClosedTube>>,
}

/// A ray by its branch and sign.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct RayName {
    /// Number of the branch.
    pub branch: usize,
    /// +1 or -1.
    #[schemars(with = "serde_json::Value", extend("enum" = [1, -1]))]
    pub sign: i8,
}

/// A place on a trajectory.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ArcLength {
    /// Arc length in fold angles, radians.
    pub arc_length: f64,
}

/// A state of a trajectory in which a tube is closed.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ClosedTube {
    /// Arc length in fold angles, radians.
    pub arc_length: f64,
    /// Signed curvature at vertex 0, an inverse length.
    pub curvature: f64,
}

/// An extremum of a quantity along a trajectory.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct TurningPoint {
    /// Which quantity.
    #[schemars(extend("enum" = ["curvature", "strain11", "strain22", "strain12"]))]
    pub of: String,
    /// Arc length in fold angles, radians.
    pub arc_length: f64,
    /// Its value there.
    pub value: f64,
}

impl TraceSummary {
    /// One sentence: the end of every trajectory, and whether there are directions that no trajectory follows.
    pub(crate) fn sentence(&self) -> String {
        let ends = self.branches.iter().map(|one| match one.branch {
            Some(_) => format!("{} at {:.6}", one.end, one.arc_length),
            None => "no real direction to fold along".to_owned(),
        });
        let others = match self.directions.as_str() {
            "continuum" => "; infinitely many other directions are not followed",
            "not-established" => "; other directions are not excluded",
            _ => "",
        };
        ends.collect::<Vec<_>>().join(", ") + others
    }
}
