//! Two Miura tubes side by side, aligned so that they share a wall; `zipper.rs` couples them as a zipper.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_3, FRAC_PI_4};

use super::super::angle::radians;
use super::error::{GenerateError, angle_between, count, length};
use super::parts::{Parts, parameters};
use crate::math::Vec3;
use crate::sheet::cell::{Corner, Sheet};

pub(super) const SOURCE: &str = "Coupled Miura tubes: E. T. Filipov, T. Tachi, G. H. Paulino, PNAS 112, 12321 (2015).";

parameters! {
    /// Two coupled tubes of Miura-ori along x.
    ///
    /// Ring `r` of the first tube is that of `r = 0` moved by `(r b cos f, [r odd] b sin f, 0)`. It has the sides `u =
    /// (0, y, z)` and `v = (0, y, -z)` of length `a`, `y = a cos t / sin f`; the wall of the side `u` touches the
    /// second tube.
    MiuraTubes {
        /// Side `a` of the parallelograms round the tubes. Default 1.
        a: f64 = 1.0,
        /// Side `b` of the parallelograms along the tubes. Default 1.
        b: f64 = 1.0,
        /// Acute angle `t` of the parallelograms in radians, in `(0, pi/2)`. Default pi/3.
        sector: f64 as "radians" = FRAC_PI_3,
        /// Angle `f` between the zigzags and the axis in radians, in `(pi/2 - t, pi/2)`. Default pi/4.
        fold: f64 as "radians" = FRAC_PI_4,
        /// Number of zigzags along the axis, 1 to 500. Default 2.
        cells: usize = 2,
    }
}

/// The first of two coupled tubes.
pub(super) struct CoupledTube {
    pub sides: [Vec3; 2],
    /// Step from a ring to the next one: along the axis, and to and fro across it.
    step: [f64; 2],
    /// Number of pieces between rings.
    pub pieces: usize,
    /// The parameters, in words.
    pub words: String,
}

impl CoupledTube {
    /// Returns the displacement of a ring from the first one.
    pub fn place(&self, ring: usize) -> Vec3 {
        Vec3::new(ring as f64 * self.step[0], (ring % 2) as f64 * self.step[1], 0.0)
    }

    /// Returns the parts of a sheet whose rings are the first one, moved, with a face between two rings for each of these
    /// walls between two points of a ring.
    pub fn walls(&self, title: &'static str, ring: &[Vec3], walls: &[[usize; 2]]) -> Parts {
        let corner = |r: usize, point: usize| Corner::home(r * ring.len() + point);
        let face = |r: usize, [i, j]: [usize; 2]| vec![corner(r, i), corner(r, j), corner(r + 1, j), corner(r + 1, i)];
        let mut parts = Parts { title, source: SOURCE, vertices: vec![], lattice: None, polygons: vec![] };
        for r in 0..=self.pieces {
            parts.vertices.extend(ring.iter().map(|point| point + self.place(r)));
        }
        for r in 0..self.pieces {
            parts.polygons.extend(walls.iter().map(|wall| face(r, *wall)));
        }
        parts
    }
}

impl MiuraTubes {
    /// The first tube, of checked parameters.
    pub(super) fn tube(&self) -> Result<CoupledTube, GenerateError> {
        let (a, b) = (length("a", self.a)?, length("b", self.b)?);
        let t = angle_between("sector", self.sector, 0.0, FRAC_PI_2)?;
        let f = angle_between("fold", self.fold, FRAC_PI_2 - t, FRAC_PI_2)?;
        let cells = count("cells", self.cells, 1, 500)?;
        let y = a * libm::cos(t) / libm::sin(f);
        let z = (a * a - y * y).sqrt();
        Ok(CoupledTube {
            sides: [Vec3::new(0.0, y, z), Vec3::new(0.0, y, -z)],
            step: [b * libm::cos(f), b * libm::sin(f)],
            pieces: 2 * cells,
            words: format!("a = {a}, b = {b}, sector = {t}, fold = {f}, cells = {cells}."),
        })
    }

    /// The second tube has the sides `u` and `-v`: both share the wall of `u`, so that three faces meet at its edges,
    /// and fold together without stretching.
    pub(super) fn aligned(&self) -> Result<Sheet, GenerateError> {
        let tube = self.tube()?;
        let [u, v] = tube.sides;
        let ring = [Vec3::zeros(), u, u + v, v, u - v, -v];
        let walls = [[0, 1], [1, 2], [2, 3], [3, 0], [1, 4], [4, 5], [5, 0]];
        tube.walls("aligned-tubes", &ring, &walls).sheet(tube.words)
    }
}
