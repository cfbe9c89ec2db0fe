//! Bars and hinges as energies: measures, laws, terms and the domains in which their points stand.
//!
//! An energy is a *measure* (a scalar of some points: the length of a bar, the fold angle of a hinge) and a *law*
//! (what a value of that scalar costs). A [`term::Term`] is a list of elements with one measure. A
//! [`domain::Domain`] says where the points of an element come from; its chain rule stands in one place. The
//! [`Model`] puts terms on a domain and is the [`crate::solver::Problem`] that the solver minimises.

pub mod assemble;
pub mod domain;
pub mod gauge;
pub mod measure;
pub mod problem;
pub mod term;

#[cfg(test)]
mod tests;

pub use domain::{Domain, Site, Turns};
pub use problem::{Gauge, Model};
pub use term::{Element, Elements, Spring, Term, TermKind};
