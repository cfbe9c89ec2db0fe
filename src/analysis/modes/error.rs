//! The errors of an analysis of modes.

use crate::kinematics::KinematicsError;
use crate::model::DriveError;
use crate::numerics::dense::DenseError;
use crate::numerics::eigen::EigenError;
use crate::numerics::factor::FactorError;
use thiserror::Error;

/// Models of up to this number of unknowns are decomposed dense where that gives eigenvalues that the iteration cannot
/// give.
pub(crate) const DENSE_EIGENVALUES: usize = 2000;
/// Most eigenvalues that are asked of the iteration.
pub const SPARSE_EIGENVALUES: usize = 256;
/// Smallest ratio of kept to dropped singular values at which a rank is believed.
pub(crate) const LEAST_GAP: f64 = 1e3;

/// Why there are no modes.
#[derive(Debug, Error)]
pub enum ModesError {
    /// A dense decomposition failed.
    #[error(transparent)]
    Dense(#[from] DenseError),
    /// A factorization failed.
    #[error(transparent)]
    Factor(#[from] FactorError),
    /// The closure conditions could not be set up.
    #[error(transparent)]
    Kinematics(#[from] KinematicsError),
    /// The sheet has a mass, but not all its coordinates are those of vertices.
    #[error("frequencies are those of vertices: {of} have no mass of their own")]
    NoMassMatrix {
        /// The other coordinates.
        of: &'static str,
    },
    /// A rigid part whose mass matrix is not diagonal, or that has a motion without mass.
    #[error(
        "the motions of part {part} are coupled by its mass, or one has none: frequencies are of parts whose middle is \
         their centre of mass, and whose turns are about principal axes"
    )]
    CoupledMotions {
        /// Number of the part.
        part: usize,
    },
    /// A mass per area gives none to a vertex.
    #[error("vertex {vertex} of cell {cell:?} belongs to no face: a mass per area gives it none")]
    Massless {
        /// Number of the vertex in its cell.
        vertex: usize,
        /// The cell.
        cell: [usize; 2],
    },
    /// The observer asked to stop.
    #[error("stopped on request")]
    Interrupted,
    /// No rank stands out.
    #[error(
        "the rank of the rigidity matrix is not certain: kept over dropped singular value {gap:.1e}, less than {LEAST_GAP:e}"
    )]
    NoGap {
        /// Smallest kept over largest dropped singular value.
        gap: f64,
    },
    /// The iteration cannot give so many eigenvalues, and the model is too large to be decomposed dense.
    #[error(
        "{wanted} eigenvalues are too many for a model of {unknowns} coordinates: at most {SPARSE_EIGENVALUES} beyond {DENSE_EIGENVALUES}"
    )]
    TooManyEigenvalues {
        /// Asked for.
        wanted: usize,
        /// Coordinates that nothing holds.
        unknowns: usize,
    },
    /// The loads cannot grow: there are none, or they would turn the sheet as a whole.
    #[error(transparent)]
    Loads(#[from] DriveError),
    /// Loads grow from a state that is no stable equilibrium.
    #[error(
        "loads grow from a stable equilibrium, and the state is none: its unbalanced force is {unbalanced:.1e} of the largest one, \
         its softest motion has the stiffness {softest:.1e}, and {} eigenvalues are negative", said(*negative)
    )]
    NotStable {
        /// Scaled unbalanced force, or gap.
        unbalanced: f64,
        /// Stiffness of a soft motion on what rigid terms leave free.
        softest: f64,
        /// Negative eigenvalues; `None` where their number cannot be established.
        negative: Option<usize>,
    },
    /// The number of critical factors is not that of the eigenvalues that become negative.
    #[error("critical factors found: {count}; negative eigenvalues beyond them: {}", said(*negative))]
    FactorsUncertain {
        /// Factors that were found.
        count: usize,
        /// Negative eigenvalues; `None` where their number cannot be established.
        negative: Option<usize>,
    },
    /// Two ways to the rank disagree.
    #[error("the rank of the rigidity matrix is {by_values} by singular values and {by_inertia} by counting signs")]
    RankDisagrees {
        /// Rank by singular values.
        by_values: usize,
        /// Rank by inertia.
        by_inertia: usize,
    },
    /// Bars and closure disagree.
    #[error("{bars} motions or stresses of the bars, but {closure} by the closure of the vertices")]
    ClosureDisagrees {
        /// Number of motions or self stresses that the rigidity matrix has.
        bars: usize,
        /// Number of motions or self stresses that the closure conditions have.
        closure: usize,
    },
}

/// A number that may not be known.
fn said(count: Option<usize>) -> String {
    count.map_or("an unknown number of".to_owned(), |count| count.to_string())
}

impl From<EigenError> for ModesError {
    fn from(error: EigenError) -> Self {
        match error {
            EigenError::Factor(error) => error.into(),
            EigenError::Stopped => Self::Interrupted,
        }
    }
}
