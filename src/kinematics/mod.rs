//! Exact folding in fold angles alone: closure of the faces around every vertex, and the linear folding modes.
//!
//! Nothing here knows bars or energies, so that it can judge what the energies find.

pub mod closure;
pub mod error;
pub mod folding_modes;
#[cfg(test)]
mod test_sheets;

pub use closure::{Closure, HingedEdge, drawn_fold_angles};
pub use error::KinematicsError;
pub use folding_modes::{FoldingModes, folding_modes, folding_modes_with_locked};
