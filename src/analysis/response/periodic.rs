//! The linear modes of a spatially periodic state, and its response.

use super::cell::PeriodicCell;
use super::error::ResponseError;
use super::mode::{Field, LinearMode, ModeTable, RawTable};
use super::poisson::Poisson;
use super::result::{LatticeMotions, Response};
use super::stresses;
use super::symmetry_types;
use super::tensors::mixed_determinant;
use crate::kinematics::metric::LatticeFrame;
use crate::kinematics::{Displacement, Embedding, FoldingModes, folding_modes_with_locked};
use crate::model::Assembly;
use crate::numerics::larger;
use nalgebra::DVector;

/// Computes the response of a spatially periodic state; `self_stresses` is left to be counted.
pub(super) fn response(assembly: &Assembly, cell: &PeriodicCell) -> Result<Response, ResponseError> {
    let CellModes { modes, table, poisson, error } = modes_of(cell)?;
    let lattice = LatticeMotions { chords: cell.lattice.map(Into::into), theta: [0.0; 2], axis: None, curvature: 0.0 };
    let stresses = stresses::of_cell(assembly, cell)?;
    let symmetries = symmetry_types::of_cell(cell, &modes, &stresses);
    Ok(Response { modes, table, lattice, self_stresses: 0, stresses, symmetries, poisson: Some(poisson), error })
}

/// The modes of a cell.
pub(super) struct CellModes {
    modes: Vec<LinearMode>,
    table: ModeTable,
    /// Poisson's ratios of the modes.
    pub poisson: Poisson,
    error: f64,
}

/// Computes the modes of a cell and their Poisson's ratios.
pub(super) fn modes_of(cell: &PeriodicCell) -> Result<CellModes, ResponseError> {
    let found = folding_modes_with_locked(&cell.sheet, &cell.locked)?;
    let embedding = Embedding::new(&cell.sheet)?;
    let mixed = |mix: DVector<f64>| mode(cell, &embedding, &found, mix);
    let basis: Vec<LinearMode> = (0..found.count()).map(|k| mixed(unit(found.count(), k))).collect::<Result<_, _>>()?;
    let raw = RawTable {
        strains: basis.iter().map(|mode| mode.strain).collect(),
        curvatures: basis.iter().map(|mode| mode.curvature).collect(),
        length: cell.area().sqrt(),
    };
    let disagreement = basis.iter().map(|mode| match &mode.field {
        Field::OfCells(field) => field.disagreement,
        Field::OfCoordinates(_) => 0.0,
    });
    let error = larger(disagreement.fold(0.0, larger), defect_of_reciprocity(&raw));
    let arranged = raw.arranged(larger(error, found.gap.recip()))?;
    let columns = arranged.amplitudes.column_iter();
    let modes: Vec<LinearMode> = columns.map(|mix| mixed(mix.into_owned())).collect::<Result<_, _>>()?;
    let table = raw.ranks()?;
    let spaces = [arranged.in_plane, arranged.bending];
    let poisson = Poisson::new(&cell.sheet, (&modes, spaces), &table, !cell.locked.is_empty(), raw.length);
    Ok(CellModes { modes, table, poisson, error })
}

fn unit(count: usize, k: usize) -> DVector<f64> {
    DVector::from_fn(count, |row, _| f64::from(u8::from(row == k)))
}

/// Returns the mode with these amplitudes along the basis.
fn mode(
    cell: &PeriodicCell,
    embedding: &Embedding,
    found: &FoldingModes,
    mix: DVector<f64>,
) -> Result<LinearMode, ResponseError> {
    let rates = (&found.basis * &mix).as_slice().to_vec();
    let curvature = &found.curvatures * &mix;
    let field = Displacement::new(embedding, embedding.drawn_angles(), &rates);
    let moving = field.lattice.ok_or(ResponseError::NotPeriodic)?;
    let chords = [0, 1].map(|a| moving[a].twist.at(&cell.lattice[a]));
    Ok(LinearMode {
        rates,
        strain: LatticeFrame::new(&cell.lattice).strain_rate(&cell.lattice, &chords),
        curvature: [curvature[0], curvature[1], curvature[2]],
        lattice_rotations: moving.map(|moving| moving.twist.angular),
        field: Field::OfCells(Box::new(field)),
    })
}

/// Returns the largest `cof(K') : E - cof(K) : E'` of two modes of norm 1.
///
/// It is zero: the rates of a mode are a self stress of the bars, its forces on the lattice are `cof(K)/2` and its
/// moments `-cof(E)/2`, and a self stress does no work on the other mode.
fn defect_of_reciprocity(raw: &RawTable) -> f64 {
    let pairs = (0..raw.strains.len()).flat_map(|a| (0..a).map(move |b| (a, b)));
    let defect = |(a, b): (usize, usize)| {
        mixed_determinant(raw.curvatures[b], raw.strains[a]) - mixed_determinant(raw.curvatures[a], raw.strains[b])
    };
    pairs.map(|pair| (raw.length * defect(pair)).abs()).fold(0.0, larger)
}
