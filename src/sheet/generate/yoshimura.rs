//! The Yoshimura pattern: diamonds with their long diagonals.

use super::super::angle::radians;
use super::error::{GenerateError, fold_angle, length};
use super::parts::{Parts, parameters};
use crate::math::Vec3;
use crate::sheet::cell::{Corner, Sheet};

const SOURCE: &str = "Yoshimura pattern: Y. Yoshimura, On the mechanism of buckling of a circular cylindrical shell \
                      under axial compression, NACA TM 1390 (1955).";

parameters! {
    /// One cell of the Yoshimura pattern: two rows of isosceles triangles with base `a` and height `b`, every other row
    /// displaced by `a / 2`.
    ///
    /// Folded evenly this sheet rolls up to a cylinder, which a drawing with a flat lattice cannot show. `fold` is the
    /// fold that a flat lattice allows, pleats along the bases; 0 is the flat crease pattern.
    /// [`Kresling`](super::Kresling) with a twist of `pi / sides` gives the pattern as rings of a cylinder.
    Yoshimura {
        /// Base of the triangles. Default 2.
        a: f64 = 2.0,
        /// Height of the triangles. Default 1.
        b: f64 = 1.0,
        /// Slope of the rows in radians, alternately up and down, in `[0, pi/2)`. Default 0.
        fold: f64 as "radians" = 0.0,
    }
}

impl Yoshimura {
    pub(super) fn sheet(&self) -> Result<Sheet, GenerateError> {
        let (a, b) = (length("a", self.a)?, length("b", self.b)?);
        let fold = fold_angle(self.fold)?;
        let (run, rise) = (b * libm::cos(fold), b * libm::sin(fold));
        let low = |n1, n2| Corner { vertex: 0, shift: [n1, n2] };
        let high = |n1, n2| Corner { vertex: 1, shift: [n1, n2] };
        let parts = Parts {
            title: "yoshimura",
            source: SOURCE,
            vertices: vec![Vec3::zeros(), Vec3::new(a / 2.0, run, rise)],
            lattice: Some([Vec3::new(a, 0.0, 0.0), Vec3::new(0.0, 2.0 * run, 0.0)]),
            polygons: vec![
                vec![low(0, 0), low(1, 0), high(0, 0)],
                vec![low(1, 0), high(1, 0), high(0, 0)],
                vec![high(0, 0), high(1, 0), low(1, 1)],
                vec![high(0, 0), low(1, 1), low(0, 1)],
            ],
        };
        parts.sheet(format!("a = {a}, b = {b}, fold = {fold}."))
    }
}
