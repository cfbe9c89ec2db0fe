//! Self stresses of a cell whose lattice is held, and the forces and moments that they put on the lattice.
//!
//! A self stress is a set of tensions of the bars, and of torques of the hinges that keep their angles, in balance at
//! every vertex. Its work on a strain `E` and a curvature `K` of the lattice, per area of the cell, is `force . E +
//! moment . K`: these are the strains and bendings that a sheet with this stress resists.

use super::cell::PeriodicCell;
use super::compatibility::rates;
use super::error::ResponseError;
use crate::model::Assembly;
use crate::numerics::DenseMatrix;
use crate::numerics::dense::{DenseError, full_svd, null_space_of_sums};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A self stress of one cell whose lattice is held, of norm 1 with torques over the root of the cell's area.
/// Summaries have what it does to the lattice alone.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(rename = "StressSummary")]
pub struct SelfStress {
    /// Tension of the bar along every edge of the cell.
    #[serde(skip)]
    pub tension: Vec<f64>,
    /// Torque of every hinge that keeps its angle; zero for the others.
    #[serde(skip)]
    pub torque: Vec<f64>,
    /// Work on strains `[e11, e22, e12]`, per area of the cell.
    pub force: [f64; 3],
    /// Work on curvatures `[k11, k22, k12]`, per area of the cell.
    pub moment: [f64; 3],
}

/// Returns an orthonormal basis of the self stresses, by falling [work](ordered_by_work); `assembly` is the one of the
/// cell, with rigid terms alone.
pub(super) fn of_cell(assembly: &Assembly, cell: &PeriodicCell) -> Result<Vec<SelfStress>, ResponseError> {
    let elements = cell.elements(assembly, &cell.model);
    let rates = rates(cell, &elements);
    let null = null_space_of_sums(&rates.by_vertices.transpose(), rates.terms)?;
    let (edges, area) = (cell.sheet.edges.len(), cell.area());
    let length = area.sqrt();
    let basis = ordered_by_work(&null.basis, &rates.by_lattice, length)?;
    let stress = |values: &[f64]| {
        let (mut tension, mut torque) = (vec![0.0; edges], vec![0.0; edges]);
        let mut work = [0.0; 6];
        for (row, (element, value)) in elements.iter().zip(values).enumerate() {
            let edge = assembly.tiling().edges[element.edge].edge;
            if element.element.is_angle() {
                torque[edge] += length * value
            } else {
                tension[edge] += value
            }
            work.iter_mut().enumerate().for_each(|(k, work)| *work += value * rates.by_lattice[(row, k)] / area);
        }
        SelfStress { tension, torque, force: [work[0], work[1], work[2]], moment: [work[3], work[4], work[5]] }
    };
    Ok(basis.column_iter().map(|values| stress(values.as_slice())).collect())
}

/// Returns the orthonormal basis of the same space whose forces and moments are orthogonal too, moments divided by this
/// length: the right singular vectors of these six numbers, by falling singular value. The largest number of each is
/// positive. Stresses that do no work come last. Where singular values are equal the basis is any.
fn ordered_by_work(basis: &DenseMatrix, by_lattice: &DenseMatrix, length: f64) -> Result<DenseMatrix, DenseError> {
    let mut work = by_lattice.transpose() * basis;
    (3..6).for_each(|k| work.row_mut(k).unscale_mut(length));
    let rotation = full_svd(&work)?.v;
    let (mut ordered, work) = (basis * &rotation, work * rotation);
    for (mut stress, work) in ordered.column_iter_mut().zip(work.column_iter()) {
        let close = (1.0 - 1e-6) * work.amax();
        if work.iter().find(|work| work.abs() >= close).is_some_and(|largest| *largest < 0.0) {
            stress.neg_mut();
        }
    }
    Ok(ordered)
}
