//! The von Mises truss: two bars that meet in an apex and snap through when it is pressed down.

use super::error::{GenerateError, length};
use super::parts::{Parts, parameters};
use crate::math::Vec3;
use crate::sheet::cell::{Corner, Sheet};

const SOURCE: &str = "Two-bar truss: R. von Mises, Ueber die Stabilitaetsprobleme der Elastizitaetstheorie, ZAMM 3, 406 \
                      (1923).";

parameters! {
    /// The two-bar truss of von Mises in the plane `y = 0`, as one triangle without lattice.
    ///
    /// ```text
    ///            1                 vertices: 0 (-w, 0, 0), 1 (0, 0, h), 2 (w, 0, 0)
    ///         /     \              bars: 0-1 and 1-2 of length sqrt(w^2 + h^2), 0-2 of length 2 w
    ///      0 --------- 2
    /// ```
    ///
    /// The bar 0-2 joins the two supports; where both are pinned it carries nothing.
    Truss {
        /// Half the distance `w` of the supports. Default 1.
        half_span: f64 = 1.0,
        /// Height `h` of the apex above the supports. Default 0.3.
        height: f64 = 0.3,
    }
}

impl Truss {
    pub(super) fn sheet(&self) -> Result<Sheet, GenerateError> {
        let (w, h) = (length("half_span", self.half_span)?, length("height", self.height)?);
        let parts = Parts {
            title: "truss",
            source: SOURCE,
            vertices: vec![Vec3::new(-w, 0.0, 0.0), Vec3::new(0.0, 0.0, h), Vec3::new(w, 0.0, 0.0)],
            lattice: None,
            polygons: vec![[0, 1, 2].map(Corner::home).to_vec()],
        };
        parts.sheet(format!("half_span = {w}, height = {h}."))
    }
}
