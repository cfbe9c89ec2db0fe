//! The mechanical model of a sheet: bars and hinges as energies, the boundary conditions, and the equations that the
//! solver minimises.
//!
//! An [`Assembly`] is the starting point: a sheet with its boundary conditions, stiffnesses, rest angles, locks, pins
//! and loads. Below it, the energy of an element is a [`Law`] applied to a [`Measure`], a scalar function of a few
//! points (the length of a bar, the fold angle of a hinge); the usual law is that of a spring. A term is a list of
//! elements with the same measure and law; [`OwnTerm`] is one of a user's own. A [`Domain`] computes the points of an
//! element from the coordinates of a state and applies the chain rule through that map. What never changes, measures
//! and topology, is shared by the clones of a [`Model`]; springs, loads and the angles from which others continue are
//! its own. It is the [`crate::solver::Problem`] that the solver minimises.
//!
//! ```
//! use foldwell::{Assembly, Pattern, RIGID, generate};
//!
//! let sheet = generate(&Pattern::named("miura")?)?;
//! let assembly = Assembly::patch(sheet, [2, 2]).bars(RIGID).creases(1.0).build()?;
//! // every list with one value for each edge has this length; boundary edges have no hinge and the angle NaN
//! assert_eq!(assembly.drawn_angles().len(), assembly.edges());
//! assert!(assembly.drawn_angles().iter().any(|angle| angle.is_nan()));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod assemble;
mod assembly;
mod assembly_error;
mod axis;
mod balance;
mod boundary;
mod builder;
mod configuration;
mod constitutive;
mod curve;
pub(crate) mod domain;
mod drive;
mod element;
mod enclosed;
mod formula;
pub(crate) mod gauge;
pub mod intrinsic;
mod law;
mod mass;
mod material;
pub mod measure;
mod membrane;
mod own_term;
mod plasticity;
mod pressure;
mod problem;
mod published_laws;
mod roll;
mod stiffness;
mod terms;
mod torque;
mod tube;

#[cfg(test)]
mod tests;

pub use crate::math::expression::ExpressionError;
pub use assembly::Assembly;
pub use assembly_error::AssemblyError;
pub use boundary::{Boundary, Drawn};
pub use builder::{Builder, Rest};
pub use configuration::Configuration;
pub use curve::{Bilinear, CurveError, ForceCurve, Measured, OfAngle, OfStrain, Power};
pub(crate) use domain::ScrewTurns;
pub use domain::{Affine, CellMap, CellMaps, Domain, OwnDomain, Site};
pub use drive::{Drive, DriveError, Driven};
pub(crate) use element::Local;
pub use element::{Element, TermKind};
pub use formula::{Formula, FormulaError};
pub use law::{Law, Laws, Memory, Spring, TermLaw};
pub use mass::Mass;
pub use material::Material;
pub use measure::{FoldAngle, Length, Measure};
pub use own_term::OwnTerm;
pub use plasticity::ElasticPlastic;
pub use problem::driving::DrivenModel;
pub use problem::{Gauge, Model};
pub use published_laws::{GreenLagrange, Ogden, Stiffening};
pub use roll::{Roll, RollError};
pub use stiffness::Stiffness;
pub use terms::{Bars, Hinges, Part, RIGID, RestLengths, Terms};
