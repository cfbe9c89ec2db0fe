//! Steps that stay where the model is one: no hinge turns too far, and no triangle beside a hinge loses most of its
//! height.
//!
//! The gradient of a fold angle grows as the reciprocal of the height of its triangles. A step that flattens a
//! triangle, or turns a hinge by more than about a radian, ends where derivatives at its start tell nothing.

use super::Model;
use crate::math::Vec3;
use crate::model::element::Element;
use crate::solver::Collapse;

/// Part of its height over a hinge that a triangle must keep in one step.
const KEPT_HEIGHT: f64 = 0.4;
/// Largest change of a fold angle in one step, in radians.
const LARGEST_TURN_RAD: f64 = 1.0;

/// Least height of a triangle over its longest side: below it rounding errors of coordinates are no longer small beside
/// heights.
const COLLAPSED: f64 = 1e-6;

impl Model {
    /// The thinnest triangle beside a hinge in a state, where it has no height to speak of.
    pub(super) fn collapsed(&self, x: &[f64]) -> Option<Collapse> {
        let coordinates = self.coordinates(x);
        let triangles = self
            .elements()
            .filter(Element::is_hinge)
            .flat_map(|hinge| [2, 3].map(|wing| self.triangle(&hinge, wing, &coordinates)));
        let (quality, vertices) = triangles.min_by(|a, b| a.0.total_cmp(&b.0))?;
        (quality < COLLAPSED).then_some(Collapse { vertices, quality })
    }

    /// Least height over longest side of the triangle of a hinge with one of its wings, the third or fourth site, and
    /// the numbers of its vertices.
    fn triangle(&self, hinge: &Element<'_>, wing: usize, coordinates: &[f64]) -> (f64, [usize; 3]) {
        let sites = [0, 1, wing].map(|n| hinge.sites()[n]);
        let [a, b, c] = sites.map(|site| self.equations.domain.point(coordinates, site));
        let longest = [b - a, c - b, a - c].map(|side| side.norm_squared()).into_iter().fold(0.0, f64::max);
        ((b - a).cross(&(c - a)).norm() / longest, sites.map(|site| site.vertex))
    }

    /// Whether no angle turns by more than [`LARGEST_TURN_RAD`] between two states, the first of which was accepted
    /// last, and the triangles beside hinges keep [`KEPT_HEIGHT`] of their heights.
    pub(super) fn turns_no_hinge_too_far(&self, from: &[f64], to: &[f64]) -> bool {
        let [from, to] = [from, to].map(|x| self.coordinates(x));
        self.elements().filter(Element::is_angle).all(|element| {
            let turn = element.value(&to) - element.last;
            let keeps_heights = || {
                let [before, after] = [&from, &to].map(|x| self.heights(&element, x));
                (0..2).all(|side| after[side] >= KEPT_HEIGHT * before[side])
            };
            turn.abs() <= LARGEST_TURN_RAD && (!element.is_hinge() || keeps_heights())
        })
    }

    /// Heights of the two triangles of a hinge over it.
    fn heights(&self, hinge: &Element<'_>, coordinates: &[f64]) -> [f64; 2] {
        let [i, j, left, right] = [0, 1, 2, 3].map(|n| self.equations.domain.point(coordinates, hinge.sites()[n]));
        let edge: Vec3 = j - i;
        [left, right].map(|wing| edge.cross(&(wing - i)).norm() / edge.norm())
    }
}
