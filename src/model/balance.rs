//! Whether loads balance on the pieces of a sheet that nothing supports along them.

use super::assembly::Assembly;
use super::assembly_error::AssemblyError;
use super::problem::Gauge;
use crate::math::Vec3;

/// Largest component of the sum of the loads on a piece, relative to the largest of any load, that counts as balanced.
const BALANCED: f64 = 1e-12;
/// Part of a direction that is not among others, relative to its length, below which it counts as one of them.
const SAME_DIRECTION: f64 = 1e-9;

impl Assembly {
    /// Checks that the loads on every connected piece balance along each direction in which it is free: otherwise there is
    /// no equilibrium. Pins, guides and parts that are held along an axis support loads, and so do `driven` vertices along
    /// unit vectors.
    ///
    /// # Errors
    /// [`AssemblyError::Unbalanced`] for the first piece on which loads are neither balanced nor supported, with the axis
    /// along which most of them is left.
    pub fn check_balance(&self, driven: &[(usize, Vec3)]) -> Result<(), AssemblyError> {
        let terms = self.terms();
        if terms.loads.is_empty() {
            return Ok(());
        }
        let along = |vertex: usize, held: [bool; 3]| {
            (0..3).filter(move |axis| held[*axis]).map(move |axis| (vertex, Vec3::ith(axis, 1.0)))
        };
        let parts =
            terms.parts.iter().filter_map(|part| Some((*part.vertices.first()?, [0, 1, 2].map(|k| !part.free[k]))));
        let held = terms.pins.iter().copied().chain(parts).flat_map(|(vertex, held)| along(vertex, held));
        let supports: Vec<_> = held.chain(terms.guides.iter().copied()).chain(driven.iter().copied()).collect();
        let largest = terms.loads.iter().map(|(_, force)| force.amax()).fold(0.0, f64::max);
        let pieces = self.model(Gauge::Held).vertices_of_pieces();
        for piece in &pieces {
            let here = |vertex: &usize| piece.binary_search(vertex).is_ok();
            let load: Vec3 = terms.loads.iter().filter(|(vertex, _)| here(vertex)).map(|(_, force)| force).sum();
            let directions = supports.iter().filter(|(vertex, _)| here(vertex)).map(|(_, direction)| *direction);
            let left = across(load, directions);
            let (axis, piece) = (left.iamax(), piece.first().copied().filter(|_| pieces.len() > 1));
            if left[axis].abs() > BALANCED * largest {
                return Err(AssemblyError::Unbalanced { piece, axis, force: left[axis] });
            }
        }
        Ok(())
    }
}

/// The part of a force that is across all of these directions, which may depend on each other.
fn across(mut force: Vec3, directions: impl Iterator<Item = Vec3>) -> Vec3 {
    let mut known: Vec<Vec3> = Vec::new();
    for direction in directions {
        let own = known.iter().fold(direction, |own, other| own - other * other.dot(&own));
        let Some(own) = own.try_normalize(SAME_DIRECTION) else { continue };
        force -= own * own.dot(&force);
        known.push(own);
    }
    force
}
