//! Symmetric sparse matrices and sparse rows, both made of cliques.
//!
//! A finite element couples all its unknowns with each other: they form a clique. A symmetric matrix is the sum of
//! small dense blocks, one a clique; its pattern and the place of every block entry (its slot) are found once, after
//! that blocks are added in place. [`Rows`] keeps one row a clique: the Jacobian of scalar measures.

mod cliques;
pub(crate) mod incidence;
mod pattern;
mod rows;
mod slots;

pub use cliques::{Cliques, FIXED};
pub use pattern::{SparsityPattern, symmetric_product};
pub use rows::Rows;
pub use slots::{ElementBlock, RankOne, Slots};
