//! Patches: every cell has the same rest angles, held along the linear folding modes of the cell.

use super::{HeldSheet, LandscapeError};
use crate::kinematics::{Displacement, Embedding, FoldingModes, KinematicsError, folding_modes_with_locked};
use crate::model::Gauge;
use crate::model::assemble::{Boundary, Drawn, Terms, assemble};
use crate::sheet::{Corner, EdgeKind, Sheet, Tiling};

impl HeldSheet {
    /// The patch of these terms; their rest angles are not read, those drawn take their place.
    ///
    /// Fails where the modes are not known.
    pub fn patch(sheet: &Sheet, tiling: &Tiling, terms: &Terms, drawn: &[f64]) -> Result<Self, LandscapeError> {
        let locked = rigid_facets(sheet, terms);
        let modes = folding_modes_with_locked(sheet, &locked)?;
        let terms = at_rest_as_drawn(terms, drawn);
        let model = assemble(&Drawn::new(sheet, tiling, Boundary::Patch), tiling, &terms, Gauge::Held);
        let moving = (modes.basis.clone(), motions(sheet, tiling.cells, &modes)?);
        let mut held = Self::new(model, moving, &locked, |edge| tiling.edges[edge].edge)?;
        held.bending = Some(modes);
        Ok(held)
    }
}

/// Diagonals of the cell's polygons where these are rigid.
pub fn rigid_facets(sheet: &Sheet, terms: &Terms) -> Vec<usize> {
    let rigid = terms.facets.as_ref().is_some_and(|hinges| hinges.stiffness.is_infinite());
    (0..sheet.edges.len()).filter(|&edge| rigid && sheet.edges[edge].kind == EdgeKind::Facet).collect()
}

/// The terms with all hinges at rest as drawn.
pub(super) fn at_rest_as_drawn(terms: &Terms, drawn: &[f64]) -> Terms {
    let mut terms = terms.clone();
    for hinges in [&mut terms.creases, &mut terms.facets].into_iter().flatten() {
        hinges.rest = drawn.to_vec();
    }
    terms
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
