//! `[sweep]`: keys of the scene that take several values.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::path::PathBuf;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::Deserialize;
use serde::de::value::MapAccessDeserializer;
use serde::de::{Error, IgnoredAny, MapAccess, SeqAccess};

use crate::scene::Located;
use crate::scene::forms::FileName;
use crate::scene::values::Exactly;
use crate::sheet::written::{Written, read_as_written};

/// The key of a sweep whose value is a table of points.
const POINTS: &str = "points";
/// The key of a sweep that says whether its axes run together.
const ZIP: &str = "zip";

/// `[sweep]`: the axes of a sweep. Its points are the product of the axes, the first of which is the slowest, or with
/// `zip` the values with the same number on every axis.
#[derive(Clone, Debug, Default)]
pub struct SweepSpec {
    /// Whether the axes run together.
    pub zip: bool,
    /// The axes in the order in which they are written.
    pub axes: Vec<SweepAxis>,
}

/// An axis of a sweep.
#[derive(Clone, Debug)]
pub struct SweepAxis {
    /// The path of the key that is set, as `--set` has it; `points` for a table of points.
    pub key: Located<String>,
    /// The values.
    pub values: Located<SweepValues>,
}

/// The values of an axis as they are written.
#[derive(Clone, Debug)]
pub enum SweepValues {
    /// `[1, 2, "flat"]`: the places of the values.
    List(Vec<Located<IgnoredAny>>),
    /// `{ linear = [a, b, n] }`: n numbers from a to b, the same distance apart.
    Linear(SweepRange),
    /// `{ log = [a, b, n] }`: n numbers from a to b, each the same multiple of the one before.
    Log(SweepRange),
    /// `{ seeds = [from, count] }`: the whole numbers from, from + 1, ...
    Seeds {
        /// The first.
        from: i64,
        /// How many there are.
        count: usize,
    },
    /// A table of points; only of the key `points`.
    File(PathBuf),
}

/// Two ends and a number of values from one to the other, both ends included.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SweepRange {
    /// The first and the last value.
    pub ends: [f64; 2],
    /// How many values there are, 2 or more.
    pub count: usize,
}

impl SweepRange {
    /// Largest number of values.
    const MOST: f64 = 1e6;

    fn new([first, last, count]: [f64; 3]) -> Result<Self, String> {
        if !(first.is_finite() && last.is_finite()) {
            return Err(format!("the range is from {first} to {last}, expected finite numbers in [from, to, count]"));
        }
        if !((2.0..=Self::MOST).contains(&count) && count.fract() == 0.0) {
            return Err(format!("the range has {count} values, expected a whole number from 2 in [from, to, count]"));
        }
        Ok(Self { ends: [first, last], count: count as usize })
    }

    fn of_logarithms(range: [f64; 3]) -> Result<Self, String> {
        let found = Self::new(range)?;
        let Some(end) = found.ends.iter().find(|end| !(**end > 0.0)) else { return Ok(found) };
        Err(format!("a logarithmic range has an end at {end}, expected numbers above 0"))
    }
}

/// The table forms of [`SweepValues`].
#[derive(Deserialize)]
struct AxisTable {
    linear: Option<Exactly<f64, 3>>,
    log: Option<Exactly<f64, 3>>,
    seeds: Option<Exactly<i64, 2>>,
    file: Option<PathBuf>,
    /// Keys that no form has: those of the scene, where quotes were forgotten.
    #[serde(flatten)]
    others: BTreeMap<String, IgnoredAny>,
}

read_as_written!(SweepValues, SweepSpec);

impl Written for SweepValues {
    const FORMS: &str = "a list of values, { linear = [from, to, count] }, { log = [from, to, count] } or \
                         { seeds = [from, count] }, for a key in quotes, as in \"energy.bars.stiffness\" = [1e2, 1e4]; or a table, \
                         points = \"points.csv\"";

    fn from_word<E: Error>(word: &str) -> Result<Self, E> {
        Ok(Self::File(word.into()))
    }

    fn from_list<'de, A: SeqAccess<'de>>(mut list: A) -> Result<Self, A::Error> {
        let mut values = Vec::new();
        while let Some(value) = list.next_element()? {
            values.push(value);
        }
        Ok(Self::List(values))
    }

    fn from_table<'de, A: MapAccess<'de>>(map: A) -> Result<Self, A::Error> {
        let AxisTable { linear, log, seeds, file, others } = AxisTable::deserialize(MapAccessDeserializer::new(map))?;
        if let Some(key) = others.keys().next() {
            return Err(A::Error::custom(format!("`{key}` is no form of values, expected {}", Self::FORMS)));
        }
        let found = match (linear, log, seeds, file) {
            (Some(Exactly(range)), None, None, None) => SweepRange::new(range).map(Self::Linear),
            (None, Some(Exactly(range)), None, None) => SweepRange::of_logarithms(range).map(Self::Log),
            (None, None, Some(Exactly(seeds)), None) => Self::seeds(seeds),
            (None, None, None, Some(file)) => Ok(Self::File(file)),
            _ => Err(format!("the axis has no values, or values in several forms, expected {}", Self::FORMS)),
        };
        found.map_err(A::Error::custom)
    }
}

impl SweepValues {
    /// Returns the number of values; `None` for a table, which has to be read first.
    pub(crate) fn count(&self) -> Option<usize> {
        match self {
            Self::List(values) => Some(values.len()),
            Self::Linear(range) | Self::Log(range) => Some(range.count),
            Self::Seeds { count, .. } => Some(*count),
            Self::File(_) => None,
        }
    }

    fn seeds([from, count]: [i64; 2]) -> Result<Self, String> {
        let most = i64::MAX - from.max(0);
        match usize::try_from(count).ok().filter(|_| from >= 0 && (1..=most).contains(&count)) {
            Some(count) => Ok(Self::Seeds { from, count }),
            None => Err(format!(
                "there are {count} seeds from {from}, expected [from, count] with a first seed of 0 or more and a count of 1 or more"
            )),
        }
    }
}

impl Written for SweepSpec {
    const FORMS: &str = "a table of keys and their values, as in \"energy.bars.stiffness\" = [1e2, 1e4]";

    fn from_table<'de, A: MapAccess<'de>>(mut map: A) -> Result<Self, A::Error> {
        let mut sweep = Self::default();
        while let Some(key) = map.next_key::<Located<String>>()? {
            if key.as_str() == ZIP {
                sweep.zip = map.next_value()?;
                continue;
            }
            let values: Located<SweepValues> = map.next_value()?;
            let table = matches!(*values, SweepValues::File(_));
            if table != (key.as_str() == POINTS) {
                let message = format!("`{}` has no values, expected {}", *key, SweepValues::FORMS);
                return Err(A::Error::custom(message));
            }
            sweep.axes.push(SweepAxis { key, values });
        }
        sweep.axes.sort_by_key(|axis| axis.key.span().start);
        Ok(sweep)
    }
}

impl JsonSchema for SweepSpec {
    fn schema_name() -> Cow<'static, str> {
        "Sweep".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let range = || json_schema!({ "type": "array", "items": { "type": "number" }, "minItems": 3, "maxItems": 3 });
        let form = |key: &str, of: Schema| json_schema!({ "type": "object", "properties": { key: of }, "required": [key], "additionalProperties": false });
        let seeds = json_schema!({ "type": "array", "items": { "type": "integer", "minimum": 0 }, "minItems": 2, "maxItems": 2 });
        json_schema!({
            "description": "Keys of the scene that take several values: `run` computes the scene at every point.",
            "type": "object",
            "properties": {
                ZIP: { "type": "boolean", "description": "Whether the axes run together, which then have one length; left out: their product, the first axis the slowest." },
                POINTS: {
                    "description": "A CSV file of points, relative to the scene: its header has the keys, each row is a point.",
                    "anyOf": [{ "type": "string" }, generator.subschema_for::<FileName>()],
                },
            },
            "additionalProperties": {
                "description": "An axis: its name is the path of a key as `--set` has it, in quotes, as in \"energy.bars.stiffness\".",
                "anyOf": [
                    { "type": "array", "minItems": 1, "description": "the values" },
                    form("linear", range()),
                    form("log", range()),
                    form("seeds", seeds),
                ],
            },
        })
    }
}
