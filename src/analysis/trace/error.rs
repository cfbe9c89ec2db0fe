//! Why there are no trajectories.

use crate::analysis::branches::BranchesError;
use crate::kinematics::KinematicsError;
use thiserror::Error;

/// Why there are no trajectories.
#[derive(Debug, Error)]
#[allow(missing_docs)] // each variant is documented by its message
pub enum TraceError {
    #[error(transparent)]
    Branches(#[from] BranchesError),
    #[error(transparent)]
    Kinematics(#[from] KinematicsError),
    #[error("there is no branch {branch}: this state has {count}")]
    NoSuchBranch { branch: usize, count: usize },
    #[error(
        "folding leaves the drawn state along infinitely many directions: lock a crease to choose among them, or ask for a surface"
    )]
    Continuum,
    #[error("faces of the first state pass through each other already: leave out the stop at self-intersection")]
    CrossesAlready,
    #[error("{}", motions_of_tube(*.motions, *.closed))]
    MotionsOfTube { motions: usize, closed: bool },
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
