//! `law = { kind = "..", .. }` of bars and hinges: how their force grows with what they are off their rest values.

use std::f64::consts::PI;
use std::sync::Arc;

use schemars::JsonSchema;
use serde::Deserialize;

use crate::model::{GreenLagrange, Law, Ogden, Stiffening};
use crate::scene::values::{Exactly, ValueError};
use crate::sheet::angle::Angle;

/// The law of the bars. `l` is the stretch of a bar, its length over its rest length.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[schemars(rename = "BarLaw")]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub enum BarLawSpec {
    /// The force EA (l^(a - 1) - l^(b - 1)) / (a - b).
    Ogden {
        /// The exponents a and b.
        exponents: Exponents,
    },
    /// The force EA l (l^2 - 1) / 2.
    GreenLagrange {},
}

/// The law of the creases, or of the facets.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[schemars(rename = "HingeLaw")]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub enum HingeLawSpec {
    /// Linear between two fold angles, and ever stiffer beyond them, without bound where it is folded flat.
    Stiffening {
        /// The two angles, the first below 0 and the second above.
        limits: Limits,
    },
}

/// Two exponents that differ.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(try_from = "Exactly<f64, 2>")]
#[schemars(with = "[f64; 2]")]
pub struct Exponents([f64; 2]);

impl TryFrom<Exactly<f64, 2>> for Exponents {
    type Error = ValueError;

    fn try_from(Exactly([a, b]): Exactly<f64, 2>) -> Result<Self, ValueError> {
        let valid = a.is_finite() && b.is_finite() && a != b;
        if valid { Ok(Self([a, b])) } else { Err(ValueError::Exponents(a, b)) }
    }
}

/// Two fold angles, one on each side of flat.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(try_from = "Exactly<Angle, 2>")]
#[schemars(with = "[Angle; 2]")]
pub struct Limits([f64; 2]);

impl TryFrom<Exactly<Angle, 2>> for Limits {
    type Error = ValueError;

    fn try_from(Exactly(limits): Exactly<Angle, 2>) -> Result<Self, ValueError> {
        let [low, high] = limits.map(|angle| angle.radians);
        let valid = -PI < low && low < 0.0 && 0.0 < high && high < PI;
        if valid { Ok(Self([low, high])) } else { Err(ValueError::Limits(low, high)) }
    }
}

impl BarLawSpec {
    /// Returns the law.
    pub(crate) fn law(&self) -> Arc<dyn Law> {
        match self {
            Self::Ogden { exponents } => Arc::new(Ogden { exponents: exponents.0 }),
            Self::GreenLagrange {} => Arc::new(GreenLagrange),
        }
    }
}

impl HingeLawSpec {
    /// Returns the law.
    pub(crate) fn law(&self) -> Arc<dyn Law> {
        let Self::Stiffening { limits } = self;
        Arc::new(Stiffening { limits: limits.0 })
    }
}
