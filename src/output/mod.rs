//! What the user gets: tables, files for ParaView, pictures and the summary of a run.
//!
//! Every writer goes through [`files`]: a file appears whole or not at all.

pub mod artifact;
pub mod error;
pub mod fault;
pub mod figure;
pub mod files;
pub mod picture;
pub mod schema;
pub mod strain_space;
pub mod summary;
pub mod table;
pub mod vtk;

pub use error::OutputError;
pub use picture::Picture;
pub use strain_space::StrainSurface;
