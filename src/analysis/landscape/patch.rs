//! Patches: every cell has the same rest angles, held along the linear folding modes of the cell.

use super::{HeldSheet, LandscapeError};
use crate::kinematics::{Displacement, Embedding, FoldingModes, KinematicsError, folding_modes_with_locked};
use crate::model::Assembly;
use crate::sheet::{Corner, Sheet};

impl HeldSheet {
    /// A patch; the rest angles of its terms are not read, those drawn take their place.
    ///
    /// # Errors
    /// [`LandscapeError`] where the modes are not known.
    pub fn patch(assembly: &Assembly) -> Result<Self, LandscapeError> {
        let (sheet, tiling) = (assembly.sheet(), assembly.tiling());
        let locked = assembly.rigid_facets_of_cell();
        let modes = folding_modes_with_locked(sheet, &locked)?;
        let moving = (modes.basis.clone(), motions(sheet, tiling.cells, &modes)?);
        let mut held = Self::at_drawn_angles(assembly, moving, &locked, |edge| tiling.edges[edge].edge)?;
        held.bending = Some(modes);
        Ok(held)
    }
}

/// Velocities of all coordinates of the patch, for every mode.
fn motions(sheet: &Sheet, cells: [usize; 2], modes: &FoldingModes) -> Result<Vec<Vec<f64>>, KinematicsError> {
    let embedding = Embedding::new(sheet)?;
    let corner = |k: usize| {
        let (cell, vertex) = (k / sheet.vertices.len(), k % sheet.vertices.len());
        Corner { vertex, shift: [(cell % cells[0]) as i32, (cell / cells[0]) as i32] }
    };
    let count = cells[0] * cells[1] * sheet.vertices.len();
    let motion = |rates: &[f64]| {
        let moving = Displacement::new(&embedding, embedding.drawn_angles(), rates);
        (0..count).flat_map(|k| <[f64; 3]>::from(moving.corner(corner(k)).1)).collect()
    };
    Ok(modes.basis.column_iter().map(|mode| motion(mode.as_slice())).collect())
}
