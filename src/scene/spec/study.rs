//! `[[study]]` and the keys of each kind of study.

use super::stop::{ProbeSpec, StopSpec};
use crate::analysis::relax::Method;
use crate::scene::Located;
use crate::scene::forms::{BranchChoice, Mode, StartSpec};
use crate::scene::values::{Cells, Count, Finite, Name, Pair, Positive, WellPair};
use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::Deserialize;
use std::path::PathBuf;

/// `[[study]]`: a question about the sheet. Every kind has these keys and its own.
///
/// In the file `kind` is a word and the keys of the kind stand beside it; [`crate::scene::parse`] moves them into a
/// table `kind = { relax = { .. } }` before the types see them.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StudySpec {
    /// Names its files: letters, digits, `_` and `-`, different for each study.
    pub name: Located<Name>,
    /// What is asked, with the keys that belong to it.
    #[schemars(flatten)]
    pub kind: Located<StudyKind>,
    /// What is checked at every state.
    #[serde(default)]
    pub check: Vec<Check>,
    /// The pictures: left out, `vtk` and `svg`; empty, tables only.
    #[serde(default = "usual_pictures")]
    pub draw: Vec<Draw>,
}

fn usual_pictures() -> Vec<Draw> {
    vec![Draw::Vtk, Draw::Svg]
}

/// A check at every state of a study.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Check {
    /// Whether faces pass through each other.
    SelfIntersection,
}

/// A kind of picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Draw {
    /// Files for ParaView.
    Vtk,
    /// One SVG.
    Svg,
    /// The numbers of the vertices, in the SVG.
    Numbers,
    /// One page with the states, plots and pictures, for a browser.
    Html,
}

/// Defines the kinds of studies by their words in the scene and the types of their keys.
macro_rules! kinds {
    ($($(#[$about:meta])* $word:literal: $kind:ident($keys:ident),)+) => {
        /// The kinds of studies.
        #[derive(Clone, Debug, Deserialize, JsonSchema)]
        #[serde(rename_all = "lowercase")]
        #[schemars(tag = "kind")]
        pub enum StudyKind {
            $($(#[$about])* $kind($keys)),+
        }

        impl StudyKind {
            /// The words of all kinds, each with the function that returns the schema of its keys.
            pub(crate) const ALL: &[(&str, fn(&mut SchemaGenerator) -> Schema)] = &[$(($word, $keys::json_schema)),+];

            /// The word in the scene.
            pub(crate) fn name(&self) -> &'static str {
                match self {
                    $(Self::$kind(_) => $word),+
                }
            }
        }
    };
}

kinds! {
    /// An equilibrium of the energy.
    "relax": Relax(RelaxSpec),
    /// The trajectories along which the sheet folds.
    "trace": Trace(TraceSpec),
    /// The surface of folded states.
    "surface": Surface(SurfaceSpec),
    /// Zero modes, self stresses and the lowest eigenvalues.
    "modes": Modes(ModesSpec),
    /// The directions in which folding leaves a state.
    "branches": Branches(BranchesSpec),
    /// Energy along modes.
    "landscape": Landscape(LandscapeSpec),
    /// Modes of nonzero wavenumber.
    "bloch": Bloch(BlochSpec),
    /// Stable states and the barriers between them.
    "wells": Wells(WellsSpec),
    /// Equilibria along a driven quantity.
    "path": Path(PathSpec),
    /// A path along the rest angles, from those drawn to those of `[energy]`.
    "fold": Fold(PathSpec),
    /// The sheet as a material: its linear modes, Poisson's ratios and moduli.
    "response": Response(ResponseSpec),
}

/// `kind = "relax"`.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RelaxSpec {
    /// Where it starts; left out: as drawn.
    pub start: Option<Located<StartSpec>>,
    /// Bound on both scaled residuals.
    pub tolerance: Option<Located<Positive>>,
    /// The unknowns of the relaxation; left out: `auto`.
    #[serde(default)]
    pub method: Method,
    /// Which states on the way are written: one in so many iterations, the first and the last one included. Left out:
    /// the start and the end.
    pub keep_every: Option<Located<Count>>,
}

/// `kind = "trace"`.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TraceSpec {
    /// What is solved at every step; left out: `kinematic`.
    #[serde(default)]
    pub engine: Engine,
    /// Which branches are followed; left out: all.
    pub branch: Option<Located<BranchChoice>>,
    /// Longest step in arc length.
    pub max_step: Option<Located<Positive>>,
    /// Bound on the residual.
    pub tolerance: Option<Located<Positive>>,
    /// The first of these that is met ends a trajectory.
    pub stop: Option<Located<StopSpec>>,
    /// Whether the table has columns with Poisson's ratios of every state, and of which modes; left out: none.
    pub response: Option<Located<RatioColumns>>,
}

/// The linear modes whose Poisson's ratios a table has.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum RatioColumns {
    /// Of the scene: rigid polygons and locks keep their angles.
    Rigid,
    /// Of the sheet whose polygons all bend and whose locks are released.
    Bending,
}

/// What a trace solves.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Engine {
    /// Closure of the fold angles round the vertices.
    #[default]
    Kinematic,
    /// The relaxation.
    Energy,
    /// Both, compared at every step.
    Both,
}

/// `kind = "surface"`: all states without locks; `[[lock]]` does not apply to it.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SurfaceSpec {
    /// Number of states along each direction over a whole turn of fold angles: discs of radius 2 pi / resolution around
    /// the states, smaller ones where the surface bends, cover it. Left out: 32.
    pub resolution: Option<Located<Count>>,
    /// Magnitude of the curvature at which the surface ends, 1/length. Left out: one over the square root of the cell's
    /// area, the curvature of a cylinder as large as the cell.
    pub max_curvature: Option<Located<Positive>>,
}

/// `kind = "modes"`.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ModesSpec {
    /// The state whose modes are wanted; left out: the drawn one.
    pub start: Option<Located<StartSpec>>,
    /// How many of the lowest eigenvalues of the energy's Hessian, and, where the scene has a mass, of the lowest
    /// frequencies; left out: none.
    pub eigenvalues: Option<Located<usize>>,
    /// How many of the lowest critical factors of the loads, at which the state buckles to first order, the last one as
    /// often as it has independent motions; left out: none.
    pub buckling: Option<Located<Count>>,
}

/// `kind = "branches"`: no keys of its own.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BranchesSpec {}

/// `kind = "landscape"`.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LandscapeSpec {
    /// The modes, each `[k11, k22, k12]` or `{ rates = "file.csv" }`.
    pub modes: Located<Vec<Located<Mode>>>,
    /// The amplitudes along each.
    pub amplitudes: Located<Vec<Positive>>,
    /// Energies in all directions; left out: none.
    pub map: Option<Located<MapSpec>>,
}

/// `map = { amplitude, rings }`: energies over the sphere of curvature tensors of one norm.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MapSpec {
    /// The norm of the tensors, `sqrt(k11^2 + k22^2 + 2 k12^2)`, 1/length.
    pub amplitude: Located<Positive>,
    /// Rings of samples from a pole (`k11 = k22`) to the equator, with four times as many samples on each; left out: 8.
    pub rings: Option<Located<Count>>,
}

/// `kind = "bloch"`.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BlochSpec {
    /// The state of which modes are wanted: an earlier study of one cell. Left out: as drawn.
    pub start: Option<Located<StartSpec>>,
    /// Wavenumbers sampled along each direction; left out: [256, 256].
    pub grid: Option<Located<Cells>>,
    /// First wavenumbers at which decay rates are wanted, in radians per cell; left out: 32 that divide the zone
    /// evenly.
    pub q1: Option<Located<Vec<Finite>>>,
    /// Modes of which the displacement is written, each `[q1, kappa2]`: of the roots at `q1` the one of nearest decay
    /// rate.
    pub modes: Option<Located<Vec<Pair>>>,
    /// Corners `[q1, q2]` of a path through the zone along which the bands of the energy are wanted, with a mass
    /// also frequencies.
    pub path: Option<Located<Vec<Pair>>>,
    /// The density of states over the whole zone, of a sheet with mass.
    pub density: Option<Located<DensitySpec>>,
    /// A strip, periodic along the first lattice vector with free edges across the second: its zero modes at every
    /// `q1`.
    pub strip: Option<Located<StripSpec>>,
    /// Wavenumbers `[q1, q2]` at which zero modes and self stresses are counted.
    pub zero_modes_at: Option<Located<Vec<Pair>>>,
}

/// `density = { grid, bins }`.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DensitySpec {
    /// Wavenumbers along each direction; left out: [64, 64].
    pub grid: Option<Located<Cells>>,
    /// Number of bins from 0 to the largest frequency; left out: 100.
    pub bins: Option<Located<Count>>,
}

/// `strip = { cells, other, clamped }`.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StripSpec {
    /// Cells across the strip, at least 8; with `other` at least 16.
    pub cells: Count,
    /// The mesh of the cell of the upper half, relative to the scene; left out: all cells are equal. It needs as many
    /// vertices, the same first lattice vector and the same edges between neighbouring rows of cells.
    pub other: Option<PathBuf>,
    /// Whether both edges are clamped instead of free: cells beyond them are held. Then self stresses are where free
    /// edges have zero modes.
    #[serde(default)]
    pub clamped: bool,
}

/// `kind = "wells"`.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct WellsSpec {
    /// The state around which random starts are crumpled; left out: the drawn one.
    pub start: Option<Located<StartSpec>>,
    /// Number of random starts; left out: 64.
    pub starts: Option<Located<Count>>,
    /// Seed of their random numbers; left out: 0.
    #[serde(default)]
    pub seed: u64,
    /// Largest distance of the random fold angles towards which the sheet is crumpled from those of the start, in
    /// radians; of a truss without creases that of a coordinate, of which pi is two mean edges. Left out: pi.
    pub spread: Option<Located<Positive>>,
    /// Pairs of wells between which the barrier is wanted, each `[a, b]`: wells are numbered by rising energy, from 0.
    /// Left out: none.
    #[serde(default)]
    pub barriers: Vec<Located<WellPair>>,
    /// Whether wells and passes are also sought in fold angles alone, on the rigidly folded states: of a screw, or of a
    /// sheet that folds along curves.
    #[serde(default)]
    pub rigid: bool,
    /// With `rigid`, states over a whole turn of fold angles; left out: 64.
    pub resolution: Option<Located<Count>>,
    /// With `rigid`, magnitude of the curvature up to which the states of a screw are sought, 1/length. Left out: one
    /// over the square root of the cell's area.
    pub max_curvature: Option<Located<Positive>>,
}

/// `kind = "path"`, and `kind = "fold"`, which has all of these keys but `drive`.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PathSpec {
    /// Name of the drive; may be left out where the scene has exactly one.
    pub drive: Option<Located<String>>,
    /// Where it starts: "drawn" or an earlier study; left out: as drawn.
    pub start: Option<Located<StartSpec>>,
    /// Bound on both scaled residuals.
    pub tolerance: Option<Located<Positive>>,
    /// Longest step in arc length.
    pub max_step: Option<Located<Positive>>,
    /// Whether branches that leave at branch points are followed too.
    #[serde(default)]
    pub switch: bool,
    /// Whether the sheet goes to the minimum beyond where the driven value cannot grow, instead of along the path, on
    /// which it turns back; left out: whether it is of kind `fold`, without `switch`.
    pub snap: Option<Located<bool>>,
    /// The first of these that is met ends a branch; `curvature` is one of `screw` and `tube`.
    pub stop: Option<Located<StopSpec>>,
    /// Values of the drive of which the states are rows of their own, wherever the path passes them; of `fold` parts of
    /// the way, from 0 to 1.
    #[serde(default)]
    pub at: Vec<Located<Finite>>,
    /// Columns `probe_NAME` of the table: how far vertices of a patch have moved along an axis since they were drawn.
    #[serde(default)]
    pub probe: Vec<ProbeSpec>,
    /// Whether the table has columns with Poisson's ratios of every state, and of which modes; left out: none.
    pub response: Option<Located<RatioColumns>>,
}

/// `kind = "response"`, of a periodic sheet.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ResponseSpec {
    /// The state whose response is wanted; left out: the drawn one.
    pub start: Option<Located<StartSpec>>,
    /// Number of directions over half a turn at which Poisson's ratios are written; left out: 72.
    pub directions: Option<Located<Count>>,
}

impl StudyKind {
    /// Returns the state from which the study starts; `None` if the scene names none, or the kind has no such key.
    pub(crate) fn start(&self) -> Option<&Located<StartSpec>> {
        match self {
            Self::Relax(spec) => spec.start.as_ref(),
            Self::Bloch(spec) => spec.start.as_ref(),
            Self::Trace(_) | Self::Surface(_) | Self::Branches(_) | Self::Landscape(_) => None,
            Self::Modes(spec) => spec.start.as_ref(),
            Self::Wells(spec) => spec.start.as_ref(),
            Self::Path(spec) | Self::Fold(spec) => spec.start.as_ref(),
            Self::Response(spec) => spec.start.as_ref(),
        }
    }

    /// Whether the study finds frequencies, which depend on the mass of the sheet.
    pub(crate) fn reads_mass(&self) -> bool {
        match self {
            Self::Modes(spec) => spec.eigenvalues.as_ref().is_some_and(|count| **count > 0),
            Self::Bloch(spec) => spec.path.is_some() || spec.density.is_some(),
            _ => false,
        }
    }
}
