//! The pleated hyperbolic paraboloid: concentric polygons, alternately mountains and valleys, and their diagonals.

use std::f64::consts::{PI, TAU};

use super::error::{GenerateError, count, length};
use super::parts::{Parts, parameters};
use crate::math::Vec3;
use crate::sheet::cell::{Corner, Sheet};

const SOURCE: &str = "Pleated hyperbolic paraboloid: traditional; E. D. Demaine, M. L. Demaine, V. Hart, G. N. Price, \
                      T. Tachi, Graphs and Combinatorics 27, 377 (2011), doi:10.1007/s00373-011-1025-2.";

parameters! {
    /// A flat sheet with the creases of the pleated hyperbolic paraboloid: concentric regular polygons at equal
    /// distances, and the diagonals from the centre to the corners.
    ///
    /// Polygon `k` has the distance `k width` from the centre. Polygons are mountains and valleys by turns, the
    /// outermost one is the rim. The diagonals between polygons `k` and `k+1` have the letter of polygon `k`, so that
    /// every vertex but the centre has three creases of one letter and one of the other.
    ///
    /// Vertex 0 is the centre, vertex `1 + (k-1) sides + s` the corner `s` of polygon `k`. With pleats that do not
    /// bend, this pattern of squares cannot be folded at all, as the source proves; a sheet folds by bending its faces.
    Hypar {
        /// Number of sides of the polygons, 3 to 100. Default 4.
        sides: usize = 4,
        /// Number of polygons, the rim included, 2 to 200. Default 6.
        pleats: usize = 6,
        /// Distance between polygons. Default 1.
        width: f64 = 1.0,
    }
}

impl Hypar {
    pub(super) fn sheet(&self) -> Result<Sheet, GenerateError> {
        let sides = count("sides", self.sides, 3, 100)?;
        let pleats = count("pleats", self.pleats, 2, 200)?;
        let width = length("width", self.width)?;
        let at = |k: usize, s: usize| Corner::home(if k == 0 { 0 } else { 1 + (k - 1) * sides + s % sides });
        let corner = |n: usize| {
            let (k, s) = (1 + n / sides, n % sides);
            let radius = k as f64 * width / libm::cos(PI / sides as f64);
            let angle = TAU * (s as f64 + 0.5) / sides as f64;
            Vec3::new(radius * libm::cos(angle), radius * libm::sin(angle), 0.0)
        };
        let face = |n: usize| {
            let (k, s) = (n / sides, n % sides);
            let inner = if k == 0 { vec![at(0, 0)] } else { vec![at(k, s + 1), at(k, s)] };
            inner.into_iter().chain([at(k + 1, s), at(k + 1, s + 1)]).collect()
        };
        let side_of = |k: usize| if k.is_multiple_of(2) { PI } else { -PI };
        let diagonals = (0..pleats * sides).map(|n| (n / sides, n % sides));
        let diagonals = diagonals.map(|(k, s)| ([at(k, s), at(k + 1, s)], side_of(k)));
        let polygons = (0..(pleats - 1) * sides).map(|n| (1 + n / sides, n % sides));
        let polygons = polygons.map(|(k, s)| ([at(k, s), at(k, s + 1)], side_of(k)));
        let angles = diagonals.chain(polygons).collect();
        let parts = Parts {
            title: "hypar",
            source: SOURCE,
            vertices: [Vec3::zeros()].into_iter().chain((0..pleats * sides).map(corner)).collect(),
            lattice: None,
            polygons: (0..pleats * sides).map(face).collect(),
        };
        parts.folding(format!("sides = {sides}, pleats = {pleats}, width = {width}."), angles)
    }
}
