//! The forms of a stiffness and of rest lengths in a scene: a number, a word, a table by letters, or a file.

use std::collections::BTreeMap;
use std::path::PathBuf;

use schemars::JsonSchema;
use serde::Deserialize;
use serde::de::value::MapAccessDeserializer;
use serde::de::{Error, MapAccess, Unexpected};

use super::Located;
use super::forms::FileName;
use super::values::{Positive, Stiffness};
use crate::sheet::Assignment;
use crate::sheet::written::{Written, read_as_written, schema_any_of};

/// Stiffness of the elements of a term.
#[derive(Clone, Debug, PartialEq)]
pub enum StiffnessSpec {
    /// One number for all elements; infinite: exactly rigid.
    Number(f64),
    /// A table with a row per element.
    File(FileName),
    /// A number for each letter of the edges' assignments.
    Letters(BTreeMap<Assignment, f64>),
    /// Numbers that the mesh file gives its edges.
    Mesh,
}

/// `{ M = 1.0, V = 2.0, .. }`: a stiffness for each letter of `edges_assignment`.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(rename_all = "UPPERCASE", deny_unknown_fields)]
#[schemars(rename = "StiffnessByLetter")]
struct Letters {
    /// Mountains.
    m: Option<Located<Stiffness>>,
    /// Valleys.
    v: Option<Located<Stiffness>>,
    /// Creases that are flat; diagonals of polygons where `J` is not given.
    f: Option<Located<Stiffness>>,
    /// Creases of which nothing is said.
    u: Option<Located<Stiffness>>,
    /// Bars on the rim.
    b: Option<Located<Stiffness>>,
    /// Bars along cuts; where it is not given, `B` counts.
    c: Option<Located<Stiffness>>,
    /// Diagonals of polygons.
    j: Option<Located<Stiffness>>,
    /// A table with a row per element; not together with letters.
    #[schemars(skip)]
    #[serde(rename = "file")]
    file: Option<Located<PathBuf>>,
}

impl Letters {
    fn into_spec(self) -> Result<StiffnessSpec, &'static str> {
        let given = [
            (Assignment::Mountain, self.m),
            (Assignment::Valley, self.v),
            (Assignment::Flat, self.f),
            (Assignment::Unassigned, self.u),
            (Assignment::Boundary, self.b),
            (Assignment::Cut, self.c),
            (Assignment::Join, self.j),
        ];
        let letters: BTreeMap<Assignment, f64> =
            given.into_iter().filter_map(|(letter, stiffness)| Some((letter, stiffness?.0))).collect();
        match self.file {
            Some(file) if letters.is_empty() => Ok(StiffnessSpec::File(FileName { file })),
            Some(_) => Err("stiffnesses come from letters and from a file at once, expected one of the two"),
            None if letters.is_empty() => Err("the table is empty, expected { M = 1.0, V = 2.0, .. } or { file }"),
            None => Ok(StiffnessSpec::Letters(letters)),
        }
    }
}

read_as_written!(StiffnessSpec, RestLengthSpec);

impl Written for StiffnessSpec {
    const FORMS: &str = "a number, `inf`, \"mesh\", { M = 1.0, V = 2.0, .. } or { file = \"k.csv\" }";

    fn from_word<E: Error>(word: &str) -> Result<Self, E> {
        let mesh = (word == "mesh").then_some(Self::Mesh);
        mesh.ok_or_else(|| E::invalid_value(Unexpected::Str(word), &Self::FORMS))
    }

    fn from_number<E: Error>(stiffness: f64, _: Unexpected<'_>) -> Result<Self, E> {
        Stiffness::try_from(stiffness).map(|stiffness| Self::Number(stiffness.0)).map_err(E::custom)
    }

    fn from_table<'de, A: MapAccess<'de>>(map: A) -> Result<Self, A::Error> {
        Letters::deserialize(MapAccessDeserializer::new(map))?.into_spec().map_err(A::Error::custom)
    }
}

schema_any_of!(StiffnessSpec as "Stiffnesses", generator, [
    generator.subschema_for::<Stiffness>(),
    { "const": "mesh", "description": "as the mesh file gives its edges" },
    generator.subschema_for::<Letters>(),
    generator.subschema_for::<FileName>(),
]);

/// Rest lengths of bars.
#[derive(Clone, Debug, PartialEq)]
pub enum RestLengthSpec {
    /// The drawn lengths.
    Drawn,
    /// The drawn lengths times this factor.
    Factor(f64),
    /// A table with a row per bar.
    File(FileName),
}

impl Written for RestLengthSpec {
    const FORMS: &str = "\"drawn\", a factor on the drawn lengths or { file = \"lengths.csv\" }";

    fn from_word<E: Error>(word: &str) -> Result<Self, E> {
        let drawn = (word == "drawn").then_some(Self::Drawn);
        drawn.ok_or_else(|| E::invalid_value(Unexpected::Str(word), &Self::FORMS))
    }

    fn from_number<E: Error>(factor: f64, _: Unexpected<'_>) -> Result<Self, E> {
        Positive::try_from(factor).map(|factor| Self::Factor(factor.0)).map_err(E::custom)
    }

    fn from_table<'de, A: MapAccess<'de>>(map: A) -> Result<Self, A::Error> {
        FileName::deserialize(MapAccessDeserializer::new(map)).map(Self::File)
    }
}

schema_any_of!(RestLengthSpec as "RestLengths", generator, [
    { "const": "drawn" },
    { "type": "number", "exclusiveMinimum": 0, "description": "factor on the drawn lengths" },
    generator.subschema_for::<FileName>(),
]);
