//! Minimisation of a soft energy under stiff measures, for any stiffness up to exactly rigid. Knows no origami.

pub mod atlas;
pub mod continuation;
pub mod corrections;
pub mod implicit;
pub mod kkt;
mod layout;
mod linearization;
mod newton;
mod problem;
mod self_stress;
mod stationary;
mod tangent;
pub mod tension;

pub use implicit::Implicit;
pub use layout::Layout;
pub use linearization::{HessianKind, Linearization, SoftElement};
pub use newton::{Equilibrium, Failure, NewtonError, Options, Start, Step, minimize};
pub use problem::{Problem, Residuals};
pub use stationary::{StationaryPoint, stationary_point};
pub use tangent::Tangent;
