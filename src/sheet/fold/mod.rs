//! FOLD 1.2 files with the additional keys `foldwell:lattice` and `foldwell:holes` for periodic sheets, and
//! `foldwell:stiffness` and `foldwell:bar_stiffness` for stiffnesses of edges.
//! `foldwell:names` for named lists of vertices.
//!
//! One cell is drawn in full: the vertices of the cell and the copies that its faces need. If `faces_vertices` is
//! absent, the faces are rebuilt from `edges_vertices`, seen along z. Angles in these files are in degrees, valley
//! positive; angles and assignments of edges are optional. Angles that agree with the coordinates within 1e-3 degrees,
//! up to full turns, are the drawn ones. If some do not agree, all angles of the file are the targets of folding, as
//! crease pattern editors write them and as they remain while a simulator folds
//! ([`targets`](crate::sheet::Sheet::targets)).
//!
//! The letters of `edges_assignment` have their meaning in FOLD 1.2. `C` cuts a finite sheet along the edge. `J` joins
//! the two faces to one polygon, of which the edge is a diagonal. An edge with `B` has one face only: a rebuilt face
//! whose sides are all boundaries is a hole. An edge with `M` or `V` may be flat, as in a crease pattern, but not
//! folded to the other side. One frame is read, the first with a mesh or that of a given number; see [`parse_frame`].
//! Keys about the file and its frame are kept, and so are all others of a finite sheet whose numbering is kept.
//!
//! ```
//! use foldwell::sheet::fold::{parse, write};
//!
//! let text = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/meshes/open-star.fold"))?;
//! let sheet = parse(&text, "open-star.fold")?;
//! // what is written reads back as the same sheet, bit by bit
//! assert_eq!(parse(&write(&sheet), "copy.fold")?, sheet);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod clean;
mod edges;
mod frames;
mod keys;
mod locate;
mod parse;
mod read;
mod record;
mod stiffness;
mod write;

pub use parse::{parse, parse_frame, read, read_frame};
pub use write::write;

#[cfg(test)]
mod tests;
