//! The errors of an analysis of modes.

use crate::kinematics::KinematicsError;
use crate::model::DriveError;
use crate::numerics::dense::DenseError;
use crate::numerics::eigen::EigenError;
use crate::numerics::factor::FactorError;
use crate::solver::inertia::in_words;
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
#[allow(missing_docs)] // each variant is documented by its message
pub enum ModesError {
    #[error(transparent)]
    Dense(#[from] DenseError),
    #[error(transparent)]
    Factor(#[from] FactorError),
    #[error(transparent)]
    Kinematics(#[from] KinematicsError),
    #[error("frequencies are those of vertices: {of} have no mass of their own")]
    NoMassMatrix { of: &'static str },
    #[error("a motion of part {part} moves no mass: frequencies need one for every free motion")]
    MasslessMotion { part: usize },
    #[error(
        "mass couples the motions of a rigid part: so many frequencies of so many unknowns are found only of parts whose \
         middle is their centre of mass, and whose turns are about principal axes"
    )]
    CoupledMotions,
    #[error("vertex {vertex} of cell {cell:?} belongs to no face: a mass per area gives it none")]
    Massless { vertex: usize, cell: [usize; 2] },
    #[error("stopped on request")]
    Interrupted,
    #[error(
        "the rank of the rigidity matrix is not certain: kept over dropped singular value {gap:.1e}, less than {LEAST_GAP:e}"
    )]
    NoGap { gap: f64 },
    #[error(
        "{wanted} eigenvalues are too many for a model of {unknowns} coordinates: at most {SPARSE_EIGENVALUES} beyond {DENSE_EIGENVALUES}"
    )]
    TooManyEigenvalues { wanted: usize, unknowns: usize },
    #[error(transparent)]
    Loads(#[from] DriveError),
    #[error(
        "loads grow from a stable equilibrium, and the state is none: its unbalanced force is {unbalanced:.1e} of the largest one, \
         its softest motion has the stiffness {softest:.1e}, and {} eigenvalues are negative", in_words(*negative)
    )]
    NotStable { unbalanced: f64, softest: f64, negative: Option<usize> },
    #[error("critical factors found: {count}; negative eigenvalues beyond them: {}", in_words(*negative))]
    FactorsUncertain { count: usize, negative: Option<usize> },
    #[error(
        "rigid bars are redundant, and the critical factors depend on which self stress they have: give bars a stiffness"
    )]
    SelfStressed,
    #[error("the rank of the rigidity matrix is {by_values} by singular values and {by_inertia} by counting signs")]
    RankDisagrees { by_values: usize, by_inertia: usize },
    #[error("{bars} motions or stresses of the bars, but {closure} by the closure of the vertices")]
    ClosureDisagrees { bars: usize, closure: usize },
}

impl From<EigenError> for ModesError {
    fn from(error: EigenError) -> Self {
        match error {
            EigenError::Factor(error) => error.into(),
            EigenError::Stopped => Self::Interrupted,
        }
    }
}
