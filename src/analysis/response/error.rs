//! The reasons for which a state has no linear response.

use crate::analysis::modes::ModesError;
use crate::numerics::dense::DenseError;

/// Why the linear response of a state cannot be computed.
#[derive(Debug, thiserror::Error)]
#[allow(missing_docs)] // each variant is documented by its message
pub enum ResponseError {
    #[error("the linear response is that of a periodic sheet: domain = \"torus\" or \"screw\"")]
    NotPeriodic,
    #[error("a state of {cells} cells has no linear response of one cell")]
    SeveralCells { cells: usize },
    #[error("the cells differ in the stiffness or the rest value of an element of edge {edge} of the cell")]
    UnevenCells { edge: usize },
    #[error("the linear response is that of springs at rest, where the law of the {term} has another stiffness")]
    NoSpringAtRest { term: &'static str },
    #[error(
        "the number of modes is not clear: motions that count as modes change lengths or held angles by up to {change:.1e}"
    )]
    UnclearModes { change: f64 },
    #[error("the energy has no bars")]
    NoBars,
    #[error("the energy has terms of one's own")]
    OwnTerms,
    #[error("the sheet is rolled up")]
    RolledUp,
    #[error(
        "the state is under stress, off its rest lengths and angles by up to {off:.1e}; moduli are those of a sheet at rest"
    )]
    UnderStress { off: f64 },
    #[error(transparent)]
    Modes(#[from] ModesError),
    #[error(transparent)]
    Decomposition(#[from] DenseError),
    #[error(
        "the rank of the {half} of the modes is not clear: singular values {kept:.1e} and {dropped:.1e} (modes of norm 1)"
    )]
    UnclearRank { half: &'static str, kept: f64, dropped: f64 },
}
