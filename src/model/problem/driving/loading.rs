//! The first order of loading: how a state changes with its loads, and what that does to its stiffness.

use super::effect::Effect;
use super::{DrivenModel, Model, POSE};
use crate::model::element::{Element, Local};
use crate::solver::path::ParametrizedProblem;
use crate::solver::self_stress::self_stress;
use crate::solver::{Linearization, Tangent};

/// Relative residual of the system of the rates.
const EXACT: f64 = 1e-14;

impl DrivenModel {
    /// Returns the rate by the parameter, in the state of a factored tangent, of the Hessian that the rates of the forces in
    /// elements make, while the state itself does not move: the geometric stiffness of linear buckling. Also that
    /// of a self stress of the rigid measures, as large as those rates, if they have one.
    pub(crate) fn geometric_rate(
        &self,
        tangent: &mut Tangent,
        x: &[f64],
        tension: &[f64],
    ) -> (Linearization, Option<Linearization>) {
        let [force, gap] =
            self.parameter_rates(&tangent.at, x, tension).map(|rates| rates.iter().map(|r| -r).collect());
        let (force, gap): (Vec<f64>, Vec<f64>) = (force, gap);
        let rates = tangent.solve(&force, &gap, EXACT);
        let mut changes = vec![0.0; tangent.at.soft_stiffness.len()];
        tangent.at.soft_rows().product(&rates.dx, &mut changes);
        let stiffness = self.model.of_soft(x, Element::response).into_iter().map(|[_, _, second]| second);
        let mut forces: Vec<f64> = changes.iter().zip(stiffness).map(|(change, second)| second * change).collect();
        if let Effect::Loads { pressures, .. } = &self.effect {
            pressures.iter().for_each(|(face, unit)| forces[*face] -= unit);
        }
        let none = vec![0.0; forces.len()];
        let stress = self_stress(&self.model, &tangent.at, &rates.dt);
        let of_stress = stress.map(|stress| self.model.geometric_stiffness(x, &none, &stress, 0.0));
        (self.model.geometric_stiffness(x, &forces, &rates.dt, 1.0), of_stress)
    }
}

impl Model {
    /// Returns the gradient of the potential of the loads, for a factor of 1.
    pub(super) fn load_rates(&self, x: &[f64]) -> Vec<f64> {
        let mut rates = vec![0.0; self.free.len()];
        if self.loads.is_empty() {
            return rates;
        }
        let all = self.generalised(x);
        let points = self.points();
        let mut of_poses = vec![0.0; self.equations.bodies.coordinates()];
        let mut local = Local::default();
        for (part, forces) in self.loaded_parts() {
            self.equations.bodies.load(part, &forces, &all, &mut local);
            of_poses[POSE * part..POSE * (part + 1)].copy_from_slice(&local.gradient);
        }
        for (rate, &k) in rates.iter_mut().zip(&self.free) {
            let k = k as usize;
            let by_coordinate = if k < points { -self.loads[k] } else { of_poses[k - points] };
            *rate = by_coordinate * self.unit(k);
        }
        rates
    }
}
