//! The shared coordinates of a domain, and the screw motions that those of a screw describe.

use crate::math::Vec3;
use nalgebra::{Complex, SMatrix};

/// Largest number of shared coordinates of a domain.
pub(crate) const MOST_SHARED: usize = 6;

pub(super) type SharedMatrix = SMatrix<f64, 3, MOST_SHARED>;

/// Storage for the Hessian of an element of up to four points; only the lower triangle of its leading block is used.
pub(super) type Pulled = SMatrix<f64, { 12 + MOST_SHARED }, { 12 + MOST_SHARED }>;

/// The two screw motions of a state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ScrewTurns {
    /// Direction of the axis: its angle from x, in radians.
    pub direction: f64,
    /// Curvature: the inverse of the height of the axis above z = 0.
    pub kappa: f64,
    /// Angles in radians by which the screw motions of the two lattice vectors rotate about the axis.
    pub theta: [f64; 2],
}

impl ScrewTurns {
    /// Computes the screw motions from the shared coordinates of a screw.
    pub(crate) fn new(shared: &[f64]) -> Self {
        let (direction, kappa) = (shared[0], shared[1]);
        Self { direction, kappa, theta: seen_along(shared).map(|l| kappa * l.im) }
    }

    /// Returns the unit vector along the axis.
    pub(crate) fn axis(&self) -> Vec3 {
        Vec3::new(self.direction.cos(), self.direction.sin(), 0.0)
    }
}

/// Returns the parts of the lattice vectors in the plane as complex numbers: real along the axis, imaginary across
/// it.
pub(super) fn seen_along(shared: &[f64]) -> [Complex<f64>; 2] {
    let back = Complex::new(shared[0].cos(), -shared[0].sin());
    [2, 3].map(|k| back * Complex::new(shared[k + 2], shared[k]))
}
