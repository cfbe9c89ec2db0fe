//! Minimisation of a soft energy under stiff measures, for any stiffness up to exactly rigid. Knows no origami.

pub mod atlas;
pub mod continuation;
pub mod corrections;
pub mod implicit;
pub mod newton;
pub mod problem;
pub mod saddle;
pub mod tension;

pub use implicit::Implicit;
pub use newton::{Equilibrium, Failure, NewtonError, Options, Start, Step, minimize};
pub use problem::{Curvature, Layout, Linearization, Problem};
