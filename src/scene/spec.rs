//! The scene as its file gives it: one type per table, one field per key.
//!
//! Paths are relative to the scene file ([`crate::scene::SceneFile::resolve`]). Values that are invalid alone are
//! refused by their types ([`super::values`], [`super::forms`]); invalid combinations of values are refused by the
//! checks at the end of [`crate::scene::parse`].

mod drive;
mod facets;
mod law;
mod law_form;
mod material;
mod stop;
mod study;
mod sweep;
mod vertices;

use super::Located;
use super::forms::FileName;
use super::rest::RestSpec;
use super::stiffness::{RestLengthSpec, StiffnessSpec};
use super::values::{Axes, CellIndex, Cells, EdgeName, Finite, Label, Positive, SeamCell, Stiffness, Triple};
use crate::sheet::SeamKept;
use crate::sheet::angle::Angle;
use schemars::JsonSchema;
use serde::Deserialize;
use std::path::PathBuf;

pub use drive::*;
pub use facets::*;
pub use law::*;
pub use law_form::LawForm;
pub use material::*;
pub use stop::*;
pub use study::*;
pub use sweep::*;
pub use vertices::*;

/// A whole scene.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(title = "foldwell scene")]
pub struct Scene {
    /// What the scene is about.
    pub title: Option<String>,
    /// The sheet and its boundary conditions.
    pub sheet: SheetSpec,
    /// Names of units, which change no number.
    pub units: Option<UnitsSpec>,
    /// The elastic sheet from which the stiffnesses follow that `energy` does not give.
    pub material: Option<Located<MaterialSpec>>,
    /// The terms of the energy; a term that is absent is not built.
    #[serde(default)]
    pub energy: EnergySpec,
    /// The mass of the sheet, from which frequencies and weight follow; left out: none.
    pub mass: Option<Located<MassSpec>>,
    /// Creases that keep their fold angle in every cell.
    #[serde(default, rename = "lock")]
    pub locks: Vec<LockSpec>,
    /// Forces on vertices of a patch, and its weight.
    #[serde(default, rename = "load")]
    pub loads: Vec<Located<LoadSpec>>,
    /// Pressure on faces of a patch.
    #[serde(default, rename = "pressure")]
    pub pressures: Vec<Located<PressureSpec>>,
    /// Vertices of a patch that are held.
    #[serde(default, rename = "pin")]
    pub pins: Vec<Located<PinSpec>>,
    /// Vertices of a patch that move as rigid bodies.
    #[serde(default, rename = "part")]
    pub parts: Vec<PartSpec>,
    /// Vertices of a patch that are drawn in one place and stay together.
    #[serde(default, rename = "tie")]
    pub ties: Vec<TieSpec>,
    /// Springs between two vertices of a patch.
    #[serde(default, rename = "spring")]
    pub springs: Vec<SpringSpec>,
    /// The quantities that paths drive.
    #[serde(default, rename = "drive")]
    pub drives: Vec<DriveSpec>,
    /// What to compute, in this order.
    #[serde(default, rename = "study")]
    pub studies: Vec<StudySpec>,
    /// Keys that take several values, at each of which the studies are computed.
    pub sweep: Option<Located<SweepSpec>>,
}

/// `[sheet]`: exactly one of `mesh` and `generate`.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SheetSpec {
    /// A FOLD file with one cell of the sheet, an .obj or .stl file, or a crease pattern: .svg with the colours
    /// of Origami Simulator, .cp, .opx, .ori or .dxf.
    pub mesh: Option<Located<PathBuf>>,
    /// Distance, in units of the file, up to which line ends of a drawing are one point; left out: 1e-4 of the extent,
    /// or more where lines end beside each other otherwise. A FOLD file with it is read as a drawing of its edges.
    pub merge: Option<Located<f64>>,
    /// The frame of the FOLD file: 0 is its top, those of `file_frames` are 1, 2, ...; left out: the first with a mesh.
    pub frame: Option<Located<usize>>,
    /// A pattern and its parameters, `{ pattern = "miura", .. }`, as `foldwell new` takes them.
    #[schemars(with = "Option<std::collections::BTreeMap<String, serde_json::Value>>")]
    pub generate: Option<Located<toml::Table>>,
    /// Boundary conditions; left out: `patch`.
    pub domain: Option<Located<DomainSpec>>,
    /// Patch and torus: cells of the model, [1, 1] when left out. Screw: cells of the pictures, [6, 6] when left out.
    /// Tube: strands and rows of the pictures; left out: all strands, and as many rows as make it about as long as
    /// wide.
    pub cells: Option<Located<Cells>>,
    /// Torus only: whether the lattice vectors are unknowns (`free`, when left out) or stay as drawn (`fixed`).
    pub lattice: Option<Located<Lattice>>,
    /// Tube only: the cell [n1, n2] that coincides with cell [0, 0].
    pub seam: Option<Located<SeamCell>>,
    /// Tube only: the closing conditions that hold; left out: `both`.
    pub closing: Option<Located<ClosingSpec>>,
    /// Tube only: whether the sheet is rolled up towards its face normals (when left out) or away from them (`false`).
    pub inwards: Option<Located<bool>>,
}

/// Where the cell's neighbours are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[schemars(rename = "Domain")]
#[serde(rename_all = "lowercase")]
pub enum DomainSpec {
    /// One cell, its copies moved by two commuting screw motions.
    Screw,
    /// n1 x n2 cells with free edges.
    #[default]
    Patch,
    /// n1 x n2 cells, spatially periodic.
    Torus,
    /// One cell repeated about an axis: the sheet rolled up and closed along a seam.
    Tube,
}

/// The closing conditions of a tube.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[schemars(rename = "Closing")]
#[serde(rename_all = "lowercase")]
pub enum ClosingSpec {
    /// Both: n1 theta1 + n2 theta2 = 2 pi and n1 h1 + n2 h2 = 0.
    #[default]
    Both,
    /// That of the angle alone: the seam slips along itself.
    Turn,
    /// That of the height alone: the tube opens or overlaps.
    Rise,
}

/// Lattice vectors of a torus.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Lattice {
    /// Unknowns of the model.
    #[default]
    Free,
    /// As drawn.
    Fixed,
}

impl SheetSpec {
    /// The domain; a scene that says nothing means a patch.
    pub(crate) fn domain(&self) -> DomainSpec {
        self.domain.as_deref().copied().unwrap_or_default()
    }

    /// The numbers of cells, with the default of the domain.
    pub(crate) fn cells(&self) -> [usize; 2] {
        match (self.cells.as_deref(), self.domain()) {
            (Some(cells), _) => cells.0,
            (None, DomainSpec::Screw) => [6, 6],
            (None, DomainSpec::Tube) => self.seam.as_ref().map_or([1, 1], |seam| seam.usual_cells()),
            (None, DomainSpec::Patch | DomainSpec::Torus) => [1, 1],
        }
    }

    /// The closing conditions that a tube keeps.
    pub(crate) fn seam_kept(&self) -> SeamKept {
        match self.closing.as_deref().copied().unwrap_or_default() {
            ClosingSpec::Both => SeamKept::BOTH,
            ClosingSpec::Turn => SeamKept { turn: true, rise: false },
            ClosingSpec::Rise => SeamKept { turn: false, rise: true },
        }
    }

    /// Whether the model is one cell, and `cells` those of pictures.
    pub(crate) fn is_one_cell(&self) -> bool {
        matches!(self.domain(), DomainSpec::Screw | DomainSpec::Tube)
    }

    /// Whether the lattice vectors of a torus are unknowns.
    pub(crate) fn lattice(&self) -> Lattice {
        self.lattice.as_deref().copied().unwrap_or_default()
    }
}

/// `[energy]`.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct EnergySpec {
    /// Bars along all edges, diagonals of polygons included.
    pub bars: Option<Located<BarsSpec>>,
    /// Hinges at the creases.
    pub creases: Option<Located<CreasesSpec>>,
    /// Hinges at the diagonals of polygons; left out, polygons are rigid, unless there is a material.
    pub facets: Option<Located<FacetsForm>>,
    /// Whether triangles are stretched and sheared as a plate of the material, in the place of bars; left out: false.
    pub membrane: Option<Located<bool>>,
}

impl EnergySpec {
    /// Whether there is a membrane.
    pub(crate) fn has_membrane(&self) -> bool {
        self.membrane.as_deref() == Some(&true)
    }

    /// The keys of creases and of facets.
    pub(crate) fn hinges(&self) -> [Option<&CreasesSpec>; 2] {
        [self.creases.as_deref(), self.facets.as_deref().map(|facets| &facets.hinges)]
    }

    /// The rest angles of creases and of facets.
    pub(crate) fn rests(&self) -> [Option<&Located<RestSpec>>; 2] {
        self.hinges().map(|spec| spec?.rest.as_ref())
    }

    /// The measured curves of all terms.
    pub(crate) fn curves(&self) -> Vec<&CurveSpec> {
        let (bars, hinges) = self.laws();
        let of_bars = bars.into_iter().flat_map(LawForm::each).filter_map(BarLawSpec::curve);
        of_bars.chain(hinges.into_iter().flatten().flat_map(LawForm::each).filter_map(HingeLawSpec::curve)).collect()
    }

    /// The tables of the laws of single elements.
    pub(crate) fn law_tables(&self) -> impl Iterator<Item = &FileName> {
        let (bars, hinges) = self.laws();
        let of_hinges = hinges.into_iter().flatten().filter_map(LawForm::table);
        bars.and_then(LawForm::table).into_iter().chain(of_hinges)
    }

    /// Whether the stiffness of bars, creases and facets follows from a measured curve.
    pub(crate) fn stiffness_of_curve(&self) -> [bool; 3] {
        let (bars, [creases, facets]) = self.laws();
        let of_bars = bars.and_then(LawForm::of_all).is_some_and(|law| law.curve().is_some());
        let of_hinges = |law: Option<&LawForm<HingeLawSpec>>| {
            law.and_then(LawForm::of_all).is_some_and(|law| law.curve().is_some())
        };
        [of_bars, of_hinges(creases), of_hinges(facets)]
    }

    fn laws(&self) -> (Option<&LawForm<BarLawSpec>>, [Option<&LawForm<HingeLawSpec>>; 2]) {
        let bars = self.bars.as_ref().and_then(|bars| bars.law.as_deref());
        (bars, self.hinges().map(|spec| spec?.law.as_deref()))
    }
}

/// `bars = { stiffness, rest, law, yield }`.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BarsSpec {
    /// EA, a force; the spring constant is EA / L0 with the rest length L0; `inf`: exactly rigid. Left out: that of the
    /// material.
    pub stiffness: Option<Located<StiffnessSpec>>,
    /// Rest lengths; left out: as drawn.
    pub rest: Option<Located<RestLengthSpec>>,
    /// How the force grows with the stretch; left out: linearly.
    pub law: Option<Located<LawForm<BarLawSpec>>>,
    /// Where it yields; left out: nowhere.
    #[serde(rename = "yield")]
    pub yields: Option<Located<BarYieldSpec>>,
}

/// `mass = { vertex }` or `mass = { area }`: exactly one of both.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MassSpec {
    /// Mass of every vertex.
    pub vertex: Option<Located<Positive>>,
    /// Mass per area: every triangle of the drawn state gives a third of its mass to each corner.
    pub area: Option<Located<Positive>>,
}

/// `[[lock]]`: a crease that keeps its fold angle in every cell.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LockSpec {
    /// The crease `[i, j, n1, n2]`.
    pub crease: Located<EdgeName>,
    /// The fold angle; left out: the drawn one, of a sheet that is rolled up to a tube that of the closed tube.
    pub angle: Option<Located<Angle>>,
}

/// `[[spring]]`: a spring between two vertices of a patch, `k (d - rest)^2 / 2` at their distance `d`.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SpringSpec {
    /// The two vertices.
    pub vertices: Located<VertexSet>,
    /// The spring constant, force per length; `inf`: their distance stays.
    pub stiffness: Stiffness,
    /// The distance without force; left out: as drawn.
    pub rest: Option<Positive>,
}

/// `[[load]]`: a force on one or more vertices of a patch: `vertex`, with or without `cell`, or `vertices`. Or the
/// weight of the whole sheet.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LoadSpec {
    /// Number of the vertex in its cell.
    pub vertex: Option<Located<usize>>,
    /// The cell of `vertex`; left out: [0, 0].
    pub cell: Option<Located<CellIndex>>,
    /// The vertices, each of which has the force.
    pub vertices: Option<Located<VertexSet>>,
    /// The force `[x, y, z]`.
    pub force: Option<Located<Triple>>,
    /// true: the force turns with the rigid part to which its vertices belong; the part turns about one axis at most.
    pub turns: Option<Located<bool>>,
    /// Instead of vertices and force: the acceleration `[x, y, z]` of gravity, on the `mass` of every vertex.
    pub weight: Option<Located<Triple>>,
}

/// `[[pressure]]`: a force per area on faces of a patch, which stays normal to them. The faces close, or their rim is
/// pinned.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PressureSpec {
    /// Its name, by which drives refer to it.
    pub name: Option<Located<Label>>,
    /// The pressure, positive along the face normals; left out of one with a name: 0.
    pub value: Option<Finite>,
    /// Numbers of the polygons of the mesh that are under pressure, in all cells; left out: all.
    pub faces: Option<Located<Vec<usize>>>,
}

/// `[[pin]]`: vertices of a patch that are held: `vertex`, with or without `cell`, or `vertices`.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PinSpec {
    /// Number of the vertex in its cell.
    pub vertex: Option<Located<usize>>,
    /// The cell of `vertex`; left out: [0, 0].
    pub cell: Option<Located<CellIndex>>,
    /// The vertices.
    pub vertices: Option<Located<VertexSet>>,
    /// The coordinates that stay as drawn, letters of "xyz"; left out: all.
    pub axes: Option<Located<Axes>>,
    /// Instead of `axes`: the direction `[x, y, z]` along which the vertices keep their coordinate; across it they
    /// move.
    pub normal: Option<Located<Triple>>,
}

impl PinSpec {
    /// Which of x, y, z are held.
    pub(crate) fn axes(&self) -> [bool; 3] {
        self.axes.as_deref().map_or([true; 3], |axes| axes.0)
    }
}
