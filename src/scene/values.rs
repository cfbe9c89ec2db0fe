//! Values of a scene that are checked alone: each type here can hold valid values only.
//!
//! Every message has the form `description of the error, expected valid value`; [`crate::scene::SceneError`] prints the
//! second half as help.

use std::borrow::Cow;

use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::de::Error as _;
use serde::{Deserialize, Deserializer};
use thiserror::Error;

use crate::sheet::{Corner, EdgeKey, Seam};

fn counted(count: &usize) -> String {
    if *count == 1 { "1 value".into() } else { format!("{count} values") }
}

/// The reasons for which a value of a scene is refused.
#[derive(Debug, Error)]
#[allow(missing_docs)] // each variant is documented by its message
pub enum ValueError {
    #[error("the list has {count}, expected {1} values", count = counted(.0))]
    Length(usize, usize),
    #[error("the stiffness is {0}, expected a positive number or `inf` (exactly rigid)")]
    Stiffness(f64),
    #[error("the number is {0}, expected a finite number")]
    NotFinite(f64),
    #[error("the number is {0}, expected a finite number above 0")]
    NotPositive(f64),
    #[error("the fraction is {0}, expected a number from -1 (folded to the other side) to 1 (folded)")]
    NoFraction(f64),
    #[error("Poisson's ratio is {0}, expected a number above -1, and at most 0.5")]
    NoPoissonRatio(f64),
    #[error("the number is {0}, expected a whole number from 1 to {max}", max = u32::MAX)]
    NoCount(i64),
    #[error("there are {0} x {1} cells, expected at least 1 in either direction")]
    NoCells(i64, i64),
    #[error("there is no tube with the seam [{0}, {1}], expected whole numbers of at most 1000, not both 0")]
    NoSeam(i64, i64),
    #[error("{0} x {1} cells are more than can be numbered, expected at most {max} in all", max = Cells::MOST)]
    TooManyCells(i64, i64),
    #[error("`{0}` is not a name for a study, expected letters, digits, `_` and `-` only")]
    Name(String),
    #[error("`{0}` is not a name, expected letters, digits, `_` and `-` only")]
    Label(String),
    #[error(
        "`{0}` is no motion, or is listed twice, expected a list of \"x\", \"y\", \"z\", \"rx\", \"ry\", \"rz\", each once; []: held"
    )]
    Motion(String),
    #[error("`{0}` cannot name a study because `start = \"{0}\"` means the drawn state, expected another name")]
    ReservedName(String),
    #[error("`{0}` names no axes, expected one or more of the letters x, y, z, each once, as in \"xz\"")]
    Axes(String),
    #[error("an edge cannot start or end at vertex {0}, expected [i, j, n1, n2] with i and j counted from 0")]
    Vertex(i64),
    #[error("cell {0} of an edge is out of range, expected n1 and n2 of [i, j, n1, n2] to be small whole numbers")]
    Shift(i64),
    #[error("the barrier is sought from well {0} to itself, expected two different wells in [a, b]")]
    OneWell(usize),
    #[error("the edge runs from vertex {0} to itself, expected two different ends in [i, j, n1, n2]")]
    Loop(usize),
}

/// A list of exactly `N` values: an array alone would silently ignore additional values.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Exactly<T, const N: usize>(pub [T; N]);

impl<'de, T: Deserialize<'de>, const N: usize> Deserialize<'de> for Exactly<T, N> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let values = Vec::<T>::deserialize(deserializer)?;
        values.try_into().map(Self).map_err(|values: Vec<T>| D::Error::custom(ValueError::Length(values.len(), N)))
    }
}

impl<T, const N: usize> JsonSchema for Exactly<T, N>
where
    [T; N]: JsonSchema,
{
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        <[T; N]>::schema_name()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        <[T; N]>::json_schema(generator)
    }
}

/// Defines kinds of numbers: what each is, whether a number is one, and the fault of those that are none.
macro_rules! numbers {
    ($fault:ident: $($(#[$about:meta])* $name:ident, $is_one:expr, $wrong:ident;)+) => {$(
        #[derive(Clone, Copy, Debug, PartialEq, Deserialize, JsonSchema)]
        $(#[$about])*
        #[serde(try_from = "f64")]
        pub struct $name(pub f64);

        impl TryFrom<f64> for $name {
            type Error = $fault;

            fn try_from(number: f64) -> Result<Self, $fault> {
                let is_one: fn(&f64) -> bool = $is_one;
                if is_one(&number) { Ok(Self(number)) } else { Err($fault::$wrong(number)) }
            }
        }
    )+};
}
pub(super) use numbers;

numbers! { ValueError:
    /// Stiffness of a term: a positive number, infinity included.
    #[schemars(extend("exclusiveMinimum" = 0))]
    Stiffness, |number| *number > 0.0, Stiffness;

    /// A finite number.
    Finite, |number| number.is_finite(), NotFinite;

    /// A finite number above zero.
    #[schemars(extend("exclusiveMinimum" = 0))]
    Positive, |number| *number > 0.0 && number.is_finite(), NotPositive;

    /// A part of the way from flat to folded: from -1 to 1, where negative numbers fold to the other side.
    #[schemars(extend("minimum" = -1, "maximum" = 1))]
    Fraction, |number| (-1.0..=1.0).contains(number), NoFraction;

    /// Poisson's ratio of an isotropic elastic material.
    #[schemars(extend("exclusiveMinimum" = -1, "maximum" = 0.5))]
    PoissonRatio, |number| *number > -1.0 && *number <= 0.5, NoPoissonRatio;
}

/// A whole number above zero.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(try_from = "i64")]
#[schemars(with = "u32", extend("minimum" = 1))]
pub struct Count(pub u32);

impl TryFrom<i64> for Count {
    type Error = ValueError;

    fn try_from(value: i64) -> Result<Self, ValueError> {
        u32::try_from(value).ok().filter(|count| *count > 0).map(Self).ok_or(ValueError::NoCount(value))
    }
}

/// Three finite numbers.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(try_from = "Exactly<f64, 3>")]
pub struct Triple(pub [f64; 3]);

impl TryFrom<Exactly<f64, 3>> for Triple {
    type Error = ValueError;

    fn try_from(Exactly(value): Exactly<f64, 3>) -> Result<Self, ValueError> {
        match value.iter().find(|x| !x.is_finite()) {
            Some(&bad) => Err(ValueError::NotFinite(bad)),
            None => Ok(Self(value)),
        }
    }
}

/// Two finite numbers.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(try_from = "Exactly<f64, 2>")]
pub struct Pair(pub [f64; 2]);

impl TryFrom<Exactly<f64, 2>> for Pair {
    type Error = ValueError;

    fn try_from(Exactly(value): Exactly<f64, 2>) -> Result<Self, ValueError> {
        match value.iter().find(|x| !x.is_finite()) {
            Some(&bad) => Err(ValueError::NotFinite(bad)),
            None => Ok(Self(value)),
        }
    }
}

/// A cell of a patch, counted from [0, 0].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default, Deserialize, JsonSchema)]
#[serde(from = "Exactly<usize, 2>")]
pub struct CellIndex(pub [usize; 2]);

impl From<Exactly<usize, 2>> for CellIndex {
    fn from(Exactly(cell): Exactly<usize, 2>) -> Self {
        Self(cell)
    }
}

/// Two different wells, numbered by energy from 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(try_from = "Exactly<usize, 2>")]
pub struct WellPair(pub [usize; 2]);

impl TryFrom<Exactly<usize, 2>> for WellPair {
    type Error = ValueError;

    fn try_from(Exactly([a, b]): Exactly<usize, 2>) -> Result<Self, ValueError> {
        if a == b { Err(ValueError::OneWell(a)) } else { Ok(Self([a, b])) }
    }
}

/// Numbers of cells along the two lattice vectors.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(try_from = "Exactly<i64, 2>")]
#[schemars(extend("items" = { "type": "integer", "minimum": 1 }))]
pub struct Cells(pub [usize; 2]);

impl Cells {
    /// Largest number of cells: their indices fit into 32 bits, signs included.
    pub(crate) const MOST: i64 = i32::MAX as i64;
}

impl TryFrom<Exactly<i64, 2>> for Cells {
    type Error = ValueError;

    fn try_from(Exactly([n1, n2]): Exactly<i64, 2>) -> Result<Self, ValueError> {
        if n1 < 1 || n2 < 1 {
            return Err(ValueError::NoCells(n1, n2));
        }
        match n1.checked_mul(n2) {
            Some(count) if count <= Self::MOST => Ok(Self([n1 as usize, n2 as usize])),
            _ => Err(ValueError::TooManyCells(n1, n2)),
        }
    }
}

/// The seam of a tube: the cell that coincides with cell (0, 0).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(try_from = "Exactly<i64, 2>")]
#[schemars(extend("items" = { "type": "integer", "minimum": -1000, "maximum": 1000 }))]
pub struct SeamCell(pub [i32; 2]);

impl SeamCell {
    /// Largest number of cells along a seam, in each lattice direction.
    const MOST: i64 = 1000;

    /// All strands, and as many rows as make a tube about as long as it is wide.
    pub(crate) fn usual_cells(self) -> [usize; 2] {
        let strands = Seam::new(self.0).map_or(1, |seam| seam.strands() as usize);
        let around: usize = self.0.iter().map(|n| n.unsigned_abs() as usize).sum();
        [strands, (6 * around).div_ceil(strands)]
    }
}

impl TryFrom<Exactly<i64, 2>> for SeamCell {
    type Error = ValueError;

    fn try_from(Exactly([n1, n2]): Exactly<i64, 2>) -> Result<Self, ValueError> {
        if (n1, n2) == (0, 0) || n1.abs() > Self::MOST || n2.abs() > Self::MOST {
            return Err(ValueError::NoSeam(n1, n2));
        }
        Ok(Self([n1 as i32, n2 as i32]))
    }
}

/// Name of a study: it names files too, so it has letters, digits, `_` and `-` only.
#[derive(Clone, Debug, PartialEq, Eq, Hash, Deserialize, JsonSchema)]
#[serde(try_from = "String")]
#[schemars(extend("pattern" = "^[A-Za-z0-9_-]+$"))]
pub struct Name(pub String);

impl TryFrom<String> for Name {
    type Error = ValueError;

    fn try_from(value: String) -> Result<Self, ValueError> {
        let legal = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
        if value == "drawn" {
            Err(ValueError::ReservedName(value))
        } else if value.is_empty() || !value.chars().all(legal) {
            Err(ValueError::Name(value))
        } else {
            Ok(Self(value))
        }
    }
}

/// Name of a part or of a drive: letters, digits, `_` and `-`.
#[derive(Clone, Debug, PartialEq, Eq, Hash, Deserialize, JsonSchema)]
#[serde(try_from = "String")]
#[schemars(extend("pattern" = "^[A-Za-z0-9_-]+$"))]
pub struct Label(pub String);

impl TryFrom<String> for Label {
    type Error = ValueError;

    fn try_from(value: String) -> Result<Self, ValueError> {
        let legal = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
        let right = !value.is_empty() && value.chars().all(legal);
        if right { Ok(Self(value)) } else { Err(ValueError::Label(value)) }
    }
}

/// Motions of a rigid body: along x, y, z and about x, y, z, true where the list names them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(try_from = "Vec<String>")]
pub struct Motions(
    #[schemars(with = "Vec<String>", extend("items" = { "enum": Motions::NAMES }, "uniqueItems" = true))] pub [bool; 6],
);

impl Motions {
    /// Names of the motions.
    pub(crate) const NAMES: [&str; 6] = ["x", "y", "z", "rx", "ry", "rz"];
}

impl TryFrom<Vec<String>> for Motions {
    type Error = ValueError;

    fn try_from(words: Vec<String>) -> Result<Self, ValueError> {
        let mut motions = [false; 6];
        for word in words {
            match Self::NAMES.iter().position(|name| *name == word) {
                Some(motion) if !motions[motion] => motions[motion] = true,
                _ => return Err(ValueError::Motion(word)),
            }
        }
        Ok(Self(motions))
    }
}

/// Coordinate axes: `[x, y, z]`, true where the letter is there.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(try_from = "String")]
#[schemars(extend("pattern" = "^[xyz]{1,3}$"))]
pub struct Axes(pub [bool; 3]);

impl TryFrom<String> for Axes {
    type Error = ValueError;

    fn try_from(value: String) -> Result<Self, ValueError> {
        let mut axes = [false; 3];
        for letter in value.chars() {
            match "xyz".find(letter) {
                Some(axis) if !axes[axis] => axes[axis] = true,
                _ => return Err(ValueError::Axes(value)),
            }
        }
        if value.is_empty() { Err(ValueError::Axes(value)) } else { Ok(Self(axes)) }
    }
}

/// The name `[i, j, n1, n2]` of an edge of the cell; `[j, i, -n1, -n2]` gives the same value.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Deserialize, JsonSchema)]
#[serde(try_from = "Exactly<i64, 4>")]
pub struct EdgeName(#[schemars(with = "[i64; 4]")] pub EdgeKey);

impl TryFrom<Exactly<i64, 4>> for EdgeName {
    type Error = ValueError;

    fn try_from(Exactly(name): Exactly<i64, 4>) -> Result<Self, ValueError> {
        directed_edge(name).map(|(key, _)| Self(key))
    }
}

/// Returns the name of the edge `[i, j, n1, n2]`, and whether its canonical form has the opposite direction.
pub(super) fn directed_edge([i, j, n1, n2]: [i64; 4]) -> Result<(EdgeKey, bool), ValueError> {
    let vertex = |v: i64| usize::try_from(v).map_err(|_| ValueError::Vertex(v));
    let shift = |n: i64| match i32::try_from(n) {
        Ok(n) if n != i32::MIN => Ok(n),
        _ => Err(ValueError::Shift(n)),
    };
    let (start, end) = (Corner::home(vertex(i)?), Corner { vertex: vertex(j)?, shift: [shift(n1)?, shift(n2)?] });
    if start == end { Err(ValueError::Loop(start.vertex)) } else { Ok(EdgeKey::new(start, end)) }
}
