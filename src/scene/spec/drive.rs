//! `[[part]]`, `[[tie]]` and `[[drive]]`: vertices that move as one body, those that stay in one place, and the quantities that a path drives.

use schemars::JsonSchema;
use serde::Deserialize;
use serde::de::value::SeqAccessDeserializer;
use serde::de::{Error, IntoDeserializer, SeqAccess, Unexpected};

use super::vertices::VertexSet;
use crate::scene::Located;
use crate::scene::values::{EdgeName, Label, Motions, Triple};
use crate::sheet::angle::Angle;
use crate::sheet::written::{Written, read_as_written, schema_any_of};

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

/// `[[tie]]`: vertices of a patch that are drawn in one place and stay together, as those of sheets that touch.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TieSpec {
    /// A set of vertices, of which those that are drawn in one place are tied; "coincident": all vertices.
    pub vertices: Located<VertexSet>,
}

/// `[[drive]]`: a quantity that a path drives. One of `part`, `vertices`, `load`, `pressure`, `volume`, `lock`, `rest` and
/// `stiffness` says which.
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
    /// The pressure of this name.
    pub pressure: Option<Located<String>>,
    /// The volume that the faces under the pressure of this name enclose; the pressure is what it takes.
    pub volume: Option<Located<String>>,
    /// The angle of this locked crease, in radians.
    pub lock: Option<Located<EdgeName>>,
    /// true: the rest angles, from 0 (as drawn) to 1 (as `[energy]` gives them).
    pub rest: Option<Located<bool>>,
    /// The stiffness of this term.
    pub stiffness: Option<Located<DrivenTerm>>,
    /// The value at the end: a displacement, an angle or a volume from where the path begins, a factor, a pressure, the
    /// angle of a lock, or a stiffness (`inf`: exactly rigid). An angle may be a text with its unit, "60 deg". A list of such values, as
    /// [0.3, -0.3, 0.3], are the ends of ways to and fro.
    pub to: Located<DriveEnd>,
}

/// The value at the end of a drive: a number, or, of an angle, a text with its unit; or the ends of several ways.
#[derive(Clone, Debug, PartialEq)]
pub struct DriveEnd(
    /// The first end, and the ends of the ways from there; never empty.
    pub Vec<Angle>,
);

impl DriveEnd {
    const RIGHT: &str = "a number, of an angle a text with its unit such as \"60 deg\", or a list of these";

    fn wrong<E: Error>() -> E {
        E::custom(format!("this is no end of a drive, expected {}", Self::RIGHT))
    }

    fn one<E: Error>(angle: Result<Angle, serde::de::value::Error>) -> Result<Self, E> {
        angle.map(|angle| Self(vec![angle])).map_err(|_| Self::wrong())
    }
}

read_as_written!(DriveEnd);

impl Written for DriveEnd {
    const FORMS: &str = Self::RIGHT;

    fn from_word<E: Error>(word: &str) -> Result<Self, E> {
        Self::one(Angle::deserialize(word.into_deserializer()))
    }

    fn from_number<E: Error>(number: f64, _: Unexpected<'_>) -> Result<Self, E> {
        Self::one(Angle::deserialize(number.into_deserializer()))
    }

    fn from_list<'de, A: SeqAccess<'de>>(list: A) -> Result<Self, A::Error> {
        let all = Vec::<Angle>::deserialize(SeqAccessDeserializer::new(list)).map_err(|_| Self::wrong())?;
        if all.is_empty() { Err(Self::wrong()) } else { Ok(Self(all)) }
    }
}

schema_any_of!(DriveEnd as "DriveEnd", generator, [
    generator.subschema_for::<Angle>(),
    { "type": "array", "minItems": 1, "items": generator.subschema_for::<Angle>() },
]);

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

schema_any_of!(AxisSpec as "Axis", generator, [{ "enum": Motions::NAMES }, generator.subschema_for::<[f64; 3]>()]);
