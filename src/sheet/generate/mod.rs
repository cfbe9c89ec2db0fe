//! Generators of origami patterns: each makes a sheet from a few parameters.
//!
//! Every parameter has a default; lengths are in the user's unit, angles in radians. The same parameters give the
//! same coordinates, bit by bit, on every machine: sines come from `libm`, random numbers from ChaCha8.
//!
//! ```
//! use foldwell::sheet::generate::{Pattern, Random, generate};
//!
//! let cell = generate(&Pattern::Random(Random { size: [3, 4], seed: 7, ..Random::default() }))?;
//! assert_eq!((cell.vertices.len(), cell.edges.len(), cell.triangles.len()), (12, 36, 24));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod eggbox;
mod error;
mod four_parallelogram;
mod grid;
mod hypar;
mod kresling;
mod miura;
mod parts;
mod random;
mod resch;
mod square_twist;
mod symmetric;
mod truss;
mod tubes;
mod waterbomb;
mod yoshimura;
mod zipper;

#[cfg(test)]
mod tests;

use serde::{Deserialize, Serialize};
use toml::{Table, Value};

use super::cell::Sheet;
use super::similar::{did_you_mean_of, there_are};
pub use eggbox::Eggbox;
pub use error::GenerateError;
pub use four_parallelogram::FourParallelogram;
pub use hypar::Hypar;
pub use kresling::Kresling;
pub use miura::{Miura, MiuraPatch};
pub use random::{Random, RandomDevelopable};
pub use resch::Resch;
pub use square_twist::SquareTwist;
pub use symmetric::{CellSymmetry, Symmetric};
pub use truss::Truss;
pub use tubes::MiuraTubes;
pub use waterbomb::Waterbomb;
pub use yoshimura::Yoshimura;

/// The names of the patterns, and a page about each.
const HELP: [(&str, &str); 16] = [
    ("miura", include_str!("help/miura.txt")),
    ("miura-patch", include_str!("help/miura-patch.txt")),
    ("eggbox", include_str!("help/eggbox.txt")),
    ("four-parallelogram", include_str!("help/four-parallelogram.txt")),
    ("waterbomb", include_str!("help/waterbomb.txt")),
    ("yoshimura", include_str!("help/yoshimura.txt")),
    ("kresling", include_str!("help/kresling.txt")),
    ("square-twist", include_str!("help/square-twist.txt")),
    ("resch", include_str!("help/resch.txt")),
    ("hypar", include_str!("help/hypar.txt")),
    ("truss", include_str!("help/truss.txt")),
    ("aligned-tubes", include_str!("help/aligned-tubes.txt")),
    ("zipper-tubes", include_str!("help/zipper-tubes.txt")),
    ("random", include_str!("help/random.txt")),
    ("symmetric", include_str!("help/symmetric.txt")),
    ("random-developable", include_str!("help/random-developable.txt")),
];

/// A pattern with its parameters. In a file, the key `pattern = "miura"` and so on stands next to the parameters.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "pattern", rename_all = "kebab-case")]
pub enum Pattern {
    /// One cell of Miura-ori.
    Miura(Miura),
    /// A finite Miura-ori.
    MiuraPatch(MiuraPatch),
    /// One cell of the eggbox.
    Eggbox(Eggbox),
    /// One cell of four parallelograms of any lengths and angles.
    FourParallelogram(FourParallelogram),
    /// One cell of the waterbomb tessellation.
    Waterbomb(Waterbomb),
    /// One cell of the Yoshimura pattern.
    Yoshimura(Yoshimura),
    /// A ring of Kresling's pattern, open or closed to a drum.
    Kresling(Kresling),
    /// One cell of square twists.
    SquareTwist(SquareTwist),
    /// One flat cell of Ron Resch's triangular tessellation.
    Resch(Resch),
    /// The flat crease pattern of the pleated hyperbolic paraboloid.
    Hypar(Hypar),
    /// The two-bar truss of von Mises.
    Truss(Truss),
    /// Two aligned Miura tubes that share a wall.
    AlignedTubes(MiuraTubes),
    /// Two Miura tubes that are coupled as a zipper.
    ZipperTubes(MiuraTubes),
    /// A random cell that cannot be flattened.
    Random(Random),
    /// A random cell with one symmetry.
    Symmetric(Symmetric),
    /// A random flat cell.
    RandomDevelopable(RandomDevelopable),
}

impl Pattern {
    /// Returns the names of all patterns.
    pub fn names() -> impl Iterator<Item = &'static str> {
        HELP.iter().map(|(name, _)| *name)
    }

    /// Returns a page about the pattern of this name: what it is, a drawing of its parameters, and the meaning, range
    /// and default of each.
    ///
    /// # Errors
    /// [`GenerateError::Unknown`] if no pattern has this name.
    pub fn help(name: &str) -> Result<&'static str, GenerateError> {
        let found = HELP.iter().find(|(known, _)| *known == name);
        found.map(|(_, text)| *text).ok_or_else(|| unknown(format!("there is no pattern `{name}`"), name))
    }

    /// Returns the pattern of this name with the default of every parameter.
    ///
    /// # Errors
    /// [`GenerateError::Unknown`] if no pattern has this name.
    pub fn named(name: &str) -> Result<Self, GenerateError> {
        Self::of(&Table::from_iter([("pattern".to_owned(), name.into())]))
    }

    /// Reads a pattern from its table, `{ pattern = "miura", .. }`; parameters that it does not have get their
    /// defaults.
    ///
    /// # Errors
    /// [`GenerateError::Unknown`] if there is no such pattern or parameter, or a value has another type.
    pub fn of(table: &Table) -> Result<Self, GenerateError> {
        let name = table.get("pattern").and_then(Value::as_str);
        let name = name.ok_or_else(|| unknown("the table names no pattern: `pattern` is missing".to_owned(), ""))?;
        Self::help(name)?;
        table.clone().try_into().map_err(|error: toml::de::Error| match error.message().split_once(", expected ") {
            Some((wrong, right)) => GenerateError::Unknown {
                message: wrong.replace("unknown field", &format!("`{name}` has no parameter")),
                help: format!("{}expected {right}", did_you_mean_of(error.message())),
            },
            None => GenerateError::Unknown { message: error.message().to_owned(), help: String::new() },
        })
    }
}

/// Returns the error about a pattern that is none of those that there are.
fn unknown(message: String, name: &str) -> GenerateError {
    GenerateError::Unknown { message, help: there_are(name, Pattern::names()) }
}

/// Makes the sheet of a pattern.
///
/// # Errors
/// [`GenerateError`] with the parameter and its range if a parameter is outside it, or with the defect of the mesh if
/// the parameters together give none.
pub fn generate(pattern: &Pattern) -> Result<Sheet, GenerateError> {
    match pattern {
        Pattern::Miura(p) => p.sheet(),
        Pattern::MiuraPatch(p) => p.sheet(),
        Pattern::Eggbox(p) => p.sheet(),
        Pattern::FourParallelogram(p) => p.sheet(),
        Pattern::Waterbomb(p) => p.sheet(),
        Pattern::Yoshimura(p) => p.sheet(),
        Pattern::Kresling(p) => p.sheet(),
        Pattern::SquareTwist(p) => p.sheet(),
        Pattern::Resch(p) => p.sheet(),
        Pattern::Hypar(p) => p.sheet(),
        Pattern::Truss(p) => p.sheet(),
        Pattern::AlignedTubes(p) => p.aligned(),
        Pattern::ZipperTubes(p) => p.zipper(),
        Pattern::Random(p) => p.sheet(),
        Pattern::Symmetric(p) => p.sheet(),
        Pattern::RandomDevelopable(p) => p.sheet(),
    }
}
