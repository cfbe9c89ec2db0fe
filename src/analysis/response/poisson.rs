//! Poisson's ratios of a sheet in its plane and of bending, and why they are opposite or not.
//!
//! **Theorem.** For any two linear folding modes `cof(K') : E = cof(K) : E'` (reciprocity: the rates of one mode are a
//! self stress of the bars, which does no work on the other). Let one mode of three strain the sheet by `E` without
//! bending it. Then every other mode bends it by a `K` with `cof(K) : E = 0`, that is, in the frame of any direction,
//! `k_across e_along + k_along e_across = 2 k_twist e_shear`; and of the two curvature tensors that are left one has no
//! twist in this direction. So `-k_across/k_along = +e_across/e_along`: in every direction the ratio of bending is
//! minus the one in the plane. Cells of four parallelograms have such a mode by their symmetry (J. McInerney, G. H.
//! Paulino, D. Z. Rocklin, "Discrete symmetries control geometric mechanics in parallelogram-based origami", PNAS 119,
//! e2202777119 (2022)); for Miura-ori see M. Schenk, S. D. Guest, PNAS 110, 3276 (2013) and Z. Y. Wei, Z. V. Guo, L.
//! Dudte, H. Y. Liang, L. Mahadevan, Phys. Rev. Lett. 110, 215501 (2013).

use super::mode::{LinearMode, ModeTable};
use super::tensors::{TensorSpace, flat};
use crate::numerics::dense::least_squares;
use crate::numerics::{DenseMatrix, larger, worst};
use crate::sheet::{Corner, Sheet};
use std::f64::consts::PI;

/// Directions at which the two ratios are compared.
const DIRECTIONS: usize = 180;
/// Largest difference of opposite sides of a parallelogram, relative to the sides.
const PARALLEL: f64 = 1e-9;

/// Least curvature of a mode, relative to the largest, below which a sheet is called close to one with a ratio.
const NEARLY_PLANAR: f64 = 1e-3;
/// Strain of modes at the neutral height that counts as zero, relative to the other strains.
const NO_STRAIN: f64 = 1e-9;

/// Poisson's ratios of the linear folding modes.
#[derive(Clone, Debug, PartialEq)]
pub struct Poisson {
    /// Strains of the modes without curvature.
    pub in_plane: TensorSpace,
    /// Curvature tensors of all modes.
    pub bending: TensorSpace,
    /// How the two ratios are related, and why.
    pub relation: Relation,
    /// Largest sum of the two ratios over the directions in which both exist, relative to the larger of their size and
    /// 1; `None` where there is no such direction.
    pub sum: Option<f64>,
    /// Height along the normal above vertex 0 at which the modes with curvature have no strain, apart from that of a
    /// mode without curvature; `None` where there is no such height.
    pub neutral_height: Option<f64>,
}

/// The relation of the ratios in the plane and of bending.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Relation {
    /// The conditions of the theorem hold: the ratios are opposite in every direction.
    Opposite {
        /// Dimension of the strains of the modes without curvature: 1, or 2 where only one mode bends the sheet.
        strains: usize,
        /// Whether the cell consists of four parallelograms, so that the theorem holds in each of its states.
        four_parallelograms: bool,
    },
    /// There are no modes: rigid polygons and locks hold the sheet.
    NoModes,
    /// Every combination of modes bends the sheet: there is no ratio in the plane.
    NoPlanarMode {
        /// Least curvature of a mode, relative to the largest, for modes of norm 1: small where the sheet is close to
        /// one that has a ratio.
        least: f64,
    },
    /// The sheet has openings, or is no surface with two sides: reciprocity says nothing of it.
    NoReciprocity,
    /// Several modes strain the sheet without bending it: there is no single ratio in the plane.
    SeveralPlanarModes {
        /// Dimension of their strains.
        strains: usize,
    },
    /// The modes without curvature do not strain the sheet: there is no ratio in the plane.
    NoStrain,
    /// No mode bends the sheet: there is no ratio of bending.
    NoBendingMode {
        /// Whether some hinges keep their angles.
        locked: bool,
    },
    /// One mode strains the sheet, and only one other bends it: the ratios are opposite only in directions in which one
    /// of the two has no shear or twist.
    OneBendingMode,
}

impl Relation {
    /// Whether the ratios are opposite in every direction; `None` where one of them does not exist.
    pub fn opposite(self) -> Option<bool> {
        match self {
            Self::Opposite { .. } => Some(true),
            Self::OneBendingMode => Some(false),
            _ => None,
        }
    }

    /// Returns the reason in words.
    pub fn because(self) -> String {
        let words = match self {
            Self::Opposite { strains, four_parallelograms } => {
                let count = if strains == 1 { "one mode strains" } else { "two modes strain" };
                let always =
                    if four_parallelograms { ", as cells of four parallelograms do in every state" } else { "" };
                return format!(
                    "{count} the sheet without bending it{always}: by reciprocity the ratios are opposite in every \
                     direction"
                );
            }
            Self::NoModes => "the sheet has no linear mode: rigid polygons and locks hold it",
            Self::NoPlanarMode { least } if least < NEARLY_PLANAR => {
                return format!(
                    "every mode bends the sheet, but one of them only by {least:.1e} of the others: the sheet is close to one \
                     with opposite ratios"
                );
            }
            Self::NoPlanarMode { .. } => {
                "every mode bends the sheet: none is in the plane, and curvature tensors are those of one mode each"
            }
            Self::SeveralPlanarModes { strains } => {
                return format!("the modes that do not bend the sheet have {strains} independent strains, not one");
            }
            Self::NoReciprocity => {
                "reciprocity holds for surfaces with two sides and without openings: of others only the sum of the ratios \
                 tells how they are related"
            }
            Self::NoStrain => "the modes that do not bend the sheet do not strain it either",
            Self::NoBendingMode { locked: true } => {
                "no mode bends the sheet while rigid polygons and locks keep their angles; with a stiffness of the \
                 facets polygons bend"
            }
            Self::NoBendingMode { locked: false } => "no mode bends the sheet",
            Self::OneBendingMode => {
                "one mode strains the sheet and one other bends it; the ratios are opposite only in directions in \
                 which one of these has no shear or twist"
            }
        };
        words.to_owned()
    }
}

impl Poisson {
    /// Finds the ratios of these modes, which are arranged, those without curvature first, with the spaces of the
    /// strains of those and of all curvatures. `length` is the unit of length, `locked` whether some hinges keep their
    /// angles.
    pub(super) fn new(
        sheet: &Sheet,
        (modes, [in_plane, bent]): (&[LinearMode], [TensorSpace; 2]),
        table: &ModeTable,
        locked: bool,
        length: f64,
    ) -> Self {
        let (planar, bending) = modes.split_at(modes.len() - table.curvatures);
        let relation = match (planar.len(), in_plane.dimension(), bent.dimension()) {
            (0, _, 0) => Relation::NoModes,
            (0, ..) => {
                let least = table.curvature_values.last().zip(table.curvature_values.first());
                Relation::NoPlanarMode { least: least.map_or(0.0, |(least, most)| least / most) }
            }
            (_, 0, _) => Relation::NoStrain,
            (_, _, 0) => Relation::NoBendingMode { locked },
            (_, strains, bendings) if (strains == 1 || strains + bendings <= 3) && !is_reciprocal(sheet) => {
                Relation::NoReciprocity
            }
            (_, strains, bendings) if strains + bendings == 3 => {
                Relation::Opposite { strains, four_parallelograms: is_four_parallelograms(sheet) }
            }
            (_, 1, 1) => Relation::OneBendingMode,
            (_, strains, _) => Relation::SeveralPlanarModes { strains },
        };
        let sum = worst((0..DIRECTIONS).filter_map(|k| {
            let angle = PI * k as f64 / DIRECTIONS as f64;
            let (in_plane, bending) = (in_plane.ratio(angle).ok()?, bent.ratio(angle).ok()?);
            Some((in_plane + bending).abs() / larger(1.0, larger(in_plane.abs(), bending.abs())))
        }));
        let neutral_height = neutral_height(planar, bending, length);
        Self { in_plane, bending: bent, relation, sum, neutral_height }
    }
}

/// Whether the rates of folding modes are self stresses of the bars: on surfaces with two sides and without openings.
pub(super) fn is_reciprocal(sheet: &Sheet) -> bool {
    sheet.is_surface() && sheet.holes.is_empty()
}

/// Whether the cell consists of four parallelograms around four vertices.
fn is_four_parallelograms(sheet: &Sheet) -> bool {
    let parallelogram = |corners: &Vec<Corner>| {
        let [a, b, c, d] = corners[..] else { return false };
        let [a, b, c, d] = [a, b, c, d].map(|corner| sheet.position(corner));
        ((b - a) - (c - d)).norm() <= PARALLEL * ((b - a).norm() + (d - a).norm())
    };
    sheet.vertices.len() == 4 && sheet.polygons.len() == 4 && sheet.polygons.iter().all(parallelogram)
}

/// Returns the height at which modes with curvature have the strains of modes without: there `E - 2 z K` of each is
/// one of those.
fn neutral_height(planar: &[LinearMode], bending: &[LinearMode], length: f64) -> Option<f64> {
    let unknowns = 1 + planar.len() * bending.len();
    let mut matrix = DenseMatrix::zeros(3 * bending.len(), unknowns);
    let mut right = DenseMatrix::zeros(3 * bending.len(), 1);
    for (j, mode) in bending.iter().enumerate() {
        let (strain, curvature) = (flat(mode.strain), flat(mode.curvature));
        // a mode with a curvature of 1 per unit of length, times the inverse of that unit: no number has a unit
        for row in 0..3 {
            right[(3 * j + row, 0)] = strain[row] / length;
            matrix[(3 * j + row, 0)] = 2.0 * curvature[row];
        }
        for (k, flat_mode) in planar.iter().enumerate() {
            (0..3).for_each(|row| {
                matrix[(3 * j + row, 1 + planar.len() * j + k)] = flat(flat_mode.strain)[row];
            });
        }
    }
    let found = if bending.is_empty() { return None } else { least_squares(&matrix, &right).ok()? };
    let size = larger(right.amax(), matrix.column(0).amax());
    (found.residual.amax() <= NO_STRAIN * size).then(|| length * found.solution[0])
}
