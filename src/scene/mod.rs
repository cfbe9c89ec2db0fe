//! Scene files, which the user writes: their types, their checks and the tables that they name.
//!
//! A scene is written in TOML. [`read`] returns a [`SceneFile`]: typed values ([`spec`]), each with its place in the
//! text, so that code that detects an error later can point at that place with [`SceneFile::error_at`].

pub mod build;
mod checks;
mod digest;
pub(crate) mod drives;
mod elements;
pub(crate) mod error;
mod file;
pub(crate) mod forms;
mod laws;
mod loads;
mod located;
pub(crate) mod material;
mod memory;
pub(crate) mod notes;
pub(crate) mod outputs;
mod parse;
pub(crate) mod places;
pub(crate) mod rest;
mod rolled;
pub(crate) mod rows;
mod schema;
mod setting;
pub(crate) mod spec;
pub(crate) mod stiffness;
mod sweep;
mod ties;
mod turns;
pub(crate) mod values;

pub(crate) use digest::{Fingerprint, digest, named_files};
pub use error::SceneError;
pub use file::{Arrays, SceneFile};
pub use located::Located;
pub use parse::{parse, parse_set, read, read_set};
pub use schema::schema;
pub use setting::{Setting, SettingError, apply};
pub use sweep::{Point, Sweep};
