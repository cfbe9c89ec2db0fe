//! Linear folding modes and self stresses of a cell by symmetry type: even, if a symmetry of the sheet carries them
//! into themselves, or odd, if it reverses their sign.
//!
//! A symmetry carries the rate of an edge to the image of the edge, with the other sign if it turns the sheet over. On
//! the space of the modes it is a map whose square is the identity: its trace is the number of even less that of odd
//! ones.

use super::cell::PeriodicCell;
use super::mode::LinearMode;
use super::stresses::SelfStress;
use crate::numerics::DenseMatrix;
use crate::numerics::dense::least_squares;
use crate::sheet::symmetry::{Symmetry, symmetries};

/// Largest distance of a trace from a whole number.
const WHOLE: f64 = 1e-4;

/// Numbers of modes and self stresses by their type under a symmetry.
#[derive(Clone, Debug, PartialEq)]
pub struct SymmetryTypes {
    /// The symmetry.
    pub symmetry: Symmetry,
    /// Even and odd linear folding modes.
    pub modes: [usize; 2],
    /// Even and odd self stresses of one cell whose lattice is held.
    pub stresses: [usize; 2],
}

/// Counts modes and self stresses under every symmetry of a cell that keeps its locks.
pub(super) fn of_cell(cell: &PeriodicCell, modes: &[LinearMode], stresses: &[SelfStress]) -> Vec<SymmetryTypes> {
    let keeps_locks = |symmetry: &Symmetry| cell.locked.iter().all(|&edge| cell.locked.contains(&symmetry.edges[edge]));
    let rates: Vec<Vec<f64>> = modes.iter().map(|mode| mode.rates.clone()).collect();
    let tensions: Vec<Vec<f64>> =
        stresses.iter().map(|stress| [&stress.tension[..], &stress.torque[..]].concat()).collect();
    let found = symmetries(&cell.sheet).into_iter().filter(keeps_locks);
    let counted = found.map(|symmetry| {
        let side = if symmetry.turns_over { -1.0 } else { 1.0 };
        let edges = symmetry.edges.len();
        let turned = |k: usize| (symmetry.edges[k], side);
        let pulled = |k: usize| match k.checked_sub(edges) {
            None => (symmetry.edges[k], 1.0),
            Some(hinge) => (edges + symmetry.edges[hinge], side),
        };
        let (modes, stresses) = (types(&rates, turned)?, types(&tensions, pulled)?);
        Some(SymmetryTypes { symmetry, modes, stresses })
    });
    counted.flatten().collect()
}

/// Returns the numbers of even and odd vectors in the span of a list, under the map that carries entry `k` to another
/// place with a sign; `None` if the map does not keep the span.
fn types(vectors: &[Vec<f64>], image: impl Fn(usize) -> (usize, f64)) -> Option<[usize; 2]> {
    let Some(length) = vectors.first().map(Vec::len) else { return Some([0, 0]) };
    // of norm 1, since modes of different units may span the space
    let mut span = DenseMatrix::from_fn(length, vectors.len(), |row, column| vectors[column][row]);
    span.column_iter_mut().for_each(|mut vector| {
        vector.normalize_mut();
    });
    let mut moved = DenseMatrix::zeros(length, vectors.len());
    for row in 0..length {
        let (to, sign) = image(row);
        (0..vectors.len()).for_each(|column| moved[(to, column)] = sign * span[(row, column)]);
    }
    let map = least_squares(&span, &moved).ok()?;
    let off = map.residual.norm() / span.norm();
    let trace = map.solution.trace();
    let whole = trace.round();
    let odd = vectors.len() as i64 - whole as i64;
    let fits = off < WHOLE && (trace - whole).abs() < WHOLE && odd >= 0 && odd % 2 == 0;
    fits.then(|| [vectors.len() - odd as usize / 2, odd as usize / 2])
}
