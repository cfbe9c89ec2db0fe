//! From a sheet back to a mesh that draws its cell in full.

use std::collections::BTreeMap;

use super::Drawn;
use crate::sheet::cell::{Corner, Sheet};

/// The mesh that draws `sheet`: its vertices in their order, then the copies that faces and openings need, by first
/// appearance. [`build`](super::build) makes the same sheet of it.
pub fn draw(sheet: &Sheet) -> Drawn {
    let mut numbers: BTreeMap<Corner, usize> = (0..sheet.vertices.len()).map(|v| (Corner::home(v), v)).collect();
    let mut coords = sheet.vertices.clone();
    let mut number = |corner: &Corner| {
        *numbers.entry(*corner).or_insert_with(|| {
            coords.push(sheet.position(*corner));
            coords.len() - 1
        })
    };
    let mut lists = |of: &[Vec<Corner>]| -> Vec<Vec<usize>> {
        of.iter().map(|corners| corners.iter().map(&mut number).collect()).collect()
    };
    let (faces, holes) = (lists(&sheet.polygons), lists(&sheet.holes));
    Drawn {
        title: sheet.title.clone(),
        description: sheet.description.clone(),
        planar: false,
        coords,
        faces,
        lattice: sheet.lattice,
        holes,
        first: 0,
    }
}
