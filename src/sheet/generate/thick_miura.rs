//! Miura-ori of thick panels, whose creases lie at several heights.

use std::f64::consts::{FRAC_PI_3, PI};

use super::super::angle::radians;
use super::error::{GenerateError, between};
use super::miura::{Miura, MiuraShape};
use super::parts::{Parts, VertexGrid, parameters};
use crate::math::Vec3;
use crate::sheet::cell::{Corner, Sheet};

const SOURCE: &str =
    "Miura-ori of thick panels: Y. Chen, R. Peng, Z. You, Origami of thick panels, Science 349, 396 (2015).";

parameters! {
    /// One cell of Miura-ori of thick panels, partly folded: four rigid panels whose hinges lie at three heights.
    ///
    /// The panels turn as the parallelograms of [`Miura`] do. The zigzag creases lie at the middle of the panels, those
    /// along y on them where they are mountains and below them where they are valleys, so that the four hinges round
    /// each vertex are a Bennett linkage. Hinges end before the vertices: an opening is left at each, and every panel
    /// is a polygon of eight corners that is not plane. The cell along x is shorter than that of the sheet without
    /// thickness by `4 d`, `d = thickness v h / n` with the lengths of [`Miura`] and the area `n` of a parallelogram.
    ThickMiura {
        /// As of [`Miura`].
        a: f64 = 1.0,
        /// As of [`Miura`].
        b: f64 = 1.0,
        /// As of [`Miura`].
        sector: f64 as "radians" = FRAC_PI_3,
        /// As of [`Miura`].
        fold: f64 as "radians" = PI / 12.0,
        /// Thickness of the panels, from the lowest hinge to the highest; above 0 and so small that the cell keeps a
        /// length at this fold. Default 0.1.
        thickness: f64 = 0.1,
        /// Part of each crease that is left open at each end, above 0 and below 1/2. Default 0.1.
        gap: f64 = 0.1,
    }
}

/// The cell of Miura-ori, and where its hinges are.
struct ThickMiuraCell {
    shape: MiuraShape,
    grid: VertexGrid,
    thickness: f64,
    gap: f64,
    /// Way along x by which a panel is nearer to the one before than without thickness.
    nearer: f64,
}

impl ThickMiuraCell {
    /// Returns both ends of the hinge of the crease from a vertex of the cell along x (`0`) or y (`1`).
    fn ends(&self, [i, j]: [usize; 2], axis: usize) -> [Vec3; 2] {
        let [from, to] = [[i, j], if axis == 0 { [i + 1, j] } else { [i, j + 1] }].map(|at| self.shape.vertex(at));
        let height = if axis == 0 { 0.0 } else { 0.5 * self.thickness * if (i + j) % 2 == 0 { 1.0 } else { -1.0 } };
        let moved = height * self.normal([i, j]) - Vec3::new(self.nearer * i as f64, 0.0, 0.0);
        [self.gap, 1.0 - self.gap].map(|part| from + (to - from) * part + moved)
    }

    /// Returns the unit normal of a panel.
    fn normal(&self, [i, j]: [usize; 2]) -> Vec3 {
        let at = |i, j| self.shape.vertex([i, j]);
        (at(i + 1, j) - at(i, j)).cross(&(at(i, j + 1) - at(i, j))).normalize()
    }

    /// Returns the corner at one end of the hinge from the vertex `(i, j)` of the pattern.
    fn corner(&self, [i, j]: [i64; 2], axis: usize, end: usize) -> Corner {
        let Corner { vertex, shift } = self.grid.corner(i, j);
        Corner { vertex: 2 * (4 * axis + vertex) + end, shift }
    }

    /// Returns the panel whose lower left vertex is `(i, j)`.
    fn panel(&self, [i, j]: [i64; 2]) -> Vec<Corner> {
        let side = |at, axis, ends: [usize; 2]| ends.map(|end| self.corner(at, axis, end));
        [side([i, j], 0, [0, 1]), side([i + 1, j], 1, [0, 1]), side([i, j + 1], 0, [1, 0]), side([i, j], 1, [1, 0])]
            .concat()
    }

    /// Returns the opening at the vertex `(i, j)`.
    fn opening(&self, [i, j]: [i64; 2]) -> Vec<Corner> {
        let hinges = [([i, j], 0, 0), ([i, j], 1, 0), ([i - 1, j], 0, 1), ([i, j - 1], 1, 1)];
        hinges.into_iter().map(|(at, axis, end)| self.corner(at, axis, end)).collect()
    }
}

impl ThickMiura {
    pub(super) fn sheet(&self) -> Result<Sheet, GenerateError> {
        let Self { a, b, sector, fold, thickness, gap } = *self;
        let shape = Miura { a, b, sector, fold }.shape()?;
        let gap = between("gap", gap, 0.0, 0.5)?;
        let per_thickness = shape.v * shape.h / (a * b * libm::sin(sector));
        let thickness = between("thickness", thickness, 0.0, f64::min(1e6, shape.s / per_thickness))?;
        let nearer = thickness * per_thickness;
        let lattice = Some([Vec3::new(2.0 * (shape.s - nearer), 0.0, 0.0), Vec3::new(0.0, 2.0 * shape.l, 0.0)]);
        let hinges = ThickMiuraCell { shape, grid: VertexGrid { size: [2, 2] }, thickness, gap, nearer };
        let all = || hinges.grid.all();
        let vertices = [0, 1].into_iter().flat_map(|axis| all().flat_map(move |at| [(at, axis)]));
        let vertices = vertices.flat_map(|(at, axis)| hinges.ends(at, axis)).collect();
        let places = || all().map(|at| at.map(|k| k as i64));
        let polygons = places().map(|at| hinges.panel(at)).collect();
        let openings = places().map(|at| hinges.opening(at)).collect();
        let words =
            format!("a = {a}, b = {b}, sector = {sector}, fold = {fold}, thickness = {thickness}, gap = {gap}.");
        Parts { title: "thick-miura", source: SOURCE, vertices, lattice, polygons }.open(words, openings)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sheet::EdgeKind;
    use std::f64::consts::FRAC_PI_3;

    /// Claim: the panels are rigid: all their bars, diagonals included, have the same length at every fold, for every
    /// thickness; four panels, eight hinges and four openings in a cell. Tolerance: rounding.
    #[test]
    fn panels_keep_their_shape() {
        for thickness in [0.01, 0.1, 0.4] {
            let at = |fold: f64| ThickMiura { fold, thickness, a: 1.3, sector: 1.1, ..ThickMiura::default() }.sheet();
            let flat = at(0.0).unwrap();
            let hinges = flat.edges.iter().filter(|edge| edge.kind == EdgeKind::Crease).count();
            assert_eq!((flat.polygons.len(), hinges, flat.holes.len(), flat.vertices.len()), (4, 8, 4, 16));
            for folded in [0.3, 0.7, 1.1].map(|fold| at(fold).unwrap()) {
                for (edge, key) in flat.edges.iter().map(|edge| (edge.kind, &edge.key)) {
                    let [drawn, now] = [&flat, &folded].map(|sheet| {
                        let [from, to] = key.ends().map(|end| sheet.position(end));
                        (to - from).norm()
                    });
                    assert!((drawn - now).abs() <= 1e-14, "{thickness}: {edge:?} {key:?} {drawn} {now}");
                }
            }
        }
    }

    /// Claim: panels that are too thick for the fold are refused with the largest thickness, at which the cell has no
    /// length: `b tan t / tan g`. Tolerance: rounding.
    #[test]
    fn too_thick_panels_are_refused() {
        let error = ThickMiura { fold: 1.2, thickness: 0.9, ..ThickMiura::default() }.sheet().unwrap_err();
        let GenerateError::Number { name: "thickness", high, .. } = error else { panic!("{error}") };
        assert!((high - f64::tan(FRAC_PI_3) / f64::tan(1.2)).abs() <= 1e-14, "{high}");
    }
}
