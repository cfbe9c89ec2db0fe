//! Why there is no surface of folded states.

use crate::analysis::branches::BranchesError;
use crate::kinematics::KinematicsError;
use crate::solver::atlas::AtlasError;
use thiserror::Error;

/// Why there is no surface.
#[derive(Debug, Error)]
pub enum SurfaceError {
    /// The drawn state is no state of a cell with two commuting screw motions.
    #[error("a surface of folded states needs domain \"screw\": its states are drawn in the space of lattice strains")]
    NotScrew,
    /// The folded states are a curve.
    #[error("the folded states are a curve")]
    Curve,
    /// The folded states are neither a surface nor a curve.
    #[error(
        "the folded states are neither a surface nor a curve: {modes} linear folding motions and {quadrics} quadratic conditions on \
         them leave {left} dimensions"
    )]
    NotTwoDimensional {
        /// Linear folding motions of the drawn state.
        modes: usize,
        /// Independent quadrics.
        quadrics: usize,
        /// Their difference.
        left: i64,
    },
    /// What the drawn state says.
    #[error(transparent)]
    Branches(#[from] BranchesError),
    /// The sheet cannot be put together.
    #[error(transparent)]
    Kinematics(#[from] KinematicsError),
    /// Second order does not say what leaves the drawn state.
    #[error(
        "second order does not tell the folded states here: the quadratic condition on the linear motions has the signature \
         {signature:?} (positive, negative, zero), whose zeros are multiple"
    )]
    Degenerate {
        /// Eigenvalues that are positive, negative and zero.
        signature: [usize; 3],
    },
    /// No direction was met, which does not say that there is none.
    #[error(
        "no simple real direction was met on {sections} random hyperplanes, and {multiple} multiple ones: this does not \
         establish that no surface leaves the drawn state"
    )]
    NoneMet {
        /// Hyperplanes.
        sections: usize,
        /// Real solutions of higher multiplicity, for which second order says no more.
        multiple: usize,
    },
    /// The curvature is met before the surface can be told from the drawn state.
    #[error(
        "nothing could be found within max_curvature = {max_curvature:e}: half of it is met at {reach:e} from the drawn state or nearer in \
         fold angles, where the surface cannot be told from its singular point; choose a larger max_curvature"
    )]
    NothingWithin {
        /// The largest curvature.
        max_curvature: f64,
        /// Distance from the drawn state, in fold angles, at which half of it is met.
        reach: f64,
    },
    /// No ray could be followed away from the drawn state.
    #[error("{rays} real directions leave the drawn state, but along none of them a folded state was found")]
    NoStart {
        /// How many.
        rays: usize,
    },
    /// The charts could not be begun.
    #[error(transparent)]
    Atlas(#[from] AtlasError),
}
