//! `[[part]]` and `[[drive]]`: vertices that move as one body, and the quantities that a path drives.

use std::borrow::Cow;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::value::SeqAccessDeserializer;
use serde::de::{Error, SeqAccess, Unexpected};
use serde::{Deserialize, Deserializer};

use super::vertices::VertexSet;
use crate::scene::Located;
use crate::scene::values::{EdgeName, Label, Motions, Triple};
use crate::scene::written::{Written, read_as_written};
use crate::sheet::angle::Angle;

/// `[[part]]`: vertices of a patch that move as one rigid body.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PartSpec {
    /// Its name, by which drives refer to it.
    pub name: Located<Label>,
    /// The vertices.
    pub vertices: Located<VertexSet>,
    /// The motions that it keeps: along "x", "y", "z", and about "rx", "ry", "rz" through the centroid of its vertices;
    /// left out: all; []: it is held.
    pub free: Option<Located<Motions>>,
}

/// `[[drive]]`: a quantity that a path drives. One of `part`, `vertices`, `load`, `lock`, `rest` and `stiffness` says
/// which.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DriveSpec {
    /// Its name, by which studies refer to it.
    pub name: Located<Label>,
    /// The part that is moved along or about `axis`.
    pub part: Option<Located<String>>,
    /// The vertices that are moved along `axis`; across it they are free.
    pub vertices: Option<Located<VertexSet>>,
    /// The axis: for a part one of "x", "y", "z", "rx", "ry", "rz"; for vertices one of "x", "y", "z" or a direction
    /// [x, y, z].
    pub axis: Option<Located<AxisSpec>>,
    /// true: a factor of all loads.
    pub load: Option<Located<bool>>,
    /// The angle of this locked crease, in radians.
    pub lock: Option<Located<EdgeName>>,
    /// true: the rest angles, from 0 (as drawn) to 1 (as `[energy]` gives them).
    pub rest: Option<Located<bool>>,
    /// The stiffness of this term.
    pub stiffness: Option<Located<DrivenTerm>>,
    /// The value at the end: a displacement or an angle from where the path begins, a factor, the angle of a lock, or a
    /// stiffness (`inf`: exactly rigid). An angle may be a text with its unit, "60 deg".
    pub to: Located<DriveEnd>,
}

/// The value at the end of a drive: a number, or, of an angle, a text with its unit.
#[derive(Clone, Copy, Debug, PartialEq, JsonSchema)]
#[schemars(transparent)]
pub struct DriveEnd(pub Angle);

impl<'de> Deserialize<'de> for DriveEnd {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let right = "expected a number, or of an angle a text with its unit such as \"60 deg\"";
        let wrong = |_| D::Error::custom(format!("this is no end of a drive, {right}"));
        Angle::deserialize(deserializer).map(Self).map_err(wrong)
    }
}

/// A term whose stiffness can be driven.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum DrivenTerm {
    /// The bars.
    Bars,
    /// The creases.
    Creases,
    /// The facets.
    Facets,
}

/// The axis of a driven motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AxisSpec {
    /// A motion of a rigid body: 0, 1, 2 along x, y, z; 3, 4, 5 about them.
    Motion(usize),
    /// A direction, not zero.
    Direction([f64; 3]),
}

read_as_written!(AxisSpec);

impl Written for AxisSpec {
    const FORMS: &str = "one of \"x\", \"y\", \"z\", \"rx\", \"ry\", \"rz\", or a direction [x, y, z]";

    fn from_word<E: Error>(word: &str) -> Result<Self, E> {
        let found = Motions::NAMES.iter().position(|name| *name == word);
        found.map(Self::Motion).ok_or_else(|| E::invalid_value(Unexpected::Str(word), &Self::FORMS))
    }

    fn from_list<'de, A: SeqAccess<'de>>(seq: A) -> Result<Self, A::Error> {
        match Triple::deserialize(SeqAccessDeserializer::new(seq))?.0 {
            [0.0, 0.0, 0.0] => Err(A::Error::custom("the direction is zero, expected a direction [x, y, z]")),
            direction => Ok(Self::Direction(direction)),
        }
    }
}

impl JsonSchema for AxisSpec {
    fn schema_name() -> Cow<'static, str> {
        "Axis".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let direction = generator.subschema_for::<[f64; 3]>();
        json_schema!({ "anyOf": [{ "enum": Motions::NAMES }, direction] })
    }
}
