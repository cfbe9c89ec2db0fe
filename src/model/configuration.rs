//! A state of a sheet as a value: what answers, files and restarts hold, and what every analysis begins from.

use super::law::Memory;
use super::problem::Model;
use crate::solver::{Problem, Start};
use serde::{Deserialize, Serialize};

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
