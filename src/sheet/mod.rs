//! One cell of a sheet on the torus (or a finite sheet), with its files and its generators.

mod assigned;
pub(crate) mod assignment;
pub(crate) mod assignment_fault;
pub mod build;
pub(crate) mod cell;
mod drawn_edge;
pub(crate) mod error;
pub mod fold;
pub mod generate;
pub(crate) mod info;
pub mod obj;
pub mod pieces;
pub(crate) mod record;
pub(crate) mod text;
pub(crate) mod tiling;

pub use assignment::Assignment;
pub use cell::{Corner, Edge, EdgeKey, EdgeKind, Sheet, Triangle};
pub use error::{Problem, SheetError};
pub use generate::{GenerateError, Pattern, generate};
pub use info::Info;
pub use pieces::pieces;
pub use record::FileRecord;
pub use tiling::{Site, TiledEdge, TiledTriangle, Tiling, tile};
