//! The coordinates of the model in which an exactly folded state stands.
//!
//! Of a screw-periodic state (see [`crate::model::domain`]): x along the axis, z from vertex 0 to the axis where the
//! curvature is positive and away from it where it is negative, vertex 0 at the origin; then the direction 0, the
//! curvature, and the lattice across and along the axis.

use super::trace::Folded;
use super::tube;
use crate::kinematics::Shape;
use crate::math::Vec3;
use crate::model::Domain;

/// Below this rotation angle `b` comes from the chord, above it from the angle; both are exact there.
const SMALL_TURN: f64 = 1.0;

/// Coordinates of all vertices, and of the screw where the state has a lattice.
pub fn coordinates(state: &Folded) -> Vec<f64> {
    match &state.shape {
        Some(shape) => screw_coordinates(shape),
        None => state.positions.iter().flat_map(|p| [p.x, p.y, p.z]).collect(),
    }
}

/// Coordinates of a state in this domain: those of a tube are about its axis.
pub(crate) fn coordinates_in(domain: &Domain, state: &Folded) -> Vec<f64> {
    match (domain, &state.shape) {
        (Domain::Tube { seam, kept, .. }, Some(shape)) => {
            let axis = state.seam.map_or_else(Vec3::zeros, |place| place.axis);
            tube::coordinates(shape, &axis, seam, *kept)
        }
        _ => coordinates(state),
    }
}

/// Coordinates of the vertices and of the screw of a screw-periodic state.
pub(crate) fn screw_coordinates(shape: &Shape) -> Vec<f64> {
    let (chords, towards) = (shape.screw.chords, shape.screw.towards_axis());
    // below, the direction of the axis is off by more than what leaving out the turn costs
    let turns = shape.turns();
    let curvature = if turns { shape.curvature } else { 0.0 };
    let (x, z) = match shape.screw.axis.filter(|_| turns && towards.norm() > 0.0) {
        Some(axis) => (axis, (towards * curvature.signum()).normalize()),
        None => (chords[0].normalize(), chords[0].cross(&chords[1]).normalize()),
    };
    let y = z.cross(&x);
    let origin = shape.positions[0];
    let mut coordinates: Vec<f64> =
        shape.positions.iter().flat_map(|p| [x, y, z].map(|axis: Vec3| axis.dot(&(p - origin)))).collect();
    let step = |k: usize| {
        let theta = shape.theta[k];
        let sinc = if theta == 0.0 { 1.0 } else { theta.sin() / theta };
        if theta.abs() < SMALL_TURN { chords[k].dot(&y) / sinc } else { theta / curvature }
    };
    coordinates.extend([0.0, curvature]);
    coordinates.extend([step(0), step(1), chords[0].dot(&x), chords[1].dot(&x)]);
    coordinates
}
