//! The errors of the generators, and the checks of parameters against their ranges.

use std::f64::consts::FRAC_PI_2;

use crate::math::short;
use crate::sheet::error::Defect;

/// Advice about parameters that are no angles.
const RANGES: &str = "the page of the pattern has the ranges: `foldwell new PATTERN --help`";

/// The reason why a pattern has no sheet for its parameters.
#[derive(Debug, thiserror::Error)]
#[allow(missing_docs)] // each variant is documented by its message
pub enum GenerateError {
    #[error("{message}")]
    Unknown { message: String, help: String },
    #[error(
        "`{name}` is {}; it should be {} {} and below {}", short(*value), if *closed { "at least" } else { "above" },
        short(*low), short(*high)
    )]
    Number { name: &'static str, value: f64, low: f64, closed: bool, high: f64 },
    #[error(
        "`{name}` is {} rad; it should be {} {} and below {}{}", short(*value),
        if *closed { "at least" } else { "above" }, short(*low), short(*high),
        perhaps_degrees(*value, *high)
    )]
    Angle {
        name: &'static str,
        /// Its value in radians.
        value: f64,
        low: f64,
        closed: bool,
        high: f64,
    },
    #[error("`{name}` is {value}; it should be from {low} to {high}")]
    Count { name: &'static str, value: usize, low: usize, high: usize },
    #[error("`{name}` is {value}; it should be even for this symmetry")]
    Odd { name: &'static str, value: usize },
    #[error(
        "no cell has these angles `ac`, `ad`, `bc` and `bd`: `fold` should be above {} rad and below {} rad",
        short(*low), short(*high)
    )]
    NoFold {
        /// Lower end of the range of `fold` in radians, not below the upper one.
        low: f64,
        high: f64,
    },
    #[error("these parameters together give no sheet: {0}")]
    Mesh(#[from] Defect),
}

impl GenerateError {
    /// Returns what would be right.
    pub fn help(&self) -> String {
        match self {
            Self::Unknown { help, .. } => help.clone(),
            Self::Angle { .. } | Self::NoFold { .. } => "angles are radians, or written as \"60 deg\"".to_owned(),
            _ => RANGES.to_owned(),
        }
    }
}

/// Returns a question, if an angle that is too large would be in its range as a number of degrees.
fn perhaps_degrees(value: f64, high: f64) -> String {
    if value > high && value.to_radians() < high { format!("; did you mean \"{value} deg\"?") } else { String::new() }
}

/// Checks `low < value < high`.
pub(super) fn between(name: &'static str, value: f64, low: f64, high: f64) -> Result<f64, GenerateError> {
    let good = low < value && value < high;
    if good { Ok(value) } else { Err(GenerateError::Number { name, value, low, closed: false, high }) }
}

/// Checks `low <= value < high`.
pub(super) fn from(name: &'static str, value: f64, low: f64, high: f64) -> Result<f64, GenerateError> {
    let good = low <= value && value < high;
    if good { Ok(value) } else { Err(GenerateError::Number { name, value, low, closed: true, high }) }
}

/// Checks that a length is above zero and below 1e6.
pub(super) fn length(name: &'static str, value: f64) -> Result<f64, GenerateError> {
    between(name, value, 0.0, 1e6)
}

pub(super) fn count(name: &'static str, value: usize, low: usize, high: usize) -> Result<usize, GenerateError> {
    if (low..=high).contains(&value) { Ok(value) } else { Err(GenerateError::Count { name, value, low, high }) }
}

/// Checks `low < value < high` of an angle in radians.
pub(super) fn angle_between(name: &'static str, value: f64, low: f64, high: f64) -> Result<f64, GenerateError> {
    let good = low < value && value < high;
    if good { Ok(value) } else { Err(GenerateError::Angle { name, value, low, closed: false, high }) }
}

/// Checks that the angle `fold`, in radians, is from 0 to below a right angle.
pub(super) fn fold_angle(value: f64) -> Result<f64, GenerateError> {
    let (low, high) = (0.0, FRAC_PI_2);
    let good = low <= value && value < high;
    if good { Ok(value) } else { Err(GenerateError::Angle { name: "fold", value, low, closed: true, high }) }
}
