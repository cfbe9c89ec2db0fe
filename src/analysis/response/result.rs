//! The result: the linear response of a state.

use super::mode::{LinearMode, ModeTable};
use super::poisson::Poisson;
use super::stresses::SelfStress;
use super::symmetry_types::SymmetryTypes;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The linear response of a state.
#[derive(Clone, Debug, Default)]
pub struct Response {
    /// The linear folding modes: those without curvature first, then the others.
    pub modes: Vec<LinearMode>,
    /// Rank of the table of the modes, and of its two halves.
    pub table: ModeTable,
    /// The lattice of the state.
    pub lattice: LatticeMotions,
    /// Self stresses of the rigidity matrix of the bars in the boundary conditions of the assembly.
    pub self_stresses: usize,
    /// A basis of the self stresses of one cell whose lattice is held; empty on a cylinder.
    pub stresses: Vec<SelfStress>,
    /// Modes and self stresses by their type under the symmetries of the cell; empty on a cylinder.
    pub symmetries: Vec<SymmetryTypes>,
    /// Poisson's ratios of the modes; `None` on a cylinder, which has a curvature in one direction already.
    pub poisson: Option<Poisson>,
    /// Error of the modes: the larger of the difference between two ways over the faces and the defect of reciprocity,
    /// for modes of norm 1.
    pub error: f64,
}

/// The motions from a cell to the next.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(rename = "LatticeSummary")]
pub struct LatticeMotions {
    /// Chords from vertex 0 to its copies, in the frame of the mesh file.
    pub chords: [[f64; 3]; 2],
    /// Rotation angles about the common axis, in radians; 0 where nothing rotates. The larger one in absolute value is
    /// positive.
    pub theta: [f64; 2],
    /// Unit vector along the axis, in the frame of the mesh file; null where nothing rotates.
    pub axis: Option<[f64; 3]>,
    /// Signed curvature of the cylinder of vertex 0; 0 where nothing rotates.
    pub curvature: f64,
}
