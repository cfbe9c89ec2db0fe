//! Miura-ori: equal parallelograms with one degree of freedom of rigid folding.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_3, PI};

use super::super::angle::radians;
use super::error::{GenerateError, angle_between, count, fold_angle, length};
use super::parts::{Parts, VertexGrid, parameters};
use crate::math::Vec3;
use crate::sheet::cell::Sheet;

const SOURCE: &str = "Miura-ori: K. Miura, Method of packaging and deployment of large membranes in space, ISAS Report \
                      618 (1985); coordinates as in M. Schenk, S. D. Guest, PNAS 110, 3276 (2013).";

parameters! {
    /// One cell of Miura-ori, 2 x 2 parallelograms, partly folded.
    ///
    /// Vertex `(i, j)` is `(s i, l j + v [i odd], h [j odd])` with `h = a sin t sin g`, `q = sqrt(1 + cos^2 g tan^2
    /// t)`, `s = b cos g tan t / q`, `v = b / q`, `l = a sqrt(1 - sin^2 g sin^2 t)`.
    Miura {
        /// Side `a` of the parallelograms, across the zigzags. Default 1.
        a: f64 = 1.0,
        /// Side `b` of the parallelograms, along the zigzags. Default 1.
        b: f64 = 1.0,
        /// Acute angle `t` of the parallelograms in radians, in `(0, pi/2)`. Default pi/3.
        sector: f64 as "radians" = FRAC_PI_3,
        /// Angle `g` between the faces and the plane of the sheet in radians, in `[0, pi/2)`; 0 is flat. Default pi/12.
        fold: f64 as "radians" = PI / 12.0,
    }
}

parameters! {
    /// A finite Miura-ori of `cells` whole cells, `(2 n1 + 1) x (2 n2 + 1)` vertices, with the parameters of [`Miura`].
    MiuraPatch {
        /// Side `a` of the parallelograms, across the zigzags. Default 1.
        a: f64 = 1.0,
        /// Side `b` of the parallelograms, along the zigzags. Default 1.
        b: f64 = 1.0,
        /// Acute angle `t` of the parallelograms in radians, in `(0, pi/2)`. Default pi/3.
        sector: f64 as "radians" = FRAC_PI_3,
        /// Angle `g` between the faces and the plane of the sheet in radians, in `[0, pi/2)`; 0 is flat. Default pi/12.
        fold: f64 as "radians" = PI / 12.0,
        /// Numbers of cells along the two directions, 1 to 500 each. Default `[5, 5]`.
        cells: [usize; 2] = [5, 5],
    }
}

/// The four lengths from which every vertex is computed; see [`Miura`].
pub(super) struct MiuraShape {
    pub s: f64,
    pub l: f64,
    pub v: f64,
    pub h: f64,
}

impl MiuraShape {
    pub fn vertex(&self, [i, j]: [usize; 2]) -> Vec3 {
        let odd = |n: usize| (n % 2) as f64;
        Vec3::new(self.s * i as f64, self.l * j as f64 + self.v * odd(i), self.h * odd(j))
    }
}

impl Miura {
    pub(super) fn shape(&self) -> Result<MiuraShape, GenerateError> {
        let (a, b) = (length("a", self.a)?, length("b", self.b)?);
        let t = angle_between("sector", self.sector, 0.0, FRAC_PI_2)?;
        let g = fold_angle(self.fold)?;
        let rise = libm::sin(t) * libm::sin(g);
        let run = libm::cos(g) * libm::tan(t);
        let q = (1.0 + run * run).sqrt();
        Ok(MiuraShape { s: b * run / q, l: a * (1.0 - rise * rise).sqrt(), v: b / q, h: a * rise })
    }

    fn parameters(&self) -> String {
        format!("a = {}, b = {}, sector = {}, fold = {}.", self.a, self.b, self.sector, self.fold)
    }

    pub(super) fn sheet(&self) -> Result<Sheet, GenerateError> {
        let shape = self.shape()?;
        let grid = VertexGrid { size: [2, 2] };
        let lattice = Some([Vec3::new(2.0 * shape.s, 0.0, 0.0), Vec3::new(0.0, 2.0 * shape.l, 0.0)]);
        let vertices = grid.all().map(|at| shape.vertex(at)).collect();
        let polygons = grid.all().map(|at| grid.quad(at).to_vec()).collect();
        Parts { title: "miura", source: SOURCE, vertices, lattice, polygons }.sheet(self.parameters())
    }
}

impl MiuraPatch {
    pub(super) fn sheet(&self) -> Result<Sheet, GenerateError> {
        let cell = Miura { a: self.a, b: self.b, sector: self.sector, fold: self.fold };
        let shape = cell.shape()?;
        let [n1, n2] = [count("cells[0]", self.cells[0], 1, 500)?, count("cells[1]", self.cells[1], 1, 500)?];
        let grid = VertexGrid { size: [2 * n1 + 1, 2 * n2 + 1] };
        let vertices = grid.all().map(|at| shape.vertex(at)).collect();
        let inner = grid.all().filter(|[i, j]| *i < 2 * n1 && *j < 2 * n2);
        let polygons = inner.map(|at| grid.quad(at).to_vec()).collect();
        let parameters = format!("{n1} x {n2} cells, {}", cell.parameters());
        Parts { title: "miura-patch", source: SOURCE, vertices, lattice: None, polygons }.sheet(parameters)
    }
}
