//! Ron Resch's triangular tessellation: triangular tiles, and tucks that vanish beneath them.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_3, PI};

use super::error::{GenerateError, length};
use super::parts::{Parts, parameters};
use crate::math::Vec3;
use crate::sheet::cell::{Corner, Sheet};

const SOURCE: &str = "Ron Resch's triangular tessellation: R. D. Resch, US patent 3407558 (1968); C. Lv, D. \
                      Krishnaraju, G. Konjevod, H. Yu, H. Jiang, Sci. Rep. 4, 5979 (2014), doi:10.1038/srep05979.";

parameters! {
    /// One flat cell of Ron Resch's triangular tessellation, with the angles to which it folds.
    ///
    /// ```text
    ///       o-------o-------o       a tuck: a triangle of side 2a, divided by its three medians into six
    ///        \  \   |   /  /        right triangles; two tiles, triangles of side a, stand beside it in
    ///         \    \|/    /         every cell
    ///          o----x----o          (the spokes to the corners and to the middles of the sides all meet at x)
    ///           \   |   /
    ///             \ | /
    ///               o
    /// ```
    ///
    /// Folded, the tiles cover a plane, turned against each other, and the right triangles of a tuck stand below them
    /// in three upright walls of two layers each. The target angles say so: -pi/2 along the sides of tiles, -pi/3 from
    /// the middles of the sides of a tuck to its centre, pi from its corners. The lattice vectors are then shorter by
    /// the factor `sqrt 3`.
    Resch {
        /// Side of the tiles. Default 1.
        a: f64 = 1.0,
    }
}

/// Returns the vertex at `x e1 + y e2` of the triangular grid with `e1 = (a, 0)`, `e2 = (a/2, a sqrt 3/2)`; the lattice
/// vectors are `e1 + e2` and `2 e2 - e1`.
fn on_grid([x, y]: [i32; 2]) -> Corner {
    let vertex = (x - y).rem_euclid(3);
    let [p, q] = [[x, y], [x - 1, y], [x, y - 1]][vertex as usize];
    let n2 = (q - p) / 3;
    Corner { vertex: vertex as usize, shift: [p + n2, n2] }
}

impl Resch {
    pub(super) fn sheet(&self) -> Result<Sheet, GenerateError> {
        let a = length("a", self.a)?;
        let (e1, e2) = (Vec3::new(a, 0.0, 0.0), Vec3::new(0.5 * a, 0.75f64.sqrt() * a, 0.0));
        let centre = Corner::home(3);
        // counter-clockwise; corners of the tuck stand at even places, middles of its sides at odd ones
        let round = [[0, 0], [0, 1], [0, 2], [-1, 2], [-2, 2], [-1, 1]].map(on_grid);
        let tile = |[x, y]: [i32; 2]| [[x, y], [x + 1, y], [x, y + 1]].map(on_grid).to_vec();
        let tuck = (0..6).map(|k| vec![centre, round[k], round[(k + 1) % 6]]);
        let sides = (0..6).map(|k| ([round[k], round[(k + 1) % 6]], -FRAC_PI_2));
        let spokes = (0..6).map(|k| ([centre, round[k]], if k % 2 == 0 { PI } else { -FRAC_PI_3 }));
        let angles = sides.chain(spokes).collect();
        let parts = Parts {
            title: "resch",
            source: SOURCE,
            vertices: vec![Vec3::zeros(), e1, e2, (e2 * 4.0 - e1 * 2.0) / 3.0],
            lattice: Some([e1 + e2, e2 * 2.0 - e1]),
            polygons: [tile([0, 0]), tile([-1, 0])].into_iter().chain(tuck).collect(),
        };
        parts.folding(format!("a = {a}."), angles)
    }
}
