//! The eggbox: parallelograms as in Miura-ori, joined so that they never lie flat.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_3, FRAC_PI_4};

use super::super::angle::radians;
use super::error::{GenerateError, angle_between, length};
use super::parts::{Parts, VertexGrid, parameters};
use crate::math::Vec3;
use crate::sheet::cell::Sheet;

const SOURCE: &str = "Eggbox: M. Schenk, S. D. Guest, PNAS 110, 3276 (2013); H. Nassar, A. Lebee, L. Monasse \
                      (2017) on the surfaces it makes.";

parameters! {
    /// One cell of the eggbox, 2 x 2 parallelograms with sides `a`, `b` and acute angle `sector`.
    ///
    /// Vertex `(i, j)` is `(a cos(f) i, b cos(e) j, -a sin(f) [i odd] - b sin(e) [j odd])`: zigzags of slope `f` along
    /// x and of slope `e` along y, with `sin(f) sin(e) = cos(sector)` so that the angle between the sides is kept. Top
    /// and bottom vertices have four acute or four obtuse angles: the sheet is not developable and has no flat state.
    Eggbox {
        /// Side of the parallelograms along x. Default 1.
        a: f64 = 1.0,
        /// Side of the parallelograms along y. Default 1.
        b: f64 = 1.0,
        /// Acute angle of the parallelograms in radians, in `(0, pi/2)`. Default pi/3.
        sector: f64 as "radians" = FRAC_PI_3,
        /// Slope `f` of the sides `a` in radians, in `(pi/2 - sector, pi/2)`; the cell is closed along one direction at
        /// either limit. Default pi/4.
        fold: f64 as "radians" = FRAC_PI_4,
    }
}

impl Eggbox {
    pub(super) fn sheet(&self) -> Result<Sheet, GenerateError> {
        let (a, b) = (length("a", self.a)?, length("b", self.b)?);
        let sector = angle_between("sector", self.sector, 0.0, FRAC_PI_2)?;
        let f = angle_between("fold", self.fold, FRAC_PI_2 - sector, FRAC_PI_2)?;
        let slope = libm::cos(sector) / libm::sin(f);
        let (x, y) = (a * libm::cos(f), b * (1.0 - slope * slope).max(0.0).sqrt());
        let (down1, down2) = (a * libm::sin(f), b * slope);
        let grid = VertexGrid { size: [2, 2] };
        let vertex = |[i, j]: [usize; 2]| {
            let (i, j) = (i as f64, j as f64);
            Vec3::new(x * i, y * j, 0.0 - down1 * i - down2 * j)
        };
        let parts = Parts {
            title: "eggbox",
            source: SOURCE,
            vertices: grid.all().map(vertex).collect(),
            lattice: Some([Vec3::new(2.0 * x, 0.0, 0.0), Vec3::new(0.0, 2.0 * y, 0.0)]),
            polygons: grid.all().map(|at| grid.quad(at).to_vec()).collect(),
        };
        parts.sheet(format!("a = {}, b = {}, sector = {}, fold = {}.", self.a, self.b, self.sector, self.fold))
    }
}
