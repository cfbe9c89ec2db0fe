//! Exact folding in fold angles alone: closure of the faces around every vertex, the embedding that follows from the
//! angles, its screw lattice, and the linear folding modes.
//!
//! Nothing here knows bars or energies, so that it can judge what the energies find.

pub mod closing;
pub mod closure;
pub mod displacement;
pub mod embedding;
pub mod error;
pub mod folding_modes;
pub mod metric;
pub mod motion;
pub mod rays;
pub mod screw;
pub mod second_order;
pub mod shape;
#[cfg(test)]
mod test_sheets;
pub mod tube;
mod walk;

pub use closing::Closing;
pub use closure::{Closure, HingedEdge, drawn_fold_angles};
pub use displacement::Displacement;
pub use embedding::{Compatibility, Embedding, Placement};
pub use error::KinematicsError;
pub use folding_modes::{FoldingModes, folding_modes, folding_modes_with_locked};
pub use motion::{Motion, Moving, Rigid, Twist};
pub use rays::{Ray, Rays, RealDirections};
pub use screw::{Screw, ScrewRate};
pub use second_order::{SecondOrder, signature};
pub use shape::{Shape, ShapeRate};
pub use tube::Tube;
