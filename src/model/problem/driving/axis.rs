//! The axis about which a straight screw begins to bend as it is driven.
//!
//! Without curvature the direction of the axis does not affect the shape, and any direction is an equilibrium. But
//! rigid faces let a straight sheet bend about few axes only: from another one no path leads on. To second order the
//! work of the drive is least about the axes about which the sheet can bend; about the others the rigid measures, which
//! resist by their weights in the factorization, make it a million times larger.

use super::DrivenModel;
use crate::model::axis::{UNCORRECTED, decrease_along_step, direction_of_highest_peak};
use crate::model::domain::STRAIGHT;
use crate::numerics::vector::{max_abs, moved};
use crate::solver::path::ParametrizedProblem;
use crate::solver::{HessianKind, Problem, Start, Tangent};

/// Shift of the Hessian, which holds the direction of the axis and motions that cost no energy.
const SHIFT: f64 = 1e-9;
/// Length of a motion, in mean edges, after which the curvature is asked for; and the part of it, as an angle from a mean edge
/// to the next, up to which a sheet is not bent but for the weights of rigid measures.
const SHORT: f64 = 1e-3;
const BENT: f64 = 1e-4;

impl DrivenModel {
    /// The unknowns of a straight screw with these tensions, with the axis about which the drive bends it with the
    /// least work. A state that is no straight screw stays as it is.
    pub(crate) fn about_best_axis(&self, x: Vec<f64>, tension: &[f64]) -> Vec<f64> {
        let model = &self.model;
        let Some(turns) = model.equations.domain.turns(&model.coordinates(&x)) else { return x };
        if turns.kappa.abs() * model.equations.mean_edge > STRAIGHT {
            return x;
        }
        let about = |direction: f64| {
            let mut all = model.generalised(&x);
            model.equations.domain.bend(&mut all[..model.points()], direction, turns.kappa);
            model.extracted(&all)
        };
        let gain = |direction: f64| -self.second_order_work(&about(direction), tension).unwrap_or(f64::INFINITY);
        direction_of_highest_peak(gain).map_or(x.clone(), about)
    }

    /// Whether a straight screw stays straight while it is driven, held so by measures that are rigid beside the driven one:
    /// then its axis has no direction, and no path leads on.
    pub(crate) fn stays_straight(&self, Start { x, tension }: &Start) -> bool {
        let (model, edge) = (&self.model, self.model.equations.mean_edge);
        let curvature = |x: &[f64]| model.equations.domain.turns(&model.coordinates(x)).map(|turns| turns.kappa * edge);
        let rigid = self.compliance().iter().filter(|compliance| **compliance == 0.0).count();
        let Some(from) = curvature(x).filter(|kappa| rigid > 1 && kappa.abs() <= STRAIGHT) else { return false };
        let tension = tension.as_deref().unwrap_or_default();
        let Some((mut tangent, [force, stretch])) = self.responding(x, tension) else { return false };
        let step = tangent.solve(&force, &stretch, UNCORRECTED).dx;
        let part = SHORT * edge / max_abs(&step);
        curvature(&moved(x, part, &step)).is_some_and(|to| (to - from).abs() <= BENT * SHORT)
    }

    /// Half the second derivative by the parameter of the least energy, by the factorization's weights of rigid
    /// measures; `None` where nothing can be factored.
    fn second_order_work(&self, x: &[f64], tension: &[f64]) -> Option<f64> {
        let (mut tangent, [force, stretch]) = self.responding(x, tension)?;
        Some(-decrease_along_step(&mut tangent, [&force, &stretch], UNCORRECTED))
    }

    /// The factored tangent problem at a state, with the force and the stretch by which the drive acts on it.
    fn responding(&self, x: &[f64], tension: &[f64]) -> Option<(Tangent, [Vec<f64>; 2])> {
        let mut tangent = Tangent::at_state(self, x, tension, HessianKind::Full).ok()?;
        tangent.factor(SHIFT).ok()?;
        let rates = self.parameter_rates(&tangent.at, x, tension);
        Some((tangent, rates.map(|rates| rates.iter().map(|rate| -rate).collect())))
    }
}
