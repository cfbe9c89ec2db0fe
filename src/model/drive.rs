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
    /// The pressure of this name; the volume of its faces is free.
    Pressure(String),
    /// The volume that the faces under the pressure of this name enclose, counted from where the path begins; their
    /// pressure is what it takes.
    Volume(String),
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
#[allow(missing_docs)] // each variant is documented by its message
pub enum DriveError {
    #[error("there are no loads to drive")]
    NoLoads,
    #[error("no pressure has this name")]
    NoPressure,
    #[error("the loads can turn the sheet as a whole: hold it against rotations with pins, or drive a displacement")]
    FreeRotation,
    #[error("the crease is not locked")]
    NotLocked,
    #[error("no motion of the sheet changes the angle of this crease")]
    NoMotion,
    #[error("the sheet stays straight while it is driven, and the axis of its cylinder has no direction: take a torus")]
    StaysStraight,
    #[error("there are no {}", .0.name())]
    NoTerm(TermKind),
    #[error("the {} do not all have the same stiffness", .0.name())]
    NotUniform(TermKind),
    #[error("the stiffness of the {} cannot be driven: they have a law", .0.name())]
    HasLaw(TermKind),
    #[error("the {} cannot be driven to infinite stiffness: only bars can", .0.name())]
    TooStiff(TermKind),
    #[error("the creases rest as they are drawn, so that nothing folds")]
    RestAsDrawn,
    #[error("the driven value is {at} at the beginning already")]
    NoWay { at: f64 },
}
