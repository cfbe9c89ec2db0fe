//! The reasons for which a state has no linear response.

use crate::analysis::modes::ModesError;
use crate::kinematics::KinematicsError;
use crate::numerics::dense::DenseError;

/// Why the linear response of a state cannot be computed.
#[derive(Debug, thiserror::Error)]
pub enum ResponseError {
    /// The sheet is finite, or a patch.
    #[error("the linear response is that of a periodic sheet: domain = \"torus\" or \"screw\"")]
    NotPeriodic,
    /// The state has several cells, which may differ.
    #[error("a state of {cells} cells has no linear response of one cell")]
    SeveralCells {
        /// Number of cells.
        cells: usize,
    },
    /// The cells of a torus have different stiffnesses or rest values.
    #[error("the cells differ in the stiffness or the rest value of an element of edge {edge} of the cell")]
    UnevenCells {
        /// Number of the edge in the cell.
        edge: usize,
    },
    /// A law is not that of a spring at rest.
    #[error("the linear response is that of springs at rest, where the law of the {term} has another stiffness")]
    NoSpringAtRest {
        /// Name of the term.
        term: &'static str,
    },
    /// The linear folding modes are not known.
    #[error(transparent)]
    Kinematics(#[from] KinematicsError),
    /// The self stresses are not known.
    #[error(transparent)]
    Modes(#[from] ModesError),
    /// A decomposition failed, or a rank is not clear.
    #[error(transparent)]
    Decomposition(#[from] DenseError),
    /// A rank of the table of the modes is not clear.
    #[error(
        "the rank of the {half} of the modes is not clear: singular values {kept:.1e} and {dropped:.1e} (modes of norm 1)"
    )]
    UnclearRank {
        /// The half of the table: strains, curvatures or both.
        half: &'static str,
        /// Smallest singular value that counts as nonzero.
        kept: f64,
        /// Largest singular value that counts as zero.
        dropped: f64,
    },
}
