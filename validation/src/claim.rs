//! A claim about the program, as stated in a file in `validation/claims/`.
//!
//! ```toml
//! claim  = "what is claimed, in a sentence"
//! source = "where the expected value comes from"
//! quick  = true                                # also checked by `cargo run --release -p foldwell-validation -- --quick`; default false
//! scene  = "star-trace.toml"                   # a scene of meshes/; or  measurement = "tolerance"
//! value  = "studies.loops.branches.*.arc_length" # path in the result, for a scene in summary.json
//! expected  = [50.2037156, 9.9314250]          # or  at_most = 1e-10,  or  at_least = 5.9
//! tolerance = 1e-6                             # of `expected`, absolute; or  relative_tolerance = 1e-6
//! reason    = "why the tolerance, or the bound, has this value"
//! ```

use serde::{Deserialize, Serialize};
use thiserror::Error;

/// One number or several.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(untagged)]
pub enum Numbers {
    /// One number.
    One(f64),
    /// A list of numbers.
    Many(Vec<f64>),
}

impl Numbers {
    /// Returns the numbers as a list.
    pub fn list(&self) -> &[f64] {
        match self {
            Self::One(number) => std::slice::from_ref(number),
            Self::Many(numbers) => numbers,
        }
    }
}

/// The experiment that gives the value of a claim.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Experiment {
    /// A scene of `meshes/`, run as by `foldwell run`.
    Scene(String),
    /// Name of a measurement of [`super::measure`].
    Measurement(String),
}

/// The requirement on the value.
#[derive(Clone, Debug, PartialEq)]
pub enum Wanted {
    /// The value equals these numbers, each within `absolute + relative * |number|`.
    Equal {
        /// The expected numbers.
        numbers: Numbers,
        /// Absolute tolerance.
        absolute: f64,
        /// Relative tolerance.
        relative: f64,
    },
    /// No number is above this bound.
    AtMost(f64),
    /// No number is below this bound.
    AtLeast(f64),
}

/// A claim.
#[derive(Clone, Debug, PartialEq)]
pub struct Claim {
    /// Name of its file without extension.
    pub name: String,
    /// The statement, in a sentence.
    pub claim: String,
    /// Source of the expected value.
    pub source: String,
    /// Whether it is also checked by `cargo run --release -p foldwell-validation -- --quick`.
    pub quick: bool,
    /// The experiment that gives the value.
    pub experiment: Experiment,
    /// Path of the value in the result of the experiment; see [`super::verdict::numbers_at`].
    pub value: String,
    /// The requirement on the value.
    pub wanted: Wanted,
    /// Reason for the size of the tolerance or the bound.
    pub reason: String,
}

/// The reason why a file is not a valid claim.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum ClaimError {
    /// The file is not TOML, or has unknown keys.
    #[error("{name}: {message}")]
    Form {
        /// Name of the claim.
        name: String,
        /// Message of the parser.
        message: String,
    },
    /// The file has not exactly one of `scene` and `measurement`.
    #[error("{name}: a claim names one scene or one measurement")]
    Experiment {
        /// Name of the claim.
        name: String,
    },
    /// The file has not exactly one of `expected`, `at_most` and `at_least`, or has a tolerance without `expected`, or
    /// `expected` without a tolerance.
    #[error("{name}: a claim has `expected` with a tolerance, or `at_most`, or `at_least`")]
    Wanted {
        /// Name of the claim.
        name: String,
    },
}

/// The keys of the file.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Keys {
    claim: String,
    source: String,
    #[serde(default)]
    quick: bool,
    scene: Option<String>,
    measurement: Option<String>,
    value: String,
    expected: Option<Numbers>,
    tolerance: Option<f64>,
    relative_tolerance: Option<f64>,
    at_most: Option<f64>,
    at_least: Option<f64>,
    reason: String,
}

impl Claim {
    /// Reads a claim.
    ///
    /// # Errors
    /// [`ClaimError`] if the text is not a valid claim.
    pub fn parse(name: &str, text: &str) -> Result<Self, ClaimError> {
        let keys: Keys = toml::from_str(text)
            .map_err(|fault| ClaimError::Form { name: name.into(), message: fault.message().into() })?;
        let experiment = match (&keys.scene, &keys.measurement) {
            (Some(scene), None) => Experiment::Scene(scene.clone()),
            (None, Some(measurement)) => Experiment::Measurement(measurement.clone()),
            _ => return Err(ClaimError::Experiment { name: name.into() }),
        };
        let wanted = keys.wanted().ok_or_else(|| ClaimError::Wanted { name: name.into() })?;
        let Keys { claim, source, quick, value, reason, .. } = keys;
        Ok(Self { name: name.into(), claim, source, quick, experiment, value, wanted, reason })
    }

    /// Returns the command that computes the value.
    pub fn command(&self) -> String {
        match &self.experiment {
            Experiment::Scene(scene) => format!("foldwell run meshes/{scene}"),
            Experiment::Measurement(_) => format!("cargo run --release -p foldwell-validation -- {}", self.name),
        }
    }
}

impl Keys {
    fn wanted(&self) -> Option<Wanted> {
        let tolerances = self.tolerance.is_some() || self.relative_tolerance.is_some();
        match (&self.expected, self.at_most, self.at_least) {
            (Some(numbers), None, None) if tolerances => Some(Wanted::Equal {
                numbers: numbers.clone(),
                absolute: self.tolerance.unwrap_or(0.0),
                relative: self.relative_tolerance.unwrap_or(0.0),
            }),
            (None, Some(bound), None) if !tolerances => Some(Wanted::AtMost(bound)),
            (None, None, Some(bound)) if !tolerances => Some(Wanted::AtLeast(bound)),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const HEAD: &str = "claim = \"c\"\nsource = \"s\"\nquick = true\nvalue = \"v\"\nreason = \"r\"\n";

    fn parse(rest: &str) -> Result<Claim, ClaimError> {
        Claim::parse("a", &format!("{HEAD}{rest}"))
    }

    /// Claim: each way to state a value is read correctly.
    #[test]
    fn claims_are_read() {
        let claim =
            parse("scene = \"x.toml\"\nexpected = [1, 2.5]\ntolerance = 0.1\nrelative_tolerance = 0.2").unwrap();
        let numbers = Numbers::Many(vec![1.0, 2.5]);
        assert_eq!(claim.wanted, Wanted::Equal { numbers, absolute: 0.1, relative: 0.2 });
        assert_eq!(claim.command(), "foldwell run meshes/x.toml");
        let claim = parse("measurement = \"m\"\nat_most = 3").unwrap();
        assert_eq!(
            (&claim.wanted, claim.command()),
            (&Wanted::AtMost(3.0), "cargo run --release -p foldwell-validation -- a".to_owned())
        );
        assert_eq!(parse("measurement = \"m\"\nat_least = 3").unwrap().wanted, Wanted::AtLeast(3.0));
    }

    /// Claim: an ambiguous file is refused: with no or two experiments, no or two values, a value without tolerance, a
    /// bound with a tolerance, or unknown keys.
    #[test]
    fn what_is_no_claim_is_refused() {
        for rest in ["at_most = 1", "scene = \"x\"\nmeasurement = \"m\"\nat_most = 1"] {
            assert_eq!(parse(rest), Err(ClaimError::Experiment { name: "a".into() }), "{rest}");
        }
        for rest in ["", "expected = 1", "at_most = 1\nat_least = 1", "at_most = 1\ntolerance = 1"] {
            let rest = format!("scene = \"x\"\n{rest}");
            assert_eq!(parse(&rest), Err(ClaimError::Wanted { name: "a".into() }), "{rest}");
        }
        assert!(matches!(parse("scene = \"x\"\nat_most = 1\nother = 2"), Err(ClaimError::Form { .. })));
    }
}
