//! The work of loads, which the energy of a loaded sheet includes.

use crate::math::Vec3;
use crate::model::Assembly;

/// The loads on a sheet, and where they act in the drawn state.
#[derive(Clone, Debug)]
pub(crate) struct Work(Vec<Load>);

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
        Self(assembly.terms().loads.iter().map(load).collect())
    }

    /// Returns the work of the loads from the drawn state to the state with these coordinates.
    pub(crate) fn to(&self, coordinates: &[f64]) -> f64 {
        self.0.iter().map(|load| load.force.dot(&(point(coordinates, load.vertex) - load.drawn))).sum()
    }
}

fn point(coordinates: &[f64], vertex: usize) -> Vec3 {
    Vec3::from_column_slice(&coordinates[3 * vertex..3 * vertex + 3])
}
