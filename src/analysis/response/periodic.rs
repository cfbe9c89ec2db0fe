//! The linear modes of a spatially periodic state, and its response.
//!
//! The modes are the motions of the vertices of the cell together with a strain and a curvature of the lattice that
//! keep every length and every held angle ([`super::compatibility`]), for any assembly. Those of a surface obey
//! reciprocity, which no equation here asks for.

use super::cell::PeriodicCell;
use super::compatibility::{MACROSCOPIC, lattice_motions, rates, units};
use super::cylinder::hinges_of;
use super::error::ResponseError;
use super::mode::{Field, LinearMode, RawTable};
use super::poisson::{Poisson, is_reciprocal};
use super::result::{LatticeMotions, Response};
use super::tensors::mixed_determinant;
use super::{stresses, symmetry_types};
use crate::math::Vec3;
use crate::model::Assembly;
use crate::numerics::dense::{full_svd, null_space_of_sums};
use crate::numerics::{DenseMatrix, larger};
use std::iter;

/// Largest change of lengths over the root of the cell's area, or of held angles in radians, by motions of norm 1 that
/// count as modes: more is no rounding error. Next to a flat state motions that are none change lengths by as little.
const LARGEST_CHANGE: f64 = 3e-10;
/// Smallest folding in radians of a motion of norm 1, lengths over the root of the cell's area, that is no rounding
/// error.
const FOLDS: f64 = 1e-9;

/// Computes the response of a spatially periodic state; `self_stresses` is left to be counted.
pub(super) fn response(assembly: &Assembly, cell: &PeriodicCell) -> Result<Response, ResponseError> {
    let modes = modes_of(assembly, cell)?;
    let lattice = LatticeMotions { chords: cell.lattice.map(Into::into), ..LatticeMotions::default() };
    let stresses = stresses::of_cell(assembly, cell)?;
    let symmetries = symmetry_types::of_cell(cell, &modes.modes, &stresses);
    Ok(Response { lattice, stresses, symmetries, ..modes })
}

/// Computes the part of the response that is modes of a cell and their Poisson's ratios; `assembly` is the one of the
/// cell, with rigid terms alone.
pub(super) fn modes_of(assembly: &Assembly, cell: &PeriodicCell) -> Result<Response, ResponseError> {
    let basis = Basis::new(assembly, cell)?;
    let raw = basis.table();
    let mut error = basis.error;
    if is_reciprocal(&cell.sheet) {
        error = larger(error, defect_of_reciprocity(&raw));
    }
    let arranged = raw.arranged(error)?;
    let modes: Vec<LinearMode> = (0..arranged.amplitudes.ncols())
        .map(|k| basis.mode(cell, &arranged.amplitudes.columns(k, 1).into_owned()))
        .collect();
    let table = raw.ranks()?;
    let spaces = [arranged.in_plane, arranged.bending];
    let poisson = Poisson::new(&cell.sheet, (&modes, spaces), &table, !cell.locked.is_empty(), raw.length);
    Ok(Response { modes, table, poisson: Some(poisson), error, ..Response::default() })
}

/// A basis of the modes of a cell, orthonormal in the rates of its fold angles; where motions fold nothing, as those of
/// a truss, orthonormal in the motions.
struct Basis {
    /// Velocities of all vertices but the first, strain and curvature in their norm, a column for each mode.
    motions: DenseMatrix,
    /// Rates of the fold angles of the cell's edges.
    folds: DenseMatrix,
    /// Unit of length, the root of the cell's area.
    length: f64,
    /// Error of the modes: what they change of lengths and held angles, or what rounding may mix into them.
    error: f64,
}

impl Basis {
    fn new(assembly: &Assembly, cell: &PeriodicCell) -> Result<Self, ResponseError> {
        let length = cell.area().sqrt();
        let held = rates(cell, &cell.elements(assembly, &cell.model));
        let rows = held.by_motions(length);
        let null = null_space_of_sums(&rows, held.terms)?;
        let change = null.singular_values.get(null.rank).copied().unwrap_or(0.0);
        if change > LARGEST_CHANGE {
            return Err(ResponseError::UnclearModes { change });
        }
        let hinges = hinges_of(assembly);
        let elements = cell.elements(assembly, &hinges);
        let mut folding = DenseMatrix::zeros(cell.sheet.edges.len(), rows.ncols());
        for (element, row) in elements.iter().zip(rates(cell, &elements).by_motions(length).row_iter()) {
            folding.set_row(assembly.tiling().edges[element.edge].edge, &row);
        }
        let mut motions = null.basis;
        let folded = full_svd(&(&folding * &motions))?;
        let least = motions.ncols().checked_sub(1).and_then(|last| folded.singular_values.get(last));
        if least.is_some_and(|least| *least > FOLDS) {
            motions *= &folded.v;
            motions.column_iter_mut().zip(&folded.singular_values).for_each(|(mut mode, value)| mode /= *value);
        }
        let error = larger((rows * &motions).amax(), null.gap.recip());
        Ok(Self { folds: folding * &motions, motions, length, error })
    }

    /// The strain and the curvature of a motion.
    fn tensors(&self, motion: &[f64]) -> [f64; MACROSCOPIC] {
        let (units, tensors) = (units(self.length), &motion[motion.len() - MACROSCOPIC..]);
        [0, 1, 2, 3, 4, 5].map(|k| tensors[k] / units[k])
    }

    fn table(&self) -> RawTable {
        let (strains, curvatures) = (0..self.motions.ncols())
            .map(|k| self.tensors(self.motions.column(k).as_slice()))
            .map(|[e11, e22, e12, k11, k22, k12]| ([e11, e22, e12], [k11, k22, k12]))
            .unzip();
        RawTable { strains, curvatures, length: self.length }
    }

    /// Returns the mode with these amplitudes.
    fn mode(&self, cell: &PeriodicCell, amplitudes: &DenseMatrix) -> LinearMode {
        let motion = &self.motions * amplitudes;
        let tensors = self.tensors(motion.as_slice());
        let [e11, e22, e12, k11, k22, k12] = tensors;
        let others = motion.as_slice().chunks_exact(3).map(|rates| self.length * Vec3::from_column_slice(rates));
        let velocities = iter::once(Vec3::zeros()).chain(others);
        let vertices = cell.sheet.vertices.iter().zip(velocities).map(|(place, velocity)| [*place, velocity]).collect();
        let lattice = lattice_motions(cell, tensors);
        LinearMode {
            rates: (&self.folds * amplitudes).as_slice().to_vec(),
            strain: [e11, e22, e12],
            curvature: [k11, k22, k12],
            lattice_rotations: lattice.map(|moving| moving.twist.angular),
            field: Field::OfCells { vertices, lattice: Box::new(lattice) },
        }
    }
}

/// Returns the largest `cof(K') : E - cof(K) : E'` of two modes of norm 1.
///
/// It is zero for surfaces: the rates of a mode are a self stress of the bars, its forces on the lattice are `cof(K)/2`
/// and its moments `-cof(E)/2`, and a self stress does no work on the other mode.
fn defect_of_reciprocity(raw: &RawTable) -> f64 {
    let pairs = (0..raw.strains.len()).flat_map(|a| (0..a).map(move |b| (a, b)));
    let defect = |(a, b): (usize, usize)| {
        mixed_determinant(raw.curvatures[b], raw.strains[a]) - mixed_determinant(raw.curvatures[a], raw.strains[b])
    };
    pairs.map(|pair| (raw.length * defect(pair)).abs()).fold(0.0, larger)
}
