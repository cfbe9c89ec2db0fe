//! One cell of a sheet on the torus (or a finite sheet), with its files and its generators.

pub mod cell;
pub mod tiling;

pub use cell::{Corner, Edge, EdgeKey, EdgeKind, Sheet, Triangle};
