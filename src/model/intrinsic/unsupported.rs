//! What has no form in fold angles.

use thiserror::Error;

/// Why a model has no intrinsic form.
#[derive(Clone, Copy, Debug, Error, PartialEq, Eq)]
pub enum Unsupported {
    /// It is no patch.
    #[error("only patches are solved in fold angles")]
    Domain,
    /// Pins and loads act on positions.
    #[error("pins and loads act on positions")]
    PinsOrLoads,
    /// Some elements are no springs of edges.
    #[error("bars or hinges have a law, or there are terms of one's own")]
    Law,
    /// Some edge has no bar.
    #[error("edge {edge} has no bar")]
    NoBar {
        /// Number of the edge in the tiling.
        edge: usize,
    },
    /// Some edge between two faces has no stiffness against folding.
    #[error("edge {edge} has no stiffness against folding")]
    NoHinge {
        /// Number of the edge in the tiling.
        edge: usize,
    },
    /// The faces do not form one connected sheet whose rims are circles.
    #[error("the faces do not form one sheet with simple rims")]
    Topology,
}
