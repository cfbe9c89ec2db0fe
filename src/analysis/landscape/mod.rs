//! Energy landscapes near the rigid limit: what a folding mode of a periodic sheet costs on a patch.
//!
//! The rest angles of a patch of `n1 x n2` cells are the same in every cell and are themselves unknowns, but for their
//! components along the linear folding modes, which are held at an amplitude times a mode. What is left is the cost of
//! not being a rigid folding. It goes as the fourth power of the amplitude for modes with Gaussian curvature, and its
//! coefficient knows the mode only through that. `samples` relaxes patches, `expansion` needs linear solves alone.

pub mod cone;
mod error;
pub(crate) mod expansion;
pub mod fit;
mod held;
mod patch;
pub mod samples;
mod settling;
pub mod sphere;
mod taylor_path;
mod taylor_paths;
mod torus;

pub use error::LandscapeError;
pub use expansion::Expansion;
pub use held::HeldSheet;
pub use samples::{Sample, Samples};
pub use taylor_path::{HeldState, TaylorPath};
pub use taylor_paths::TaylorPaths;
