//! The results of a study of kind `bloch` in the summary.

use crate::analysis::bloch::zero_lines::{Region, ZeroLine};
use crate::output::counted;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Spatially varying modes.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct BlochSummary {
    /// `[m, n, c]` of the centred determinant `sum c z1^m z2^n`; empty where there is none.
    pub determinant: Vec<[f64; 3]>,
    /// Why there is no determinant, so that all that is read off it is null or empty: it vanishes at all wavenumbers,
    /// or is rounding; null where there is one.
    #[serde(default)]
    pub no_determinant: Option<String>,
    /// Largest `|c_mn - c_-m,-n|` over the largest coefficient; null without a determinant.
    pub symmetry_error: Option<f64>,
    /// Largest imaginary part on the zone over the largest magnitude; null without a determinant.
    pub imaginary_part: Option<f64>,
    /// At every given `q1`; empty without a determinant.
    pub decay: Vec<DecaySummary>,
    /// Largest `|kappa2 + kappa2'|` of a pair; null where no pair is known well enough to be compared.
    pub pairing_error: Option<f64>,
    /// Largest condition number of the roots of these pairs; null where there are none.
    pub pairing_condition: Option<f64>,
    /// Roots left out of the pairing, whose condition is larger.
    pub ill_conditioned: usize,
    /// Half the difference of the numbers of roots `z1`, `z2` inside and outside the unit circle, averaged; null
    /// without a determinant.
    pub polarization: Option<[f64; 2]>,
    /// Mean numbers of roots on the unit circle; null without a determinant.
    pub on_circle: Option<[f64; 2]>,
    /// Part of the wavenumbers of the grid at which the determinant is positive, among those at which its sign is
    /// certain; null where it is not real.
    pub positive_fraction: Option<f64>,
    /// Number of lines of zeros in the zone; null where the determinant is not real, and none were looked for, or where
    /// they could not be followed.
    pub zero_lines: Option<usize>,
    /// Why they could not be followed; null where they were, or were not looked for.
    #[serde(default)]
    pub no_zero_lines: Option<String>,
    /// The lines.
    pub lines: Vec<ZeroLine>,
    /// Parts of the zone of one sign, the largest first.
    pub regions: Vec<Region>,
    /// Order to which the determinant vanishes at `q = 0`; null where it is not real.
    pub order_at_origin: Option<usize>,
    /// Angles in the plane of `(q1, q2)` at which zero lines pass `q = 0`.
    pub directions: Vec<f64>,
    /// Rotation angles from a cell to the next of the state that was asked about: wavenumbers of its rotations about
    /// directions across the axis. Null of the drawn state.
    pub theta: Option<[f64; 2]>,
    /// Distance of these wavenumbers from a zero of the determinant, its value there over its gradient; null of the
    /// drawn state.
    pub theta_to_zero: Option<f64>,
    /// The strip; null without one.
    #[serde(default)]
    pub strip: Option<StripSummary>,
}

/// Zero modes of a strip with free edges.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct StripSummary {
    /// Cells across it.
    pub cells: usize,
    /// Wavenumbers along it.
    pub q1: Vec<f64>,
    /// Number of zero modes at each.
    pub zero_modes: Vec<usize>,
    /// Number of self stresses at each.
    pub self_stresses: Vec<usize>,
    /// Smallest singular value that is not zero over the largest that is, at each.
    pub gap: Vec<f64>,
    /// Largest difference of a measured rate from the predicted one; null where none was compared.
    pub error: Option<f64>,
    /// Number of rates that were compared.
    pub compared: usize,
    /// Number of predicted rates that were not found in the strip.
    pub unmatched: usize,
    /// Zero modes bound to the interface at each wavenumber; empty without an interface.
    pub interface_zero_modes: Vec<usize>,
    /// Self stresses bound to the interface.
    pub interface_self_stresses: Vec<usize>,
    /// Zero modes less self stresses that the winding numbers of both determinants predict; null where one of them
    /// vanishes at all wavenumbers.
    pub interface_predicted: Vec<Option<i64>>,
}

/// Roots at one wavenumber.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct DecaySummary {
    /// The wavenumber.
    pub q1: f64,
    /// `log|z2|` of every root, ascending.
    pub kappa2: Vec<f64>,
    /// Condition number of every root.
    pub condition: Vec<f64>,
    /// How many roots coincide with every root, itself among them, as far as the rigidity matrix tells.
    pub multiplicity: Vec<usize>,
    /// Whether the determinant vanishes at this wavenumber for every `z2`, so that there are no roots.
    #[serde(default)]
    pub vanishes: bool,
}

impl BlochSummary {
    /// One sentence: zero lines, and how well roots pair.
    pub(crate) fn sentence(&self) -> String {
        let lines = self.zero_lines.map(|count| counted(count, "zero line"));
        let lines = lines
            .or_else(|| self.no_determinant.clone())
            .or_else(|| self.no_zero_lines.clone())
            .unwrap_or_else(|| "no real determinant, so that zero lines are not looked for".to_owned());
        let pairing = self
            .pairing_error
            .map_or("no root known well enough to be paired".to_owned(), |error| format!("pairing error {error:.1e}"));
        let decays = self.polarization.map(|[p1, p2]| format!(", {pairing}, polarization ({p1}, {p2})"));
        lines + &decays.unwrap_or_default()
    }
}
