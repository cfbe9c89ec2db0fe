//! The work of loads, which the energy of a loaded sheet includes.

use crate::math::{Vec3, point};
use crate::model::{Assembly, Gauge, Model};

/// The loads on a sheet, and where they act in the drawn state.
#[derive(Clone)]
pub(crate) struct Work {
    loads: Vec<(usize, Vec3)>,
    drawn: Vec<f64>,
    /// Where faces are under pressure: the model, and the work to the drawn state from that of no volume.
    pressure: Option<(Model, f64)>,
}

impl Work {
    /// Returns the work of the loads of an assembly.
    pub(crate) fn new(assembly: &Assembly) -> Self {
        let drawn = assembly.drawn().coordinates.clone();
        let pressed = assembly.terms().own.iter().any(|term| term.is_load());
        let pressure = pressed.then(|| assembly.model(Gauge::Held)).map(|model| {
            let work = model.work_of_pressure(&drawn);
            (model, work)
        });
        Self { loads: assembly.terms().loads.clone(), drawn, pressure }
    }

    /// Returns the work of the loads from the drawn state to the state with these coordinates.
    pub(crate) fn to(&self, coordinates: &[f64]) -> f64 {
        let moved =
            |(vertex, force): &(usize, Vec3)| force.dot(&(point(coordinates, *vertex) - point(&self.drawn, *vertex)));
        let of_pressure = self.pressure.as_ref().map(|(model, drawn)| model.work_of_pressure(coordinates) - drawn);
        self.loads.iter().map(moved).sum::<f64>() + of_pressure.unwrap_or(0.0)
    }
}
