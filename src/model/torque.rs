//! A torque on a rigid part: what forces that turn with it do.
//!
//! A torque has a potential where the part turns about one fixed axis only: minus the torque times the angle by which the
//! part has turned. Where a part turns about several axes the work of a torque, or of forces that turn with the part,
//! depends on the way there, and there is none. Source: H. Ziegler, Principles of Structural Stability (1968), section 2.3.

use super::assembly::Assembly;
use super::assembly_error::AssemblyError;
use super::element::{Term, TermKind};
use super::law::{Law, Spring, Stored};
use super::measure::Measure;
use super::own_term::OwnTerm;
use super::pressure::Push;
use super::problem::Gauge;
use crate::math::{Vec3, lower_triangle};
use crate::sheet::tiling::Site;
use nalgebra::{Matrix3, SVector};
use std::sync::Arc;

/// The angle, in radians, by which the line between two points has turned about an axis, seen along it; between -pi
/// and pi.
#[derive(Clone, Copy, Debug)]
struct TurnAbout {
    /// Two unit vectors across the axis and each other, the first along the line where the angle is zero.
    across: [Vec3; 2],
}

impl TurnAbout {
    /// The components of the line across the axis.
    fn components(&self, [a, b]: &[Vec3; 2]) -> [f64; 2] {
        self.across.map(|unit| unit.dot(&(b - a)))
    }
}

impl Measure<2, 6> for TurnAbout {
    const ANGLE: bool = true;

    fn value(&self, points: &[Vec3; 2]) -> f64 {
        let [u, v] = self.components(points);
        v.atan2(u)
    }

    fn gradient(&self, points: &[Vec3; 2]) -> (f64, SVector<f64, 6>) {
        let [u, v] = self.components(points);
        let rate = (u * self.across[1] - v * self.across[0]) / (u * u + v * v);
        (v.atan2(u), SVector::from_fn(|k, _| if k < 3 { -rate[k] } else { rate[k - 3] }))
    }

    fn hessian(&self, points: &[Vec3; 2], lower: &mut Vec<f64>) -> (f64, SVector<f64, 6>) {
        let ([u, v], [e, f]) = (self.components(points), self.across);
        let square = (u * u + v * v).powi(2);
        let (along, mixed) = (2.0 * u * v / square, (v * v - u * u) / square);
        let block: Matrix3<f64> =
            along * (e * e.transpose() - f * f.transpose()) + mixed * (e * f.transpose() + f * e.transpose());
        lower.clear();
        let sign = |row: usize, column: usize| if row / 3 == column / 3 { 1.0 } else { -1.0 };
        lower.extend(lower_triangle(6).map(|(row, column)| sign(row, column) * block[(row % 3, column % 3)]));
        self.gradient(points)
    }
}

impl OwnTerm {
    /// Makes a torque on a rigid part about the axis (0, 1, 2 for x, y, z) about which alone it turns, positive to the
    /// right seen along it: a force times a length. As a load it has no energy in tables, and a drive of the loads drives
    /// it.
    ///
    /// ```
    /// use foldwell::model::OwnTerm;
    /// use foldwell::{Assembly, Pattern, generate, relax};
    ///
    /// // a tube of creased paper whose lid is turned
    /// let tube = generate(&Pattern::named("kresling")?)?;
    /// let [floor, lid] = [0..6, 6..12].map(|ring| ring.map(|vertex| (vertex, [0, 0])).collect::<Vec<_>>());
    /// let held = Assembly::patch(tube, [1, 1]).bars(100.0).creases(0.1);
    /// let assembly = held.part(floor, [false; 6]).part(lid, [false, false, true, false, false, true]).build()?;
    /// let turned = assembly.with_own_term(OwnTerm::torque(&assembly, 1, 2, 0.01)?);
    /// assert!(relax(&turned)?.state.total() > 0.0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`AssemblyError::Turning`] if the part does not turn about this axis alone, [`AssemblyError::Loose`] if nothing holds
    /// the sheet, which the torque would turn for ever.
    ///
    /// # Panics
    /// If there is no part of this number.
    pub fn torque(assembly: &Assembly, part: usize, axis: usize, value: f64) -> Result<Self, AssemblyError> {
        let body = &assembly.terms().parts[part];
        if (0..3).any(|other| body.free[3 + other] != (other == axis)) {
            return Err(AssemblyError::Turning { part, axis });
        }
        if assembly.model(Gauge::Held).rigid_motion_counts()[1] > 0 {
            return Err(AssemblyError::Loose);
        }
        let positions = &assembly.tiling().positions;
        let across = |vertex: usize| {
            let line = positions[vertex] - positions[body.vertices[0]];
            line - Vec3::ith(axis, line[axis])
        };
        let longest = |a: &usize, b: &usize| across(*a).norm().total_cmp(&across(*b).norm());
        // a part turns about an axis on which not all of its vertices lie
        let far = body.vertices.iter().copied().max_by(longest).unwrap_or(body.vertices[0]);
        let first = across(far).normalize();
        let measure = TurnAbout { across: [first, Vec3::ith(axis, 1.0).cross(&first)] };
        let ends = [body.vertices[0], far].map(|vertex| Site { vertex, shift: [0, 0] });
        let push: Arc<dyn Law> = Arc::new(Push);
        let stored = |_| Stored::Law(push.clone());
        let term = Term::new((TermKind::Torque, TermKind::Torque.name()), measure, vec![(ends, None)], stored);
        Ok(Self::of(Arc::new(term), vec![Spring { stiffness: value, rest: 0.0 }]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::tests::check_derivatives;

    /// Claim: gradient and Hessian of the angle are its differences, in any quadrant.
    #[test]
    fn turns_have_their_derivatives() {
        let axis = Vec3::new(0.6, 0.0, 0.8);
        let first = Vec3::new(0.8, 0.0, -0.6);
        let measure = TurnAbout { across: [first, axis.cross(&first)] };
        for end in [[0.9, 0.7, 0.1], [-0.8, 0.4, 0.2], [0.3, -1.1, -0.4]] {
            let points = [Vec3::new(0.1, -0.2, 0.3), Vec3::from(end)];
            check_derivatives(&measure, &points);
        }
        assert!(measure.value(&[Vec3::zeros(), first + 0.1 * axis.cross(&first)]) > 0.0, "to the right about the axis");
    }
}
