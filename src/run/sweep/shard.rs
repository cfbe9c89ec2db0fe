//! Shards: the parts of a sweep that separate runs compute, such as the jobs of an array of a scheduler.

use std::fmt;
use std::str::FromStr;

use thiserror::Error;

/// One of several parts of a sweep, `2/8`: of the points in order every eighth, from the second.
///
/// ```
/// use foldwell::run::Shard;
///
/// let shard: Shard = "2/3".parse()?;
/// assert_eq!(shard.points(8), [1, 4, 7]);
/// assert_eq!(Shard::default().points(2), [0, 1]);
/// assert!("0/3".parse::<Shard>().is_err() && "4/3".parse::<Shard>().is_err());
/// # Ok::<(), foldwell::run::ShardError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    /// Number of the shard, from 1.
    number: usize,
    /// How many there are.
    of: usize,
}

/// A text that names no shard.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("`{0}` names no shard; write I/N with I from 1 to N, as in 2/8")]
pub struct ShardError(String);

impl Shard {
    /// Returns the points of the shard among this number of points: those with index `number - 1` modulo the number of
    /// shards.
    pub fn points(&self, count: usize) -> Vec<usize> {
        (self.number - 1..count).step_by(self.of).collect()
    }
}

/// The only shard of one.
impl Default for Shard {
    fn default() -> Self {
        Self { number: 1, of: 1 }
    }
}

impl FromStr for Shard {
    type Err = ShardError;

    fn from_str(text: &str) -> Result<Self, ShardError> {
        let numbers = text.split_once('/').and_then(|(i, n)| Some((i.trim().parse().ok()?, n.trim().parse().ok()?)));
        let found = numbers.filter(|(number, of)| (1..=*of).contains(number));
        found.map(|(number, of)| Self { number, of }).ok_or_else(|| ShardError(text.to_owned()))
    }
}

impl fmt::Display for Shard {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.number, self.of)
    }
}
