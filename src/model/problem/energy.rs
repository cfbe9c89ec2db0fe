//! The model as the problem that the solver minimises: energies, gaps and their derivatives, summed over the terms.

use super::Model;
use crate::model::element::{Elements, Local};
use crate::numerics::parallel;
use crate::numerics::vector::max_abs;
use crate::solver::{HessianKind, Layout, Linearization, Problem, SoftElement};
use std::sync::Arc;

/// Angle in radians whose torque is the least force to which residuals are relative: if every hinge is closer to rest
/// than that, residuals are relative to the force of a milliradian instead of to round-off.
const LEAST_ANGLE: f64 = 1e-3;

/// Returns the terms, each with the number of its first element among the elements of all terms.
fn numbered(terms: &[Box<dyn Elements>]) -> impl Iterator<Item = (usize, &dyn Elements)> {
    let mut end = 0;
    terms.iter().map(move |term| {
        end += term.len();
        (end - term.len(), term.as_ref())
    })
}

impl Problem for Model {
    fn layout(&self) -> &Arc<Layout> {
        &self.layout
    }

    fn compliance(&self) -> &[f64] {
        &self.compliance
    }

    fn gap_scale(&self) -> &[f64] {
        &self.gap_scale
    }

    fn unit_of_length(&self) -> f64 {
        self.mean_edge
    }

    fn energy(&self, x: &[f64]) -> f64 {
        let all = self.coordinates(x);
        let mut energy = -self.loads.iter().zip(&all).map(|(f, x)| f * x).sum::<f64>();
        for term in &self.soft {
            let cost = |k: usize, energy: &mut f64| {
                let spring = term.spring(k);
                let off = term.value(k, &self.domain, &all) - spring.rest;
                *energy = 0.5 * spring.stiffness * off * off;
            };
            parallel::compute_and_consume(term.len(), cost, |_, value| energy += value);
        }
        energy
    }

    fn gaps(&self, x: &[f64]) -> Vec<f64> {
        let all = self.coordinates(x);
        let mut gaps = Vec::with_capacity(self.compliance.len());
        for term in &self.stiff {
            let gap = |k: usize, gap: &mut f64| *gap = term.value(k, &self.domain, &all) - term.spring(k).rest;
            parallel::compute_and_consume(term.len(), gap, |_, gap| gaps.push(*gap));
        }
        gaps
    }

    fn linearize(&self, x: &[f64], tension: &[f64], kind: HessianKind, out: &mut Linearization) {
        let all = self.coordinates(x);
        out.clear(kind);
        self.linearize_loads(&all, out);
        self.linearize_soft(&all, kind, out);
        self.linearize_stiff(&all, tension, out);
    }

    fn accept(&mut self, x: &mut [f64]) {
        let mut all = self.coordinates(x);
        for term in self.soft.iter_mut().chain(&mut self.stiff) {
            term.accept(&self.domain, &all);
        }
        let moved = self.domain.recentre(&mut all, self.mean_edge);
        let units = self.units_at(&all);
        if moved || units != self.units {
            self.units = units;
            x.copy_from_slice(&self.unknowns(&all));
        }
        if moved {
            self.base = all;
        }
    }

    fn hold(&self, tension: &[f64], out: &mut Linearization) {
        self.hold_rotations(tension, out);
    }

    fn relieve(&mut self, x: &mut [f64]) -> f64 {
        self.turn_along_loads(x)
    }
}

impl Model {
    fn linearize_loads(&self, all: &[f64], out: &mut Linearization) {
        for (coordinate, force) in self.loads.iter().enumerate() {
            out.energy -= force * all[coordinate];
            out.largest_force = out.largest_force.max(force.abs());
        }
        if !self.loads.is_empty() {
            self.free.iter().zip(&mut out.gradient).for_each(|(&k, g)| *g -= self.loads[k as usize]);
        }
    }

    fn linearize_soft(&self, all: &[f64], kind: HessianKind, out: &mut Linearization) {
        let full = kind == HessianKind::Full;
        for (first, term) in numbered(&self.soft) {
            let add = |k: usize, local: &Local| {
                let spring = term.spring(k);
                let off = local.value - spring.rest;
                let force = spring.stiffness * off;
                out.energy += 0.5 * force * off;
                let largest = max_abs(&local.gradient);
                out.largest_force = out.largest_force.max(largest * spring.stiffness * off.abs().max(LEAST_ANGLE));
                let (gradient, hessian) = (&local.gradient, &local.hessian);
                out.add_soft(first + k, &SoftElement { stiffness: spring.stiffness, force, gradient, hessian });
            };
            parallel::compute_and_consume(term.len(), self.locals(term, all, full), add);
        }
    }

    fn linearize_stiff(&self, all: &[f64], tension: &[f64], out: &mut Linearization) {
        let sizes = self.gap_scale.iter().map(|scale| scale / self.mean_edge);
        out.sizes.iter_mut().zip(sizes).for_each(|(out, size)| *out = size);
        for (first, term) in numbered(&self.stiff) {
            let add = |k: usize, local: &Local| {
                let measure = first + k;
                out.gaps[measure] = local.value - term.spring(k).rest;
                let largest = max_abs(&local.gradient);
                out.largest_force = out.largest_force.max(largest * tension[measure].abs());
                out.jacobian[self.layout.stiff.range(measure)].copy_from_slice(&local.gradient);
                out.add_stiff(measure, tension[measure], &local.hessian);
            };
            parallel::compute_and_consume(term.len(), self.locals(term, all, true), add);
        }
    }

    /// Returns a function that puts the measure of an element of this term, with its derivatives by the unknowns,
    /// into a [`Local`].
    fn locals<'a>(
        &'a self,
        term: &'a dyn Elements,
        all: &'a [f64],
        want_hessian: bool,
    ) -> impl Fn(usize, &mut Local) + Sync + Send + 'a {
        move |k, local| {
            term.local(k, &self.domain, all, want_hessian, local);
            local.measure_in(&self.units);
        }
    }
}
