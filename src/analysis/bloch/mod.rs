//! Spatially varying modes of periodic sheets: displacements that are multiplied by `z1` and `z2` from a cell to the
//! next.
//!
//! `z = exp(i q)` with wavenumbers `q` in radians per cell, which may be complex. The bars keep their lengths where the
//! rigidity matrix `R(z1, z2)` is singular (McInerney, Chen, Theran, Santangelo, Rocklin, PNAS 117, 30252 (2020), last
//! section and appendix J; C. L. Kane, T. C. Lubensky, Nature Physics 10, 39 (2014)).

pub mod bands;
pub mod cluster;
pub mod decay;
pub mod determinant;
pub mod double_double;
mod error;
mod exact_pairing;
pub mod extrema;
pub mod laurent;
pub mod mode_shape;
pub mod polarization;
pub mod rigidity;
mod root;
pub mod singular;
mod survey;
pub mod zero_lines;
pub mod zone;

pub use decay::Decay;
pub use determinant::Determinant;
pub use error::BlochError;
pub use laurent::Laurent;
pub use mode_shape::ModeShape;
pub use polarization::Polarization;
pub use rigidity::Rigidity;
pub use root::Root;
pub use survey::{STEPS, Survey, SurveyOptions, survey};
pub use zero_lines::ZeroLines;
pub use zone::Zone;
