//! A state of a sheet as it is drawn or written: points, triangles, lines and what is known on them.

use super::fault::ShapeError;

use crate::analysis::shown_cells::ShownCells;
use crate::analysis::state::State;
use crate::math::Vec3;
use crate::model::{Assembly, Drawn};
use crate::sheet::{Corner, EdgeKey, EdgeKind, Sheet};
use std::collections::HashMap;

/// A state of a sheet, flattened: no cells and no lattice any more.
///
/// Everything on lines has one entry per line, NaN where it does not apply.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Picture {
    /// Positions in this state.
    pub points: Vec<Vec3>,
    /// This state minus the drawn one, at each point.
    pub displacement: Vec<Vec3>,
    /// Triangles, counter-clockwise seen from the side of the face normals.
    pub triangles: Vec<[usize; 3]>,
    /// Whether a triangle passes through another one (1) or not (0); 0 where that was not asked.
    pub self_intersecting: Vec<u8>,
    /// Edges between two points.
    pub lines: Vec<[usize; 2]>,
    /// What each edge is.
    pub line_kinds: Vec<EdgeKind>,
    /// The edge of the sheet's cell of which each line is a copy.
    pub line_edges: Vec<i32>,
    /// Fold angle in radians, valley positive.
    pub fold_angle: Vec<f64>,
    /// Fold angle at which the hinge rests.
    pub rest_angle: Vec<f64>,
    /// Relative change of length, L / L0 - 1.
    pub strain: Vec<f64>,
    /// Energy of bar and hinge together.
    pub energy: Vec<f64>,
    /// Force along the bar, positive where it is stretched.
    pub tension: Vec<f64>,
    /// Torque of the hinge.
    pub torque: Vec<f64>,
}

impl Picture {
    /// A state of an assembly on the cells that pictures of it show.
    pub fn new(assembly: &Assembly, state: &State) -> Self {
        Self::of_state(&ShownCells::new(assembly), assembly.drawn(), state)
    }

    /// A state on the cells of a view.
    pub fn of_state(view: &ShownCells, drawn: &Drawn, state: &State) -> Self {
        let on_lines = |values: &[f64]| view.edges.iter().map(|&edge| values[edge]).collect();
        let points = view.positions(drawn, &state.coordinates);
        let start = view.positions(drawn, &drawn.coordinates);
        Self {
            displacement: points.iter().zip(&start).map(|(now, then)| now - then).collect(),
            points,
            triangles: view.triangles.clone(),
            self_intersecting: vec![0; view.triangles.len()],
            lines: view.lines.clone(),
            line_kinds: view.patch.edges.iter().map(|edge| edge.kind).collect(),
            line_edges: view.patch.edges.iter().map(|edge| edge.edge as i32).collect(),
            fold_angle: on_lines(&state.fold_angle),
            rest_angle: on_lines(&state.rest_angle),
            strain: on_lines(&state.strain),
            energy: on_lines(&state.energy),
            tension: on_lines(&state.tension),
            torque: on_lines(&state.torque),
        }
    }

    /// The picture with those triangles marked that pass through others.
    pub(crate) fn with_crossing(self, faces: &[bool]) -> Self {
        Self { self_intersecting: faces.iter().map(|&face| u8::from(face)).collect(), ..self }
    }

    /// The drawn state of a sheet: one cell, or all of a finite sheet, with the images its faces need.
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
            self_intersecting: vec![0; triangles.len()],
            triangles,
            line_kinds: lines.iter().map(|(_, edge)| sheet.edges[*edge].kind).collect(),
            line_edges: lines.iter().map(|(_, edge)| *edge as i32).collect(),
            fold_angle: lines.iter().map(|(_, edge)| angle(*edge)).collect(),
            lines: lines.into_iter().map(|(ends, _)| ends).collect(),
            rest_angle: nan.clone(),
            strain: nan.clone(),
            tension: nan.clone(),
            torque: nan.clone(),
            energy: nan,
        }
    }

    /// The picture with its points moved along their displacements, the largest of them by `part` of the sheet's size.
    pub(crate) fn displaced(&self, part: f64) -> Self {
        let size = self.points.iter().map(|p| (p - self.points[0]).norm()).fold(0.0, f64::max);
        let largest = self.displacement.iter().map(Vec3::norm).fold(f64::MIN_POSITIVE, f64::max);
        let moved = self.points.iter().zip(&self.displacement).map(|(p, u)| p + u * (part * size / largest));
        Self { points: moved.collect(), ..self.clone() }
    }

    /// Whether all arrays fit together: readers crash where they do not.
    ///
    /// # Errors
    /// The first array or index that does not fit.
    pub(crate) fn check(&self) -> Result<(), ShapeError> {
        let (points, faces, lines) = (self.points.len(), self.triangles.len(), self.lines.len());
        let arrays = [
            ("displacement", self.displacement.len(), points),
            ("self_intersecting", self.self_intersecting.len(), faces),
            ("line_kinds", self.line_kinds.len(), lines),
            ("line_edges", self.line_edges.len(), lines),
            ("fold_angle", self.fold_angle.len(), lines),
            ("rest_angle", self.rest_angle.len(), lines),
            ("strain", self.strain.len(), lines),
            ("energy", self.energy.len(), lines),
            ("tension", self.tension.len(), lines),
            ("torque", self.torque.len(), lines),
        ];
        if let Some(&(array, found, expected)) = arrays.iter().find(|(_, found, expected)| found != expected) {
            return Err(ShapeError::Length { array, found, expected });
        }
        let mut used = self.triangles.iter().flatten().chain(self.lines.iter().flatten());
        match used.find(|&&point| point >= points) {
            Some(&point) => Err(ShapeError::NoSuchPoint { point, count: points }),
            None => Ok(()),
        }
    }
}

/// Sheets for the tests of writers.
#[cfg(test)]
pub(super) mod samples {
    use super::*;

    /// Two triangles folded by `angle` along an edge of unit length: a crease and four edges of the boundary.
    pub(crate) fn hinge(angle: f64) -> Picture {
        let points = vec![
            Vec3::zeros(),
            Vec3::new(0.0, 1.0, 0.0),
            Vec3::new(-1.0, 0.5, 0.0),
            Vec3::new(angle.cos(), 0.5, angle.sin()),
        ];
        let none = f64::NAN;
        Picture {
            displacement: points.iter().map(|p| Vec3::new(0.0, 0.0, p.z)).collect(),
            points,
            triangles: vec![[0, 1, 2], [1, 0, 3]],
            self_intersecting: vec![0, 1],
            lines: vec![[0, 1], [1, 2], [2, 0], [0, 3], [3, 1]],
            line_kinds: [vec![EdgeKind::Crease], vec![EdgeKind::Boundary; 4]].concat(),
            line_edges: vec![0, 1, 2, 3, 4],
            fold_angle: vec![angle, none, none, none, none],
            rest_angle: vec![0.0, none, none, none, none],
            strain: vec![1e-3, 0.0, 0.0, -2e-5, 0.0],
            energy: vec![0.5 * angle * angle, 0.0, 0.0, 0.0, 0.0],
            tension: vec![1e-3, 0.0, 0.0, -2e-5, 0.0],
            torque: vec![angle, none, none, none, none],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The check lets a right picture pass and names the array or point that is wrong.
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
