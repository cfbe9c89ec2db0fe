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
mod hypar;
mod kresling;
mod miura;
mod parts;
mod random;
mod resch;
mod square_twist;
mod symmetric;
mod thick_miura;
mod truss;
mod tube_block;
mod tubes;
mod waterbomb;
mod yoshimura;
mod zipper;

#[cfg(test)]
mod tests;

use serde::{Deserialize, Serialize};
use toml::{Table, Value};

use super::cell::Sheet;
use super::serde_message::in_words;
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
pub use thick_miura::ThickMiura;
pub use truss::Truss;
pub use tube_block::TubeBlock;
pub use tubes::MiuraTubes;
pub use waterbomb::Waterbomb;
pub use yoshimura::Yoshimura;

/// Defines the patterns by their names, and the function of their parameters that makes the sheet.
macro_rules! patterns {
    ($($(#[$about:meta])* $name:literal: $pattern:ident($parameters:ident::$sheet:ident),)+) => {
        /// The names of the patterns, and a page about each.
        const HELP: &[(&str, &str)] = &[$(($name, include_str!(concat!("help/", $name, ".txt")))),+];

        /// A pattern with its parameters. In a file, the key `pattern = "miura"` and so on stands next to the
        /// parameters.
        #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
        #[serde(tag = "pattern", rename_all = "kebab-case")]
        pub enum Pattern {
            $($(#[$about])* $pattern($parameters)),+
        }

        /// Makes the sheet of a pattern.
        ///
        /// # Errors
        /// [`GenerateError`] with the parameter and its range if a parameter is outside it, or with the defect of the
        /// mesh if the parameters together give none.
        pub fn generate(pattern: &Pattern) -> Result<Sheet, GenerateError> {
            match pattern {
                $(Pattern::$pattern(parameters) => parameters.$sheet()),+
            }
        }
    };
}

patterns! {
    /// One cell of Miura-ori.
    "miura": Miura(Miura::sheet),
    /// A finite Miura-ori.
    "miura-patch": MiuraPatch(MiuraPatch::sheet),
    /// One cell of Miura-ori of thick panels.
    "thick-miura": ThickMiura(ThickMiura::sheet),
    /// One cell of the eggbox.
    "eggbox": Eggbox(Eggbox::sheet),
    /// One cell of four parallelograms of any lengths and angles.
    "four-parallelogram": FourParallelogram(FourParallelogram::sheet),
    /// One cell of the waterbomb tessellation.
    "waterbomb": Waterbomb(Waterbomb::sheet),
    /// One cell of the Yoshimura pattern.
    "yoshimura": Yoshimura(Yoshimura::sheet),
    /// A ring of Kresling's pattern, open or closed to a drum.
    "kresling": Kresling(Kresling::sheet),
    /// One cell of square twists.
    "square-twist": SquareTwist(SquareTwist::sheet),
    /// One flat cell of Ron Resch's triangular tessellation.
    "resch": Resch(Resch::sheet),
    /// The flat crease pattern of the pleated hyperbolic paraboloid.
    "hypar": Hypar(Hypar::sheet),
    /// The two-bar truss of von Mises.
    "truss": Truss(Truss::sheet),
    /// Two aligned Miura tubes that share a wall.
    "aligned-tubes": AlignedTubes(MiuraTubes::aligned),
    /// A block of aligned Miura tubes.
    "tube-block": TubeBlock(TubeBlock::sheet),
    /// Two Miura tubes that are coupled as a zipper.
    "zipper-tubes": ZipperTubes(MiuraTubes::zipper),
    /// A random cell that cannot be flattened.
    "random": Random(Random::sheet),
    /// A random cell with one symmetry.
    "symmetric": Symmetric(Symmetric::sheet),
    /// A random flat cell.
    "random-developable": RandomDevelopable(RandomDevelopable::sheet),
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
        table.clone().try_into().map_err(|error: toml::de::Error| {
            let (wrong, right) = in_words(error.message());
            // the error does not name its parameter: it is the one without which there is another error, or none
            let is_wrong = |key: &&String| {
                let others = table.iter().filter(|(other, _)| other != key).map(|(k, v)| (k.clone(), v.clone()));
                let found = Table::from_iter(others).try_into::<Self>();
                *key != "pattern" && found.err().is_none_or(|other| other.message() != error.message())
            };
            let wrong = table
                .keys()
                .find(is_wrong)
                .map_or(wrong.clone(), |key| wrong.replace("the value", &format!("`{key}`")));
            GenerateError::Unknown {
                message: wrong.replace("unknown field", &format!("`{name}` has no parameter")),
                help: right.map(|right| did_you_mean_of(error.message()) + "expected " + &right).unwrap_or_default(),
            }
        })
    }
}

/// Returns the error about a pattern that is none of those that there are.
fn unknown(message: String, name: &str) -> GenerateError {
    GenerateError::Unknown { message, help: there_are(name, Pattern::names()) }
}
