//! The forms of rest angles in a scene: a word, a number, a table by letters, a mode or a file.

use std::collections::BTreeMap;
use std::path::PathBuf;

use schemars::JsonSchema;
use serde::Deserialize;
use serde::de::value::MapAccessDeserializer;
use serde::de::{Error, MapAccess, Unexpected};

use super::Located;
use super::forms::{FileName, Mode};
use super::values::Finite;
use crate::sheet::Assignment;
use crate::sheet::angle::Angle;
use crate::sheet::written::{Written, read_as_written, schema_any_of};

/// Rest angles of creases or facets.
#[derive(Clone, Debug, PartialEq)]
pub enum RestSpec {
    /// The drawn fold angles.
    Drawn,
    /// Zero, the flat state.
    Flat,
    /// The target angles of the mesh file.
    Target,
    /// -pi for mountains, pi for valleys, 0 for all others: the sheet folded flat.
    Assigned,
    /// One angle for all hinges.
    Angle(Angle),
    /// An angle for each letter of the edges' assignments.
    Letters(BTreeMap<Assignment, Angle>),
    /// The drawn fold angles plus an amplitude along a mode.
    Mode(ModeRest),
    /// A table with a row per hinge.
    File(FileName),
}

impl RestSpec {
    /// Returns the angles that are written in the scene.
    pub(super) fn angles(&self) -> Vec<Angle> {
        match self {
            Self::Angle(angle) => vec![*angle],
            Self::Letters(letters) => letters.values().copied().collect(),
            _ => vec![],
        }
    }
}

/// `{ mode = .., amplitude = .. }`.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ModeRest {
    /// The linear folding mode.
    pub mode: Located<Mode>,
    /// How far along it.
    pub amplitude: Located<Finite>,
}

read_as_written!(RestSpec);

impl Written for RestSpec {
    const FORMS: &str = concat!(
        "\"drawn\", \"flat\", \"target\", \"assigned\", an angle, { M = -1.0, V = 1.0, F = 0.0 }, ",
        "{ mode = [k11, k22, k12], amplitude = e } or { file = \"angles.csv\" }",
    );

    fn from_word<E: Error>(word: &str) -> Result<Self, E> {
        match word {
            "drawn" => Ok(Self::Drawn),
            "flat" => Ok(Self::Flat),
            "target" => Ok(Self::Target),
            "assigned" => Ok(Self::Assigned),
            angle if angle.starts_with(|c: char| !c.is_alphabetic()) => {
                angle.parse().map(Self::Angle).map_err(E::custom)
            }
            _ => Err(E::invalid_value(Unexpected::Str(word), &Self::FORMS)),
        }
    }

    fn from_number<E: Error>(angle: f64, _: Unexpected<'_>) -> Result<Self, E> {
        Finite::try_from(angle).map(|angle| Self::Angle(angle.0.into())).map_err(E::custom)
    }

    fn from_table<'de, A: MapAccess<'de>>(map: A) -> Result<Self, A::Error> {
        RestTable::deserialize(MapAccessDeserializer::new(map))?.into_rest().map_err(A::Error::custom)
    }
}

/// `{ M = -1.0, V = 1.0, F = 0.0 }`: a rest angle for each letter of `edges_assignment`.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "RestByLetter")]
struct RestTable {
    /// Mountains; 0 or negative.
    #[serde(rename = "M")]
    mountain: Option<Angle>,
    /// Valleys; 0 or positive.
    #[serde(rename = "V")]
    valley: Option<Angle>,
    /// Creases that are flat; 0 when left out.
    #[serde(rename = "F")]
    flat: Option<Angle>,
    /// Creases of which nothing is said; 0 when left out.
    #[serde(rename = "U")]
    unassigned: Option<Angle>,
    /// Diagonals of polygons; 0 when left out.
    #[serde(rename = "J")]
    join: Option<Angle>,
    /// A folding mode; not together with letters.
    #[schemars(skip)]
    mode: Option<Located<Mode>>,
    /// How far along the mode.
    #[schemars(skip)]
    amplitude: Option<Located<Finite>>,
    /// A table with a row per hinge; not together with letters.
    #[schemars(skip)]
    file: Option<Located<PathBuf>>,
}

impl RestTable {
    fn into_rest(self) -> Result<RestSpec, &'static str> {
        let letters = self.letters();
        match (self.mode, self.amplitude, self.file) {
            (None, None, None) if !letters.is_empty() => with_signs(letters),
            (Some(mode), Some(amplitude), None) if letters.is_empty() => {
                Ok(RestSpec::Mode(ModeRest { mode, amplitude }))
            }
            (None, None, Some(file)) if letters.is_empty() => Ok(RestSpec::File(FileName { file })),
            (Some(_), None, None) => Err("`amplitude` is missing, expected { mode = [k11, k22, k12], amplitude = e }"),
            (None, Some(_), None) => Err("`mode` is missing, expected { mode = [k11, k22, k12], amplitude = e }"),
            (None, None, None) => {
                Err("the table is empty, expected { M = -1.0, V = 1.0 }, { mode, amplitude } or { file }")
            }
            _ => Err("rest angles come from more than one of letters, a mode and a file, expected one of the three"),
        }
    }

    fn letters(&self) -> BTreeMap<Assignment, Angle> {
        let given = [
            (Assignment::Mountain, self.mountain),
            (Assignment::Valley, self.valley),
            (Assignment::Flat, self.flat),
            (Assignment::Unassigned, self.unassigned),
            (Assignment::Join, self.join),
        ];
        given.into_iter().filter_map(|(letter, angle)| Some((letter, angle?))).collect()
    }
}

/// Returns rest angles by letters, of which those of mountains and valleys are on their own side.
fn with_signs(letters: BTreeMap<Assignment, Angle>) -> Result<RestSpec, &'static str> {
    let angle = |letter| letters.get(&letter).map_or(0.0, |angle| angle.radians);
    if angle(Assignment::Mountain) > 0.0 {
        return Err("the rest angle of mountains (M) is positive, expected a negative one: valleys are positive");
    }
    if angle(Assignment::Valley) < 0.0 {
        return Err("the rest angle of valleys (V) is negative, expected a positive one: mountains are negative");
    }
    Ok(RestSpec::Letters(letters))
}

schema_any_of!(RestSpec as "Rest", generator, [
    { "enum": ["drawn", "flat", "target", "assigned"] },
    generator.subschema_for::<Angle>(),
    generator.subschema_for::<RestTable>(),
    generator.subschema_for::<ModeRest>(),
    generator.subschema_for::<FileName>(),
]);
