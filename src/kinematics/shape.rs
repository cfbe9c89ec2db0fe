//! The shape of a periodic sheet at some fold angles: positions, screw, signed curvature, strain.
//!
//! The vector `k` from vertex 0 towards the axis (see [`Screw`]) has the length of the curvature. Its sign is positive
//! where the axis lies on the side of the face normals, counted over all faces of the cell: it is the sign of
//!
//! `sum over faces of area_f . (k - |k|^2 x_f)`, with area times normal `area_f` and the centroid `x_f` across the axis.
//!
//! Over `|k|^2` this is the flow of the field towards the axis through the faces, twice the volume between a cell and the
//! axis; it does not depend on which copies of the faces make the cell, nor on how often one goes round the axis. Near a
//! spatially periodic state it is `k` times the whole area of the cell, so that the curvature goes through zero smoothly.

use super::KinematicsError;
use super::embedding::{Compatibility, Embedding, Placement};
use super::metric::LatticeFrame;
use super::motion::{Motion, Moving};
use super::screw::{Screw, ScrewRate};
use crate::math::Vec3;

/// A periodic sheet at some fold angles, in the frame of the [embedding](super::embedding).
#[derive(Clone, Debug)]
pub struct Shape {
    /// The vertices of cell (0, 0).
    pub positions: Vec<Vec3>,
    /// The lattice motions.
    pub motions: [Motion; 2],
    /// Axis, angles and chords; where any cell is.
    pub screw: Screw,
    /// Rotation angles from a cell to the next about the common axis, directed so that the larger is positive.
    pub theta: [f64; 2],
    /// Signed curvature of the cylinder of vertex 0: one over its distance from the axis, positive when the axis lies on
    /// the side of the face normals. Not a number where vertex 0 is on the axis.
    pub curvature: f64,
    /// `[strain11, strain22, strain12]` of the chords from vertex 0 against the drawn lattice.
    pub strain: [f64; 3],
    /// The axis in the plane of the drawn sheet: along the direction `n1 l1 + n2 l2` with `n1 theta1 + n2 theta2 = 0`,
    /// which stays straight. Its angle to the first lattice vector in radians, as a line, in `(-pi/2, pi/2]`; `None`
    /// where nothing turns.
    pub axis_angle: Option<f64>,
    /// How well the angles close.
    pub compatibility: Compatibility,
}

/// Rates of a shape that is a cylinder.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShapeRate {
    /// Of axis, angles and chords.
    pub screw: ScrewRate,
    /// Of the signed curvature.
    pub curvature: f64,
    /// Of the strain.
    pub strain: [f64; 3],
}

impl Shape {
    /// The shape at fold angles of every edge, in radians, valley positive.
    ///
    /// Angles that do not close have a shape too, which means little; [`compatibility`](Self::compatibility) tells.
    /// Fails for a finite sheet.
    /// # Panics
    /// Where `angles` has another length than the edges.
    pub fn at(embedding: &Embedding, angles: &[f64]) -> Result<Self, KinematicsError> {
        Self::of(embedding, embedding.place(angles))
    }

    /// The shape of a placement. Fails for a finite sheet.
    pub fn of(embedding: &Embedding, placement: Placement) -> Result<Self, KinematicsError> {
        let (Some(motions), Some(drawn)) = (placement.lattice, &embedding.lattice) else {
            return Err(KinematicsError::NoLattice);
        };
        let (screw, frame) = (Screw::new(&motions), LatticeFrame::new(drawn));
        let curvature = signed_curvature(embedding, &placement, &screw);
        let [theta1, theta2] = screw.theta;
        let axis_angle = screw.axis.map(|_| frame.line_angle([-theta2, theta1]));
        let strain = frame.strain(&screw.chords);
        let Placement { positions, compatibility, .. } = placement;
        Ok(Self { positions, motions, screw, theta: screw.theta, curvature, strain, axis_angle, compatibility })
    }

    /// Rates of the shape, from its lattice motions with their rates; `None` where nothing turns.
    pub fn rate(&self, embedding: &Embedding, lattice: &[Moving; 2]) -> Option<ShapeRate> {
        let screw = self.screw.rate(lattice)?;
        let frame = LatticeFrame::new(embedding.lattice.as_ref()?);
        let towards = self.screw.towards_axis();
        let curvature = towards.dot(&screw.towards_axis) / self.curvature;
        Some(ShapeRate { screw, curvature, strain: frame.strain_rate(&self.screw.chords, &screw.chords) })
    }
}

fn signed_curvature(embedding: &Embedding, placement: &Placement, screw: &Screw) -> f64 {
    let (towards, axis) = (screw.towards_axis(), screw.axis.unwrap_or_else(Vec3::zeros));
    let squared = towards.norm_squared();
    let flow = embedding.faces.iter().zip(&placement.walked.faces).map(|(face, motion)| {
        let (area, centroid) = (motion.rotation * face.area, motion.apply(&face.centroid));
        area.dot(&(towards - squared * (centroid - axis * axis.dot(&centroid))))
    });
    squared.sqrt().copysign(flow.sum())
}

#[cfg(test)]
mod tests {
    use super::super::test_sheets::*;
    use super::super::{Closure, Displacement};
    use super::*;
    use crate::numerics::DenseMatrix;
    use crate::numerics::dense::null_space;
    use crate::numerics::derivatives::{TOLERANCE, check_jacobian};
    use crate::sheet::Sheet;

    fn close(found: &[f64], expected: &[f64], tolerance: f64) -> bool {
        found.iter().zip(expected).all(|(a, b)| (a - b).abs() <= tolerance)
    }

    /// Claim: curvature, rotation angles and strain are those that an independent program found, in size, sign and order;
    /// the mirror image has the same strain and the opposite curvature. Tolerance 1e-9: the project's promise; that
    /// program's states close to 1e-12. Mirrored: rounding.
    #[test]
    fn stored_states_of_open_star() {
        let sheet = open_star();
        let embedding = Embedding::new(&sheet).unwrap();
        let states = open_star_reference().states(&sheet);
        assert_eq!(states.len(), 4);
        for (angles, kappa, theta, strain) in states {
            let shape = Shape::at(&embedding, &angles).unwrap();
            assert!((shape.curvature - kappa).abs() <= 1e-9, "{} for {kappa}", shape.curvature);
            assert!(close(&shape.theta, &theta, 1e-9) && close(&shape.strain, &strain, 1e-9), "{shape:?}");
            let mirrored: Vec<f64> = angles.iter().map(|angle| -angle).collect();
            let mirrored = Shape::at(&embedding, &mirrored).unwrap();
            assert!((mirrored.curvature + kappa).abs() <= 1e-9 && close(&mirrored.strain, &strain, 1e-9));
        }
    }
}
