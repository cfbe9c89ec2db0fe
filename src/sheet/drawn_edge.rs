//! The name of an edge in a drawn mesh.

use std::fmt;

/// A drawn edge, by the file's numbers of its ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DrawnEdge(pub usize, pub usize);

impl fmt::Display for DrawnEdge {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "[{}, {}]", self.0, self.1)
    }
}
