//! Spatially varying modes of periodic sheets: displacements that are multiplied by `z1` and `z2` from a cell to the
//! next.
//!
//! `z = exp(i q)` with wavenumbers `q` in radians per cell, which may be complex. The bars keep their lengths where the
//! rigidity matrix `R(z1, z2)` is singular (McInerney, Chen, Theran, Santangelo, Rocklin, PNAS 117, 30252 (2020), last
//! section and appendix J; C. L. Kane, T. C. Lubensky, Nature Physics 10, 39 (2014)).

pub mod bands;
pub(crate) mod cluster;
pub(crate) mod counts;
pub mod decay;
mod density;
pub(crate) mod determinant;
pub(crate) mod double_double;
mod error;
mod exact_pairing;
pub(crate) mod extrema;
pub(crate) mod laurent;
pub(crate) mod mode_shape;
pub(crate) mod polarization;
pub(crate) mod rigidity;
mod root;
pub(crate) mod singular;
pub mod strip;
mod survey;
mod touching;
pub mod zero_lines;
pub(crate) mod zone;

pub use counts::ZeroModeCounts;
pub use decay::Decay;
pub use density::Density;
pub use determinant::Determinant;
pub use error::BlochError;
pub use laurent::Laurent;
pub use mode_shape::ModeShape;
pub use polarization::Polarization;
pub use rigidity::Rigidity;
pub use root::Root;
pub use strip::Strip;
pub(crate) use survey::{STEPS, Survey};
pub use survey::{SurveyOptions, survey};
pub use zero_lines::ZeroLines;
pub use zone::Zone;
