//! Bars and hinges as energies: measures, laws, terms and the domains in which their points stand.
//!
//! An energy is a *measure* (a scalar of some points: the length of a bar, the fold angle of a hinge) and a *law*
//! (what a value of that scalar costs). A [`Term`](element::Term) is a list of elements with one measure. A
//! [`Domain`] says where the points of an element come from; its chain rule stands in one place. The
//! [`Model`] puts terms on a domain and is the [`crate::solver::Problem`] that the solver minimises.

mod assemble;
mod assembly;
mod assembly_error;
mod axis;
mod boundary;
mod builder;
pub(crate) mod domain;
mod element;
pub(crate) mod gauge;
pub mod measure;
mod problem;
mod terms;

#[cfg(test)]
mod tests;

pub use assembly::Assembly;
pub use assembly_error::AssemblyError;
pub use boundary::{Boundary, Drawn};
pub use builder::{Builder, Rest};
pub(crate) use domain::Turns;
pub use domain::{Domain, Site};
pub use element::{Elements, Spring, TermKind};
pub use problem::{Gauge, Model};
pub use terms::{Hinges, RIGID, Terms};
