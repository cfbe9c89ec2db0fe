//! Values of a scene that are checked alone: each type here can hold valid values only.
//!
//! Every message has the form `description of the error, expected valid value`; [`crate::scene::SceneError`] prints the
//! second half as help.

use schemars::JsonSchema;
use serde::de::Error as _;
use serde::{Deserialize, Deserializer};
use thiserror::Error;

use crate::math::short;
use crate::sheet::{Corner, EdgeKey, Seam};

fn counted(count: &usize) -> String {
    if *count == 1 { "1 value".into() } else { format!("{count} values") }
}

/// Smallest stiffness: the reciprocals of spring constants, which are this over a length, are numbers too.
pub(super) const LEAST_STIFFNESS: f64 = 1e-300;

/// The reasons for which a value of a scene is refused.
#[derive(Debug, Error)]
#[allow(missing_docs)] // each variant is documented by its message
pub enum ValueError {
    #[error("the list has {count}, expected {1} values", count = counted(.0))]
    Length(usize, usize),
    #[error("the stiffness is {}, expected a positive number or `inf` (exactly rigid), 1e-300 at least", short(*.0))]
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

// A list of exactly `N` values: an array alone would silently ignore additional values. (A documentation comment would
// be the description of every such list in the schema.)
#[derive(Clone, Copy, Debug, PartialEq, Eq, JsonSchema)]
#[schemars(inline, bound = "[T; N]: JsonSchema")]
pub(crate) struct Exactly<T, const N: usize>(pub [T; N]);

impl<'de, T: Deserialize<'de>, const N: usize> Deserialize<'de> for Exactly<T, N> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let values = Vec::<T>::deserialize(deserializer)?;
        values.try_into().map(Self).map_err(|values: Vec<T>| D::Error::custom(ValueError::Length(values.len(), N)))
    }
}

/// Defines values that are checked when they are read: from what, and how.
macro_rules! checked {
    ($fault:ident: $($(#[$about:meta])* $name:ident($(#[$at:meta])* $seen:vis $of:ty) from $given:ty, $read:expr;)+) => {$(
        $(#[$about])*
        pub struct $name($(#[$at])* $seen $of);

        impl TryFrom<$given> for $name {
            type Error = $fault;

            fn try_from(given: $given) -> Result<Self, $fault> {
                let read: fn($given) -> Result<$of, $fault> = $read;
                read(given).map(Self)
            }
        }
    )+};
}
pub(super) use checked;

/// Defines kinds of numbers: what each is, whether a number is one, and the fault of those that are none.
macro_rules! numbers {
    ($fault:ident: $($(#[$about:meta])* $name:ident, $is_one:expr, $wrong:ident;)+) => {
        checked! { $fault: $(
            #[derive(Clone, Copy, Debug, PartialEq, Deserialize, JsonSchema)]
            $(#[$about])*
            #[serde(try_from = "f64")]
            $name(pub f64) from f64, |number| {
                let is_one: fn(&f64) -> bool = $is_one;
                if is_one(&number) { Ok(number) } else { Err($fault::$wrong(number)) }
            };
        )+ }
    };
}
pub(super) use numbers;

numbers! { ValueError:
    /// Stiffness of a term: a positive number, infinity included.
    #[schemars(extend("minimum" = LEAST_STIFFNESS))]
    Stiffness, |number| *number >= LEAST_STIFFNESS, Stiffness;

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

checked! { ValueError:
    /// A whole number above zero.
    #[derive(Clone, Copy, Debug, PartialEq, Deserialize, JsonSchema)]
    #[serde(try_from = "i64")]
    #[schemars(with = "u32", extend("minimum" = 1))]
    Count(pub u32) from i64, |n| u32::try_from(n).ok().filter(|count| *count > 0).ok_or(ValueError::NoCount(n));

    /// Three finite numbers.
    #[derive(Clone, Copy, Debug, PartialEq, Deserialize, JsonSchema)]
    #[serde(try_from = "Exactly<f64, 3>")]
    Triple(pub [f64; 3]) from Exactly<f64, 3>, all_finite;

    /// Two finite numbers.
    #[derive(Clone, Copy, Debug, PartialEq, Deserialize, JsonSchema)]
    #[serde(try_from = "Exactly<f64, 2>")]
    Pair(pub [f64; 2]) from Exactly<f64, 2>, all_finite;

    /// A cell of a patch, counted from [0, 0].
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default, Deserialize, JsonSchema)]
    #[serde(try_from = "Exactly<usize, 2>")]
    CellIndex(pub [usize; 2]) from Exactly<usize, 2>, |Exactly(cell)| Ok(cell);

    /// Two different wells, numbered by energy from 0.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
    #[serde(try_from = "Exactly<usize, 2>")]
    WellPair(pub [usize; 2]) from Exactly<usize, 2>,
        |Exactly([a, b])| if a == b { Err(ValueError::OneWell(a)) } else { Ok([a, b]) };

    /// Numbers of cells along the two lattice vectors.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
    #[serde(try_from = "Exactly<i64, 2>")]
    #[schemars(extend("items" = { "type": "integer", "minimum": 1 }))]
    Cells(pub [usize; 2]) from Exactly<i64, 2>, |Exactly([n1, n2])| match n1.checked_mul(n2) {
        _ if n1 < 1 || n2 < 1 => Err(ValueError::NoCells(n1, n2)),
        Some(count) if count <= Cells::MOST => Ok([n1 as usize, n2 as usize]),
        _ => Err(ValueError::TooManyCells(n1, n2)),
    };

    /// The seam of a tube: the cell that coincides with cell (0, 0).
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
    #[serde(try_from = "Exactly<i64, 2>")]
    #[schemars(extend("items" = { "type": "integer", "minimum": -1000, "maximum": 1000 }))]
    SeamCell(pub [i32; 2]) from Exactly<i64, 2>, |Exactly([n1, n2])| {
        let none = (n1, n2) == (0, 0) || n1.abs() > SeamCell::MOST || n2.abs() > SeamCell::MOST;
        if none { Err(ValueError::NoSeam(n1, n2)) } else { Ok([n1 as i32, n2 as i32]) }
    };

    /// Name of a study: it names files too, so it has letters, digits, `_` and `-` only.
    #[derive(Clone, Debug, PartialEq, Eq, Hash, Deserialize, JsonSchema)]
    #[serde(try_from = "String")]
    #[schemars(extend("pattern" = "^[A-Za-z0-9_-]+$"))]
    Name(pub String) from String,
        |name| if name == "drawn" { Err(ValueError::ReservedName(name)) } else { word(name, ValueError::Name) };

    /// Name of a part or of a drive: letters, digits, `_` and `-`.
    #[derive(Clone, Debug, PartialEq, Eq, Hash, Deserialize, JsonSchema)]
    #[serde(try_from = "String")]
    #[schemars(extend("pattern" = "^[A-Za-z0-9_-]+$"))]
    Label(pub String) from String, |name| word(name, ValueError::Label);

    /// Motions of a rigid body: along x, y, z and about x, y, z, true where the list names them.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
    #[serde(try_from = "Vec<String>")]
    Motions(
        #[schemars(with = "Vec<String>", extend("items" = { "enum": Motions::NAMES }, "uniqueItems" = true))]
        pub [bool; 6]
    ) from Vec<String>, |words| {
        let mut motions = [false; 6];
        for word in words {
            match Motions::NAMES.iter().position(|name| *name == word) {
                Some(motion) if !motions[motion] => motions[motion] = true,
                _ => return Err(ValueError::Motion(word)),
            }
        }
        Ok(motions)
    };

    /// Coordinate axes: `[x, y, z]`, true where the letter is there.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
    #[serde(try_from = "String")]
    #[schemars(extend("pattern" = "^[xyz]{1,3}$"))]
    Axes(pub [bool; 3]) from String, |letters| {
        let mut axes = [false; 3];
        for letter in letters.chars() {
            match "xyz".find(letter) {
                Some(axis) if !axes[axis] => axes[axis] = true,
                _ => return Err(ValueError::Axes(letters)),
            }
        }
        if letters.is_empty() { Err(ValueError::Axes(letters)) } else { Ok(axes) }
    };

    /// The name `[i, j, n1, n2]` of an edge of the cell; `[j, i, -n1, -n2]` gives the same value.
    #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Deserialize, JsonSchema)]
    #[serde(try_from = "Exactly<i64, 4>")]
    EdgeName(#[schemars(with = "[i64; 4]")] pub EdgeKey) from Exactly<i64, 4>,
        |Exactly(name)| directed_edge(name).map(|(key, _)| key);
}

impl Cells {
    /// Largest number of cells: their indices fit into 32 bits, signs included.
    pub(crate) const MOST: i64 = i32::MAX as i64;
}

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

impl Motions {
    /// Names of the motions.
    pub(crate) const NAMES: [&str; 6] = ["x", "y", "z", "rx", "ry", "rz"];
}

fn all_finite<const N: usize>(Exactly(numbers): Exactly<f64, N>) -> Result<[f64; N], ValueError> {
    numbers.iter().find(|x| !x.is_finite()).map_or(Ok(numbers), |bad| Err(ValueError::NotFinite(*bad)))
}

fn word(text: String, fault: fn(String) -> ValueError) -> Result<String, ValueError> {
    let legal = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
    if !text.is_empty() && text.chars().all(legal) { Ok(text) } else { Err(fault(text)) }
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
