//! The faces of a crease pattern that is drawn by its edges alone.
//!
//! A pattern that stands upright, as in the plane of x and z that Origami Simulator uses, is seen from the side to
//! which the normal of its plane has its positive component of largest magnitude; all others are seen along z.

use std::collections::BTreeSet;

use super::planar::faces_of;
use super::{Defect, Drawing};
use crate::math::Vec3;
use crate::sheet::assignment::Assignment;
use crate::sheet::sides::{sides, sorted, uses_of_sides};

/// Largest distance of a vertex from the plane of an upright pattern, relative to its extent.
const FLAT: f64 = 1e-6;

/// Largest component along z of the unit normal of an upright pattern.
const UPRIGHT: f64 = 0.5;

/// Gives `drawn` the faces that `edges` bound in the plane, without those that are listed as openings and those that
/// the assignments show to be holes; returns the number of these.
pub(crate) fn rebuild_faces(drawn: &mut Drawing, edges: &[[usize; 2]]) -> Result<usize, Defect> {
    drawn.faces = match laid_down(&drawn.coords) {
        Some(coords) => faces_of(&Drawing { coords, ..drawn.clone() }, edges)?,
        None => faces_of(drawn, edges)?,
    };
    drop_openings(drawn);
    let faces = drawn.faces.len();
    drop_holes(drawn);
    Ok(faces - drawn.faces.len())
}

/// Returns the points of a plane that stands upright as points of the plane of x and y; `None` if they are none.
fn laid_down(coords: &[Vec3]) -> Option<Vec<Vec3>> {
    let origin = *coords.first()?;
    let longer = |a: Vec3, b: Vec3| if b.norm_squared() > a.norm_squared() { b } else { a };
    let along = coords.iter().map(|x| x - origin).fold(Vec3::zeros(), longer);
    let normal = coords.iter().map(|x| along.cross(&(x - origin))).fold(Vec3::zeros(), longer).try_normalize(0.0)?;
    let off = coords.iter().map(|x| normal.dot(&(x - origin)).abs()).fold(0.0, f64::max);
    if normal.z.abs() > UPRIGHT || !(off <= FLAT * along.norm()) {
        return None;
    }
    let normal = if normal[normal.iamax()] < 0.0 { -normal } else { normal };
    let right = normal.cross(&along).cross(&normal).normalize();
    let up = normal.cross(&right);
    Some(coords.iter().map(|x| x - origin).map(|x| Vec3::new(right.dot(&x), up.dot(&x), 0.0)).collect())
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
    let boundary = drawn.assignments.iter().filter(|(_, assignment)| *assignment == Assignment::Boundary);
    let boundary: BTreeSet<[usize; 2]> = boundary.map(|(ends, _)| sorted(*ends)).collect();
    let faces = uses_of_sides(&drawn.faces);
    let is_shared = |side: [usize; 2]| boundary.contains(&side) && faces[&side] == 2;
    drawn.faces.retain(|face| !sides(face).map(sorted).all(is_shared));
}
