//! Sets of vertices of a patch, in the forms in which a scene names them.

use schemars::JsonSchema;
use serde::Deserialize;
use serde::de::value::{MapAccessDeserializer, SeqAccessDeserializer};
use serde::de::{Error, MapAccess, SeqAccess, Unexpected};

use crate::scene::values::Exactly;
use crate::sheet::written::{Written, read_as_written, schema_any_of};

/// A set of vertices of a patch.
#[derive(Clone, Debug, PartialEq)]
pub enum VertexSet {
    /// The vertices of a list.
    List(Vec<VertexName>),
    /// The vertices that the mesh lists under a name (`foldwell:names`).
    Name(String),
    /// The vertices whose drawn coordinates have these values; a coordinate that is not given is arbitrary.
    Where([Option<Coordinate>; 3]),
    /// The vertices whose drawn positions lie in a box with these opposite corners.
    Box([[f64; 3]; 2]),
}

/// A vertex: its number in its cell, and the cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct VertexName {
    /// Number of the vertex in its cell.
    pub vertex: usize,
    /// The cell.
    pub cell: [usize; 2],
}

/// A value of a coordinate of the drawn state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Coordinate {
    /// The least value of any vertex of the patch.
    Least,
    /// The largest value of any vertex of the patch.
    Largest,
    /// A number.
    At(f64),
}

/// The tables of [`VertexSet`] in one, used to find out which of them was given.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct SetTable {
    r#where: Option<Plane>,
    r#box: Option<Exactly<Exactly<f64, 3>, 2>>,
}

/// `{ x, y, z }` of `where`.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Where")]
struct Plane {
    /// Value of the coordinate x.
    x: Option<Coordinate>,
    /// Value of the coordinate y.
    y: Option<Coordinate>,
    /// Value of the coordinate z.
    z: Option<Coordinate>,
}

impl SetTable {
    fn into_set(self) -> Result<VertexSet, &'static str> {
        match (self.r#where, self.r#box) {
            (Some(Plane { x: None, y: None, z: None }), None) => {
                Err("`where` is empty, expected one or more of x, y, z, as in { where = { z = \"max\" } }")
            }
            (Some(Plane { x, y, z }), None) => Ok(VertexSet::Where([x, y, z])),
            (None, Some(Exactly(corners))) => {
                let corners = corners.map(|Exactly(corner)| corner);
                if corners.iter().flatten().any(|x| x.is_nan()) {
                    return Err("a corner of the box is not a number, expected [[x, y, z], [x, y, z]]");
                }
                Ok(VertexSet::Box(corners))
            }
            (None, None) => Err("the table is empty, expected { where = { z = \"max\" } } or { box = [[..], [..]] }"),
            (Some(_), Some(_)) => Err("a set has `where` and `box` at once, expected one of the two"),
        }
    }
}

read_as_written!(VertexSet, VertexName, Coordinate);

impl Written for VertexSet {
    const FORMS: &str = concat!(
        "a list of vertices v or [v, c1, c2], a name of the mesh, { where = { z = \"max\" } } ",
        "or { box = [[x, y, z], [x, y, z]] }",
    );

    fn from_word<E: Error>(name: &str) -> Result<Self, E> {
        Ok(Self::Name(name.into()))
    }

    fn from_list<'de, A: SeqAccess<'de>>(seq: A) -> Result<Self, A::Error> {
        Deserialize::deserialize(SeqAccessDeserializer::new(seq)).map(Self::List)
    }

    fn from_table<'de, A: MapAccess<'de>>(map: A) -> Result<Self, A::Error> {
        SetTable::deserialize(MapAccessDeserializer::new(map))?.into_set().map_err(A::Error::custom)
    }
}

impl Written for VertexName {
    const FORMS: &str = "a vertex: v, in cell [0, 0], or [v, c1, c2], counted from 0";

    fn from_whole<E: Error>(number: i64) -> Result<Self, E> {
        let vertex = usize::try_from(number);
        let vertex = vertex.map_err(|_| E::invalid_value(Unexpected::Signed(number), &Self::FORMS))?;
        Ok(VertexName { vertex, cell: [0, 0] })
    }

    fn from_list<'de, A: SeqAccess<'de>>(seq: A) -> Result<Self, A::Error> {
        let Exactly([vertex, c1, c2]) = Exactly::deserialize(SeqAccessDeserializer::new(seq))?;
        Ok(VertexName { vertex, cell: [c1, c2] })
    }
}

impl Written for Coordinate {
    const FORMS: &str = "\"min\", \"max\" or a finite number";

    fn from_word<E: Error>(word: &str) -> Result<Self, E> {
        match word {
            "min" => Ok(Self::Least),
            "max" => Ok(Self::Largest),
            _ => Err(E::invalid_value(Unexpected::Str(word), &Self::FORMS)),
        }
    }

    fn from_number<E: Error>(value: f64, written: Unexpected<'_>) -> Result<Self, E> {
        let finite = Some(value).filter(|value| value.is_finite());
        finite.map(Self::At).ok_or_else(|| E::invalid_value(written, &Self::FORMS))
    }
}

schema_any_of!(VertexSet as "VertexSet", generator, [
    { "type": "array", "items": { "anyOf": [
        { "type": "integer", "minimum": 0 },
        { "type": "array", "items": { "type": "integer", "minimum": 0 }, "minItems": 3, "maxItems": 3 },
    ] } },
    { "type": "string", "description": "a list of vertices that the mesh names in `foldwell:names`" },
    {
        "type": "object", "additionalProperties": false, "required": ["where"],
        "properties": { "where": generator.subschema_for::<Plane>() },
    },
    {
        "type": "object", "additionalProperties": false, "required": ["box"],
        "properties": { "box": generator.subschema_for::<[[f64; 3]; 2]>() },
    },
]);

schema_any_of!(Coordinate as "Coordinate", _generator, [{ "enum": ["min", "max"] }, { "type": "number" }]);
