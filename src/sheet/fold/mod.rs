//! FOLD 1.2 files with the periodic keys `foldwell:lattice` and `foldwell:holes`.
//!
//! One cell is drawn in full: the vertices of the cell and the copies that its faces need. `faces_vertices` is rebuilt
//! from `edges_vertices` where it is absent, seen along z. Angles in these files are degrees, valley positive; angles
//! and assignments of edges are optional. An angle that is given must be the one that the coordinates draw (within 1e-3
//! degrees, full turns aside); letters of `edges_assignment` are checked to be letters of the format, and not compared
//! with the geometry, since a crease pattern assigns folds that it does not draw. Other keys are ignored.

mod edges;
mod locate;
mod read;
mod write;

pub use read::{parse, read};
pub use write::write;

#[cfg(test)]
mod tests;
