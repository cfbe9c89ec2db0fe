//! Measurements: experiments that cannot be described by a scene, one in each file.

use super::findings::{ExperimentError, Findings};

mod cells;
mod extremes;
mod frequencies;
mod rigid_limit;
mod sizes;
mod steps;
mod stiffness;
mod tolerance;
mod trial;

/// A measurement; whether to leave out the parts that take long.
pub type Measurement = fn(bool) -> Result<Findings, ExperimentError>;

/// The measurements by name.
const MEASUREMENTS: &[(&str, Measurement)] = &[
    ("cells", cells::measure),
    ("extremes", extremes::measure),
    ("frequencies", frequencies::measure),
    ("rigid limit", rigid_limit::measure),
    ("sizes", sizes::measure),
    ("steps", steps::measure),
    ("stiffness", stiffness::measure),
    ("tolerance", tolerance::measure),
];

/// Returns the measurement of this name.
pub fn find(name: &str) -> Option<Measurement> {
    MEASUREMENTS.iter().find(|(known, _)| *known == name).map(|(_, measurement)| *measurement)
}
