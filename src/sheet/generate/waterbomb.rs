//! The waterbomb tessellation: rows of waterbomb bases, each row displaced by half a base.

use super::super::angle::radians;
use super::error::{GenerateError, fold_angle, length};
use super::parts::{Parts, parameters};
use crate::math::Vec3;
use crate::sheet::cell::{Corner, Sheet};

const SOURCE: &str = "Waterbomb tessellation: traditional; Y. Chen, H. Feng, J. Ma, R. Peng, Z. You, Proc. R. Soc. A \
                      472, 20150846 (2016).";

parameters! {
    /// One cell of the waterbomb tessellation: two bases of `2a x 2b`, one above the other and displaced by `a`; every
    /// vertex has six creases.
    ///
    /// ```text
    ///     x---x---x       a base: two diagonals and the upright middle line; rows alternate between bases
    ///     | \ | / |       that begin at even and at odd multiples of a, and the lines between rows are creases
    ///     |   o   |
    ///     | / | \ |
    ///     x---x---x
    /// ```
    ///
    /// Folded evenly this sheet rolls up to a cylinder, which no drawing with a flat lattice can show: if all bases are
    /// equal, square and mirror-symmetric, the six edge lengths allow the flat state only. `fold` is therefore the fold
    /// that a flat lattice allows, pleats along the lines between rows; 0 is the flat crease pattern.
    Waterbomb {
        /// Half the width of a base. Default 1.
        a: f64 = 1.0,
        /// Half the height of a base. Default 1.
        b: f64 = 1.0,
        /// Slope of the rows in radians, alternately up and down, in `[0, pi/2)`. Default 0.
        fold: f64 as "radians" = 0.0,
    }
}

/// Returns the vertex at `a k` on the line below row `r`; each row has the vertices 3 r (k even), 3 r + 1 (k odd) and
/// 3 r + 2 (centre).
fn on_line(k: i32, r: i32) -> Corner {
    let vertex = 3 * r.rem_euclid(2) + k.rem_euclid(2);
    Corner { vertex: vertex as usize, shift: [k.div_euclid(2), r.div_euclid(2)] }
}

/// Returns the six triangles of the base in row `r`, whose middle line is at `a r`.
fn base(r: i32) -> impl Iterator<Item = Vec<Corner>> {
    let centre = Corner::home(3 * r as usize + 2);
    let round = [(-1, 0), (0, 0), (1, 0), (1, 1), (0, 1), (-1, 1)].map(|(k, up)| on_line(r + k, r + up));
    (0..6).map(move |n| vec![centre, round[n], round[(n + 1) % 6]])
}

impl Waterbomb {
    pub(super) fn sheet(&self) -> Result<Sheet, GenerateError> {
        let (a, b) = (length("a", self.a)?, length("b", self.b)?);
        let fold = fold_angle(self.fold)?;
        let (run, rise) = (b * libm::cos(fold), b * libm::sin(fold));
        let parts = Parts {
            title: "waterbomb",
            source: SOURCE,
            vertices: vec![
                Vec3::zeros(),
                Vec3::new(a, 0.0, 0.0),
                Vec3::new(0.0, run, rise),
                Vec3::new(0.0, 2.0 * run, 2.0 * rise),
                Vec3::new(a, 2.0 * run, 2.0 * rise),
                Vec3::new(a, 3.0 * run, rise),
            ],
            lattice: Some([Vec3::new(2.0 * a, 0.0, 0.0), Vec3::new(0.0, 4.0 * run, 0.0)]),
            polygons: (0..2).flat_map(base).collect(),
        };
        parts.sheet(format!("a = {a}, b = {b}, fold = {fold}."))
    }
}
