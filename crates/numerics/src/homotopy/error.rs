//! Why a system of quadrics was not solved.

/// Largest number of quadrics: `2^16` paths.
pub(super) const MOST_QUADRICS: usize = 16;
/// Why a system of quadrics was not solved.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[allow(missing_docs)] // each variant is documented by its message
pub enum HomotopyError {
    #[error("quadric {number} is zero, not finite, or of another size than the others")]
    Quadric { number: usize },
    #[error("{quadrics} quadrics in {unknowns} homogeneous unknowns do not have single solutions")]
    NotSquare { quadrics: usize, unknowns: usize },
    #[error("{quadrics} quadrics have 2^{quadrics} solutions; at most {MOST_QUADRICS} quadrics are solved")]
    TooMany { quadrics: usize },
    #[error("{paths} of the paths to the solutions were lost")]
    Lost { paths: usize },
    #[error("{paths} of the paths came to simple solutions of other paths")]
    Collision { paths: usize },
    #[error("{paths} solutions were found without their conjugates")]
    Unpaired { paths: usize },
    #[error("{paths} paths came to a solution of multiplicity {multiplicity}")]
    Multiplicity { paths: usize, multiplicity: usize },
}
