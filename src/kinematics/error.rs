//! The errors of exact folding.

use crate::numerics::dense::DenseError;
use crate::numerics::homotopy::HomotopyError;
use crate::sheet::Sheet;

/// The reasons for which a kinematic quantity cannot be computed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[allow(missing_docs)] // each variant is documented by its message
pub enum KinematicsError {
    #[error("the faces around vertex {vertex} do not form one closed round")]
    BrokenRound { vertex: usize },
    #[error("a finite sheet has neither curvature nor lattice motions nor linear folding modes: they need a lattice")]
    NoLattice,
    #[error(
        "exact folding is of surfaces with two sides: here an edge has more than two faces or none, or the faces have one \
         side, as those of a Moebius band"
    )]
    NoSurface,
    #[error(
        "a cell that screw motions repeat is drawn rolled up: it folds as a tube, and several cells need lattice vectors"
    )]
    Rolled,
    #[error(
        "the sheet has {loops} opening(s): closing its vertices does not close their rims, which is done for finite sheets only"
    )]
    Openings { loops: usize },
    #[error(
        "the {faces} faces do not hang together with all vertices, and in both directions where there is a lattice"
    )]
    Disconnected { faces: usize },
    #[error("a folding mode does not close over the cell: two ways over the faces differ by {difference:.2e}")]
    WaysDisagree { difference: f64 },
    #[error(
        "curvatures name a mode only where there are 3 linear folding modes; this sheet has {modes} (a flat sheet has \
         one more for each vertex, rigid polygons take some away)"
    )]
    NotThreeModes { modes: usize },
    #[error(
        "curvatures do not name a mode of this sheet: modes and curvature tensors are not one to one (condition number \
         {condition:.1e})"
    )]
    SingularCurvatures { condition: f64 },
    #[error("closure of the vertices: {0}")]
    Decomposition(#[from] DenseError),
    #[error("{}", second_order(.0))]
    Quadrics(#[from] HomotopyError),
    #[error("the faces do not close at this state: residual {residual:.2e}")]
    NotClosed { residual: f64 },
    #[error("a tube needs a seam other than [0, 0]")]
    NoSeam,
    #[error("no tube along {seam:?}: rolled up as far as it goes, its seam turns by {turn:.3} rad, less than 2 pi")]
    NoTube {
        seam: [i32; 2],
        /// Largest angle by which the seam turned, in radians.
        turn: f64,
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
