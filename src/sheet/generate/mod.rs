//! Patterns of sheets, made from numbers.
//!
//! Every parameter has a default; lengths are in the user's unit, angles in radians. The same parameters give the same
//! coordinates, bit by bit, on every machine: sines come from `libm`, random numbers from ChaCha8.

mod eggbox;
mod grid;
mod kresling;
mod miura;
mod random;
mod square_twist;
mod waterbomb;
mod yoshimura;

#[cfg(test)]
mod tests;

use serde::de::IntoDeserializer;
use serde::{Deserialize, Serialize};

use super::build::{Drawing, build, draw};
use super::cell::{Corner, Sheet};
use super::error::Defect;
use crate::math::Vec3;
pub use eggbox::Eggbox;
pub use kresling::Kresling;
pub use miura::{Miura, MiuraPatch};
pub use random::{Random, RandomDevelopable};
pub use square_twist::SquareTwist;
pub use waterbomb::Waterbomb;
pub use yoshimura::Yoshimura;

/// A pattern with its parameters; `pattern = "miura"` and so on in a file, beside the parameters.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "pattern", rename_all = "kebab-case")]
pub enum Pattern {
    /// One cell of Miura-ori.
    Miura(Miura),
    /// A finite Miura-ori.
    MiuraPatch(MiuraPatch),
    /// One cell of the eggbox.
    Eggbox(Eggbox),
    /// One cell of the waterbomb tessellation.
    Waterbomb(Waterbomb),
    /// One cell of the Yoshimura pattern.
    Yoshimura(Yoshimura),
    /// A ring of Kresling's pattern.
    Kresling(Kresling),
    /// One cell of square twists.
    SquareTwist(SquareTwist),
    /// A random cell that cannot be flattened.
    Random(Random),
    /// A random flat cell.
    RandomDevelopable(RandomDevelopable),
}

impl Pattern {
    /// The names of all patterns.
    pub fn names() -> &'static [&'static str] {
        &[
            "miura",
            "miura-patch",
            "eggbox",
            "waterbomb",
            "yoshimura",
            "kresling",
            "square-twist",
            "random",
            "random-developable",
        ]
    }

    /// The pattern of this name with the default of every parameter.
    ///
    /// # Errors
    /// [`GenerateError::Unknown`] where no pattern has this name.
    pub fn named(name: &str) -> Result<Self, GenerateError> {
        let pair = [("pattern", name)].into_iter();
        Self::deserialize(IntoDeserializer::<serde::de::value::Error>::into_deserializer(
            pair.collect::<std::collections::BTreeMap<_, _>>(),
        ))
        .map_err(|_| GenerateError::Unknown { name: name.to_owned() })
    }
}

/// Why a pattern has no sheet for its parameters.
#[derive(Debug, thiserror::Error)]
pub enum GenerateError {
    /// A name that no pattern has.
    #[error("there is no pattern `{name}`; there are {}", Pattern::names().join(", "))]
    Unknown {
        /// The name.
        name: String,
    },
    /// A number out of its range.
    #[error("`{name}` is {value}; it should be {} {low} and below {high}", if *closed { "at least" } else { "above" })]
    Number {
        /// The parameter.
        name: &'static str,
        /// Its value.
        value: f64,
        /// Lower end of the range.
        low: f64,
        /// Whether the lower end belongs to the range.
        closed: bool,
        /// Upper end of the range, which never belongs to it.
        high: f64,
    },
    /// A count out of its range.
    #[error("`{name}` is {value}; it should be from {low} to {high}")]
    Count {
        /// The parameter.
        name: &'static str,
        /// Its value.
        value: usize,
        /// Least count.
        low: usize,
        /// Largest count.
        high: usize,
    },
    /// Parameters, each in its range, that together give a degenerate mesh.
    #[error("these parameters together give no sheet: {0}")]
    Mesh(#[from] Defect),
}

/// The sheet of a pattern.
///
/// # Errors
/// A [`GenerateError`] with the number and its range.
pub fn generate(pattern: &Pattern) -> Result<Sheet, GenerateError> {
    match pattern {
        Pattern::Miura(p) => p.sheet(),
        Pattern::MiuraPatch(p) => p.sheet(),
        Pattern::Eggbox(p) => p.sheet(),
        Pattern::Waterbomb(p) => p.sheet(),
        Pattern::Yoshimura(p) => p.sheet(),
        Pattern::Kresling(p) => p.sheet(),
        Pattern::SquareTwist(p) => p.sheet(),
        Pattern::Random(p) => p.sheet(),
        Pattern::RandomDevelopable(p) => p.sheet(),
    }
}

/// `low < value < high`.
fn between(name: &'static str, value: f64, low: f64, high: f64) -> Result<f64, GenerateError> {
    let good = low < value && value < high;
    if good { Ok(value) } else { Err(GenerateError::Number { name, value, low, closed: false, high }) }
}

/// `low <= value < high`.
fn from(name: &'static str, value: f64, low: f64, high: f64) -> Result<f64, GenerateError> {
    let good = low <= value && value < high;
    if good { Ok(value) } else { Err(GenerateError::Number { name, value, low, closed: true, high }) }
}

/// A length: above zero, below 1e6.
fn length(name: &'static str, value: f64) -> Result<f64, GenerateError> {
    between(name, value, 0.0, 1e6)
}

fn count(name: &'static str, value: usize, low: usize, high: usize) -> Result<usize, GenerateError> {
    if (low..=high).contains(&value) { Ok(value) } else { Err(GenerateError::Count { name, value, low, high }) }
}

/// What a generator knows of a sheet; edges and triangles follow.
struct Parts {
    title: &'static str,
    /// Source of the pattern.
    source: &'static str,
    vertices: Vec<Vec3>,
    lattice: Option<[Vec3; 2]>,
    polygons: Vec<Vec<Corner>>,
}

impl Parts {
    fn sheet(self, parameters: String) -> Result<Sheet, GenerateError> {
        let Self { title, source, vertices, lattice, polygons } = self;
        let bare = Sheet {
            title: title.to_owned(),
            description: format!("{source} {parameters} Unit of length: any."),
            vertices,
            lattice,
            polygons,
            ..Sheet::default()
        };
        let drawn: Drawing = draw(&bare);
        Ok(build(&drawn)?)
    }
}
