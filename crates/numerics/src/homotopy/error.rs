//! Why a system of quadrics was not solved.

/// Largest number of quadrics: `2^16` paths.
pub(super) const MOST_QUADRICS: usize = 16;
/// Why a system of quadrics was not solved.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum HomotopyError {
    /// A quadric is no finite square matrix of the right size, or zero.
    #[error("quadric {number} is zero, not finite, or of another size than the others")]
    Quadric {
        /// Its number in the list.
        number: usize,
    },
    /// The numbers of quadrics and unknowns do not fit.
    #[error("{quadrics} quadrics in {unknowns} homogeneous unknowns do not have single solutions")]
    NotSquare {
        /// Number of quadrics.
        quadrics: usize,
        /// Number of unknowns.
        unknowns: usize,
    },
    /// There are too many quadrics, and so too many paths.
    #[error("{quadrics} quadrics have 2^{quadrics} solutions; at most {MOST_QUADRICS} quadrics are solved")]
    TooMany {
        /// Number of quadrics.
        quadrics: usize,
    },
    /// Paths did not come to an end.
    #[error("{paths} of the paths to the solutions were lost")]
    Lost {
        /// Number of them.
        paths: usize,
    },
    /// Two paths came to one simple solution.
    #[error("{paths} of the paths came to simple solutions of other paths")]
    Collision {
        /// Number of them.
        paths: usize,
    },
    /// Solutions were found without their conjugates.
    #[error("{paths} solutions were found without their conjugates")]
    Unpaired {
        /// Number of them.
        paths: usize,
    },
    /// The multiplicity of a solution is not the number of paths that came to it.
    #[error("{paths} paths came to a solution of multiplicity {multiplicity}")]
    Multiplicity {
        /// Number of paths.
        paths: usize,
        /// Multiplicity by the equations around it.
        multiplicity: usize,
    },
}
