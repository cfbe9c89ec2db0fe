//! The results of a study of kind `landscape` in the summary.

use crate::output::counted;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The landscapes of a study.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct LandscapeSummary {
    /// One for each mode.
    pub modes: Vec<ModeLandscape>,
    /// Energies in all directions, where they were asked for.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    #[schemars(with = "MapSummary")]
    pub map: Option<MapSummary>,
}

/// Energies over the sphere of curvature tensors.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct MapSummary {
    /// Norm of the tensors.
    pub amplitude: f64,
    /// Samples.
    pub samples: usize,
    /// Those that did not converge.
    pub failed: usize,
    /// Newton steps of all samples.
    pub iterations: usize,
    /// Largest energy; null where no sample converged.
    pub largest_energy: Option<f64>,
    /// Points on the exact cone of cylinders that the kinematics found.
    pub cone_points: usize,
    /// Largest angle, in radians, between some of these points and the zeros of the energy beside them; null without
    /// any.
    pub cone_distance: Option<f64>,
}

/// What a mode costs; null: too few samples for a fit, or no prediction.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ModeLandscape {
    /// The curvature tensor `[k11, k22, k12]` of a mode of a patch; null for waves.
    pub mode: Option<[f64; 3]>,
    /// How often a mode of a torus goes round it, where it was named so.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    #[schemars(with = "[i32; 2]")]
    pub wave: Option<[i32; 2]>,
    /// By rising amplitude.
    pub samples: Vec<SampleSummary>,
    /// Slope of log energy on the smallest amplitudes.
    pub exponent: Option<f64>,
    /// Standard error of the exponent; null also where there are no more samples than numbers to fit, and nothing tells
    /// it.
    pub exponent_error: Option<f64>,
    /// Limit of energy over the fourth power of the amplitude, from a fit.
    pub coefficient: Option<f64>,
    /// Standard error of the coefficient; null likewise.
    pub coefficient_error: Option<f64>,
    /// The same without a fit, from the second order.
    pub predicted_coefficient: Option<f64>,
    /// Coefficient of the fifth power, without a fit.
    pub predicted_fifth: Option<f64>,
    /// Coefficient of the sixth power, without a fit: where the fourth vanishes it leads.
    pub predicted_sixth: Option<f64>,
    /// Samples left out of the fits, because so much of their energy may be rounding.
    #[serde(default)]
    pub below_rounding: usize,
    /// Whether the fitted coefficient is the predicted one within both errors; null where there is no fit.
    #[serde(default)]
    pub fit_agrees: Option<bool>,
    /// Gaussian curvature `k11 k22 - k12^2` of the mode of a patch; null for waves.
    pub defect: Option<f64>,
}

/// A sample of a landscape.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct SampleSummary {
    /// Amplitude of the mode.
    pub amplitude: f64,
    /// Energy of the relaxed patch; null where it was not found.
    pub energy: Option<f64>,
    /// Whether so much of the energy may be rounding that it was left out of the fits.
    #[serde(default)]
    pub below_rounding: bool,
    /// Whether it is in another minimum than the sample before, and was left out of the fits too.
    #[serde(default)]
    pub other_minimum: bool,
    /// Whether it was found.
    pub converged: bool,
}

impl LandscapeSummary {
    /// One sentence: the exponent of every mode, and what theory predicts.
    pub(crate) fn sentence(&self) -> String {
        let modes = self.modes.iter().map(|one| {
            let mode = match (one.wave, one.mode) {
                (Some(wave), _) => format!("wave {wave:?}"),
                (_, mode) => format!("{:?}", mode.unwrap_or([f64::NAN; 3])),
            };
            let exponent = one.exponent.map_or("?".into(), |exponent| format!("{exponent:.3}"));
            let [c4, c6] = [one.predicted_coefficient, one.predicted_sixth].map(|c| c.unwrap_or(f64::NAN));
            let below = match one.below_rounding {
                0 => String::new(),
                count => format!(" ({} below rounding left out)", counted(count, "sample")),
            };
            let elsewhere = match one.samples.iter().filter(|sample| sample.other_minimum).count() {
                0 => String::new(),
                count => format!(" ({} in another minimum left out)", counted(count, "sample")),
            };
            let agrees = if one.fit_agrees == Some(false) { "; THE FIT DISAGREES" } else { "" };
            format!("{mode}: exponent {exponent}{below}{elsewhere}, predicted {c4:.6e} a^4, {c6:.6e} a^6{agrees}")
        });
        modes.collect::<Vec<_>>().join("; ")
    }
}
