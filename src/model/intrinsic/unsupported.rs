//! What has no form in fold angles.

use thiserror::Error;

/// Why a model has no intrinsic form.
#[derive(Clone, Copy, Debug, Error, PartialEq, Eq)]
#[allow(missing_docs)] // each variant is documented by its message
pub enum Unsupported {
    #[error("only patches are solved in fold angles")]
    Domain,
    #[error("pins and loads act on positions")]
    PinsOrLoads,
    #[error("bars or hinges have a law, or there are terms of one's own")]
    Law,
    #[error("edge {edge} has no bar")]
    NoBar { edge: usize },
    #[error("edge {edge} has no stiffness against folding")]
    NoHinge { edge: usize },
    #[error("the faces do not form one sheet with simple rims")]
    Topology,
}
