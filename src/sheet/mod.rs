//! One cell of a sheet on the torus (or a finite sheet), with its files and its generators.

mod assigned;
pub mod assignment;
pub mod assignment_fault;
pub mod build;
pub mod cell;
mod drawn_edge;
pub mod error;
pub mod fold;
pub mod generate;
pub mod info;
pub mod obj;
pub mod pieces;
pub mod record;
pub mod text;
pub mod tiling;

pub use assignment::Assignment;
pub use cell::{Corner, Edge, EdgeKey, EdgeKind, Sheet, Triangle};
pub use error::{Problem, SheetError};
pub use generate::{GenerateError, Pattern, generate};
pub use info::Info;
pub use pieces::pieces;
pub use record::FileRecord;
pub use tiling::{Site, TiledEdge, TiledTriangle, Tiling, tile};
