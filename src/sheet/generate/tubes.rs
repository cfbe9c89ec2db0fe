//! Two aligned Miura tubes that share a wall.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_3, FRAC_PI_4};

use serde::{Deserialize, Serialize};

use super::super::angle::radians;
use super::error::{GenerateError, angle_between, count, length};
use super::parts::Parts;
use crate::math::Vec3;
use crate::sheet::cell::{Corner, Sheet};

const SOURCE: &str = "Coupled Miura tubes: E. T. Filipov, T. Tachi, G. H. Paulino, PNAS 112, 12321 (2015).";

/// Number of vertices of a ring: two of the wall that both tubes share, and two of each tube.
const RING: usize = 6;

/// Two tubes of Miura-ori along x that share a wall of parallelograms, so that three faces meet at its edges.
///
/// Ring `r` is that of `r = 0` moved by `(r b cos f, [r odd] b sin f, 0)`. The shared wall has the side `u = (0, y, z)` of
/// length `a`, `y = a cos t / sin f`; the first tube has the sides `u` and `v = (0, y, -z)`, the second one `u` and `-v`.
/// Both fold together without stretching.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct AlignedTubes {
    /// Side `a` of the parallelograms round the tubes. Default 1.
    pub a: f64,
    /// Side `b` of the parallelograms along the tubes. Default 1.
    pub b: f64,
    /// Acute angle `t` of the parallelograms in radians, in `(0, pi/2)`. Default pi/3.
    #[serde(deserialize_with = "radians")]
    pub sector: f64,
    /// Angle `f` between the zigzags and the axis in radians, in `(pi/2 - t, pi/2)`. Default pi/4.
    #[serde(deserialize_with = "radians")]
    pub fold: f64,
    /// Number of zigzags along the axis, 1 to 500. Default 2.
    pub cells: usize,
}

impl Default for AlignedTubes {
    fn default() -> Self {
        Self { a: 1.0, b: 1.0, sector: FRAC_PI_3, fold: FRAC_PI_4, cells: 2 }
    }
}

impl AlignedTubes {
    pub(super) fn sheet(&self) -> Result<Sheet, GenerateError> {
        let (a, b) = (length("a", self.a)?, length("b", self.b)?);
        let t = angle_between("sector", self.sector, 0.0, FRAC_PI_2)?;
        let f = angle_between("fold", self.fold, FRAC_PI_2 - t, FRAC_PI_2)?;
        let cells = count("cells", self.cells, 1, 500)?;
        let y = a * libm::cos(t) / libm::sin(f);
        let z = (a * a - y * y).sqrt();
        let (u, v) = (Vec3::new(0.0, y, z), Vec3::new(0.0, y, -z));
        let ring = [Vec3::zeros(), u, u + v, v, u - v, -v];
        let place = |r: usize| Vec3::new(r as f64 * b * libm::cos(f), (r % 2) as f64 * b * libm::sin(f), 0.0);
        let walls = [[0, 1], [1, 2], [2, 3], [3, 0], [1, 4], [4, 5], [5, 0]];
        let face = |r: usize, [i, j]: [usize; 2]| {
            [i, j, j + RING, i + RING].map(|vertex| Corner::home(r * RING + vertex)).to_vec()
        };
        let parts = Parts {
            title: "aligned-tubes",
            source: SOURCE,
            vertices: (0..=2 * cells).flat_map(|r| ring.map(|point| point + place(r))).collect(),
            lattice: None,
            polygons: (0..2 * cells).flat_map(|r| walls.map(|wall| face(r, wall))).collect(),
        };
        parts.sheet(format!("a = {a}, b = {b}, sector = {t}, fold = {f}, cells = {cells}."))
    }
}
