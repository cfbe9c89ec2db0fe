//! Why there are no trajectories.

use crate::analysis::branches::BranchesError;
use crate::kinematics::KinematicsError;
use thiserror::Error;

/// Why there are no trajectories.
#[derive(Debug, Error)]
pub enum TraceError {
    /// The rays are not known.
    #[error(transparent)]
    Branches(#[from] BranchesError),
    /// The sheet cannot be put together.
    #[error(transparent)]
    Kinematics(#[from] KinematicsError),
    /// The scene asks for a branch that does not exist.
    #[error("there is no branch {branch}: this state has {count}")]
    NoSuchBranch {
        /// Asked for.
        branch: usize,
        /// Found.
        count: usize,
    },
    /// TracedClosure leaves along infinitely many directions, none of which stands alone: there is no single trajectory
    /// to follow.
    #[error(
        "folding leaves the drawn state along infinitely many directions: lock a crease to choose among them, or ask for a surface"
    )]
    Continuum,
    /// Where faces pass through each other from the beginning, nothing can end where they first do.
    #[error("faces of the first state pass through each other already: leave out the stop at self-intersection")]
    CrossesAlready,
    /// A tube has several motions, or one although both closing conditions are kept.
    #[error("{}", motions_of_tube(*.motions, *.closed))]
    MotionsOfTube {
        /// Number of its linear motions, without rigid ones.
        motions: usize,
        /// Whether both closing conditions are kept.
        closed: bool,
    },
    /// No ray was found, and none was excluded.
    #[error("no direction of folding was found, but none was excluded either: lock a crease")]
    NotEstablished,
}

/// Returns the message about a tube that has more motions than can be followed.
fn motions_of_tube(motions: usize, closed: bool) -> String {
    if closed {
        let what = "a generic closed tube has none, and whether this one moves is not established";
        return format!("the closed tube has {motions} linear motion(s) along its creases: {what}; lock creases");
    }
    let extra = motions.saturating_sub(1);
    format!(
        "the tube has {motions} motions that keep its closing condition, and one can be followed: lock {extra} crease(s)"
    )
}
