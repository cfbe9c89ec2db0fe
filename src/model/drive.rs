//! Drives: the one quantity of an assembly that a path of equilibria changes.

use super::element::TermKind;
use crate::math::Vec3;
use thiserror::Error;

/// The quantity that a drive changes.
#[derive(Clone, Debug, PartialEq)]
pub enum Driven {
    /// The displacement of a rigid part along an axis (0, 1, 2 for x, y, z), or its rotation about one (3, 4, 5), in
    /// radians, counted from where the path begins.
    Part {
        /// Number of the part in [`super::Terms::parts`].
        part: usize,
        /// The axis.
        axis: usize,
    },
    /// The displacement of vertices along a direction, counted from where the path begins; across it they are free.
    Vertices {
        /// Numbers of the tiling's vertices.
        vertices: Vec<usize>,
        /// The direction, a unit vector.
        direction: Vec3,
    },
    /// A factor of all loads.
    Loads,
    /// The fold angle of these locked edges of the tiling, in radians.
    Lock(Vec<usize>),
    /// The rest values of all elements: 0 where they are those of the state in which the path begins, 1 as given.
    Rest,
    /// The stiffness of all elements of a kind, in the unit of the scene; it may end at infinity.
    Stiffness(TermKind),
}

/// A driven quantity and its value at the end of the path.
#[derive(Clone, Debug, PartialEq)]
pub struct Drive {
    /// The quantity.
    pub quantity: Driven,
    /// Its value at the end.
    pub to: f64,
}

/// The reason for which a drive does nothing to a model.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
pub enum DriveError {
    /// There are no loads.
    #[error("there are no loads to drive")]
    NoLoads,
    /// Nothing holds the sheet against rotations, which the loads would have to do.
    #[error("the loads can turn the sheet as a whole: hold it against rotations with pins, or drive a displacement")]
    FreeRotation,
    /// The edge is not locked.
    #[error("the crease is not locked")]
    NotLocked,
    /// The model has no elements of this kind.
    #[error("there are no {}", .0.name())]
    NoTerm(TermKind),
    /// The elements of this kind have different stiffnesses.
    #[error("the {} do not all have the same stiffness", .0.name())]
    NotUniform(TermKind),
    /// The elements of this kind have a law and tensions.
    #[error("the stiffness of the {} cannot be driven: they have a law", .0.name())]
    HasLaw(TermKind),
    /// Soft hinges cannot be driven to infinite stiffness.
    #[error("the {} cannot be driven to infinite stiffness: only bars can", .0.name())]
    TooStiff(TermKind),
    /// The rest values are those of the drawn state.
    #[error("the creases rest as they are drawn, so that nothing folds")]
    RestAsDrawn,
    /// The driven value is at its end already.
    #[error("the driven value is {at} at the beginning already")]
    NoWay {
        /// The parameter there.
        at: f64,
    },
}
