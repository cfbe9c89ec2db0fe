//! Meshes, crease patterns and their files.

mod assignments;
mod bad_meshes;
mod careless_drawings;
mod corpus;
mod dialects;
mod flattening;
mod frames;
mod mesh_files;
mod plain_drawings;
pub(crate) mod random_patterns;
mod symmetry_types;
pub(crate) mod targets;
mod thin;
