//! The name of an edge in a drawn mesh.

use std::fmt;

/// An edge of a drawn mesh, named by the numbers that the file gives to its ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DrawnEdge(pub usize, pub usize);

impl fmt::Display for DrawnEdge {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "[{}, {}]", self.0, self.1)
    }
}
