//! The results of a study of kind `branches` in the summary.

use crate::output::counted;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The branches along which exact folding leaves the drawn state.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct BranchesSummary {
    /// Linear folding motions.
    pub modes: usize,
    /// Independent quadrics that these must satisfy to extend.
    pub quadrics: usize,
    /// Positive, negative and zero eigenvalues of the quadric; null where it is not just one.
    pub signature: Option<[usize; 3]>,
    /// Dimension of the set of solutions: 0 points, 1 a curve, and so on.
    pub dimension: usize,
    /// Isolated complex solutions, with multiplicity; where `dimension` is not 0, those on a random linear space.
    pub complex_solutions: usize,
    /// The same without multiplicity.
    pub distinct: usize,
    /// Bezout's number.
    pub expected: usize,
    /// Ends of paths on curves or more of solutions, where single ones are expected.
    pub on_continua: usize,
    /// Solutions of random combinations that do not satisfy all quadrics.
    pub extraneous: usize,
    /// Real singular points of the set of solutions, where it is a curve or of one quadric, and they are single points;
    /// otherwise null.
    pub singular: Option<usize>,
    /// What is established about the real directions: `listed` (each is one of `rays`), `continuum` (infinitely many,
    /// of which only those that stand alone are in `rays`), `not-established` (others were neither found nor excluded).
    #[schemars(extend("enum" = ["listed", "continuum", "not-established"]))]
    pub directions: String,
    /// Number of isolated real rays, two for each real solution.
    pub real_rays: usize,
    /// The isolated real rays.
    pub rays: Vec<RaySummary>,
}

/// A direction in which folding leaves the drawn state.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct RaySummary {
    /// Number of the branch, the same for a ray and its opposite.
    pub branch: usize,
    /// 1 for the ray whose first rate beyond 1e-6 is positive, -1 for its opposite.
    #[schemars(with = "serde_json::Value", extend("enum" = [1, -1]))]
    pub sign: i8,
    /// Multiplicity of the solution.
    pub multiplicity: usize,
    /// Rates of the fold angles of all edges, of norm 1.
    pub direction: Vec<f64>,
    /// Sign of the curvature, positive towards the face normals, 0 without any; null for a finite sheet.
    #[schemars(extend("minimum" = -1, "maximum" = 1))]
    pub curvature_sign: Option<i8>,
}

impl BranchesSummary {
    /// One sentence: the number of rays, and whether these are all directions in which the sheet folds.
    pub(crate) fn sentence(&self) -> String {
        let rays = match self.directions.as_str() {
            "continuum" => {
                format!(
                    "{}, and infinitely many directions that fill a curve or more",
                    counted(self.real_rays, "single real ray")
                )
            }
            "not-established" => format!("{} found, others not excluded", counted(self.real_rays, "real ray")),
            _ => counted(self.real_rays, "real ray"),
        };
        format!("{rays}, {} complex solutions of {}", self.complex_solutions, self.expected)
    }
}
