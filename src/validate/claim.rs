//! A claim about the program, as its file in `validation/claims/` states it.
//!
//! ```toml
//! claim  = "what is claimed, in a sentence"
//! source = "where the expected value comes from"
//! quick  = true                                # also checked by `foldwell validate --quick`; left out: false
//! scene  = "star-trace.toml"                   # a scene of meshes/; or  measurement = "tolerance"
//! value  = "studies.loops.branches.*.arc_length" # path in what it gives; of a scene that is summary.json
//! expected  = [50.2037156, 9.9314250]          # or  at_most = 1e-10,  or  at_least = 5.9
//! tolerance = 1e-6                             # of `expected`, absolute; or  relative_tolerance = 1e-6
//! reason    = "why the tolerance, or the bound, is what it is"
//! ```

use serde::{Deserialize, Serialize};
use thiserror::Error;

/// A number or several.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(untagged)]
pub(crate) enum Numbers {
    /// One number.
    One(f64),
    /// A list.
    Many(Vec<f64>),
}

impl Numbers {
    /// The numbers.
    pub(crate) fn list(&self) -> &[f64] {
        match self {
            Self::One(number) => std::slice::from_ref(number),
            Self::Many(numbers) => numbers,
        }
    }
}

/// Where the value comes from.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Experiment {
    /// A scene of `meshes/`, run as `foldwell run` does.
    Scene(String),
    /// A measurement of [`super::measure`].
    Measurement(String),
}

/// What the value has to be.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Wanted {
    /// These numbers, each within `absolute + relative * |number|`.
    Equal {
        /// The numbers.
        numbers: Numbers,
        /// Absolute tolerance.
        absolute: f64,
        /// Relative tolerance.
        relative: f64,
    },
    /// No number above this one.
    AtMost(f64),
    /// No number below this one.
    AtLeast(f64),
}

/// A claim.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Claim {
    /// Name of its file without ending.
    pub name: String,
    /// What is claimed.
    pub claim: String,
    /// Where the expected value comes from.
    pub source: String,
    /// Whether it is among the quick ones.
    pub quick: bool,
    /// What gives the value.
    pub experiment: Experiment,
    /// Which value of it.
    pub value: String,
    /// What it has to be.
    pub wanted: Wanted,
    /// Why the tolerance or the bound is what it is.
    pub reason: String,
}

/// Why a file states no claim.
#[derive(Clone, Debug, Error, PartialEq)]
pub(crate) enum ClaimError {
    /// It is no TOML, or has other keys.
    #[error("{name}: {message}")]
    Form {
        /// The claim.
        name: String,
        /// What is wrong.
        message: String,
    },
    /// There must be one of `scene` and `measurement`.
    #[error("{name}: a claim names one scene or one measurement")]
    Experiment {
        /// The claim.
        name: String,
    },
    /// There must be one of `expected`, `at_most`, `at_least`, and tolerances belong to the first.
    #[error("{name}: a claim has `expected` with a tolerance, or `at_most`, or `at_least`")]
    Wanted {
        /// The claim.
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
    /// [`ClaimError`] where the text is no claim.
    pub(crate) fn parse(name: &str, text: &str) -> Result<Self, ClaimError> {
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

    /// The command that computes the value.
    pub(crate) fn command(&self) -> String {
        match &self.experiment {
            Experiment::Scene(scene) => format!("foldwell run meshes/{scene}"),
            Experiment::Measurement(_) => format!("foldwell validate {}", self.name),
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

    /// Claim: each way of stating a value is read as it is meant.
    #[test]
    fn claims_are_read() {
        let claim =
            parse("scene = \"x.toml\"\nexpected = [1, 2.5]\ntolerance = 0.1\nrelative_tolerance = 0.2").unwrap();
        let numbers = Numbers::Many(vec![1.0, 2.5]);
        assert_eq!(claim.wanted, Wanted::Equal { numbers, absolute: 0.1, relative: 0.2 });
        assert_eq!(claim.command(), "foldwell run meshes/x.toml");
        let claim = parse("measurement = \"m\"\nat_most = 3").unwrap();
        assert_eq!((&claim.wanted, claim.command()), (&Wanted::AtMost(3.0), "foldwell validate a".to_owned()));
        assert_eq!(parse("measurement = \"m\"\nat_least = 3").unwrap().wanted, Wanted::AtLeast(3.0));
    }

    /// Claim: a file that leaves open what is claimed is refused: no or two experiments, no or two values, a value
    /// without tolerance, a bound with one, unknown keys.
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
