//! A law of all elements of a term, one for each letter of their edges, or one of a list for each of them.

use std::borrow::Cow;
use std::collections::BTreeMap;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::{DeserializeOwned, Error, MapAccess};
use serde::{Deserialize, Deserializer};

use crate::scene::forms::FileName;
use crate::sheet::Assignment;
use crate::sheet::written::{Written, read};

/// The letters of edges, as messages list them.
const LETTERS: [&str; 7] = ["M", "V", "F", "U", "B", "C", "J"];

/// A law of all elements of a term, `{ M = { kind = "..", .. }, .. }`: one for each letter of `edges_assignment`, elements
/// of other letters are springs; or `{ each = { file = "laws.csv" }, of = [{ kind = "..", .. }, ..] }`: one of a list.
#[derive(Clone, Debug)]
pub enum LawForm<T> {
    /// One law for all elements.
    All(T),
    /// A law for each letter.
    Letters(BTreeMap<Assignment, T>),
    /// A table with the number of a law of this list for each element, counted from 1; 0 is a spring.
    Listed(FileName, Vec<T>),
}

impl<T> LawForm<T> {
    /// The law of all elements; `None` where laws are given by letters.
    pub(crate) fn of_all(&self) -> Option<&T> {
        match self {
            Self::All(law) => Some(law),
            Self::Letters(_) | Self::Listed(..) => None,
        }
    }

    /// All laws that are given.
    pub(crate) fn each(&self) -> Vec<&T> {
        match self {
            Self::All(law) => vec![law],
            Self::Letters(letters) => letters.values().collect(),
            Self::Listed(_, laws) => laws.iter().collect(),
        }
    }

    /// The table of the laws of single elements; `None` where they are given otherwise.
    pub(crate) fn table(&self) -> Option<&FileName> {
        if let Self::Listed(table, _) = self { Some(table) } else { None }
    }
}

impl<'de, T: DeserializeOwned> Deserialize<'de> for LawForm<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        read(deserializer)
    }
}

impl<T: DeserializeOwned> Written for LawForm<T> {
    const FORMS: &str = "a law { kind = \"..\", .. }; { M = { kind = \"..\", .. }, V = .. }, one for each letter; or \
                         { each = { file = \"laws.csv\" }, of = [{ kind = \"..\", .. }, ..] }, one of a list for each element";

    fn from_table<'de, A: MapAccess<'de>>(mut map: A) -> Result<Self, A::Error> {
        let (mut letters, mut keys) = (BTreeMap::new(), toml::Table::new());
        let (mut each, mut of) = (None, None::<Vec<T>>);
        while let Some(key) = map.next_key::<String>()? {
            if let Some(letter) = Assignment::from_letter(&key) {
                letters.insert(letter, map.next_value()?);
            } else if key == "each" {
                each = Some(map.next_value()?);
            } else if key == "of" {
                of = Some(map.next_value()?);
            } else {
                keys.insert(key, map.next_value()?);
            }
        }
        let is_alone = letters.is_empty() && keys.is_empty();
        match (each, of) {
            (None, None) => {}
            (Some(each), Some(of)) if is_alone && !of.is_empty() => return Ok(Self::Listed(each, of)),
            _ => {
                return Err(A::Error::custom(
                    "`each` names a table of numbers and `of` lists laws, both without other keys",
                ));
            }
        }
        match keys.keys().next() {
            None if !letters.is_empty() => Ok(Self::Letters(letters)),
            Some(key) if !letters.is_empty() || key.chars().count() == 1 => {
                Err(A::Error::custom(format!("`{key}` is none of the letters {LETTERS:?}, expected {}", Self::FORMS)))
            }
            _ => keys.try_into().map(Self::All).map_err(|fault| A::Error::custom(fault.message())),
        }
    }
}

impl<T: JsonSchema> JsonSchema for LawForm<T> {
    fn schema_name() -> Cow<'static, str> {
        format!("{}s", T::schema_name()).into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let law = generator.subschema_for::<T>();
        let letters = json_schema!({
            "type": "object",
            "description": "a law for each letter of `edges_assignment`; elements of other letters are springs",
            "propertyNames": { "enum": LETTERS },
            "additionalProperties": law,
            "minProperties": 1,
        });
        let listed = json_schema!({
            "type": "object",
            "description": "a law of the list for each element",
            "properties": {
                "each": generator.subschema_for::<FileName>(),
                "of": { "type": "array", "items": law, "minItems": 1 },
            },
            "required": ["each", "of"],
            "additionalProperties": false,
        });
        json_schema!({ "anyOf": [law, letters, listed] })
    }
}
