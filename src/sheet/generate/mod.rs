//! Patterns of sheets, made from numbers.
//!
//! Every parameter has a default; lengths are in the user's unit, angles in radians. The same parameters give the same
//! coordinates, bit by bit, on every machine: sines come from `libm`, random numbers from ChaCha8.

mod eggbox;
mod error;
mod grid;
mod kresling;
mod miura;
mod parts;
mod random;
mod square_twist;
mod waterbomb;
mod yoshimura;

#[cfg(test)]
mod tests;

use serde::de::IntoDeserializer;
use serde::{Deserialize, Serialize};

use super::cell::Sheet;
pub use eggbox::Eggbox;
pub use error::GenerateError;
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
    pub(crate) fn names() -> &'static [&'static str] {
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
        .map_err(|_| GenerateError::Unknown { name: name.to_owned(), known: Self::names() })
    }
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
