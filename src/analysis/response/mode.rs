//! A linear folding mode with what it does to the sheet as a whole, and the table of all modes.

use super::error::ResponseError;
use super::tensors::{Span, TensorSpace, flat};
use crate::kinematics::Moving;
use crate::kinematics::motion::Rigid;
use crate::math::Vec3;
use crate::numerics::DenseMatrix;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Smallest determinant, relative to the largest one, of the two curvature components that name modes.
const NAMES: f64 = 0.1;

/// A linear folding mode.
#[derive(Clone, Debug)]
pub struct LinearMode {
    /// Rates of the fold angles of the cell's edges, diagonals included.
    pub rates: Vec<f64>,
    /// Rate of the strain `[e11, e22, e12]` of the chords from vertex 0.
    pub strain: [f64; 3],
    /// Rate of the curvature tensor `[k11, k22, k12]`, in radians per length.
    pub curvature: [f64; 3],
    /// Angular velocities of a cell relative to the previous one along the two lattice vectors, in the frame of the
    /// mesh file.
    pub lattice_rotations: [Vec3; 2],
    /// The velocities of the vertices.
    pub field: Field,
}

/// The velocities of a mode.
#[derive(Clone, Debug)]
pub enum Field {
    /// Velocities of the vertices of a spatially periodic state.
    OfCells {
        /// Position and velocity of every vertex of the cell `[0, 0]`; vertex 0 is at rest in the origin.
        vertices: Vec<[Vec3; 2]>,
        /// The lattice motions with their twists.
        lattice: Box<[Moving; 2]>,
    },
    /// Rates of all coordinates of the assembly, of a cylinder.
    OfCoordinates(Vec<f64>),
}

impl Field {
    /// Returns the velocity of a vertex of a cell, in the frame of the mesh file; `None` for a cylinder.
    pub fn at(&self, vertex: usize, cell: [i32; 2]) -> Option<Vec3> {
        match self {
            Self::OfCells { vertices, lattice } => {
                let [place, velocity] = &vertices[vertex];
                Some(Moving::lattice_power(lattice, cell).carry(place, velocity))
            }
            Self::OfCoordinates(_) => None,
        }
    }
}

/// The table of strains and curvatures of the modes.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(rename = "TableSummary")]
pub struct ModeTable {
    /// Rank of the whole table: the number of independent isometric strains and bendings. In summaries it stands beside
    /// the table.
    #[serde(skip)]
    pub rank: usize,
    /// Rank of the strains alone.
    pub strains: usize,
    /// Rank of the curvatures alone.
    pub curvatures: usize,
    /// Singular values for modes of norm 1, lengths in units of the square root of the cell's area; descending.
    pub singular_values: Vec<f64>,
    /// Singular values of the strains alone.
    pub strain_values: Vec<f64>,
    /// Singular values of the curvatures alone: a small one means that a mode hardly bends the sheet.
    pub curvature_values: Vec<f64>,
}

/// Strains and curvatures of an orthonormal basis of the modes.
pub(super) struct RawTable {
    /// Strain of each mode.
    pub strains: Vec<[f64; 3]>,
    /// Curvature tensor of each mode.
    pub curvatures: Vec<[f64; 3]>,
    /// Unit of length.
    pub length: f64,
}

/// The modes by which a table is shown.
pub(super) struct Arranged {
    /// Amplitudes along the basis, a column for each mode.
    pub amplitudes: DenseMatrix,
    /// Strains of the modes without curvature.
    pub in_plane: TensorSpace,
    /// Curvature tensors of all modes.
    pub bending: TensorSpace,
}

impl RawTable {
    fn matrix(tensors: &[[f64; 3]], unit: f64) -> DenseMatrix {
        DenseMatrix::from_fn(3, tensors.len(), |row, k| unit * flat(tensors[k])[row])
    }

    /// Returns the ranks.
    pub(super) fn ranks(&self) -> Result<ModeTable, ResponseError> {
        let (strains, curvatures) = (Self::matrix(&self.strains, 1.0), Self::matrix(&self.curvatures, self.length));
        let whole = DenseMatrix::from_fn(6, self.strains.len(), |row, k| {
            if row < 3 { strains[(row, k)] } else { curvatures[(row - 3, k)] }
        });
        let table = Span::new(&whole, "strains and curvatures")?;
        let (strains, curvatures) = (Span::new(&strains, "strains")?, Span::new(&curvatures, "curvatures")?);
        Ok(ModeTable {
            rank: table.rank,
            strains: strains.rank,
            curvatures: curvatures.rank,
            singular_values: table.values,
            strain_values: strains.values,
            curvature_values: curvatures.values,
        })
    }

    /// Returns the modes by which the table is shown, as combinations of the basis, and the spaces of their tensors;
    /// `error` is the error of the basis.
    ///
    /// First the modes without curvature, by falling strain, each with 1 as its largest component of strain, or of norm
    /// 1 if it has no strain. Then modes with curvature, orthogonal to those: of three, those with one component 1 and
    /// the others 0; of two, the same for two of the components, `k11` and `k12` unless these hardly differ; a single
    /// one has 1 as its largest component.
    pub(super) fn arranged(&self, error: f64) -> Result<Arranged, ResponseError> {
        let bends = Span::new(&Self::matrix(&self.curvatures, self.length), "curvatures")?;
        let (bending, count) = (bends.rank, self.curvatures.len());
        let planar = bends.combinations.columns(bending, count - bending).into_owned();
        let (mut columns, mut in_plane): (Vec<_>, _) = (Vec::new(), TensorSpace::default());
        if planar.ncols() > 0 {
            let strained = Span::new(&(Self::matrix(&self.strains, 1.0) * &planar), "strains without curvature")?;
            in_plane = TensorSpace::new(&strained, error);
            let sorted = planar * &strained.combinations;
            let strains = Self::matrix(&self.strains, 1.0) * &sorted;
            for (k, mode) in sorted.column_iter().enumerate() {
                let strain = strains.column(k);
                let largest = strain.iamax();
                let unit = if k < strained.rank { unflat(largest, strain[largest]) } else { 1.0 };
                columns.push(mode / unit);
            }
        }
        for target in named(&bends) {
            let parts = bends.components.columns(0, bending).tr_mul(&target);
            let scaled = DenseMatrix::from_fn(bending, 1, |k, _| self.length * parts[k] / bends.values[k]);
            columns.push((bends.combinations.columns(0, bending) * scaled).column(0).into_owned());
        }
        let amplitudes = DenseMatrix::from_fn(count, columns.len(), |row, k| columns[k][row]);
        Ok(Arranged { amplitudes, in_plane, bending: TensorSpace::new(&bends, error) })
    }
}

/// Returns the component of a tensor from that of [`flat`].
fn unflat(component: usize, value: f64) -> f64 {
    if component == 2 { value / std::f64::consts::SQRT_2 } else { value }
}

/// Returns the curvature tensors, in the components of [`flat`], of the modes by which a space of them is shown.
fn named(bends: &Span) -> Vec<DenseMatrix> {
    let space = bends.components.columns(0, bends.rank).into_owned();
    let unit = |component: usize| flat([0, 1, 2].map(|k| f64::from(u8::from(k == component))));
    let column = |tensor: [f64; 3]| DenseMatrix::from_column_slice(3, 1, &tensor);
    match bends.rank {
        0 => vec![],
        1 => {
            let k = space.column(0).iamax();
            vec![&space / unflat(k, space[k])]
        }
        2 => {
            let minor = |[a, b]: [usize; 2]| space[(a, 0)] * space[(b, 1)] - space[(a, 1)] * space[(b, 0)];
            let pairs = [[0, 2], [0, 1], [1, 2]];
            let most = pairs.iter().map(|pair| minor(*pair).abs()).fold(0.0, f64::max);
            let pair = pairs.into_iter().find(|pair| minor(*pair).abs() >= NAMES * most).unwrap_or(pairs[0]);
            let tensor = |[a, b]: [usize; 2]| {
                // component a is 1 and component b is 0
                let mix = [space[(b, 1)], -space[(b, 0)]].map(|x| x / minor([a, b]));
                let mixed = space.column(0) * mix[0] + space.column(1) * mix[1];
                let scale = unit(a)[a];
                column([0, 1, 2].map(|k| scale * mixed[k]))
            };
            vec![tensor(pair), tensor([pair[1], pair[0]])]
        }
        _ => (0..3).map(|k| column(unit(k))).collect(),
    }
}
