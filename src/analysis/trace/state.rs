//! A state on a trajectory, and the conditions that end one.

use crate::analysis::tube::SeamPlace;
use crate::kinematics::Shape;
use crate::math::Vec3;

/// Conditions that end a trajectory: the first that is met.
#[derive(Clone, Copy, Debug, Default)]
pub struct Stop {
    /// Arc length.
    pub arc_length: Option<f64>,
    /// Magnitude of the curvature.
    pub curvature: Option<f64>,
    /// An edge and its fold angle.
    pub crease_angle: Option<(usize, f64)>,
    /// Faces passing through each other.
    pub self_intersection: bool,
}

/// Says whether faces of a state pass through each other.
pub(crate) type Intersects<'a> = &'a mut dyn FnMut(&Folded) -> bool;

/// A state on a trajectory.
#[derive(Clone, Debug, Default)]
pub struct Folded {
    /// Arc length from the start.
    pub arc_length: f64,
    /// Fold angles of all edges, continuous along the trajectory.
    pub angles: Vec<f64>,
    /// Rates of the fold angles per arc length.
    pub rates: Vec<f64>,
    /// The cylinder; `None` for a finite sheet.
    pub shape: Option<Shape>,
    /// The seam of a tube; `None` for other sheets.
    pub seam: Option<SeamPlace>,
    /// Vertices of the cell, vertex 0 and the first face at it as drawn.
    pub positions: Vec<Vec3>,
    /// Largest component of the closure residual.
    pub residual: f64,
}
