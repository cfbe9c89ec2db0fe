//! The results of a study of kind `response` in the summary.

use crate::analysis::response::{LatticeMotions, ModeTable, ModuliMatrices, Principal, SelfStress};
use crate::output::counted;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The linear response of a periodic sheet. Strains are rates of `a^-T g a^-1` of the state, without a factor of a
/// half; x is along the first lattice vector of the state, y in the plane of the lattice towards the second.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ResponseSummary {
    /// The linear folding modes, those without curvature first.
    pub linear_modes: Vec<LinearModeSummary>,
    /// Rank of the table of strains and curvatures: how many of six are isometries.
    pub table_rank: usize,
    /// Ranks of its halves, and its singular values.
    pub table: ModeTable,
    /// Self stresses of the bars in the boundary conditions of the scene.
    pub self_stresses: usize,
    /// A basis of the self stresses of one cell with held lattice; empty on a cylinder.
    pub stresses: Vec<SelfStress>,
    /// Modes and self stresses by their type under the symmetries of the cell.
    #[serde(default)]
    pub symmetries: Vec<SymmetrySummary>,
    /// The lattice of the state.
    pub lattice: LatticeMotions,
    /// Poisson's ratios of the rigid modes.
    pub poisson: PoissonSummary,
    /// Effective moduli of the energy; null where there are none.
    pub moduli: Option<ModuliSummary>,
    /// Why there are no moduli; null where there are.
    pub no_moduli: Option<String>,
}

/// A matrix of second derivatives by the components 11, 22, 12.
type Matrix = [[f64; 3]; 3];

/// Second derivatives of the energy per area of the cell by the components 11, 22, 12 of strain and curvature, each
/// counted once: energy per area `E S E / 2 + E C K + K B K / 2`, with strains as in `linear_modes`, twice the small
/// ones.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ModuliSummary {
    /// Second derivatives of the energy per area by two components of the strain; null where rigid elements make them
    /// infinite.
    pub stretching: Option<Matrix>,
    /// Second derivatives by a component of the strain (row) and one of the curvature (column); null where rigid
    /// elements make them infinite.
    pub coupling: Option<Matrix>,
    /// Second derivatives by two components of the curvature; null where rigid elements make them infinite.
    pub bending: Option<Matrix>,
    /// The limit of the moduli over `EA` for stiff bars: those of the bars alone, the stiffest with `EA = 1`. Null
    /// where rigid polygons or locks make some infinite.
    pub rigid_limit: Option<ModuliMatrices>,
    /// Principal strains and bendings of the rigid modes in the limit of rigid bars, by rising stiffness.
    pub rigid_modes: Vec<Principal>,
    /// The softest principal strains and bendings of all, as many as there are rigid modes, by rising stiffness.
    pub softest: Vec<Principal>,
}

/// A linear folding mode.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct LinearModeSummary {
    /// Strain `[e11, e22, e12]` of the chords from vertex 0.
    pub strain: [f64; 3],
    /// Curvature tensor `[k11, k22, k12]`, radians per length.
    pub curvature: [f64; 3],
    /// Angular velocities from a cell to the next along the two lattice vectors, in the frame of the mesh file.
    pub lattice_rotations: [[f64; 3]; 2],
}

/// Modes and self stresses that a symmetry of order two carries into themselves (even) or into their negative (odd).
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct SymmetrySummary {
    /// Kind of the symmetry in words, such as "mirror plane across the sheet".
    pub operation: String,
    /// Unit vector of an axis along the sheet, of the line in which a plane across it meets the sheet, or of the
    /// translation of a glide plane along it, in the frame of the mesh file; null for the others.
    pub direction: Option<[f64; 3]>,
    /// Even linear folding modes.
    pub even: usize,
    /// Odd linear folding modes.
    pub odd: usize,
    /// Even self stresses of one cell with held lattice.
    pub even_stresses: usize,
    /// Odd self stresses of one cell with held lattice.
    pub odd_stresses: usize,
}

/// Poisson's ratios, along the first lattice vector.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct PoissonSummary {
    /// Ratio of a stretch without curvature; null where no mode has it, or several, or it does not stretch along the
    /// first lattice vector.
    pub in_plane: Option<f64>,
    /// Ratio of a bending without twist; null where no mode has it, or several, or it does not bend along the first
    /// lattice vector.
    pub bending: Option<f64>,
    /// Why there is no ratio in the plane; null where there is, and of a sheet that is rolled up.
    #[serde(default)]
    pub no_in_plane: Option<String>,
    /// Why there is no ratio of bending; null where there is, and of a sheet that is rolled up.
    #[serde(default)]
    pub no_bending: Option<String>,
    /// Whether the two are opposite in every direction; null where one of them does not exist.
    pub opposite: Option<bool>,
    /// Why they are opposite or not, or do not exist.
    pub because: String,
    /// Largest sum of the two over 180 directions, relative to the larger of 1 and their size; null where no direction
    /// has both.
    pub sum: Option<f64>,
    /// Height above vertex 0, along the normal, at which the modes with curvature have no strain of their own; null
    /// where there is none.
    pub neutral_height: Option<f64>,
}

impl ResponseSummary {
    /// One sentence: the modes, and Poisson's ratios along the first lattice vector.
    pub(crate) fn sentence(&self) -> String {
        let poisson = &self.poisson;
        let ratio = |ratio: Option<f64>, reason: &Option<String>| {
            let reason = reason.iter().map(|reason| format!(" [{reason}]")).collect::<String>();
            ratio.map_or_else(|| format!("none{reason}"), |ratio| format!("{ratio:.6}"))
        };
        let opposite = match poisson.opposite {
            Some(true) => ", opposite in every direction",
            Some(false) => ", not opposite in every direction",
            None => "",
        };
        format!(
            "{}, table of rank {}; Poisson's ratio {} in the plane, {} of bending{opposite} ({})",
            counted(self.linear_modes.len(), "linear mode"),
            self.table_rank,
            ratio(poisson.in_plane, &poisson.no_in_plane),
            ratio(poisson.bending, &poisson.no_bending),
            poisson.because
        )
    }
}
