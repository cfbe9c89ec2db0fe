//! Minimisation of a soft energy under stiff measures, for any stiffness up to exactly rigid; and solutions of
//! equations `F(x) = 0` along curves and over surfaces. Knows no origami.
//!
//! A [`Problem`] is a soft energy `E(x)` and stiff measures with gaps `m_r(x)` (the measure minus its rest value) and
//! compliances `c_r = 1/k_r >= 0`:
//!
//! minimise `E(x) + sum_r m_r(x)^2 / (2 c_r)`.
//!
//! A compliance of zero is the constraint `m_r(x) = 0`. The *tension* `t_r` of a measure is an unknown of its own, so
//! nothing is ever multiplied by a stiffness. With `R = dm/dx` a state is in equilibrium where
//!
//! `dE/dx + R^T t = 0` and `m = c t`.
//!
//! | file | what it is for |
//! |---|---|
//! | `problem` | the trait [`Problem`], and the [`Residuals`] of a state |
//! | `layout`, `linearization` | unknowns and couplings; energy, gradient, Hessian, gaps and Jacobian at one state |
//! | [`kkt`], [`corrections`] | the linear system of a Newton step, and its refinement by conjugate residuals |
//! | `tangent` | the same at one state: a Newton step, the inertia, the response to a force ([`Tangent`]) |
//! | `inertia` | the number of negative eigenvalues on what rigid measures leave free |
//! | `newton` | [`minimize`]: Newton's method with retraction onto the stiff measures |
//! | `stationary` | [`stationary_point`]: an equilibrium of any index near a state |
//! | [`path`] | equilibria along a parameter, through limit points and branch points |
//! | [`constrained`] | a separable quadratic function under local constraints |
//! | [`self_stress`], [`tension`] | tensions that balance each other, and tensions without them |
//! | [`implicit`] | Newton's method onto the solutions of `F(x) = 0` |
//! | [`continuation`], [`atlas`] | curves and surfaces of solutions |
//!
//! # Example
//!
//! A point on a rigid rod of length 1 about the origin, pulled towards `(2, 1)` by a soft spring of stiffness 1: the
//! equilibrium lies in the direction of `(2, 1)`, and the rod is pulled by `sqrt(5) - 1`.
//!
//! ```
//! use foldwell_numerics::sparse::Cliques;
//! use foldwell_solver::{HessianKind, Layout, Linearization, Options, Problem, SoftElement, minimize};
//! use std::sync::Arc;
//!
//! struct Rod {
//!     layout: Arc<Layout>,
//! }
//!
//! const TARGET: [f64; 2] = [2.0, 1.0];
//!
//! impl Problem for Rod {
//!     fn layout(&self) -> &Arc<Layout> {
//!         &self.layout
//!     }
//!     fn compliance(&self) -> &[f64] {
//!         &[0.0] // one stiff measure, exactly rigid
//!     }
//!     fn gap_scale(&self) -> &[f64] {
//!         &[1.0]
//!     }
//!     fn energy(&self, x: &[f64]) -> f64 {
//!         0.5 * ((x[0] - TARGET[0]).powi(2) + (x[1] - TARGET[1]).powi(2))
//!     }
//!     fn gaps(&self, x: &[f64]) -> Vec<f64> {
//!         vec![x[0].hypot(x[1]) - 1.0]
//!     }
//!     fn linearize(&self, x: &[f64], tension: &[f64], kind: HessianKind, out: &mut Linearization) {
//!         out.clear(kind);
//!         out.energy = self.energy(x);
//!         for k in 0..2 {
//!             // one soft element a coordinate: its measure is `x_k - target_k`, which has no curvature
//!             let force = x[k] - TARGET[k];
//!             out.largest_force = out.largest_force.max(force.abs());
//!             out.add_soft(k, &SoftElement { stiffness: 1.0, excess: 0.0, force, size: 1.0, gradient: &[1.0], hessian: &[] });
//!         }
//!         let length = x[0].hypot(x[1]);
//!         let [u, v] = [x[0] / length, x[1] / length];
//!         out.gaps[0] = length - 1.0;
//!         out.jacobian.copy_from_slice(&[u, v]);
//!         // second derivatives of the length: xx, xy, yy
//!         out.add_stiff(0, tension[0], &[v * v / length, -u * v / length, u * u / length]);
//!     }
//!     fn accept(&mut self, _x: &mut [f64]) {}
//! }
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let (mut soft, mut stiff) = (Cliques::new(), Cliques::new());
//! soft.push([0]);
//! soft.push([1]);
//! stiff.push([0, 1]);
//! // both unknowns belong to one block
//! let mut rod = Rod { layout: Layout::new(vec![0, 0], soft, stiff) };
//! let found = minimize(&mut rod, vec![0.0, -1.0], Options::default(), &mut |_| true)?;
//! let length = f64::sqrt(5.0);
//! assert!((found.x[0] - 2.0 / length).abs() < 1e-12 && (found.x[1] - 1.0 / length).abs() < 1e-12);
//! assert!((found.tension[0] - (length - 1.0)).abs() < 1e-12);
//! assert_eq!(found.negative_eigenvalues, Some(0));
//! # Ok(())
//! # }
//! ```

#![cfg_attr(test, allow(clippy::unwrap_used))]
// pages of public modules link to private items too, which `cargo doc --document-private-items` shows
#![allow(rustdoc::private_intra_doc_links)]

pub mod atlas;
pub mod constrained;
pub mod continuation;
pub mod corrections;
pub(crate) mod implicit;
pub mod inertia;
pub mod kkt;
mod layout;
mod linearization;
mod newton;
pub mod path;
mod problem;
pub mod self_stress;
mod stationary;
mod tangent;
pub mod tension;

pub use implicit::Implicit;
pub use layout::Layout;
pub use linearization::{HessianKind, Linearization, SoftElement};
pub use newton::{Equilibrium, Failure, Iterate, NewtonError, Options, Start, Step, minimize, minimize_iterates};
pub use problem::{Collapse, Problem, Residuals};
pub use stationary::{StationaryPoint, stationary_point};
pub use tangent::Tangent;

/// Sees every accepted step of an iteration, and returns false to stop it.
pub type Observe<'a> = &'a mut dyn FnMut(&Step) -> bool;
