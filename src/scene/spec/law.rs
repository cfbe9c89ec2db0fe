//! `law = { kind = "..", .. }` of bars and hinges: how their force grows with what they are off their rest values.

use std::f64::consts::PI;
use std::path::PathBuf;

use schemars::JsonSchema;
use serde::Deserialize;
use serde::de::value::SeqAccessDeserializer;
use serde::de::{SeqAccess, Unexpected};
use thiserror::Error;

use crate::scene::values::{Exactly, checked, numbers};
use crate::sheet::angle::Angle;
use crate::sheet::written::{Written, read_as_written, schema_any_of};

/// The reasons for which a number of a law is refused.
#[derive(Debug, Error)]
#[allow(missing_docs)] // each variant is documented by its message
pub enum LawFault {
    #[error("the exponents are {0} and {1}, expected two finite numbers that differ")]
    Exponents(f64, f64),
    #[error("the exponent is {0}, expected a number from 1 to 100")]
    Exponent(f64),
    #[error("the ratio is {0}, expected a finite number that is not negative")]
    Ratio(f64),
    #[error(
        "the stiffness changes at {0} and {1} off rest, expected one at most 0, one at least 0, and one of them finite"
    )]
    Yields(f64, f64),
    #[error("it yields at {0}, expected a positive number")]
    Bound(f64),
    #[error("the part is {0}, expected a number from 0 to 1")]
    Share(f64),
    #[error("the hardening is {0}, expected a number from 0 to below 1: the slope beyond the bound over the stiffness")]
    Slope(f64),
    #[error("the limits are {0} and {1} rad, expected one between -pi and 0, and one between 0 and pi")]
    Limits(f64, f64),
}

/// The law of the bars. `l` is the stretch of a bar, its length over its rest length.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[schemars(rename = "BarLaw")]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub enum BarLawSpec {
    /// The force EA (l - 1) of a spring, as without a law.
    Linear {},
    /// The force EA (l^(a - 1) - l^(b - 1)) / (a - b).
    Ogden {
        /// The exponents a and b.
        exponents: Exponents,
    },
    /// The force EA l (l^2 - 1) / 2.
    GreenLagrange {},
    /// Two stiffnesses: EA up to two strains, ratio EA beyond them.
    Bilinear {
        /// The stiffness beyond them over EA, at least 0.
        ratio: Ratio,
        /// The strains: a number on both sides, or [low, high], of which one may be infinite.
        at: Yields,
    },
    /// A curve through measured points.
    Table(CurveSpec),
    /// A formula.
    Formula {
        /// The force, of the length `m`, the rest length `m0` and the spring constant `k` = EA / `m0`; as
        /// "k*m0*ln(m/m0)".
        #[serde(alias = "torque")]
        force: String,
    },
}

/// The law of the creases, or of the facets.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[schemars(rename = "HingeLaw")]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub enum HingeLawSpec {
    /// The torque k d of a spring, d the angle off rest, as without a law.
    Linear {},
    /// Linear between two fold angles, and ever stiffer beyond them, without bound where it is folded flat.
    Stiffening {
        /// The two angles, the first below 0 and the second above.
        limits: Limits,
    },
    /// The torque k d^exponent of the angle d off rest, with its sign.
    Power {
        /// The exponent, at least 1.
        exponent: Exponent,
    },
    /// Two stiffnesses: k up to two angles off rest, ratio k beyond them.
    Bilinear {
        /// The stiffness beyond them over k, at least 0.
        ratio: Ratio,
        /// The angles off rest: one on both sides, or [low, high], of which one may be infinite.
        at: Turns,
    },
    /// A curve through measured points.
    Table(CurveSpec),
    /// A formula.
    Formula {
        /// The torque, of the fold angle `m`, the rest angle `m0` and the spring constant `k`; as "k*sinh(m - m0)".
        torque: String,
    },
}

impl BarLawSpec {
    /// The measured curve, if it is one.
    pub(crate) fn curve(&self) -> Option<&CurveSpec> {
        if let Self::Table(curve) = self { Some(curve) } else { None }
    }
}

impl HingeLawSpec {
    /// The finite angles off rest that it has in the scene; those of points may be up to a whole turn.
    pub(crate) fn changes(&self) -> Vec<Angle> {
        let angles: Vec<Angle> = match self {
            Self::Bilinear { at, .. } => vec![at.0[1], at.0[0]],
            Self::Table(curve) => {
                let points = curve.points.iter().flatten();
                points.map(|point| Angle { radians: point[0], has_unit: true }).collect()
            }
            _ => vec![],
        };
        angles.into_iter().filter(|angle| angle.radians.is_finite()).collect()
    }

    /// The measured curve, if it is one.
    pub(crate) fn curve(&self) -> Option<&CurveSpec> {
        if let Self::Table(curve) = self { Some(curve) } else { None }
    }
}

/// A curve through measured points: exactly one of `file` and `points`. A stiffness beside it scales the curve; left
/// out, the slope at rest is the stiffness.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[schemars(rename = "Curve")]
#[serde(deny_unknown_fields)]
pub struct CurveSpec {
    /// CSV: `angle,torque` of hinges, in radians off rest and torque per length; `strain,force` of bars.
    pub file: Option<PathBuf>,
    /// The same numbers in the scene, a pair for each point.
    pub points: Option<Vec<[f64; 2]>>,
}

/// `yield = { force, hardening, isotropic }`: bars that yield.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[schemars(rename = "BarYield")]
#[serde(deny_unknown_fields)]
pub struct BarYieldSpec {
    /// The force at which a bar first yields.
    pub force: YieldBound,
    /// Slope of the force beyond the bound over the stiffness, below 1; left out: 0.
    #[serde(default)]
    pub hardening: Slope,
    /// The part of the hardening that widens the bound on both sides (isotropic); the other part shifts it (kinematic).
    /// Left out: 0.
    #[serde(default)]
    pub isotropic: Share,
}

/// `yield = { moment, hardening, isotropic }`: creases or facets that yield.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[schemars(rename = "HingeYield")]
#[serde(deny_unknown_fields)]
pub struct HingeYieldSpec {
    /// The torque per length at which a hinge first yields.
    pub moment: YieldBound,
    /// Slope of the torque beyond the bound over the stiffness, below 1; left out: 0.
    #[serde(default)]
    pub hardening: Slope,
    /// The part of the hardening that widens the bound on both sides (isotropic); the other part shifts it (kinematic).
    /// Left out: 0.
    #[serde(default)]
    pub isotropic: Share,
}

numbers! { LawFault:
    /// A force, or a torque per length, at which an element yields.
    #[schemars(extend("exclusiveMinimum" = 0))]
    YieldBound, |bound| *bound > 0.0 && bound.is_finite(), Bound;

    /// The slope of a force beyond the bound over the stiffness.
    #[derive(Default)]
    #[schemars(extend("minimum" = 0, "exclusiveMaximum" = 1))]
    Slope, |slope| (0.0..1.0).contains(slope), Slope;

    /// A part of one, from 0 to 1.
    #[derive(Default)]
    #[schemars(extend("minimum" = 0, "maximum" = 1))]
    Share, |part| (0.0..=1.0).contains(part), Share;

    /// A ratio of stiffnesses.
    #[schemars(extend("minimum" = 0))]
    Ratio, |ratio| *ratio >= 0.0 && ratio.is_finite(), Ratio;

    /// The exponent of a torque.
    #[schemars(extend("minimum" = 1))]
    Exponent, |exponent| (1.0..=100.0).contains(exponent), Exponent;
}

/// The values off rest at which the stiffness of a bilinear law changes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Yields(pub(crate) [f64; 2]);

/// The angles off rest at which the stiffness of a bilinear law changes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Turns(pub(crate) [Angle; 2]);

read_as_written!(Yields, Turns);

impl Written for Turns {
    const FORMS: &str = "an angle above 0, or [low, high] with low <= 0 <= high";

    fn from_number<E: serde::de::Error>(size: f64, written: Unexpected<'_>) -> Result<Self, E> {
        Yields::from_number(size, written).map(|Yields(at)| Self(at.map(Angle::from)))
    }

    fn from_word<E: serde::de::Error>(text: &str) -> Result<Self, E> {
        let angle: Angle = text.parse().map_err(E::custom)?;
        Yields::from_number(angle.radians, Unexpected::Str(text))
            .map(|Yields(at)| Self(at.map(|radians| Angle { radians, ..angle })))
    }

    fn from_list<'de, A: SeqAccess<'de>>(list: A) -> Result<Self, A::Error> {
        let Exactly(at) = Exactly::<Angle, 2>::deserialize(SeqAccessDeserializer::new(list))?;
        Yields::between(at.map(|angle| angle.radians)).map(|_| Self(at))
    }
}

schema_any_of!(Turns as "Turns", generator, [
    generator.subschema_for::<Angle>(),
    generator.subschema_for::<[Angle; 2]>(),
]);

impl Yields {
    fn between<E: serde::de::Error>([low, high]: [f64; 2]) -> Result<Self, E> {
        let valid = low <= 0.0 && 0.0 <= high && (low.is_finite() || high.is_finite());
        if valid { Ok(Self([low, high])) } else { Err(E::custom(LawFault::Yields(low, high))) }
    }
}

impl Written for Yields {
    const FORMS: &str = "a number above 0, or [low, high] with low <= 0 <= high";

    fn from_number<E: serde::de::Error>(size: f64, _: Unexpected<'_>) -> Result<Self, E> {
        if size > 0.0 { Ok(Self([-size, size])) } else { Err(E::custom(LawFault::Yields(-size, size))) }
    }

    fn from_list<'de, A: SeqAccess<'de>>(list: A) -> Result<Self, A::Error> {
        let Exactly(at) = Exactly::<f64, 2>::deserialize(SeqAccessDeserializer::new(list))?;
        Self::between(at)
    }
}

schema_any_of!(Yields as "Yields", generator, [
    { "type": "number", "exclusiveMinimum": 0, "description": "on both sides" },
    generator.subschema_for::<[f64; 2]>(),
]);

checked! { LawFault:
    /// Two exponents that differ.
    #[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
    #[serde(try_from = "Exactly<f64, 2>")]
    #[schemars(with = "[f64; 2]")]
    Exponents(pub(crate) [f64; 2]) from Exactly<f64, 2>, |Exactly([a, b])| {
        let valid = a.is_finite() && b.is_finite() && a != b;
        if valid { Ok([a, b]) } else { Err(LawFault::Exponents(a, b)) }
    };

    /// Two fold angles, one on each side of flat.
    #[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
    #[serde(try_from = "Exactly<Angle, 2>")]
    #[schemars(with = "[Angle; 2]")]
    Limits(pub(crate) [f64; 2]) from Exactly<Angle, 2>, |Exactly(limits)| {
        let [low, high] = limits.map(|angle| angle.radians);
        let valid = -PI < low && low < 0.0 && 0.0 < high && high < PI;
        if valid { Ok([low, high]) } else { Err(LawFault::Limits(low, high)) }
    };
}
