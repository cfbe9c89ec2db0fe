//! Why there is no answer about spatially varying modes.

use crate::kinematics::KinematicsError;
use crate::numerics::dense::DenseError;
use thiserror::Error;

/// Why there is no answer about spatially varying modes.
#[derive(Debug, Error)]
pub enum BlochError {
    /// A finite sheet has no wavenumbers.
    #[error("a sheet without lattice vectors has no spatially varying modes")]
    NoLattice,
    /// As many equations as unknowns are needed for a determinant.
    #[error("{rows} conditions (bars and rigid facets) for {columns} coordinates of a cell: no determinant")]
    NotSquare {
        /// Bars and rigid facets of a cell.
        rows: usize,
        /// Coordinates of a cell.
        columns: usize,
    },
    /// The determinant is zero for all Bloch factors.
    #[error(
        "the determinant vanishes at all wavenumbers: the rigidity matrix has zero modes at each of {compared} generic ones, \
         {zero_modes} or more"
    )]
    Vanishes {
        /// Wavenumbers that were looked at.
        compared: usize,
        /// Fewest zero modes at one of them.
        zero_modes: usize,
    },
    /// The determinant is rounding, although there are wavenumbers without zero modes.
    #[error(
        "the determinant is known to {error:.1e} of its size only, more than {limit:e}: the cell is too ill-conditioned"
    )]
    NoDeterminant {
        /// Difference to the matrix over the largest magnitude.
        error: f64,
        /// The largest that is accepted.
        limit: f64,
    },
    /// Waves need a finite energy.
    #[error("bands need an energy of springs, and a state with rigid {kind} has none")]
    RigidElement {
        /// The kind of the rigid element, in the plural.
        kind: &'static str,
    },
    /// A state that is not stable has no frequencies.
    #[error(
        "the state is not stable: a wave with q = ({:.4}, {:.4}) grows, at the rate {rate:.4e}; without `density` its bands \
         are tabulated along a path", q[0], q[1]
    )]
    Unstable {
        /// The largest rate of growth on the grid.
        rate: f64,
        /// Its wavenumbers in radians.
        q: [f64; 2],
    },
    /// A decomposition failed.
    #[error(transparent)]
    Dense(#[from] DenseError),
    /// The determinant is not real on the zone.
    #[error("the determinant is not symmetric (relative asymmetry {asymmetry:.1e}): it has no lines of zeros")]
    NotSymmetric {
        /// Largest difference of opposite coefficients over the largest.
        asymmetry: f64,
    },
    /// The zero lines that were followed do not agree with the signs of the determinant.
    #[error("lines of zero modes could not be followed: {}", contradiction(*edges))]
    ZeroLines {
        /// Edges of the grid that contradict; 0 where a line came to no end.
        edges: usize,
    },
    /// Zero and nonzero singular values of a strip are not apart.
    #[error(
        "at q1 = {q1} the zero modes of the strip do not stand out: the singular values next to them are only {gap:.1e} \
         times as large; modes of opposite sides meet, which more cells part"
    )]
    StripRank {
        /// The wavenumber.
        q1: f64,
        /// Ratio of neighbouring singular values.
        gap: f64,
    },
    /// A determinant has no winding number.
    #[error("at q1 = {q1} the determinant is nearly zero on the unit circle: it has no winding number")]
    NoWinding {
        /// The wavenumber.
        q1: f64,
    },
    /// The linear folding modes are not known.
    #[error(transparent)]
    Kinematics(#[from] KinematicsError),
}

impl BlochError {
    /// Whether this says that there is no determinant to speak of, so that what needs one does not exist.
    pub(crate) fn is_of_determinant(&self) -> bool {
        matches!(self, Self::Vanishes { .. } | Self::NoDeterminant { .. })
    }
}

fn contradiction(edges: usize) -> String {
    match edges {
        0 => "one of them came to no end".to_owned(),
        _ => format!("{edges} edges of the grid contradict them"),
    }
}
