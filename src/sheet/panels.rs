//! Panels: quadrilaterals with a vertex at their centre, as the bar-and-hinge model N5B8 has them.

use std::collections::BTreeMap;

use super::assignment::Assignment;
use super::build::{build, draw};
use super::cell::{Corner, EdgeKey, EdgeKind, Panel, Sheet};
use super::error::Defect;
use crate::math::Vec3;

/// Least distance, relative to the length of a diagonal, of its crossing with the other one from its ends: up to this
/// the quadrilateral has a straight corner.
const STRAIGHT: f64 = 1e-6;

/// Relative difference of two lengths up to which they count as equal.
const TIE: f64 = 1e-9;

impl Panel {
    /// Returns the edges of each triangle in turn: from the centre to its first corner, and from that one to its
    /// second.
    pub(crate) fn edges(&self, sheet: &Sheet) -> [[EdgeKey; 2]; 4] {
        self.triangles.map(|triangle| {
            let triangle = &sheet.triangles[triangle];
            let at = triangle.corners.iter().position(|corner| corner.vertex == self.centre).unwrap_or_default();
            [0, 1].map(|next| triangle.sides()[(at + next) % 3].key)
        })
    }
}

/// Gives every quadrilateral of a sheet whose diagonals cross a vertex there, from which four facets lead to its
/// corners. Where the corners are not in a plane, the vertex is on the shorter diagonal, where the longer one is
/// closest to it; so the panel is drawn bent along the shorter one. Other faces stay as they are. Vertices keep their
/// numbers; the new ones follow them.
///
/// Quadrilaterals that have a centre already, a vertex with four facets and no other edge, are panels too.
///
/// ```
/// use foldwell::sheet::{Pattern, generate, with_centres};
///
/// let miura = with_centres(&generate(&Pattern::named("miura")?)?)?;
/// assert_eq!((miura.vertices.len(), miura.triangles.len(), miura.panels.len()), (4 + 4, 16, 4));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// Source: E. T. Filipov, K. Liu, T. Tachi, M. Schenk and G. H. Paulino, Int. J. Solids Struct. 124, 26 (2017), model
/// N5B8; panels that are not plane as in K. Liu and G. H. Paulino, MERLIN2, Origami 7 (2018).
///
/// # Errors
/// [`Defect`] if a new vertex stands where a vertex of the sheet, or a copy of one, is.
pub fn with_centres(sheet: &Sheet) -> Result<Sheet, Defect> {
    let mut drawn = draw(sheet);
    let faces = std::mem::take(&mut drawn.faces);
    for face in faces {
        let corners: Vec<Vec3> = face.iter().map(|&corner| drawn.coords[corner]).collect();
        let Some(crossing) = <[Vec3; 4]>::try_from(corners).ok().and_then(crossing) else {
            drawn.faces.push(face);
            continue;
        };
        let centre = drawn.coords.len();
        drawn.coords.push(crossing);
        drawn.faces.extend((0..4).map(|k| vec![face[k], face[(k + 1) % 4], centre]));
        drawn.assignments.extend(face.iter().map(|&corner| ([corner, centre], Assignment::Join)));
    }
    let mut centred = build(&drawn)?;
    (centred.stiffness, centred.record) = (sheet.stiffness.clone(), sheet.record.clone());
    centred.panels = panels(&centred);
    Ok(centred)
}

/// Returns the point of the shorter diagonal that is closest to the other one; `None` if it is not between the corners.
/// In a tie it is on the diagonal through the corner that is listed first.
fn crossing([a, b, c, d]: [Vec3; 4]) -> Option<Vec3> {
    let (first, second, offset) = (c - a, d - b, b - a);
    let squares = [first, second].map(|diagonal| diagonal.norm_squared());
    let along = [first, second].map(|diagonal| diagonal.dot(&offset));
    let product = first.dot(&second);
    let at = [squares[1] * along[0] - product * along[1], product * along[0] - squares[0] * along[1]];
    let [on_first, on_second] = at.map(|part| part / (squares[0] * squares[1] - product * product));
    let inside = |part: f64| part > STRAIGHT && part < 1.0 - STRAIGHT;
    let crossing = if squares[0] <= squares[1] * (1.0 + TIE) { a + first * on_first } else { b + second * on_second };
    (inside(on_first) && inside(on_second)).then_some(crossing)
}

/// A triangle at a vertex: its number, and its other two corners in the frame in which the vertex stands in cell (0,
/// 0).
type Flank = (usize, [Corner; 2]);

/// Returns the panels of a sheet, by the vertices that have four facets and no other edge.
fn panels(sheet: &Sheet) -> Vec<Panel> {
    let mut edges = vec![[0, 0]; sheet.vertices.len()];
    for edge in &sheet.edges {
        for end in edge.key.ends() {
            edges[end.vertex][usize::from(edge.kind != EdgeKind::Facet)] += 1;
        }
    }
    let mut flanks: BTreeMap<usize, Vec<Flank>> = BTreeMap::new();
    for (number, triangle) in sheet.triangles.iter().enumerate() {
        for k in 0..3 {
            let [centre, from, to] = [0, 1, 2].map(|next| triangle.corners[(k + next) % 3]);
            if edges[centre.vertex] == [4, 0] {
                let corners = [from, to].map(|corner| corner.translated(centre.shift.map(|n| -n)));
                flanks.entry(centre.vertex).or_default().push((number, corners));
            }
        }
    }
    flanks.iter().filter_map(|(&centre, flanks)| Some(Panel { centre, triangles: round(flanks)? })).collect()
}

/// Returns the triangles round a vertex in their order; `None` if they are not four that close.
fn round(flanks: &[Flank]) -> Option<[usize; 4]> {
    let mut ring = vec![*flanks.first()?];
    while ring.len() < flanks.len() {
        let end = ring[ring.len() - 1].1[1];
        ring.push(*flanks.iter().find(|(_, corners)| corners[0] == end)?);
    }
    ring.iter().map(|(number, _)| *number).collect::<Vec<_>>().try_into().ok()
}

impl Sheet {
    /// Returns the number of the face that each polygon is, if the triangles of a panel are counted as one face: that
    /// of the mesh before its quadrilaterals had centres.
    pub(crate) fn faces(&self) -> Vec<usize> {
        let mut first: Vec<usize> = (0..self.polygons.len()).collect();
        for panel in &self.panels {
            let polygons = panel.triangles.map(|triangle| self.triangles[triangle].polygon);
            let lowest = polygons.into_iter().fold(usize::MAX, usize::min);
            polygons.iter().for_each(|&polygon| first[polygon] = lowest);
        }
        let mut count = 0;
        for polygon in 0..first.len() {
            let is_new = first[polygon] == polygon;
            first[polygon] = if is_new { count } else { first[first[polygon]] };
            count += usize::from(is_new);
        }
        first
    }

    /// Returns the corners of the face of which each polygon is a part: those of the polygon and, if it is a triangle
    /// of a panel, of the others, in its frame.
    pub(crate) fn outlines(&self) -> Vec<Vec<Corner>> {
        let mut outlines = self.polygons.clone();
        for panel in &self.panels {
            let triangles = panel.triangles.map(|triangle| &self.triangles[triangle]);
            let is_centre = |corner: &&Corner| corner.vertex == panel.centre;
            let frames = triangles.map(|t| t.corners.iter().find(is_centre).map_or([0, 0], |corner| corner.shift));
            for (triangle, [n1, n2]) in triangles.iter().zip(frames) {
                for (other, [m1, m2]) in triangles.iter().zip(frames) {
                    let in_frame = other.corners.map(|corner| corner.translated([n1 - m1, n2 - m2]));
                    outlines[triangle.polygon].extend(in_frame);
                }
            }
        }
        outlines
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Claim: diagonals cross where they meet; of a quadrilateral that is not plane, on the shorter one, in a tie on
    /// that of the first corner; an arrowhead and a triangle with a fourth corner on a side have no crossing. Source:
    /// by hand. Tolerance: rounding.
    #[test]
    fn crossings() {
        let at = |corners: [[f64; 3]; 4]| crossing(corners.map(Vec3::from)).map(<[f64; 3]>::from);
        let close = |found: Option<[f64; 3]>, expected: [f64; 3]| {
            let found = found.unwrap();
            assert!((0..3).all(|k| (found[k] - expected[k]).abs() < 1e-15), "{found:?}, not {expected:?}");
        };
        close(at([[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [4.0, 2.0, 0.0], [0.0, 2.0, 0.0]]), [2.0, 1.0, 0.0]);
        close(at([[0.0, 0.0, 0.0], [3.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]]), [0.75, 0.75, 0.0]);
        close(at([[-1.0, 0.0, 0.0], [0.0, -2.0, 1.0], [1.0, 0.0, 0.0], [0.0, 2.0, 1.0]]), [0.0, 0.0, 0.0]);
        close(at([[0.0, -2.0, 1.0], [1.0, 0.0, 0.0], [0.0, 2.0, 1.0], [-1.0, 0.0, 0.0]]), [0.0, 0.0, 0.0]);
        close(at([[-1.0, 0.0, 0.0], [0.0, -1.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 1.0]]), [0.0, 0.0, 0.0]);
        assert_eq!(at([[0.0, 0.0, 0.0], [4.0, -1.0, 0.0], [1.0, 0.0, 0.0], [4.0, 1.0, 0.0]]), None);
        assert_eq!(at([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0], [1.0, 2.0, 0.0]]), None);
    }
}
