//! What can be wrong with a question about exact folding.

use crate::numerics::dense::DenseError;
use crate::numerics::homotopy::HomotopyError;

/// Why there is no answer.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum KinematicsError {
    /// The faces at a vertex do not form one round.
    #[error("the faces around vertex {vertex} do not form one closed round")]
    BrokenRound {
        /// Number of the vertex.
        vertex: usize,
    },
    /// A finite sheet was asked for something that only a periodic one has.
    #[error("a finite sheet has neither curvature nor lattice motions nor linear folding modes: they need a lattice")]
    NoLattice,
    /// The sheet has openings, whose rims the closure of the vertices does not see.
    #[error("the sheet has {loops} opening(s): closing its vertices does not close their rims")]
    Openings {
        /// Number of independent loops that no vertex closes.
        loops: usize,
    },
    /// The faces do not hang together, or not in both directions of the lattice, or a vertex has none.
    #[error(
        "the {faces} faces do not hang together with all vertices, and in both directions where there is a lattice"
    )]
    Disconnected {
        /// Number of triangles, of a cell where there is a lattice.
        faces: usize,
    },
    /// Different ways over the faces of the cell end in different rotations.
    #[error("a folding mode does not close over the cell: two ways over the faces differ by {difference:.2e}")]
    WaysDisagree {
        /// Largest difference of angular velocities, for a mode of norm 1.
        difference: f64,
    },
    /// A mode was named by its curvatures, but the sheet has not just three modes.
    #[error(
        "curvatures name a mode only where there are 3 linear folding modes; this sheet has {modes} (a flat sheet has \
         one more for each vertex, rigid polygons take some away)"
    )]
    NotThreeModes {
        /// Number of linear folding modes.
        modes: usize,
    },
    /// A mode was named by its curvatures, but the three modes do not make all curvatures.
    #[error(
        "curvatures do not name a mode of this sheet: modes and curvature tensors are not one to one (condition number \
         {condition:.1e})"
    )]
    SingularCurvatures {
        /// Condition number of the map from modes to curvature tensors.
        condition: f64,
    },
    /// A decomposition failed, or no rank stands out.
    #[error("closure of the vertices: {0}")]
    Decomposition(#[from] DenseError),
    /// The obstruction quadrics could not be solved.
    #[error("second order: {0}")]
    Quadrics(#[from] HomotopyError),
    /// The state does not close, so there are no directions to leave it.
    #[error("the faces do not close at this state: residual {residual:.2e}")]
    NotClosed {
        /// Largest entry of the closure residual.
        residual: f64,
    },
    /// A tube was asked for along no cells.
    #[error("a tube needs a seam other than [0, 0]")]
    NoSeam,
    /// The sheet does not roll up to a tube.
    #[error("no tube along {seam:?}: rolled up as far as it goes, its seam turns by {turn:.3} rad, less than 2 pi")]
    NoTube {
        /// The cell that should come to lie on cell (0, 0).
        seam: [i32; 2],
        /// Largest turn of the seam that was met.
        turn: f64,
    },
    /// A tube with a slipping seam has not just one motion.
    #[error("a tube whose seam slips has one motion, this one has {motions}")]
    NotOneMotion {
        /// Number of linear motions.
        motions: usize,
    },
}
