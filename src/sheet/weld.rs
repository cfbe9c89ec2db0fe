//! Sheets that touch, joined to one assembly: their coincident vertices become one.

use std::collections::BTreeSet;

use super::build::{Drawing, build, draw, merged};
use super::cell::Sheet;
use super::error::Defect;

/// Joins the pieces of a sheet where they touch: vertices that stand at one place become one, and of faces that lie on
/// each other one is kept. Where more than two faces meet then, every two neighbours round the edge have a hinge.
/// Returns the assembly, and the numbers of vertices and faces that it has less. Stiffnesses and named lists of vertices
/// are not kept, since vertices and edges get other numbers.
///
/// ```
/// use foldwell::Sheet;
/// use foldwell::sheet::{fold, welded};
///
/// // three triangles that share a place for an edge
/// let apart = r#"{"vertices_coords": [[0,0,0], [0,1,0], [1,0,0], [0,0,0], [0,1,0], [-1,0,1], [0,0,0], [0,1,0], [-1,0,-1]],
///     "faces_vertices": [[0,2,1], [3,4,5], [6,7,8]]}"#;
/// let (joined, less): (Sheet, [usize; 2]) = welded(&fold::parse(apart, "apart.fold")?)?;
/// assert_eq!((joined.vertices.len(), less), (5, [4, 0]));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`Defect`] if the assembly is no sheet: two corners of a face become one, or faces hang together at a vertex alone.
pub fn welded(sheet: &Sheet) -> Result<(Sheet, [usize; 2]), Defect> {
    let drawn = draw(sheet);
    let (coords, number) = merged(&drawn.coords);
    let moved = |v: &usize| number[*v];
    let pair = |ends: &[usize; 2]| ends.each_ref().map(moved);
    let mut seen = BTreeSet::new();
    let mut faces: Vec<Vec<usize>> = drawn.faces.iter().map(|face| face.iter().map(moved).collect()).collect();
    faces.retain(|face| {
        let mut corners = face.clone();
        corners.sort_unstable();
        seen.insert(corners)
    });
    let less = [number.len() - coords.len(), drawn.faces.len() - faces.len()];
    let joined = Drawing {
        coords,
        faces,
        holes: drawn.holes.iter().map(|hole| hole.iter().map(moved).collect()).collect(),
        assignments: drawn.assignments.iter().map(|(ends, letter)| (pair(ends), *letter)).collect(),
        fold_angles: drawn.fold_angles.iter().map(|(ends, angle)| (pair(ends), *angle)).collect(),
        glue: drawn.glue.iter().map(|(ends, words)| (pair(ends), words.clone())).collect(),
        bars: drawn.bars.iter().map(pair).collect(),
        names: Default::default(),
        ..drawn
    };
    Ok((build(&joined)?, less))
}
