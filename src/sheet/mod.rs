//! Sheets: the cell of a periodic sheet, or a finite sheet, with its file formats and pattern generators.
//!
//! A [`Sheet`] has vertices, polygons, their triangles and the edges between them. It comes from a file ([`fold`],
//! [`obj`]) or from a generator ([`mod@generate`]), both by way of the same checks ([`build`]). [`tile`] makes `n1 x
//! n2` cells of it.
//!
//! ```
//! let text = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/meshes/open-star.fold"))?;
//! let sheet = foldwell::sheet::fold::parse(&text, "open-star.fold")?;
//! assert!(sheet.lattice.is_some());
//! assert_eq!((sheet.vertices.len(), sheet.edges.len(), sheet.triangles.len()), (4, 12, 8));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub(crate) mod angle;
mod assigned;
pub(crate) mod assignment;
mod boxes;
pub mod build;
pub(crate) mod cell;
pub(crate) mod error;
mod flatten;
pub mod fold;
pub mod generate;
pub(crate) mod info;
pub mod listed;
pub(crate) mod memory;
pub mod obj;
mod panels;
pub mod pattern;
pub(crate) mod pattern_fault;
pub mod ply;
pub(crate) mod record;
pub(crate) mod screws;
mod seam;
pub(crate) mod serde_message;
pub(crate) mod sides;
pub mod similar;
pub mod stl;
pub mod symmetry;
pub(crate) mod text;
mod thicken;
pub(crate) mod tiling;
mod weld;
pub(crate) mod written;

pub use crate::math::pieces::pieces;
pub use assignment::Assignment;
pub use cell::{Corner, Edge, EdgeKey, EdgeKind, Glue, MeshStiffness, Panel, Sheet, Triangle};
pub use error::{MeshProblem, SheetError};
pub use flatten::{NotDevelopable, flatten};
pub use generate::{GenerateError, Pattern, generate};
pub use info::{Info, ThinTriangle};
pub use panels::with_centres;
pub use record::{FileRecord, Gap, Redrawing};
pub use screws::ScrewLattice;
pub use seam::{Seam, SeamKept};
pub use thicken::{Solid, thickened};
pub use tiling::{Site, TiledEdge, TiledTriangle, Tiling, tile};
pub use weld::welded;
