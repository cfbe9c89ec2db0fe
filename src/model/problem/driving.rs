//! A model whose supports, loads, rest values or stiffness one parameter drives.

mod axis;
mod effect;
mod loading;
mod prescribed;

use super::{Model, POSE};
use crate::model::drive::{Drive, DriveError, Driven};
use crate::model::element::{Element, TermKind};
use crate::model::law::Memory;
use crate::numerics::vector::dot;
use crate::solver::path::{ParametrizedProblem, Rates};
use crate::solver::{Collapse, HessianKind, Layout, Linearization, Problem};
use effect::Effect;
use std::ops::Range;
use std::sync::Arc;

/// A model with a driven quantity, for [`crate::solver::path::follow_path`].
///
/// The parameter is the driven value, except for the stiffness of elements that have tensions as unknowns, of which it
/// is the reciprocal: an infinite stiffness is the parameter zero.
pub struct DrivenModel {
    /// The model, with the supports that the drive moves.
    pub model: Model,
    parameter: f64,
    target: f64,
    way: f64,
    /// The part of the model that changes with the parameter.
    effect: Effect,
    /// The driven value for a parameter of 1, where one is proportional to the other.
    unit: f64,
    /// Numbers of the stiff measures that the model has for the drive only.
    added: Range<usize>,
    /// Generalised coordinates of the state at which the held coordinates were first chosen.
    first: Vec<f64>,
}

impl DrivenModel {
    /// Makes a model driven from its reference state. `drawn` are the values of all measures in the drawn state
    /// ([`Model::values`]); `loaded` says whether loads and rest values act in full in the reference state.
    ///
    /// # Errors
    /// [`DriveError`] if the drive has no effect on this model.
    pub fn new(mut model: Model, drive: &Drive, drawn: Vec<f64>, loaded: bool) -> Result<Self, DriveError> {
        let first = model.compliance.len();
        let begin = f64::from(u8::from(loaded));
        let (mut unit, mut volume_added) = (1.0, None);
        let (effect, parameter, target) = match &drive.quantity {
            Driven::Part { part, axis } => {
                let pose = model.points() + POSE * part + axis;
                (model.support_moved(vec![vec![(pose, 1.0)]], *axis >= 3), 0.0, drive.to)
            }
            Driven::Vertices { vertices, direction } => {
                let along = |v: &usize| (0..3).map(|axis| (3 * v + axis, direction[axis])).collect();
                (model.support_moved(vertices.iter().map(along).collect(), false), 0.0, drive.to)
            }
            Driven::Loads if model.loads.is_empty() && model.pressures().iter().all(|(_, value)| *value == 0.0) => {
                return Err(DriveError::NoLoads);
            }
            Driven::Loads if !model.turning.is_empty() => return Err(DriveError::FreeRotation),
            Driven::Loads => (Effect::loads(&model, true, model.pressures()), begin, drive.to),
            Driven::Pressure(name) => {
                let (faces, _) = model.pressure_of(name).ok_or(DriveError::NoPressure)?;
                let value = begin * model.springs[faces.start].stiffness;
                (Effect::loads(&model, false, faces.map(|k| (k, 1.0)).collect()), value, drive.to)
            }
            Driven::Volume(name) => {
                let (volume, area) = model.hold_volume(name).ok_or(DriveError::NoPressure)?;
                (unit, volume_added) = (area, Some(volume.0..volume.0 + 1));
                (Effect::Prescribed(vec![volume]), 0.0, drive.to / area)
            }
            Driven::Lock(edges) => {
                let (effect, from) = Effect::locks(&model, edges)?;
                (effect, from, drive.to)
            }
            Driven::Rest => (Effect::rest(&model, drawn)?, begin, drive.to),
            Driven::Stiffness(kind) => Effect::stiffness(&model, *kind, drive.to)?,
        };
        if !((target - parameter).abs() > 0.0) {
            return Err(DriveError::NoWay { at: parameter });
        }
        let added = volume_added.unwrap_or(first..model.compliance.len());
        Ok(Self { unit, added, ..Self::driven(model, [parameter, target], effect) })
    }

    /// Makes a model whose rest values, those of locks and supports included, go from some at 0 to others at 1: one of
    /// each measure, as [`Model::values`] gives them.
    pub(crate) fn by_rests(model: Model, [from, to]: [Vec<f64>; 2]) -> Self {
        Self::driven(model, [0.0, 1.0], Effect::Rest { drawn: from, given: to })
    }

    /// Makes a model whose compliances of these bars, of the numbers among the stiff measures, go from one multiple of
    /// those given to another: of [`Model::rigid_bars`] to 0, of [`Model::soft_bars`] to 1.
    pub(crate) fn by_compliance(model: Model, bars: Vec<(usize, f64)>, multiples: [f64; 2]) -> Self {
        Self::driven(model, multiples, Effect::Compliance(bars))
    }

    fn driven(model: Model, [parameter, target]: [f64; 2], effect: Effect) -> Self {
        let (first, way) = (model.base.clone(), (target - parameter).abs());
        let mut driven = Self { model, parameter, target, way, effect, unit: 1.0, added: 0..0, first };
        driven.set_parameter(parameter);
        driven
    }

    /// Returns the parameter at the end of the drive.
    pub fn target(&self) -> f64 {
        self.target
    }

    /// Returns the driven value that belongs to a parameter.
    pub fn drive_at(&self, parameter: f64) -> f64 {
        if matches!(self.effect, Effect::Compliance(_)) { parameter.recip() } else { parameter * self.unit }
    }

    /// Returns the parameter that belongs to a driven value.
    pub fn parameter_at(&self, drive: f64) -> f64 {
        if matches!(self.effect, Effect::Compliance(_)) { drive.recip() } else { drive / self.unit }
    }

    /// Returns the reaction for a value of [`ParametrizedProblem::conjugate`]: the derivative of the energy by the
    /// driven value; for loads, their displacement along themselves since the beginning.
    pub fn reaction_of(&self, conjugate: f64, parameter: f64) -> f64 {
        match self.effect {
            Effect::Compliance(_) => -parameter * parameter * conjugate,
            _ => conjugate / self.unit,
        }
    }

    /// Returns the tensions of the model without drive.
    pub(crate) fn without_drive(&self, tension: &[f64]) -> Vec<f64> {
        [&tension[..self.added.start], &tension[self.added.end..]].concat()
    }

    /// Returns tensions of this model, zero where the model without drive, whose are given, has no measure.
    pub(crate) fn with_drive(&self, mut tension: Vec<f64>) -> Vec<f64> {
        tension.splice(self.added.start..self.added.start, vec![0.0; self.added.len()]);
        tension
    }

    /// Returns the work that the drive has done on the sheet, given the integral of the conjugate over the parameter.
    /// A load works through the displacement that is conjugate to it.
    pub fn work_of(&self, integral: f64, conjugate: f64, parameter: f64) -> f64 {
        match self.effect {
            Effect::Loads { .. } => parameter * conjugate - integral,
            _ => integral,
        }
    }

    /// Whether the parameter is a load and its conjugate a displacement, instead of the other way round.
    pub fn is_load(&self) -> bool {
        !matches!(self.effect, Effect::Prescribed(_))
    }

    /// Whether the parameter is a stiffness, or the reciprocal of one, which should not become negative.
    pub fn is_stiffness(&self) -> bool {
        matches!(self.effect, Effect::Compliance(_) | Effect::Stiffness(_))
    }

    /// Whether extrema of the conjugate mean anything to a user: those of forces, torques and displacements do, where
    /// there is anything that makes a force.
    pub fn has_conjugate_limits(&self) -> bool {
        let model = &self.model;
        let stores = model.soft_elements() > 0 || model.compliance().iter().any(|compliance| *compliance > 0.0);
        (stores || !model.loads.is_empty()) && matches!(self.effect, Effect::Prescribed(_) | Effect::Loads { .. })
    }
}

impl Model {
    /// Returns the stiff elements of a kind, each with its number among the stiff measures.
    pub(super) fn stiff_of(&self, kind: TermKind) -> impl Iterator<Item = (usize, Element<'_>)> {
        self.stiff().enumerate().filter(move |(_, element)| element.kind() == kind)
    }

    /// Returns the length in the drawn state between the first two points of an element: of its edge.
    pub(super) fn length_of(&self, element: &Element<'_>) -> f64 {
        let [from, to] = [0, 1].map(|n| self.equations.domain.point(&self.equations.drawn, element.sites()[n]));
        (to - from).norm()
    }
}

impl ParametrizedProblem for DrivenModel {
    fn parameter(&self) -> f64 {
        self.parameter
    }

    /// Angles, then the memories of all elements that have one.
    fn reference(&self, x: &[f64]) -> Vec<f64> {
        let memory = self.model.memory_after(x);
        self.model.angles().into_iter().chain(memory.iter().flat_map(|memory| [memory.kept, memory.gone])).collect()
    }

    fn set_reference(&mut self, reference: &[f64]) {
        let angles = self.model.elements().filter(Element::is_angle).count().min(reference.len());
        self.model.set_angles(&reference[..angles]);
        let memory = reference[angles..].chunks_exact(2).map(|pair| Memory { kept: pair[0], gone: pair[1] });
        self.model.set_memory(&memory.collect::<Vec<_>>());
    }

    fn has_kinks(&self) -> bool {
        self.model.remembers()
    }

    fn may_have_kinks(&self) -> bool {
        self.has_kinks() || self.model.elements().any(|element| element.has_kinks())
    }

    fn conjugate_integral(&self, x: &[f64], tension: &[f64]) -> f64 {
        let of_stiff = self.model.compliance().iter().zip(tension).map(|(c, t)| 0.5 * c * t * t).sum::<f64>();
        let potential = self.model.energy(x) + of_stiff;
        match &self.effect {
            Effect::Loads { origin, .. } => -potential - origin * self.parameter,
            _ => potential,
        }
    }

    fn choice(&self) -> Vec<f64> {
        if self.model.base == self.first { vec![] } else { self.model.base.clone() }
    }

    fn set_choice(&mut self, choice: &[f64]) {
        let place = if choice.is_empty() { &self.first } else { choice };
        if self.model.base != place {
            self.model.rechoose(place.to_vec());
        }
    }

    fn set_parameter(&mut self, value: f64) {
        self.parameter = value;
        let model = &mut self.model;
        match &self.effect {
            Effect::Prescribed(offsets) => offsets.iter().for_each(|(k, offset)| model.prescribe(*k, value + offset)),
            Effect::Loads { forces, pressures, .. } => {
                if *forces {
                    model.load_factor = value;
                }
                pressures.iter().for_each(|(k, unit)| model.springs[*k].stiffness = value * unit);
            }
            Effect::Rest { drawn, given } => model.set_rests(drawn, given, value),
            Effect::Compliance(units) => units.iter().for_each(|(k, unit)| model.compliance[*k] = value * unit),
            Effect::Stiffness(units) => units.iter().for_each(|(k, unit)| model.springs[*k].stiffness = value * unit),
        }
    }

    fn parameter_scale(&self) -> f64 {
        self.way
    }

    fn parameter_rates(&self, at: &Linearization, x: &[f64], tension: &[f64]) -> [Vec<f64>; 2] {
        let (mut force, mut gap) = (vec![0.0; at.gradient.len()], vec![0.0; tension.len()]);
        let mut of_soft = vec![0.0; at.soft_stiffness.len()];
        match &self.effect {
            Effect::Prescribed(offsets) => offsets.iter().for_each(|(k, _)| gap[*k] = -1.0),
            Effect::Loads { forces, pressures, .. } => {
                if *forces {
                    force = self.model.load_rates(x);
                }
                pressures.iter().for_each(|(k, unit)| of_soft[*k] = -unit);
            }
            Effect::Rest { drawn, given } => {
                let moved: Vec<f64> = given.iter().zip(drawn).map(|(given, drawn)| given - drawn).collect();
                let by_rest = self.model.of_soft(x, Element::by_rest);
                by_rest.iter().enumerate().for_each(|(k, [_, force, _])| of_soft[k] = force * moved[k]);
                gap.iter_mut().zip(&moved[by_rest.len()..]).for_each(|(gap, moved)| *gap = -moved);
            }
            Effect::Compliance(units) => units.iter().for_each(|(k, unit)| gap[*k] = -unit * tension[*k]),
            Effect::Stiffness(units) => {
                let found = self.model.of_soft(x, Element::response);
                units.iter().for_each(|(k, _)| of_soft[*k] = found[*k][1] / self.parameter);
            }
        }
        at.soft_rows().add_transpose_product(&of_soft, &mut force);
        [force, gap]
    }

    fn conjugate(&self, _: &Linearization, x: &[f64], tension: &[f64]) -> f64 {
        match &self.effect {
            Effect::Prescribed(offsets) => -offsets.iter().map(|(k, _)| tension[*k]).sum::<f64>(),
            Effect::Loads { forces, origin, pressures } => {
                self.model.loaded_along(*forces, pressures, &self.model.coordinates(x)) - origin
            }
            Effect::Rest { drawn, given } => {
                let of_soft = self.model.of_soft(x, Element::by_rest).into_iter().map(|[energy, ..]| energy);
                let rates = of_soft.chain(tension.iter().map(|force| -force));
                rates.zip(given.iter().zip(drawn)).map(|(rate, (given, drawn))| rate * (given - drawn)).sum::<f64>()
            }
            Effect::Compliance(units) => {
                -units.iter().map(|(k, unit)| 0.5 * unit * tension[*k] * tension[*k]).sum::<f64>()
            }
            Effect::Stiffness(units) => {
                let found = self.model.of_soft(x, Element::response);
                units.iter().map(|(k, _)| found[*k][0] / self.parameter).sum()
            }
        }
    }

    fn conjugate_rate(&self, at: &Linearization, x: &[f64], tension: &[f64], rates: &Rates) -> f64 {
        let mut changes = vec![0.0; at.soft_stiffness.len()];
        at.soft_rows().product(&rates.x, &mut changes);
        match &self.effect {
            Effect::Prescribed(offsets) => -offsets.iter().map(|(k, _)| rates.tension[*k]).sum::<f64>(),
            Effect::Loads { forces, pressures, .. } => {
                let of_pressure = pressures.iter().map(|(k, unit)| unit * changes[*k]).sum::<f64>();
                let of_forces = if *forces { -dot(&self.model.load_rates(x), &rates.x) } else { 0.0 };
                of_pressure + of_forces
            }
            Effect::Rest { drawn, given } => {
                let moved: Vec<f64> = given.iter().zip(drawn).map(|(given, drawn)| given - drawn).collect();
                let soft = self.model.of_soft(x, Element::by_rest).into_iter().zip(&changes).zip(&moved);
                let of_soft =
                    soft.map(|(([_, force, energy], change), moved)| force * change + energy * moved * rates.parameter);
                let all = of_soft.chain(rates.tension.iter().map(|force| -force));
                all.zip(&moved).map(|(rate, moved)| rate * moved).sum::<f64>()
            }
            Effect::Compliance(units) => {
                -units.iter().map(|(k, unit)| unit * tension[*k] * rates.tension[*k]).sum::<f64>()
            }
            Effect::Stiffness(units) => {
                let found = self.model.of_soft(x, Element::response);
                units.iter().map(|(k, _)| found[*k][1] / self.parameter * changes[*k]).sum()
            }
        }
    }
}

impl Problem for DrivenModel {
    fn layout(&self) -> &Arc<Layout> {
        self.model.layout()
    }

    fn compliance(&self) -> &[f64] {
        self.model.compliance()
    }

    fn gap_scale(&self) -> &[f64] {
        self.model.gap_scale()
    }

    fn proportions(&self) -> Vec<f64> {
        self.model.proportions()
    }

    fn unit_of_length(&self) -> f64 {
        self.model.unit_of_length()
    }

    fn energy(&self, x: &[f64]) -> f64 {
        self.model.energy(x)
    }

    fn gaps(&self, x: &[f64]) -> Vec<f64> {
        self.model.gaps(x)
    }

    fn linearize(&self, x: &[f64], tension: &[f64], kind: HessianKind, out: &mut Linearization) {
        self.model.linearize(x, tension, kind, out);
    }

    fn admits(&self, from: &[f64], to: &[f64]) -> bool {
        self.model.admits(from, to)
    }

    fn breakdown(&self, x: &[f64]) -> Option<Collapse> {
        self.model.breakdown(x)
    }

    /// Keeps the unknowns: the path's tangents and earlier states are written in them.
    fn accept(&mut self, x: &mut [f64]) {
        let all = self.model.generalised(x);
        self.model.accept_angles(&all[..self.model.points()]);
    }

    fn choose_anew(&mut self, x: &[f64], rates: &[f64]) -> Option<[Vec<f64>; 2]> {
        self.model.choose_anew(x, rates)
    }
}
