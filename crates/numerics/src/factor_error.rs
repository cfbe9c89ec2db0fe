//! Why a factorization cannot be used.

use thiserror::Error;

/// The reason for which a factorization cannot be used.
#[derive(Debug, Error, Clone, Copy, PartialEq)]
#[allow(missing_docs)] // each variant is documented by its message
pub enum FactorError {
    #[error("the matrix has an entry that is not finite")]
    NotFinite,
    #[error("the matrix is singular to working precision (smallest over largest pivot {ratio:.1e})")]
    Singular { ratio: f64 },
    #[error("the factorization does not solve its system (relative residual {residual:.1e})")]
    Inaccurate { residual: f64 },
    #[error("{found} of {wanted} eigenpairs were found")]
    Eigenpairs { wanted: usize, found: usize },
    #[error("the matrix of {size} unknowns is too large to factor")]
    TooLarge { size: usize },
}
