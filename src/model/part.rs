//! Rigid parts: vertices of a patch that move as one body.

/// Vertices of a patch that move as one rigid body, and the motions that the body keeps.
///
/// The body turns about the centroid of its vertices in the drawn state. Its rotation is described by the rotation
/// vector from the drawn state, of which components that are not free stay zero.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// Numbers of the tiling's vertices that belong to the part.
    pub vertices: Vec<usize>,
    /// Whether the part can move along x, y, z and turn about x, y, z.
    pub free: [bool; 6],
}
