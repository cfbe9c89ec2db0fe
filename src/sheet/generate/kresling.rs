//! Kresling's pattern: a stack of twisted prisms.

use std::f64::consts::{FRAC_PI_6, PI, TAU};

use super::super::angle::radians;
use super::error::{GenerateError, angle_between, count, length};
use super::parts::{Parts, VertexGrid, parameters};
use crate::math::Vec3;
use crate::sheet::cell::{Corner, Sheet};

const SOURCE: &str = "Kresling pattern: B. Kresling, Natural twist buckling in shells: from the hawkmoth's bellows to \
                      the deployable Kresling-pattern and cylindrical Miura-ori, IASS-IACM (2008).";

parameters! {
    /// A finite ring of Kresling's pattern about the z axis without lattice, open at both ends or closed to a drum by a
    /// polygon at either end.
    ///
    /// Vertex `(k, j)` is at radius `radius`, angle `2 pi k / sides + j twist` and height `j height`. Each storey has
    /// the edges `(k, j)`-`(k, j+1)` and the diagonals `(k+1, j)`-`(k, j+1)`; face normals point outwards. A twist of
    /// `pi / sides` makes all triangles isosceles: that is the Yoshimura pattern.
    ///
    /// The edges between two polygons have the length `sqrt(h^2 + 2 r^2 (1 - cos t))`, where `r` is the radius, `h` the height
    /// and `t` the twist; the diagonals have the same with `t - 2 pi / sides` in place of `t`.
    Kresling {
        /// Number of sides of the polygons, 3 to 1000. Default 6.
        sides: usize = 6,
        /// Number of storeys, 1 to 1000. Default 3, and 1 for a closed drum.
        #[serde(skip_serializing_if = "Option::is_none")]
        levels: Option<usize> = None,
        /// Height of a storey. Default 0.8.
        height: f64 = 0.8,
        /// Rotation of a storey against the one below in radians, in `(-pi, pi)`. Default pi/6.
        twist: f64 as "radians" = FRAC_PI_6,
        /// Radius of the polygons. Default 1.
        radius: f64 = 1.0,
        /// Whether the lowest and the highest polygon are faces, so that the sheet is a closed drum. Default false.
        closed: bool = false,
    }
}

impl Kresling {
    pub(super) fn sheet(&self) -> Result<Sheet, GenerateError> {
        let sides = count("sides", self.sides, 3, 1000)?;
        let levels = count("levels", self.levels.unwrap_or(if self.closed { 1 } else { 3 }), 1, 1000)?;
        let (height, radius) = (length("height", self.height)?, length("radius", self.radius)?);
        let twist = angle_between("twist", self.twist, -PI, PI)?;
        let vertex = |[k, j]: [usize; 2]| {
            let angle = TAU * k as f64 / sides as f64 + twist * j as f64;
            Vec3::new(radius * libm::cos(angle), radius * libm::sin(angle), height * j as f64)
        };
        let at = |k: usize, j: usize| Corner::home(j * sides + k % sides);
        let storeys = VertexGrid { size: [sides, levels] };
        let pair = |[k, j]: [usize; 2]| {
            let (left, right, over, across) = (at(k, j), at(k + 1, j), at(k, j + 1), at(k + 1, j + 1));
            [vec![left, right, over], vec![right, across, over]]
        };
        let mut polygons: Vec<Vec<Corner>> = storeys.all().flat_map(pair).collect();
        if self.closed {
            polygons.push((0..sides).rev().map(|k| at(k, 0)).collect());
            polygons.push((0..sides).map(|k| at(k, levels)).collect());
        }
        let parts = Parts {
            title: if self.closed { "closed kresling" } else { "kresling" },
            source: SOURCE,
            vertices: VertexGrid { size: [sides, levels + 1] }.all().map(vertex).collect(),
            lattice: None,
            polygons,
        };
        let closed = if self.closed { ", closed = true" } else { "" };
        parts.sheet(format!(
            "sides = {sides}, levels = {levels}, height = {height}, twist = {twist}, radius = {radius}{closed}."
        ))
    }
}
