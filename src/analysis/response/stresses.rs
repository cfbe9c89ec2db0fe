//! Self stresses of a cell whose lattice is held, and the forces and moments that they put on the lattice.
//!
//! A self stress is a set of tensions of the bars, and of torques of the hinges that keep their angles, in balance at
//! every vertex. Its work on a strain `E` and a curvature `K` of the lattice, per area of the cell, is `force . E +
//! moment . K`: these are the strains and bendings that a sheet with this stress resists.

use super::cell::PeriodicCell;
use super::compatibility::rates;
use super::error::ResponseError;
use crate::model::Assembly;
use crate::numerics::dense::null_space;

/// A self stress of one cell whose lattice is held, of norm 1.
#[derive(Clone, Debug, PartialEq)]
pub struct SelfStress {
    /// Tension of the bar along every edge of the cell.
    pub tension: Vec<f64>,
    /// Torque of every hinge that keeps its angle; zero for the others.
    pub torque: Vec<f64>,
    /// Work per area of the cell for each component `[e11, e22, e12]` of the strain.
    pub force: [f64; 3],
    /// Work per area of the cell for each component `[k11, k22, k12]` of the curvature tensor.
    pub moment: [f64; 3],
}

/// Returns an orthonormal basis of the self stresses; `assembly` is the one of the cell, with rigid terms alone.
///
/// # Errors
/// [`ResponseError::Decomposition`] where their number is not clear.
pub(super) fn of_cell(assembly: &Assembly, cell: &PeriodicCell) -> Result<Vec<SelfStress>, ResponseError> {
    let elements = cell.elements(assembly);
    let rates = rates(cell, &elements);
    let null = null_space(&rates.by_vertices.transpose())?;
    let (edges, area) = (cell.sheet.edges.len(), cell.area());
    let stress = |values: &[f64]| {
        let (mut tension, mut torque) = (vec![0.0; edges], vec![0.0; edges]);
        let mut work = [0.0; 6];
        for (row, (element, value)) in elements.iter().zip(values).enumerate() {
            let edge = assembly.tiling().edges[element.term.edge(element.number)].edge;
            if element.term.is_angle() {
                torque[edge] += value
            } else {
                tension[edge] += value
            }
            work.iter_mut().enumerate().for_each(|(k, work)| *work += value * rates.by_lattice[(row, k)] / area);
        }
        SelfStress { tension, torque, force: [work[0], work[1], work[2]], moment: [work[3], work[4], work[5]] }
    };
    Ok(null.basis.column_iter().map(|values| stress(values.as_slice())).collect())
}
