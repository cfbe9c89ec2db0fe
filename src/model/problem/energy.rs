//! The model as the problem that the solver minimises: energies, gaps and their derivatives, summed over the terms.

use super::{Model, POSE};
use crate::model::Site;
use crate::model::element::{Element, Elements, Local, continued};
use crate::numerics::parallel;
use crate::numerics::vector::max_abs;
use crate::solver::{Collapse, HessianKind, Layout, Linearization, Problem, SoftElement};
use std::sync::Arc;

/// Angle in radians whose torque is the least force to which residuals are relative: if every hinge is closer to rest
/// than that, residuals are relative to the force of a milliradian instead of to round-off.
const LEAST_ANGLE: f64 = 1e-3;
/// Largest change of a fold angle in one step, to first order, in radians: with 0.3 and with 1 the scenes of `meshes/`
/// take as many iterations, and a step that turns a hinge further says little about it.
const LARGEST_CHANGE_RAD: f64 = 0.3;
/// Mean edges over the shortest height of a triangle whose forces count in full where residuals are made relative.
const SHORTEST_ARMS: f64 = 1e4;
/// Compliance of supports in proportion to that of a bar of the mean edge: next to none, since they are rigid where
/// bars are only stiff.
const SUPPORT: f64 = 1e-6;
/// Least stiffness of an element in the metric, over that at rest.
const LEAST_METRIC: f64 = 1e-9;
/// Least stiffness of an element in the Hessian, over that at rest, but for negative ones: what hangs on a hinge that bends
/// by a power has none at rest. Where such a law pulls more than residuals may be, it is stiffer.
const LEAST_STIFFNESS: f64 = 1e-12;
/// Gap of a stiff measure, relative to its natural size, below which its force counts as that of this gap where no soft
/// element and no load gives forces a size.
const LEAST_GAP: f64 = 1e-3;

/// Returns the terms, each with the number of its first element, which is this one for the first of them.
fn numbered(terms: &[Arc<dyn Elements>], first: usize) -> impl Iterator<Item = (usize, &dyn Elements)> {
    let mut end = first;
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

    fn proportions(&self) -> Vec<f64> {
        let mean_edge = &self.equations.mean_edge;
        let of_terms = self.stiff().map(|element| match element.spring.rest {
            _ if element.is_angle() => self.length_of(&element).recip(),
            length if length > 0.0 => length,
            _ => *mean_edge,
        });
        let of_support = |angle: bool| SUPPORT * if angle { mean_edge.recip() } else { *mean_edge };
        of_terms.chain(self.supports.iter().map(|support| of_support(support.is_angle))).collect()
    }

    fn unit_of_length(&self) -> f64 {
        self.equations.mean_edge
    }

    fn largest_change(&self) -> f64 {
        LARGEST_CHANGE_RAD
    }

    fn energy(&self, x: &[f64]) -> f64 {
        let all = self.coordinates(x);
        let mut energy = -self.load_factor * self.load_displacement(&all);
        for (first, term) in numbered(&self.equations.soft, 0) {
            let cost = |k: usize, energy: &mut f64| {
                let element = self.element(term, k, first + k);
                *energy = element.response(element.value(&all))[0];
            };
            parallel::compute_and_consume(term.len(), cost, |_, value| energy += value);
        }
        energy
    }

    fn gaps(&self, x: &[f64]) -> Vec<f64> {
        let generalised = self.generalised(x);
        let all = &generalised[..self.points()];
        let mut gaps = Vec::with_capacity(self.compliance.len());
        for (first, term) in numbered(&self.equations.stiff, self.soft_elements()) {
            let gap = |k: usize, gap: &mut f64| {
                let element = self.element(term, k, first + k);
                *gap = element.value(all) - element.spring.rest;
            };
            parallel::compute_and_consume(term.len(), gap, |_, gap| gaps.push(*gap));
        }
        gaps.extend(self.supports.iter().map(|support| support.value(&generalised) - support.rest));
        gaps
    }

    fn linearize(&self, x: &[f64], tension: &[f64], kind: HessianKind, out: &mut Linearization) {
        let all = self.generalised(x);
        out.clear(kind);
        self.linearize_loads(&all, out);
        let responds = |element: &Element<'_>, value: f64| {
            let [energy, force, second] = element.response(value);
            [energy, force, second, element.metric()]
        };
        self.add_soft_terms(&all, kind == HessianKind::Full, responds, out);
        self.linearize_stiff(&all, tension, out);
        self.linearize_supports(&all, tension, out);
    }

    fn admits(&self, from: &[f64], to: &[f64]) -> bool {
        self.turns_no_hinge_too_far(from, to)
    }

    fn breakdown(&self, x: &[f64]) -> Option<Collapse> {
        self.collapsed(x)
    }

    fn accept(&mut self, x: &mut [f64]) {
        let mut all = self.generalised(x);
        let points = self.points();
        self.accept_angles(&all[..points]);
        let moved = self.equations.domain.recentre(&mut all[..points], self.equations.mean_edge);
        let units = self.units_at(&all[..points]);
        if moved || units != self.units {
            self.units = units;
            x.copy_from_slice(&self.extracted(&all));
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

    fn choose_anew(&mut self, x: &[f64], rates: &[f64]) -> Option<[Vec<f64>; 2]> {
        self.still_held(x, rates)
    }
}

impl Model {
    /// Lets fold angles continue from the state with these coordinates; the unknowns and their units stay as they are.
    pub(in crate::model) fn accept_angles(&mut self, points: &[f64]) {
        let soft = self.soft_elements();
        let Self { equations, last, .. } = self;
        let terms = numbered(&equations.soft, 0).chain(numbered(&equations.stiff, soft));
        for (first, term) in terms.filter(|(_, term)| term.head().is_angle) {
            for (k, last) in last[first..first + term.len()].iter_mut().enumerate() {
                *last = continued(*last, term.value(k, &equations.domain, points));
            }
        }
    }

    /// Displacement of the loads, each along its force and weighted by it, from the origin; the energy falls by it
    /// times the factor of the loads.
    pub(super) fn load_displacement(&self, all: &[f64]) -> f64 {
        self.loads.iter().zip(all).map(|(f, x)| f * x).sum()
    }

    /// Returns the soft elements that are faces under pressure, by number, and their pressures.
    pub(super) fn pressures(&self) -> Vec<(usize, f64)> {
        self.soft().filter(Element::is_load).map(|face| (face.number, face.spring.stiffness)).collect()
    }

    /// Returns the work of pressures, one for each face that has one, from the state without volume to that with these
    /// coordinates.
    pub(super) fn work_of(&self, pressures: &[(usize, f64)], all: &[f64]) -> f64 {
        let of = |number: usize| pressures.binary_search_by_key(&number, |(face, _)| *face).ok();
        let faces = self.soft().filter(Element::is_load).filter_map(|face| Some((face, pressures[of(face.number)?].1)));
        faces.map(|(face, pressure)| pressure * face.value(&all[..self.points()])).sum()
    }

    /// Displacement of these pressures, and of the forces on vertices if they are asked for, each weighted by it.
    pub(super) fn loaded_along(&self, forces: bool, pressures: &[(usize, f64)], all: &[f64]) -> f64 {
        self.work_of(pressures, all) + if forces { self.load_displacement(all) } else { 0.0 }
    }

    /// Returns the work of the pressures on faces, from the state without volume to that with these coordinates.
    pub(crate) fn work_of_pressure(&self, coordinates: &[f64]) -> f64 {
        self.work_of(&self.pressures(), coordinates)
    }

    fn linearize_loads(&self, all: &[f64], out: &mut Linearization) {
        if self.loads.is_empty() {
            return;
        }
        out.energy -= self.load_factor * self.load_displacement(all);
        let largest = max_abs(&self.loads);
        out.largest_force = out.largest_force.max((self.load_factor * largest).abs());
        let free = self.free.iter().zip(&mut out.gradient).filter(|(k, _)| **k < self.loads.len() as u32);
        free.for_each(|(&k, g)| *g -= self.load_factor * self.loads[k as usize]);
        self.add_loads_of_parts(all, self.load_factor, out);
    }

    /// Adds the potential of this multiple of the loads on rigid parts, which is curved where they turn.
    fn add_loads_of_parts(&self, all: &[f64], force: f64, out: &mut Linearization) {
        let first = self.soft_elements();
        let mut local = Local::default();
        for (number, (part, forces)) in self.loaded_parts().into_iter().enumerate() {
            self.equations.bodies.load(part, &forces, all, &mut local);
            local.measure_in(&self.pose_units());
            let (gradient, hessian) = (&local.gradient, &local.hessian);
            // its measure is the potential itself, of stiffness zero
            let size = f64::INFINITY;
            out.add_soft(first + number, &SoftElement { stiffness: 0.0, excess: 0.0, force, size, gradient, hessian });
        }
    }

    /// Sizes of the unknowns of a pose in units of its coordinates.
    fn pose_units(&self) -> [f64; POSE] {
        let angle = 1.0 / self.equations.mean_edge;
        [1.0, 1.0, 1.0, angle, angle, angle]
    }

    /// Adds the soft elements with these energies, forces, stiffnesses, and stiffnesses at rest, at their values. In the
    /// metric an element whose law softens has the stiffness that it has there, by tangent or secant: with that at rest a
    /// shift would outweigh the stiffness of powers, which vanishes at rest, and the iteration would creep.
    fn add_soft_terms(
        &self,
        all: &[f64],
        full: bool,
        responds: impl Fn(&Element<'_>, f64) -> [f64; 4],
        out: &mut Linearization,
    ) {
        for (first, term) in numbered(&self.equations.soft, 0) {
            let most = self.most_arm(term);
            // an energy that is its own measure has no stiffness but that of its Hessian
            let is_energy = term.head().is_energy();
            let size = match term.head().kind {
                kind if kind.is_load() || is_energy => f64::INFINITY,
                _ if term.head().is_angle => 1.0,
                _ => self.equations.mean_edge,
            };
            let add = |k: usize, local: &Local| {
                let element = self.element(term, k, first + k);
                let [energy, force, second, stiffness] = responds(&element, local.value);
                out.energy += energy;
                let largest = max_abs(&local.gradient).min(most);
                out.largest_force = out.largest_force.max(largest * force.abs().max(stiffness * LEAST_ANGLE));
                out.rest_stiffness = out.rest_stiffness.max(stiffness * largest * largest);
                let (gradient, hessian) = (&local.gradient, &local.hessian);
                let secant = force / (local.value - element.spring.rest);
                let least = LEAST_STIFFNESS * stiffness;
                let second = if (0.0..least).contains(&second) { least } else { second };
                let metric = stiffness.min(second.max(secant).max(LEAST_METRIC * stiffness));
                let excess = second - metric;
                out.add_soft(first + k, &SoftElement { stiffness: metric, excess, force, size, gradient, hessian });
            };
            parallel::compute_and_consume(term.len(), self.locals((first, term), all, full || is_energy), add);
        }
    }

    fn linearize_stiff(&self, all: &[f64], tension: &[f64], out: &mut Linearization) {
        let sizes = self.gap_scale.iter().map(|scale| scale / self.equations.mean_edge);
        out.sizes.iter_mut().zip(sizes).for_each(|(out, size)| *out = size);
        let soft = self.soft_elements();
        for (first, term) in numbered(&self.equations.stiff, soft) {
            let most = self.most_arm(term);
            let add = |k: usize, local: &Local| {
                let measure = first + k - soft;
                out.gaps[measure] = local.value - self.springs[first + k].rest;
                let largest = max_abs(&local.gradient).min(most);
                out.largest_force = out.largest_force.max(largest * tension[measure].abs());
                out.jacobian[self.layout.stiff.range(measure)].copy_from_slice(&local.gradient);
                out.add_stiff(measure, tension[measure], &local.hessian);
            };
            parallel::compute_and_consume(term.len(), self.locals((first, term), all, true), add);
        }
        if self.equations.soft.is_empty() && self.loads.is_empty() {
            out.largest_force = out.largest_force.max(self.least_force(out));
        }
    }

    /// Returns the Hessian that these forces of soft elements and tensions of stiff measures, and this multiple of the loads,
    /// have by the curvature of their measures: the geometric stiffness.
    pub(super) fn geometric_stiffness(&self, x: &[f64], forces: &[f64], tension: &[f64], loads: f64) -> Linearization {
        let (all, mut out) = (self.generalised(x), Linearization::new(&self.layout));
        out.clear(HessianKind::Full);
        self.add_soft_terms(&all, true, |element, _| [0.0, forces[element.number], 0.0, 0.0], &mut out);
        self.linearize_stiff(&all, tension, &mut out);
        self.add_loads_of_parts(&all, loads, &mut out);
        out
    }

    /// Largest gradient of a measure that counts where forces are given a size: those of angles grow without bound as a
    /// triangle collapses, and would hide every other force.
    fn most_arm(&self, term: &dyn Elements) -> f64 {
        if term.head().is_angle { SHORTEST_ARMS / self.equations.mean_edge } else { f64::INFINITY }
    }

    /// Returns the force to which those of a model without soft elements and loads are relative where all of them
    /// vanish, as in a truss without stress: that of the softest stiff measure at the gap [`LEAST_GAP`]. Without
    /// measures of finite stiffness forces have no size, and none is too large.
    fn least_force(&self, at: &Linearization) -> f64 {
        let springs = self.compliance.iter().zip(&self.gap_scale).enumerate().filter(|(_, (c, _))| **c > 0.0);
        let force = |(measure, (compliance, scale)): (usize, (&f64, &f64))| {
            max_abs(&at.jacobian[self.layout.stiff.range(measure)]) * LEAST_GAP * scale / compliance
        };
        springs.map(force).fold(f64::MAX, f64::min)
    }

    fn linearize_supports(&self, all: &[f64], tension: &[f64], out: &mut Linearization) {
        let first = self.compliance.len() - self.supports.len();
        for (measure, support) in (first..).zip(&self.supports) {
            out.gaps[measure] = support.value(all) - support.rest;
            let range = self.layout.stiff.range(measure);
            for ((k, factor), entry) in support.terms.iter().zip(&mut out.jacobian[range]) {
                *entry = factor * self.unit(*k);
                out.largest_force = out.largest_force.max((*entry * tension[measure]).abs());
            }
        }
    }

    /// Returns a function that puts the measure of an element of this term, with its derivatives by the unknowns,
    /// into a [`Local`].
    fn locals<'a>(
        &'a self,
        (first, term): (usize, &'a dyn Elements),
        all: &'a [f64],
        want_hessian: bool,
    ) -> impl Fn(usize, &mut Local) + Sync + Send + 'a {
        let points = &all[..self.points()];
        move |k, local| {
            self.element(term, k, first + k).local(points, want_hessian, local);
            local.measure_in(&self.units);
            if self.equations.bodies.touch(term.sites(k)) {
                self.equations.bodies.pull(term.sites(k), all, local);
                let of_point = |site: &Site| match self.equations.bodies.part_of(site.vertex) {
                    Some(_) => self.pose_units().to_vec(),
                    None => vec![1.0; 3],
                };
                let units: Vec<f64> = term.sites(k).iter().flat_map(of_point).collect();
                local.measure_in(&units);
            }
        }
    }
}
