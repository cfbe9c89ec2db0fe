//! Output: tables, files for ParaView and for viewers, and drawings.
//!
//! All files are written through [`files`], so that a file appears complete or not at all.

pub mod artifact;
pub(crate) mod claim;
mod counted;
pub(crate) mod error;
pub mod figure;
pub mod files;
pub(crate) mod film;
pub(crate) mod glb;
pub(crate) mod html;
pub mod json;
pub mod net;
pub(crate) mod paraview;
pub mod picture;
pub(crate) mod sequence;
pub(crate) mod strain_space;
pub mod table;
#[cfg(test)]
mod test_samples;
pub mod vtk;

pub use artifact::Artifact;
pub use counted::counted;
pub use error::OutputError;
pub use picture::Picture;
pub use strain_space::StrainSurface;
pub use table::{Column, Table};
