//! Linear algebra, sparse and dense, solutions of polynomial systems, and loops over many elements. The only crate
//! of foldwell that names `faer`, and the only one that decomposes matrices by nalgebra.
//!
//! A symmetric sparse matrix `S = sum_k B_k` is a sum of small dense blocks, one a clique of unknowns. It is factored
//! as `P S P^T = L D L^T`, and the signs of `D` are those of its eigenvalues (Sylvester's law of inertia).
//!
//! | file | what it is for |
//! |---|---|
//! | [`vector`] | norms, products and maxima of plain vectors |
//! | [`sparse`] | cliques, patterns, slots of blocks, rows |
//! | [`factor`], [`order`], [`tearing`] | `L D L^T` with inertia, orders, smaller factors by open cliques |
//! | [`fronts`] | the sparse `L D L^T`, on several threads |
//! | [`rank`], [`eigen`] | ranks by counting signs; a few extreme eigenpairs |
//! | [`root`] | roots by Newton's method with shortest steps |
//! | [`dense`], [`complex`] | decompositions of dense matrices, real and complex |
//! | [`polynomial`], [`homotopy`] | roots; all solutions of quadrics |
//! | [`parallel`], [`random`] | loops over the caller's threads; random numbers |
//! | [`derivatives`] | the check of hand-written derivatives |
//!
//! # Example
//!
//! A chain of two springs of stiffness 1 and 2 between three points, the first of them held, with a force of 3 on the
//! last:
//!
//! ```
//! use foldwell_numerics::factor::{Factor, FactorError};
//! use foldwell_numerics::sparse::{Cliques, FIXED, SparsityPattern, RankOne, Slots};
//!
//! # fn main() -> Result<(), FactorError> {
//! let mut springs = Cliques::new();
//! springs.push([FIXED, 0]);
//! springs.push([0, 1]);
//! let pattern = SparsityPattern::new(2, &[&springs]);
//! let slots = Slots::new(&pattern, &springs);
//! let mut values = vec![0.0; pattern.entries()];
//! for (spring, weight) in [1.0, 2.0].into_iter().enumerate() {
//!     slots.add_outer(spring, RankOne { weight, gradient: &[-1.0, 1.0] }, &mut values);
//! }
//! let blocks = [0, 1];
//! let mut factor = Factor::new(&pattern, &blocks, &[&springs])?;
//! assert_eq!(factor.factor(&pattern, &values)?.negative, 0);
//! let mut x = vec![0.0, 3.0];
//! factor.solve(&mut x);
//! assert!((x[0] - 3.0).abs() < 1e-14 && (x[1] - 4.5).abs() < 1e-14);
//! # Ok(())
//! # }
//! ```

#![cfg_attr(test, allow(clippy::unwrap_used))]
// pages of public modules link to private items too, which `cargo doc --document-private-items` shows
#![allow(rustdoc::private_intra_doc_links)]

pub mod complex;
pub mod dense;
pub mod derivatives;
pub mod eigen;
pub mod factor;
mod factor_error;
pub(crate) mod fronts;
pub mod homotopy;
pub mod order;
pub mod parallel;
pub mod polynomial;
pub mod random;
pub mod rank;
pub mod root;
pub mod sparse;
pub mod tearing;
pub mod vector;

#[cfg(test)]
mod tests;

pub use vector::{larger, worst};

/// A dense real matrix, as it is passed between modules.
pub type DenseMatrix = nalgebra::DMatrix<f64>;

/// Is told how far a computation has come, as a count, and returns false to stop it.
pub type GoOn<'a> = &'a mut dyn FnMut(usize) -> bool;
