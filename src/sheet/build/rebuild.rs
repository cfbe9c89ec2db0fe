//! The faces of a crease pattern that is drawn by its edges alone.

use std::collections::{BTreeMap, BTreeSet};

use super::planar::faces_of;
use super::{Defect, Drawing};
use crate::sheet::assignment::Assignment;

/// Gives `drawn` the faces that `edges` bound in the plane, without those that are listed as openings and those that
/// the assignments show to be holes.
///
/// # Errors
/// [`Defect`] if two vertices stand at one place, if edges cross or are loose, or if they are not connected.
pub(crate) fn rebuild_faces(drawn: &mut Drawing, edges: &[[usize; 2]]) -> Result<(), Defect> {
    drawn.faces = faces_of(drawn, edges)?;
    drop_openings(drawn);
    drop_holes(drawn);
    Ok(())
}

/// Removes rebuilt faces that are listed as openings.
fn drop_openings(drawn: &mut Drawing) {
    let sorted = |list: &Vec<usize>| {
        let mut list = list.clone();
        list.sort_unstable();
        list
    };
    let holes: Vec<_> = drawn.holes.iter().map(sorted).collect();
    drawn.faces.retain(|face| !holes.contains(&sorted(face)));
}

/// Removes rebuilt faces that the assignments show to be holes: all their sides are boundaries, and every side has a
/// face on its other side.
fn drop_holes(drawn: &mut Drawing) {
    let sorted = |[a, b]: [usize; 2]| [a.min(b), a.max(b)];
    let boundary = drawn.assignments.iter().filter(|(_, assignment)| *assignment == Assignment::Boundary);
    let boundary: BTreeSet<[usize; 2]> = boundary.map(|(ends, _)| sorted(*ends)).collect();
    let sides = |face: &Vec<usize>| -> Vec<[usize; 2]> {
        (0..face.len()).map(|k| sorted([face[k], face[(k + 1) % face.len()]])).collect()
    };
    let mut faces: BTreeMap<[usize; 2], usize> = BTreeMap::new();
    drawn.faces.iter().flat_map(sides).for_each(|side| *faces.entry(side).or_default() += 1);
    drawn.faces.retain(|face| !sides(face).iter().all(|side| boundary.contains(side) && faces[side] == 2));
}
