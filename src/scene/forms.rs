//! Values of a scene that have more than one written form: a word, a number or a table.

use std::path::PathBuf;

use schemars::JsonSchema;
use serde::Deserialize;
use serde::de::value::{MapAccessDeserializer, SeqAccessDeserializer};
use serde::de::{Error, MapAccess, SeqAccess, Unexpected};

use super::Located;
use super::values::{Positive, Triple};
use crate::sheet::written::{Written, read_as_written, schema_any_of};

/// `{ file = "angles.csv" }`.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FileName {
    /// Path relative to the scene file; see [`crate::scene::rows`].
    pub file: Located<PathBuf>,
}

/// A linear folding mode.
#[derive(Clone, Debug, PartialEq)]
pub enum Mode {
    /// `[k11, k22, k12]`: the curvature tensor it makes at unit amplitude.
    Curvature([f64; 3]),
    /// A table of fold-angle rates, a row per edge.
    Rates(RatesFile),
    /// A wave on a torus.
    Wave(Wave),
}

/// `{ rates = "file.csv" }`.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RatesFile {
    /// Path relative to the scene file; see [`crate::scene::rows`].
    pub rates: Located<PathBuf>,
}

/// `{ wave = [m1, m2] }`: goes as `cos(2 pi (m1 c1 / n1 + m2 c2 / n2))` over the cells `(c1, c2)` of a torus of
/// `n1 x n2`.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Wave {
    /// How often it goes round along each direction.
    pub wave: Located<[i32; 2]>,
}

/// The two tables of [`Mode`] in one, used to find out which of them was given.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct ModeKeys {
    rates: Option<Located<PathBuf>>,
    wave: Option<Located<[i32; 2]>>,
}

/// The state from which a study starts.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum StartSpec {
    /// The drawn state.
    #[default]
    Drawn,
    /// The last state of an earlier study of the same scene.
    Study(String),
    /// The drawn state with random displacements.
    Random(RandomStart),
    /// A `.vtu` file of an earlier run, relative to the scene file.
    File(PathBuf),
}

/// `{ random = amplitude, seed = n }`.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RandomStart {
    /// Amplitude of the displacements, in the unit of length.
    pub random: Located<Positive>,
    /// Seed of the random numbers.
    pub seed: u64,
}

/// The branches that a trace follows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum BranchChoice {
    /// All branches.
    #[default]
    All,
    /// The branch with this number.
    Number(usize),
}

read_as_written!(Mode, StartSpec, BranchChoice);

impl Written for Mode {
    const FORMS: &str = "a curvature tensor [k11, k22, k12], { rates = \"file.csv\" } or { wave = [m1, m2] }";

    fn from_list<'de, A: SeqAccess<'de>>(seq: A) -> Result<Self, A::Error> {
        match Triple::deserialize(SeqAccessDeserializer::new(seq))?.0 {
            [0.0, 0.0, 0.0] => Err(A::Error::custom("the mode is zero, expected a curvature tensor [k11, k22, k12]")),
            tensor => Ok(Self::Curvature(tensor)),
        }
    }

    fn from_table<'de, A: MapAccess<'de>>(map: A) -> Result<Self, A::Error> {
        let table = ModeKeys::deserialize(MapAccessDeserializer::new(map))?;
        match (table.rates, table.wave) {
            (Some(rates), None) => Ok(Self::Rates(RatesFile { rates })),
            (None, Some(wave)) => Ok(Self::Wave(Wave { wave })),
            (None, None) => Err(A::Error::custom("the table is empty, expected { rates } or { wave }")),
            _ => Err(A::Error::custom("a mode has rates and a wave at once, expected one of the two")),
        }
    }
}

impl Written for StartSpec {
    const FORMS: &str = "\"drawn\", the name of an earlier study, { random = amplitude, seed = n } or a .vtu file";

    fn from_word<E: Error>(word: &str) -> Result<Self, E> {
        Ok(match word {
            "drawn" => Self::Drawn,
            file if file.ends_with(".vtu") => Self::File(file.into()),
            name => Self::Study(name.into()),
        })
    }

    fn from_table<'de, A: MapAccess<'de>>(map: A) -> Result<Self, A::Error> {
        RandomStart::deserialize(MapAccessDeserializer::new(map)).map(Self::Random)
    }
}

impl Written for BranchChoice {
    const FORMS: &str = "\"all\" or the number of a branch, counted from 0";

    fn from_word<E: Error>(word: &str) -> Result<Self, E> {
        if word == "all" { Ok(Self::All) } else { Err(E::invalid_value(Unexpected::Str(word), &Self::FORMS)) }
    }

    fn from_whole<E: Error>(number: i64) -> Result<Self, E> {
        let number = usize::try_from(number).map_err(|_| E::invalid_value(Unexpected::Signed(number), &Self::FORMS))?;
        Ok(Self::Number(number))
    }
}

schema_any_of!(
    Mode as "Mode",
    generator,
    [generator.subschema_for::<[f64; 3]>(), generator.subschema_for::<RatesFile>(), generator.subschema_for::<Wave>(),]
);
schema_any_of!(StartSpec as "Start", generator, [
    { "type": "string", "description": "\"drawn\", the name of an earlier study, or a .vtu file" },
    generator.subschema_for::<RandomStart>(),
]);
schema_any_of!(BranchChoice as "BranchChoice", _generator, [{ "const": "all" }, { "type": "integer", "minimum": 0 }]);
