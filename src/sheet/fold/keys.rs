//! The keys of a frame of a FOLD file, as unparsed text.

use std::collections::BTreeMap;
use std::fmt;

use serde::de::{Error, MapAccess, Visitor};
use serde::{Deserialize, Deserializer};
use serde_json::value::RawValue;

/// Key of the joints between the faces of edges of more than two faces.
pub(super) const GLUE: &str = "foldwell:glue";

/// The keys of a frame and their values, not parsed yet. Keys that are there twice are refused, and those whose value
/// is null left out.
#[derive(Clone, Debug, Default)]
pub(super) struct Values<'a>(pub BTreeMap<String, &'a RawValue>);

impl<'a> Values<'a> {
    pub(super) fn get(&self, key: &str) -> Option<&'a RawValue> {
        self.0.get(key).copied()
    }
}

impl<'de> Deserialize<'de> for Values<'de> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Unique;
        impl<'de> Visitor<'de> for Unique {
            type Value = Values<'de>;

            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("a FOLD file, one JSON object in braces")
            }

            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Values<'de>, A::Error> {
                let mut values = BTreeMap::new();
                while let Some(key) = map.next_key::<String>()? {
                    if values.contains_key(&key) {
                        return Err(A::Error::custom(format!("duplicate field `{key}`")));
                    }
                    values.insert(key, map.next_value::<&RawValue>()?);
                }
                values.retain(|_, value| value.get() != "null");
                Ok(Values(values))
            }
        }
        deserializer.deserialize_map(Unique)
    }
}
