//! Why there is no answer about spatially varying modes.

use crate::numerics::dense::DenseError;
use thiserror::Error;

/// Why there is no answer about spatially varying modes.
#[derive(Debug, Error)]
#[allow(missing_docs)] // each variant is documented by its message
pub enum BlochError {
    #[error("a sheet without lattice vectors has no spatially varying modes")]
    NoLattice,
    #[error("{rows} conditions (bars and rigid facets) for {columns} coordinates of a cell: no determinant")]
    NotSquare { rows: usize, columns: usize },
    #[error(
        "the determinant vanishes at all wavenumbers: the rigidity matrix has zero modes at each of {compared} generic ones, \
         {zero_modes} or more"
    )]
    Vanishes { compared: usize, zero_modes: usize },
    #[error(
        "the determinant is known to {error:.1e} of its size only, more than {limit:e}: the cell is too ill-conditioned"
    )]
    NoDeterminant { error: f64, limit: f64 },
    #[error("bands need an energy of springs, and a state with rigid {kind} has none")]
    RigidElement { kind: &'static str },
    #[error(
        "the state is not stable: a wave with q = ({:.4}, {:.4}) grows, at the rate {rate:.4e}; without `density` its bands \
         are tabulated along a path", q[0], q[1]
    )]
    Unstable {
        rate: f64,
        /// Its wavenumbers in radians.
        q: [f64; 2],
    },
    #[error(transparent)]
    Dense(#[from] DenseError),
    #[error("the determinant is not symmetric (relative asymmetry {asymmetry:.1e}): it has no lines of zeros")]
    NotSymmetric { asymmetry: f64 },
    #[error("lines of zero modes could not be followed: {}", contradiction(*edges))]
    ZeroLines { edges: usize },
    #[error(
        "the determinant touches zero along a line, at q = ({:.4}, {:.4}), without a change of sign: such lines are not \
         followed", q[0], q[1]
    )]
    Touched {
        /// A point of the line, wavenumbers in radians.
        q: [f64; 2],
    },
    #[error(
        "at q1 = {q1} the zero modes of the strip do not stand out: the singular values next to them are only {gap:.1e} \
         times as large; modes of opposite sides meet, which more cells part"
    )]
    StripRank { q1: f64, gap: f64 },
    #[error("at q1 = {q1} the determinant is nearly zero on the unit circle: it has no winding number")]
    NoWinding { q1: f64 },
    #[error("interrupted")]
    Interrupted,
}

impl BlochError {
    /// Refuses to go on where the observer asked to stop.
    pub(crate) fn unless(go_on: bool) -> Result<(), Self> {
        if go_on { Ok(()) } else { Err(Self::Interrupted) }
    }

    /// Whether this says that there is no determinant to speak of, so that what needs one does not exist.
    pub(crate) fn is_of_determinant(&self) -> bool {
        matches!(self, Self::NotSquare { .. } | Self::Vanishes { .. } | Self::NoDeterminant { .. })
    }
}

fn contradiction(edges: usize) -> String {
    match edges {
        0 => "one of them came to no end".to_owned(),
        _ => format!("{edges} edges of the grid contradict them"),
    }
}
