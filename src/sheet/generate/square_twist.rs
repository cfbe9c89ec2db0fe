//! Square twists: small squares that rotate while the parallelograms between them fold.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};

use super::super::angle::radians;
use super::error::{GenerateError, angle_between, fold_angle, length};
use super::parts::{Parts, parameters};
use crate::math::Vec3;
use crate::sheet::cell::{Corner, Sheet};

const SOURCE: &str = "Square twists: J. L. Silverberg et al., Nature Materials (2015), doi:10.1038/nmat4232; the \
                      assignment that folds rigidly: T. A. Evans, R. J. Lang, S. P. Magleby, L. L. Howell, \
                      R. Soc. Open Sci. 2, 150067 (2015).";

parameters! {
    /// One cell of a tessellation by square twists: a square of side `a`, a square of side `b`, and two parallelograms
    /// between them with the angle `twist`, rigidly folded by `fold`.
    ///
    /// The vertices are the corners of the square `a`, which lies in the plane. The sides of square `b` that leave its
    /// right and its upper side are, with `t = pi/2 - twist`,
    ///
    /// ```text
    /// e = b ( cos t cos u,  sin t,         cos t sin u )       lattice vectors:  (a, 0, 0) + e
    /// f = b ( -sin t,       cos t cos w,   cos t sin w )                         (0, a, 0) + f
    /// ```
    ///
    /// so that the parallelograms keep their angles, and square `b` keeps its right angle if `tan t (cos w - cos u) +
    /// sin u sin w = 0`. The parameter `fold` is `u`, and `w` follows; 0 is the flat crease pattern.
    SquareTwist {
        /// Side of the squares that twist. Default 1.
        a: f64 = 1.0,
        /// Side of the squares between them. Default 2.
        b: f64 = 2.0,
        /// Acute angle of the parallelograms in radians, in `(0, pi/2)`. Default pi/4.
        twist: f64 as "radians" = FRAC_PI_4,
        /// Fold angle between the squares `a` and the parallelograms on their right in radians, in `[0, pi/2)`. Default
        /// 0.3.
        fold: f64 as "radians" = 0.3,
    }
}

/// Returns the root `w` of `T cos w + sin u sin w = T cos u` that starts from 0 at `u = 0` and has the opposite sign
/// of `u`. The other root that starts there folds the mirror image of the pattern.
fn partner(u: f64, tangent: f64) -> f64 {
    let s = libm::sin(u);
    let lead = libm::atan2(s, tangent);
    let amplitude = (tangent * tangent + s * s).sqrt();
    lead - libm::acos((tangent * libm::cos(u) / amplitude).clamp(-1.0, 1.0))
}

impl SquareTwist {
    pub(super) fn sheet(&self) -> Result<Sheet, GenerateError> {
        let (a, b) = (length("a", self.a)?, length("b", self.b)?);
        let t = FRAC_PI_2 - angle_between("twist", self.twist, 0.0, FRAC_PI_2)?;
        let u = fold_angle(self.fold)?;
        let w = if u == 0.0 { 0.0 } else { partner(u, libm::tan(t)) };
        let (along, across) = (b * libm::cos(t), b * libm::sin(t));
        let e = Vec3::new(along * libm::cos(u), across, along * libm::sin(u));
        let f = Vec3::new(-across, along * libm::cos(w), along * libm::sin(w));
        let at = |vertex, n1, n2| Corner { vertex, shift: [n1, n2] };
        let parts = Parts {
            title: "square-twist",
            source: SOURCE,
            vertices: vec![Vec3::zeros(), Vec3::new(a, 0.0, 0.0), Vec3::new(a, a, 0.0), Vec3::new(0.0, a, 0.0)],
            lattice: Some([Vec3::new(a, 0.0, 0.0) + e, Vec3::new(0.0, a, 0.0) + f]),
            polygons: vec![
                vec![at(0, 0, 0), at(1, 0, 0), at(2, 0, 0), at(3, 0, 0)],
                vec![at(1, 0, 0), at(0, 1, 0), at(3, 1, 0), at(2, 0, 0)],
                vec![at(3, 0, 0), at(2, 0, 0), at(1, 0, 1), at(0, 0, 1)],
                vec![at(2, 0, 0), at(3, 1, 0), at(0, 1, 1), at(1, 0, 1)],
            ],
        };
        parts.sheet(format!("a = {a}, b = {b}, twist = {}, fold = {u}.", self.twist))
    }
}
