//! The results of a study of kind `relax` in the summary.

use crate::analysis::relax::FoldingBranch;
use crate::output::counted;
use crate::study::energies::EnergySummary;
use crate::study::sides::RestSides;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// An equilibrium.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct RelaxSummary {
    /// Energy of the last state.
    pub energy: EnergySummary,
    /// Energy that elements have dissipated which yield; null where nothing does.
    #[serde(default)]
    pub dissipated: Option<f64>,
    /// Accepted Newton steps.
    pub iterations: usize,
    /// Factorizations.
    pub factorizations: usize,
    /// Solves with a factorization that was there already.
    pub chord_solves: usize,
    /// Largest unbalanced force over the largest force of any term; null where a relaxation failed before it was known.
    #[schemars(with = "Option<f64>")]
    pub residual_force: f64,
    /// Largest error of a length over the mean edge; null where a relaxation failed before it was known.
    #[schemars(with = "Option<f64>")]
    pub residual_length: f64,
    /// Negative eigenvalues of the energy's Hessian on what the rigid terms leave free; null where it did not converge,
    /// or where their number cannot be established.
    pub negative_eigenvalues: Option<usize>,
    /// Redundant rigid terms; null where they were not counted.
    pub self_stresses: Option<usize>,
    /// Whether faces of the last state pass through each other; null where that was not asked.
    pub self_intersecting: Option<bool>,
    /// Largest difference of a fold angle to the exact solver; null where that says nothing.
    pub error_to_kinematic: Option<f64>,
    /// Number of rays of rigid folding that leave the drawn state from which a rigid cell with locks was relaxed, where
    /// that is a branch point: other branches may end in other equilibria. Null elsewhere, and where these rays are not
    /// known.
    pub branch_point_start: Option<usize>,
    /// What is established about the directions of rigid folding there, in the words of `branches`; null where they
    /// were not looked for: other starts, bars that are not rigid, no locks.
    #[serde(default)]
    #[schemars(extend("enum" = ["listed", "continuum", "not-established", null]))]
    pub directions_at_start: Option<String>,
    /// The branch on which a flat sheet, or another singular start of rigid bars, was left; null for other starts.
    #[serde(default)]
    pub branch_choice: Option<FoldingBranch>,
    /// The ways that were taken, in order: in positions or fold angles from the start, then those that were tried after
    /// it.
    #[serde(default)]
    pub routes: Vec<RouteSummary>,
    /// Why fold angles were given up as unknowns; null where they were not tried or led to the result.
    #[serde(default)]
    pub intrinsic_failure: Option<String>,
    /// A row per iteration.
    pub history: Vec<IterationSummary>,
}

/// A way that a relaxation took.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub struct RouteSummary {
    /// Its name.
    #[schemars(extend("enum" = [
        "positions", "fold angles", "soft bars", "straight screw", "rest path", "stiffer bars", "saddle", "bent screw", "other tensions"
    ]))]
    pub name: String,
    /// Accepted steps that it added to the history; 0 where it did not help.
    pub iterations: usize,
    /// The failure that stood after it; null for an equilibrium.
    pub failure: Option<String>,
    /// Negative eigenvalues of the equilibrium that stood after it: those of a saddle, before it was left; null where
    /// there was none, or where they could not be counted.
    pub negative_eigenvalues: Option<usize>,
}

/// One iteration of a relaxation; null: not finite, before a relaxation failed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct IterationSummary {
    /// Number of the iteration; 0 is the start.
    pub iteration: usize,
    /// The merit: the energy, with the stiff terms through their tensions.
    #[schemars(with = "Option<f64>")]
    pub energy: f64,
    /// Largest unbalanced force over the largest force of any term.
    #[schemars(with = "Option<f64>")]
    pub residual_force: f64,
    /// Largest error of a length over the mean edge.
    #[schemars(with = "Option<f64>")]
    pub residual_length: f64,
    /// Fraction of the Newton step that was taken.
    pub step: f64,
    /// Shift added to the Hessian, over its largest diagonal entry.
    pub shift: f64,
    /// The unknowns: positions of the vertices, or fold angles, for which the residual length is the largest error of
    /// the faces' closure, in radians or mean edges.
    #[serde(default)]
    pub method: MethodName,
}

/// The unknowns of an iteration.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum MethodName {
    /// Positions of the vertices.
    #[default]
    Vertices,
    /// Fold angles.
    Intrinsic,
    /// Positions of the vertices, while rigid bars stretch to leave a singular start.
    #[serde(rename = "soft-bars")]
    SoftBars,
}

impl RelaxSummary {
    /// One sentence: energy and residuals, and a warning if the state is unstable, if faces pass through each other, or
    /// if other branches leave the start.
    pub(crate) fn sentence(&self, converged: bool) -> String {
        let unstable = match self.negative_eigenvalues {
            None if converged => ", whether it is stable is not known".to_owned(),
            None | Some(0) => String::new(),
            Some(count) => format!(", not stable ({})", counted(count, "negative eigenvalue")),
        };
        let crossing = if self.self_intersecting == Some(true) { ", faces pass through each other" } else { "" };
        let residuals = match [self.residual_force, self.residual_length] {
            [force, length] if force.is_nan() && length.is_nan() => "no residuals".to_owned(),
            [force, length] => format!("residuals {force:.1e} (force) {length:.1e} (length)"),
        };
        let iterations = counted(self.iterations, "iteration");
        let by_way_of: Vec<&str> =
            self.routes.iter().skip(1).filter(|route| route.iterations > 0).map(|route| route.name.as_str()).collect();
        let by_way_of =
            if by_way_of.is_empty() { String::new() } else { format!(", by way of {}", by_way_of.join(", ")) };
        let branching = match (self.branch_point_start, self.directions_at_start.as_deref()) {
            (_, Some("continuum")) => {
                ", infinitely many directions leave the start: others may lead to other equilibria".into()
            }
            (Some(rays), _) => {
                format!(", the start is a branch point with {rays} rays: other branches may have other equilibria")
            }
            (None, Some("not-established")) => ", it is not known whether the start is a branch point".into(),
            (None, _) => String::new(),
        };
        let left = self.branch_choice.map_or(String::new(), |FoldingBranch { hinges, on_rest_side, soft_bars }| {
            let by = if soft_bars { ", by bars that stretch at first" } else { "" };
            format!(", the start was left with {}{by}", RestSides::said([on_rest_side, hinges]))
        });
        format!(
            "energy {:.9e}, {iterations}, {residuals}{by_way_of}{unstable}{crossing}{branching}{left}",
            self.energy.total
        )
    }
}
