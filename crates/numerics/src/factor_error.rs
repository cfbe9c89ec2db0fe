//! Why a factorization cannot be used.

use thiserror::Error;

/// The reason for which a factorization cannot be used.
#[derive(Debug, Error, Clone, Copy, PartialEq)]
pub enum FactorError {
    /// An entry of the matrix is infinite or not a number.
    #[error("the matrix has an entry that is not finite")]
    NotFinite,
    /// A pivot vanished.
    #[error("the matrix is singular to working precision (smallest over largest pivot {ratio:.1e})")]
    Singular {
        /// Smallest pivot over largest pivot, in magnitude.
        ratio: f64,
    },
    /// The factorization does not solve the system.
    #[error("the factorization does not solve its system (relative residual {residual:.1e})")]
    Inaccurate {
        /// Norm of the residual over norm of the right-hand side.
        residual: f64,
    },
    /// An iteration for eigenpairs ended early.
    #[error("{found} of {wanted} eigenpairs were found")]
    Eigenpairs {
        /// Number asked for.
        wanted: usize,
        /// Number found.
        found: usize,
    },
    /// The symbolic analysis ran out of memory or indices.
    #[error("the matrix of {size} unknowns is too large to factor")]
    TooLarge {
        /// Number of unknowns.
        size: usize,
    },
}
