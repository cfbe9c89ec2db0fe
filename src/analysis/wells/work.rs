//! The work of loads, which the energy of a loaded sheet includes.

use crate::math::{Vec3, point};
use crate::model::{Assembly, Gauge, Model};

/// The loads on a sheet, and where they act in the drawn state.
#[derive(Clone)]
pub(crate) struct Work {
    loads: Vec<Load>,
    /// Where faces are under pressure: the model, and the work to the drawn state from that of no volume.
    pressure: Option<(Model, f64)>,
}

#[derive(Clone, Debug)]
struct Load {
    vertex: usize,
    force: Vec3,
    drawn: Vec3,
}

impl Work {
    /// Returns the work of the loads of an assembly.
    pub(crate) fn new(assembly: &Assembly) -> Self {
        let coordinates = &assembly.drawn().coordinates;
        let load = |&(vertex, force): &(usize, Vec3)| Load { vertex, force, drawn: point(coordinates, vertex) };
        let pressed = assembly.terms().own.iter().any(|term| term.is_load());
        let pressure = pressed.then(|| assembly.model(Gauge::Held)).map(|model| {
            let drawn = model.work_of_pressure(coordinates);
            (model, drawn)
        });
        Self { loads: assembly.terms().loads.iter().map(load).collect(), pressure }
    }

    /// Returns the work of the loads from the drawn state to the state with these coordinates.
    pub(crate) fn to(&self, coordinates: &[f64]) -> f64 {
        let moved = |load: &Load| load.force.dot(&(point(coordinates, load.vertex) - load.drawn));
        let of_pressure = self.pressure.as_ref().map(|(model, drawn)| model.work_of_pressure(coordinates) - drawn);
        self.loads.iter().map(moved).sum::<f64>() + of_pressure.unwrap_or(0.0)
    }
}
