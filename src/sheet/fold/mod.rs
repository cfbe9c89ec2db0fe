//! FOLD 1.2 files with the periodic keys `foldwell:lattice` and `foldwell:holes`.
//!
//! One cell is drawn in full: the vertices of the cell and the copies that its faces need. `faces_vertices` is rebuilt
//! from `edges_vertices` where it is absent, seen along z. Angles in these files are degrees, valley positive; angles
//! and assignments of edges are optional. An angle that is given must be the one that the coordinates draw (within 1e-3
//! degrees, full turns aside).
//!
//! Letters of `edges_assignment` mean what FOLD 1.2 says. `C` cuts a finite sheet along the edge, `J` joins the two faces
//! to one polygon, of which the edge is a diagonal. `B` has one face only: a rebuilt face between boundaries alone is a
//! hole. `M` and `V` may be flat, as in a crease pattern, but not folded to the other side. Of several frames the first
//! is read. Keys about the file and its frame are kept, others are listed as left out.

mod edges;
mod keys;
mod locate;
mod read;
mod record;
mod write;

pub use read::{parse, read};
pub use write::write;

#[cfg(test)]
mod tests;
