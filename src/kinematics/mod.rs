//! Exact rigid folding in terms of fold angles: closure of the faces around every vertex, the embedding computed from
//! the angles, its screw lattice, and the linear folding modes.
//!
//! This module does not use bars or energies, so that it is an independent check of the results of the energies.

pub(crate) mod closing;
pub(crate) mod closure;
pub(crate) mod displacement;
pub(crate) mod embedding;
pub(crate) mod error;
pub mod folding_modes;
pub mod metric;
pub(crate) mod motion;
pub(crate) mod rays;
pub(crate) mod screw;
pub(crate) mod second_order;
pub(crate) mod shape;
#[cfg(test)]
mod test_sheets;
pub mod tube;
mod walk;

pub(crate) use closing::SpatiallyPeriodic;
pub use closing::{AngleConditions, Closing};
pub use closure::Closure;
pub use closure::drawn_fold_angles;
pub use displacement::Displacement;
pub use embedding::{Embedding, Placement};
pub use error::KinematicsError;
pub use folding_modes::{FoldingModes, folding_modes, folding_modes_with_locked};
pub use motion::{Motion, Moving, Twist};
pub use rays::{Ray, Rays, RealDirections};
pub use screw::Screw;
pub use second_order::SecondOrder;
pub(crate) use second_order::signature;
pub use shape::Shape;
pub use tube::Tube;
