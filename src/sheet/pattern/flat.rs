//! The flat drawing of a sheet, as files of lines need it.

use std::ops::Neg;

use crate::math::bounds;
use crate::sheet::assignment::Assignment;
use crate::sheet::build::{draw, drawn_sides, edges_by_drawn_name, sides_seen};
use crate::sheet::cell::{Corner, EdgeKey, Sheet};

/// Largest difference in z, relative to the extent, of a sheet that counts as flat.
const FLAT: f64 = 1e-9;

/// The reason why a sheet is not a crease pattern that lines can draw.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[allow(missing_docs)] // each variant is documented by its message
pub enum NotFlat {
    #[error("a crease pattern is flat, and the vertices of this sheet lie between z = {low} and z = {high}")]
    Raised { low: f64, high: f64 },
    #[error("the sheet is periodic, and files of lines have no lattice vectors")]
    Periodic,
    #[error("the sheet is folded flat: some of its faces lie upside down")]
    FoldedFlat,
}

/// An edge of a flat sheet: its ends, letter and target angle in radians.
pub(super) struct FlatEdge {
    pub ends: [[f64; 2]; 2],
    pub letter: Assignment,
    pub target: Option<f64>,
}

/// Returns the drawn edges of a flat sheet in the order of its file; diagonals of polygons only where the file lists
/// them. They are seen from above: where faces look down mountains are valleys. A crease with a target angle is a mountain
/// or a valley, whatever its letter.
pub(super) fn edges(sheet: &Sheet) -> Result<Vec<FlatEdge>, NotFlat> {
    check(sheet)?;
    let drawn = draw(sheet);
    let [above, below] = sides_seen(&drawn);
    if above && below {
        return Err(NotFlat::FoldedFlat);
    }
    let known = edges_by_drawn_name(sheet);
    let sides = drawn_sides(&drawn).into_iter().map(|(ends, _)| ends.map(Corner::home));
    let list: Vec<[Corner; 2]> =
        if sheet.listed_edges.is_empty() { sides.collect() } else { sheet.listed_edges.clone() };
    let edge = |[a, b]: [Corner; 2]| {
        let number = *known.get(&EdgeKey::new(a, b).0)?.first()?;
        let edge = &sheet.edges[number];
        let ends = [a, b].map(|end| sheet.position(end)).map(|x| [x.x, x.y]);
        let is_cut = known[&EdgeKey::new(a, b).0].len() > 1;
        let letter = if is_cut { Assignment::Cut } else { sheet.assignment(edge) };
        let target = sheet.targets.get(&edge.key).copied();
        let (letter, target) = if below { (letter.seen_from_behind(), target.map(f64::neg)) } else { (letter, target) };
        let has_fold = |target: f64| target != 0.0 && matches!(letter, Assignment::Flat | Assignment::Unassigned);
        let letter = target.filter(|target| has_fold(*target)).map_or(letter, Assignment::of_side);
        Some(FlatEdge { ends, letter, target })
    };
    Ok(list.into_iter().filter_map(edge).collect())
}

fn check(sheet: &Sheet) -> Result<(), NotFlat> {
    if sheet.is_repeated() {
        return Err(NotFlat::Periodic);
    }
    let [low, high] = bounds(&sheet.vertices);
    if high.z - low.z > FLAT * (high - low).max() {
        return Err(NotFlat::Raised { low: low.z, high: high.z });
    }
    Ok(())
}
