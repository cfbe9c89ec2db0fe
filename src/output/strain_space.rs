//! A surface, or a curve, of folded states in the space of lattice strains, to be drawn or written.

use super::error::ShapeError;
use crate::math::Vec3;

/// Folded states, and triangles between them, or segments of a curve. Arrays have one entry for each state.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StrainSurface {
    /// Lattice strains `(strain11, strain22, strain12)` of each state.
    pub points: Vec<Vec3>,
    /// Indices of the states at the corners of each triangle.
    pub triangles: Vec<[usize; 3]>,
    /// Indices of the states at the ends of each segment of a curve; none on a surface.
    pub segments: Vec<[usize; 2]>,
    /// Signed curvature, positive if the axis is on the side of the face normals.
    pub curvature: Vec<f64>,
    /// Rotation angles from a cell to the next along the two lattice vectors, in radians.
    pub theta: Vec<[f64; 2]>,
    /// Column name of every edge of the cell, and its fold angles in radians.
    pub folds: Vec<(String, Vec<f64>)>,
    /// Total energy; `None` for a surface without energies.
    pub energy: Option<Vec<f64>>,
    /// 1 for states with faces that pass through each other, 0 for the others; `None` if this was not tested.
    pub self_intersecting: Option<Vec<u8>>,
}

impl StrainSurface {
    /// Checks that the arrays are consistent.
    pub(crate) fn check(&self) -> Result<(), ShapeError> {
        let expected = self.points.len();
        let folds = self.folds.iter().map(|(_, angles)| ("fold", angles.len()));
        let lengths = [("curvature", self.curvature.len()), ("theta", self.theta.len())].into_iter().chain(folds);
        let energy = self.energy.iter().map(|energy| ("energy", energy.len()));
        let marks = self.self_intersecting.iter().map(|marks| ("self_intersecting", marks.len()));
        let arrays = lengths.chain(energy).chain(marks).map(|(array, found)| (array, found, expected));
        ShapeError::check(arrays, self.triangles.iter().flatten().chain(self.segments.iter().flatten()), expected)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::test_samples as samples;

    /// Claim: a consistent surface is accepted; an array that is too short, and an index of no state, are named in the
    /// error.
    #[test]
    fn arrays_have_to_fit() {
        let surface = samples::cap(3);
        assert_eq!(surface.check(), Ok(()));
        let mut short = surface.clone();
        short.theta.pop();
        assert_eq!(short.check(), Err(ShapeError::Length { array: "theta", found: 8, expected: 9 }));
        let mut beyond = surface;
        beyond.triangles[0][1] = 9;
        assert_eq!(beyond.check(), Err(ShapeError::NoSuchPoint { point: 9, count: 9 }));
    }
}
