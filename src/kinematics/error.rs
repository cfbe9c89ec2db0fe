//! The errors of exact folding.

use crate::numerics::dense::DenseError;
use crate::numerics::homotopy::HomotopyError;
use crate::sheet::Sheet;

/// The reasons for which a kinematic quantity cannot be computed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum KinematicsError {
    /// The faces at a vertex do not form one closed cycle.
    #[error("the faces around vertex {vertex} do not form one closed round")]
    BrokenRound {
        /// Number of the vertex.
        vertex: usize,
    },
    /// A property of periodic sheets is wanted for a finite sheet.
    #[error("a finite sheet has neither curvature nor lattice motions nor linear folding modes: they need a lattice")]
    NoLattice,
    /// The sheet is an assembly of several sheets, has bars alone, or has one side.
    #[error(
        "exact folding is of surfaces with two sides: here an edge has more than two faces or none, or the faces have one \
         side, as those of a Moebius band"
    )]
    NoSurface,
    /// Exact folding is wanted of several cells that screw motions repeat.
    #[error(
        "a cell that screw motions repeat is drawn rolled up: it folds as a tube, and several cells need lattice vectors"
    )]
    Rolled,
    /// A periodic sheet has openings; closure of the vertices does not imply closure around their rims.
    #[error(
        "the sheet has {loops} opening(s): closing its vertices does not close their rims, which is done for finite sheets only"
    )]
    Openings {
        /// Number of independent loops that are not closed by the closure of the vertices.
        loops: usize,
    },
    /// The faces are not connected, or not along both directions of the lattice, or a vertex has no face.
    #[error(
        "the {faces} faces do not hang together with all vertices, and in both directions where there is a lattice"
    )]
    Disconnected {
        /// Number of triangles; for a periodic sheet, of one cell.
        faces: usize,
    },
    /// Different paths over the faces of the cell lead to different rotations.
    #[error("a folding mode does not close over the cell: two ways over the faces differ by {difference:.2e}")]
    WaysDisagree {
        /// Largest difference of angular velocities, for a mode of norm 1.
        difference: f64,
    },
    /// A mode was named by its curvatures, but the number of modes is not three.
    #[error(
        "curvatures name a mode only where there are 3 linear folding modes; this sheet has {modes} (a flat sheet has \
         one more for each vertex, rigid polygons take some away)"
    )]
    NotThreeModes {
        /// Number of linear folding modes.
        modes: usize,
    },
    /// A mode was named by its curvatures, but the curvature tensors of the three modes are linearly dependent.
    #[error(
        "curvatures do not name a mode of this sheet: modes and curvature tensors are not one to one (condition number \
         {condition:.1e})"
    )]
    SingularCurvatures {
        /// Condition number of the map from modes to curvature tensors.
        condition: f64,
    },
    /// A decomposition failed, or the rank of a matrix is not clear.
    #[error("closure of the vertices: {0}")]
    Decomposition(#[from] DenseError),
    /// The obstruction quadrics could not be solved.
    #[error("{}", second_order(.0))]
    Quadrics(#[from] HomotopyError),
    /// The faces do not close at this state, so that directions of folding are not defined.
    #[error("the faces do not close at this state: residual {residual:.2e}")]
    NotClosed {
        /// Largest entry of the closure residual.
        residual: f64,
    },
    /// The seam of a tube is `[0, 0]`.
    #[error("a tube needs a seam other than [0, 0]")]
    NoSeam,
    /// The sheet cannot be rolled up to a tube.
    #[error("no tube along {seam:?}: rolled up as far as it goes, its seam turns by {turn:.3} rad, less than 2 pi")]
    NoTube {
        /// The cell that should coincide with cell (0, 0).
        seam: [i32; 2],
        /// Largest angle by which the seam turned, in radians.
        turn: f64,
    },
    /// The number of motions of a tube with a slipping seam is not one.
    #[error("a tube whose seam slips has one motion, this one has {motions}")]
    NotOneMotion {
        /// Number of linear motions.
        motions: usize,
    },
}

/// Returns the message about the second-order conditions of folding; if there are too many, with what can be done.
fn second_order(error: &HomotopyError) -> String {
    let remedy = match error {
        HomotopyError::TooMany { .. } => {
            "; each self stress of the flat sheet is one: take fewer cells, or relax with rest angles, which chooses a branch"
        }
        _ => "",
    };
    format!("second order: {error}{remedy}")
}

/// Checks that a sheet is a surface with two sides, whose faces can be walked over.
pub(super) fn check_surface(sheet: &Sheet) -> Result<(), KinematicsError> {
    if sheet.is_surface() { Ok(()) } else { Err(KinematicsError::NoSurface) }
}
