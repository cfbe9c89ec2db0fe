//! Energy wells of folding sheets.
//!
//! A triangulated origami sheet is a network of bars (its edges) and hinges (its creases). `foldwell` relaxes such a
//! network with a Newton method that treats every stiffness alike, the exactly rigid sheet included, and compares
//! what it finds with the theory of rigid folding. The modules stand on floors; each imports only from lower ones:
//!
//! | floor | modules | what stands there |
//! |---|---|---|
//! | 6 | [`validation`] | claims about the program, checked by the program |
//! | 5 | [`run`] | the pipeline: read a scene, build it, study it, write files |
//! | 4 | [`scene`], [`output`] | what the user writes, what the user gets |
//! | 3 | [`analysis`] | questions about states: equilibria, modes, spectra |
//! | 2 | [`model`], [`kinematics`] | energies of bars and hinges; exact folding by closure of vertices |
//! | 1 | [`sheet`], [`solver`] | cells, lattices and files of sheets; a Newton method that knows no origami |
//! | 0 | [`math`], [`numerics`] | rotations and the sinc family; sparse matrices and factorizations |
#![cfg_attr(test, allow(clippy::unwrap_used))]

pub mod analysis;
pub mod kinematics;
pub mod math;
pub mod model;
pub mod numerics;
pub mod output;
pub mod run;
pub mod scene;
pub mod sheet;
pub mod solver;
pub mod validation;

pub use analysis::relax::{RelaxError, Relaxed};
pub use model::{Assembly, AssemblyError, Boundary, Gauge, Model, RIGID, Rest, Terms};
pub use sheet::{Pattern, Sheet, generate};
