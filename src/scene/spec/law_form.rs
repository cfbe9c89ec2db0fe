//! A law of all elements of a term, or one for each letter of their edges.

use std::borrow::Cow;
use std::collections::BTreeMap;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::{DeserializeOwned, Error, MapAccess};
use serde::{Deserialize, Deserializer};

use crate::sheet::Assignment;
use crate::sheet::written::{Written, read};

/// The letters of edges, as messages list them.
const LETTERS: [&str; 7] = ["M", "V", "F", "U", "B", "C", "J"];

/// A law of all elements of a term, or `{ M = { kind = "..", .. }, .. }`: one for each letter of `edges_assignment`;
/// elements of other letters are springs.
#[derive(Clone, Debug)]
pub enum LawForm<T> {
    /// One law for all elements.
    All(T),
    /// A law for each letter.
    Letters(BTreeMap<Assignment, T>),
}

impl<T> LawForm<T> {
    /// The law of all elements; `None` where laws are given by letters.
    pub(crate) fn of_all(&self) -> Option<&T> {
        match self {
            Self::All(law) => Some(law),
            Self::Letters(_) => None,
        }
    }

    /// All laws that are given.
    pub(crate) fn each(&self) -> Vec<&T> {
        match self {
            Self::All(law) => vec![law],
            Self::Letters(letters) => letters.values().collect(),
        }
    }
}

impl<'de, T: DeserializeOwned> Deserialize<'de> for LawForm<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        read(deserializer)
    }
}

impl<T: DeserializeOwned> Written for LawForm<T> {
    const FORMS: &str = "a law { kind = \"..\", .. }, or { M = { kind = \"..\", .. }, V = .. }, one for each letter";

    fn from_table<'de, A: MapAccess<'de>>(mut map: A) -> Result<Self, A::Error> {
        let (mut letters, mut keys) = (BTreeMap::new(), toml::Table::new());
        while let Some(key) = map.next_key::<String>()? {
            if let Some(letter) = Assignment::from_letter(&key) {
                letters.insert(letter, map.next_value()?);
            } else {
                keys.insert(key, map.next_value()?);
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
        json_schema!({ "anyOf": [law, letters] })
    }
}
