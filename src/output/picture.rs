//! A state of a sheet to be drawn or written: points, triangles, lines and the quantities on them.

use super::error::ShapeError;

use crate::analysis::shown_cells::ShownCells;
use crate::analysis::state::State;
use crate::math::Vec3;
use crate::model::{Assembly, Drawn};
use crate::sheet::{Assignment, Corner, EdgeKey, EdgeKind, Sheet};
use std::collections::{BTreeMap, HashMap};

/// A state of a sheet as a mesh, in which copies of vertices in other cells are points of their own.
///
/// Arrays on lines have one entry for each line, NaN where a quantity is not defined.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Picture {
    /// Positions of the points in this state.
    pub points: Vec<Vec3>,
    /// Position in this state minus position in the drawn state, for each point.
    pub displacement: Vec<Vec3>,
    /// Vertex of the sheet's cell, and the cell counted from the first one shown, of which each point is the copy.
    pub places: Vec<(usize, [i32; 2])>,
    /// Points at the corners of each triangle, counter-clockwise seen from the side of the face normals.
    pub triangles: Vec<[usize; 3]>,
    /// 1 for triangles that pass through another one, 0 for the others; all 0 if self-intersection was not tested.
    pub self_intersecting: Vec<u8>,
    /// Points at the ends of each edge.
    pub lines: Vec<[usize; 2]>,
    /// Kind of each edge: crease, facet or boundary.
    pub line_kinds: Vec<EdgeKind>,
    /// Letter of each edge: that of the mesh file, or what its drawing shows.
    pub letters: Vec<Assignment>,
    /// Index of the edge of the sheet's cell of which each line is a copy.
    pub line_edges: Vec<i32>,
    /// Fold angle of each edge in radians, valley positive.
    pub fold_angle: Vec<f64>,
    /// Fold angle in radians at which the hinge has no torque.
    pub rest_angle: Vec<f64>,
    /// Relative change of length of the bar, `L / L0 - 1`.
    pub strain: Vec<f64>,
    /// Energy of the bar and the hinge of each edge together.
    pub energy: Vec<f64>,
    /// Force along the bar, positive in tension.
    pub tension: Vec<f64>,
    /// Torque of the hinge, the derivative of its energy by the fold angle.
    pub torque: Vec<f64>,
    /// What elements remember that yield, by name; see [`State::memory`].
    pub memory: BTreeMap<&'static str, Vec<f64>>,
}

/// The values of a picture on its lines.
pub type OnLines = fn(&Picture) -> &[f64];

impl Picture {
    /// Names of the quantities on lines that every picture has, and their values.
    pub const FIELDS: [(&'static str, OnLines); 6] = [
        ("fold_angle", |picture| &picture.fold_angle),
        ("rest_angle", |picture| &picture.rest_angle),
        ("strain", |picture| &picture.strain),
        ("energy", |picture| &picture.energy),
        ("tension", |picture| &picture.tension),
        ("torque", |picture| &picture.torque),
    ];

    /// Makes the picture of a state of an assembly, on the cells that pictures of this assembly show.
    pub fn new(assembly: &Assembly, state: &State) -> Self {
        Self::of_state(&ShownCells::new(assembly), assembly.drawn(), state)
    }

    /// Makes the picture of a state on the cells of `view`; displacements are relative to `drawn`.
    pub fn of_state(view: &ShownCells, drawn: &Drawn, state: &State) -> Self {
        let on_lines = |values: &[f64]| view.edges.iter().map(|&edge| values[edge]).collect();
        let points = view.positions(drawn, &state.coordinates);
        let start = view.positions(drawn, &drawn.coordinates);
        Self {
            displacement: points.iter().zip(&start).map(|(now, then)| now - then).collect(),
            points,
            places: view.places.clone(),
            triangles: view.triangles.clone(),
            self_intersecting: vec![0; view.triangles.len()],
            lines: view.lines.clone(),
            line_kinds: view.patch.edges.iter().map(|edge| edge.kind).collect(),
            letters: view.letters.clone(),
            line_edges: view.patch.edges.iter().map(|edge| edge.edge as i32).collect(),
            fold_angle: on_lines(&state.fold_angle),
            rest_angle: on_lines(&state.rest_angle),
            strain: on_lines(&state.strain),
            energy: on_lines(&state.energy),
            tension: on_lines(&state.tension),
            torque: on_lines(&state.torque),
            memory: state.memory.iter().map(|(name, values)| (*name, on_lines(values))).collect(),
        }
    }

    /// Makes the picture of the drawn state of a sheet: one cell, or the whole of a finite sheet, with the copies of
    /// vertices that its faces need.
    pub(crate) fn drawn(sheet: &Sheet) -> Self {
        let mut corners: Vec<Corner> = sheet.triangles.iter().flat_map(|t| t.corners).collect();
        corners.sort_unstable_by_key(|corner| (corner.shift, corner.vertex));
        corners.dedup();
        let numbers: HashMap<Corner, usize> = corners.iter().enumerate().map(|(k, corner)| (*corner, k)).collect();
        let number = |corner: Corner| numbers[&corner];
        let names: HashMap<EdgeKey, usize> = sheet.edges.iter().enumerate().map(|(k, edge)| (edge.key, k)).collect();
        let triangles: Vec<[usize; 3]> = sheet.triangles.iter().map(|t| t.corners.map(number)).collect();
        let mut lines: Vec<([usize; 2], usize)> = Vec::new();
        for triangle in &sheet.triangles {
            for side in triangle.sides() {
                let ends = side.key.ends().map(|end| number(end.translated(side.base.shift)));
                lines.push((ends, names[&side.key]));
            }
        }
        lines.sort_unstable();
        lines.dedup();
        let nan = vec![f64::NAN; lines.len()];
        let angle = |edge: usize| sheet.drawn_angle(&sheet.edges[edge]).unwrap_or(f64::NAN);
        Self {
            points: corners.iter().map(|corner| sheet.position(*corner)).collect(),
            displacement: vec![Vec3::zeros(); corners.len()],
            places: corners.iter().map(|corner| (corner.vertex, corner.shift)).collect(),
            self_intersecting: vec![0; triangles.len()],
            triangles,
            line_kinds: lines.iter().map(|(_, edge)| sheet.edges[*edge].kind).collect(),
            letters: lines.iter().map(|(_, edge)| sheet.assignment(&sheet.edges[*edge])).collect(),
            line_edges: lines.iter().map(|(_, edge)| *edge as i32).collect(),
            fold_angle: lines.iter().map(|(_, edge)| angle(*edge)).collect(),
            lines: lines.into_iter().map(|(ends, _)| ends).collect(),
            rest_angle: nan.clone(),
            strain: nan.clone(),
            tension: nan.clone(),
            torque: nan.clone(),
            energy: nan,
            memory: BTreeMap::new(),
        }
    }

    /// Returns the picture with its points moved along their displacements, scaled so that the largest displacement is
    /// `part` times the size of the sheet (the largest distance of a point from the first one).
    pub(crate) fn displaced(&self, part: f64) -> Self {
        let size = self.points.iter().map(|p| (p - self.points[0]).norm()).fold(0.0, f64::max);
        let largest = self.displacement.iter().map(Vec3::norm).fold(f64::MIN_POSITIVE, f64::max);
        let moved = self.points.iter().zip(&self.displacement).map(|(p, u)| p + u * (part * size / largest));
        Self { points: moved.collect(), ..self.clone() }
    }

    /// Checks that all arrays are consistent; programs that read files with inconsistent arrays crash.
    pub(crate) fn check(&self) -> Result<(), ShapeError> {
        let (points, faces, lines) = (self.points.len(), self.triangles.len(), self.lines.len());
        let arrays = [
            ("displacement", self.displacement.len(), points),
            ("places", self.places.len(), points),
            ("self_intersecting", self.self_intersecting.len(), faces),
            ("line_kinds", self.line_kinds.len(), lines),
            ("letters", self.letters.len(), lines),
            ("line_edges", self.line_edges.len(), lines),
        ];
        let fields = Self::FIELDS.iter().map(|(name, get)| (*name, get(self).len(), lines));
        let memory = self.memory.iter().map(|(name, values)| (*name, values.len(), lines));
        let used = self.triangles.iter().flatten().chain(self.lines.iter().flatten());
        ShapeError::check(arrays.into_iter().chain(fields).chain(memory), used, points)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::test_samples as samples;

    /// The check accepts a consistent picture, and names an array of a wrong length or a point that does not exist.
    #[test]
    fn parts_that_do_not_fit_are_named() {
        let right = samples::hinge(0.3);
        assert_eq!(right.check(), Ok(()));
        let mut short = right.clone();
        short.strain.pop();
        assert_eq!(short.check(), Err(ShapeError::Length { array: "strain", found: 4, expected: 5 }));
        let mut wild = right;
        wild.lines[4] = [3, 7];
        assert_eq!(wild.check(), Err(ShapeError::NoSuchPoint { point: 7, count: 4 }));
    }
}
