//! Why there is no surface of folded states.

use crate::kinematics::KinematicsError;
use crate::solver::atlas::AtlasError;
use thiserror::Error;

/// Why there is no surface.
#[derive(Debug, Error)]
#[allow(missing_docs)] // each variant is documented by its message
pub enum SurfaceError {
    #[error("a surface of folded states needs domain \"screw\": its states are drawn in the space of lattice strains")]
    NotScrew,
    #[error("the folded states are a curve")]
    Curve,
    #[error(
        "the folded states are neither a surface nor a curve: {modes} linear folding motions and {quadrics} quadratic conditions on \
         them leave {left} dimensions"
    )]
    NotTwoDimensional { modes: usize, quadrics: usize, left: i64 },
    #[error(transparent)]
    Kinematics(#[from] KinematicsError),
    #[error(
        "second order does not tell the folded states here: the quadratic condition on the linear motions has the signature \
         {signature:?} (positive, negative, zero), whose zeros are multiple"
    )]
    Degenerate { signature: [usize; 3] },
    #[error(
        "no simple real direction was met on {sections} random hyperplanes, and {multiple} multiple ones: this does not \
         establish that no surface leaves the drawn state"
    )]
    NoneMet { sections: usize, multiple: usize },
    #[error(
        "nothing could be found within max_curvature = {max_curvature:e}: half of it is met at {reach:e} from the drawn state or nearer in \
         fold angles, where the surface cannot be told from its singular point; choose a larger max_curvature"
    )]
    NothingWithin { max_curvature: f64, reach: f64 },
    #[error("{rays} real directions leave the drawn state, but along none of them a folded state was found")]
    NoStart { rays: usize },
    #[error(transparent)]
    Atlas(#[from] AtlasError),
}
