//! A state of a sheet as a value: what answers, files and restarts hold, and what every analysis begins from.

use super::assembly::Assembly;
use super::element::Element;
use super::law::Memory;
use super::problem::Gauge;
use super::problem::Model;
use crate::sheet::Site;
use crate::solver::{Problem, Start};
use serde::{Deserialize, Serialize};
use std::collections::HashMap;

/// A state of a sheet, independent of how a model numbers its unknowns.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Configuration {
    /// All coordinates: x, y and z of every vertex in the unit of length of the sheet, then those that all points
    /// share; see [`Domain`](super::Domain).
    pub coordinates: Vec<f64>,
    /// Angles of all hinges of the model in radians, from which later angles continue without jumps of `2 pi`; see
    /// [`Model::angles`].
    pub angles: Vec<f64>,
    /// Tensions of the stiff measures of the model; `None` where they are not known.
    #[serde(default)]
    pub tension: Option<Vec<f64>>,
    /// Memories of the elements whose law has one, as those that yield, soft elements first; empty where no law has one.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub memory: Vec<Memory>,
}

impl Configuration {
    /// A state whose elements remember nothing.
    pub fn new(coordinates: Vec<f64>, angles: Vec<f64>, tension: Option<Vec<f64>>) -> Self {
        Self { coordinates, angles, tension, memory: vec![] }
    }

    /// The tensions; none where they are not known.
    pub fn tensions(&self) -> &[f64] {
        self.tension.as_deref().unwrap_or_default()
    }

    /// The same state, whose tensions are not known.
    #[must_use]
    pub fn without_tension(&self) -> Self {
        Self { tension: None, ..self.clone() }
    }

    /// This state of an assembly as one of another assembly of the same vertices, with other terms: locks, panels, laws.
    /// Hinges and bars on the same points keep their angles and memories, others have those of the drawn state and none;
    /// tensions are kept where the stiff measures are the same.
    #[must_use]
    pub fn carried(&self, from: &Assembly, to: &Assembly) -> Self {
        let (from, to) = (from.model(Gauge::Free), to.model(Gauge::Free));
        let angle_at: HashMap<_, f64> = hinges(&from).zip(self.angles.iter().copied()).collect();
        let memory_at: HashMap<_, Memory> = yielding(&from).zip(self.memory.iter().copied()).collect();
        let angle = |(place, own)| angle_at.get(&place).copied().unwrap_or(own);
        let same =
            from.stiff().map(place).eq(to.stiff().map(place)) && from.compliance().len() == to.compliance().len();
        Self {
            coordinates: self.coordinates.clone(),
            angles: hinges(&to).zip(to.angles()).map(angle).collect(),
            tension: self.tension.clone().filter(|_| same),
            memory: yielding(&to).map(|place| memory_at.get(&place).copied().unwrap_or_default()).collect(),
        }
    }
}

/// Whether an element has an angle, and the points on which it stands.
type Place<'a> = (bool, &'a [Site]);

fn place<'a>(element: Element<'a>) -> Place<'a> {
    (element.is_angle(), element.sites())
}

fn hinges(model: &Model) -> impl Iterator<Item = Place<'_>> {
    model.elements().filter(Element::is_angle).map(place)
}

fn yielding(model: &Model) -> impl Iterator<Item = Place<'_>> {
    model.elements().filter(Element::remembers).map(place)
}

impl Model {
    /// The state with these unknowns, where the angles of hinges last continued, and these tensions.
    pub fn configuration(&self, x: &[f64], tension: Option<Vec<f64>>) -> Configuration {
        Configuration { coordinates: self.coordinates(x), angles: self.angles(), tension, memory: self.memory_after(x) }
    }

    /// Makes a state the reference state: coordinates held against drift keep the values that they have in it, and
    /// angles continue from its own. Returns its unknowns, and its tensions where the state has as many as the model
    /// has stiff measures.
    pub fn enter(&mut self, state: &Configuration) -> Start {
        self.set_angles(&state.angles);
        self.set_memory(&state.memory);
        let x = self.start_from(state.coordinates.clone());
        let measures = self.compliance().len();
        Start { x, tension: state.tension.clone().filter(|tension| tension.len() == measures) }
    }
}
