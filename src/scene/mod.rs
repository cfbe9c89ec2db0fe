//! What the user writes: scene files, their checks and the tables of angles they name.
//!
//! A scene is TOML. [`read`] gives a [`SceneFile`]: typed values ([`spec`]), each with its place in the text, so that
//! whoever finds a fault later can point at it with [`SceneFile::error_at`].

pub mod angles;
pub mod build;
mod checks;
mod digest;
pub mod error;
mod file;
pub mod forms;
mod located;
mod memory;
pub mod outputs;
mod parse;
mod schema;
pub mod spec;
mod turns;
pub mod values;

pub use digest::{Fingerprint, digest, named_files};
pub use error::SceneError;
pub use file::SceneFile;
pub use located::Located;
pub use parse::{parse, read};
pub use schema::schema;
