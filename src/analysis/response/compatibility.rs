//! Compatibility: rates of lengths and fold angles when the vertices of a cell move and the lattice is strained and
//! bent.
//!
//! The copy of vertex `x` in the cell `(n1, n2)` moves with the twist of `A1^n1 A2^n2`, where the lattice motion
//! `A_a x = S_a x + l_a` changes at the rates `Omega_a` and `dl_a`. A strain `E` and a curvature tensor `K` give
//!
//! `dl_a = E l_a / 2`,   `(Omega_a x l_b) . n = l_a . K l_b`,
//!
//! with `Omega_a` in the plane of the lattice. The tilt of the lattice vectors, which turns the sheet as a whole, is
//! zero. To first order such motions commute for every `K`.

use super::cell::{CellElement, PeriodicCell};
use crate::kinematics::motion::{Motion, Moving, Rigid, Twist};
use crate::math::Vec3;
use crate::model::Local;
use crate::numerics::{DenseMatrix, larger};
use nalgebra::{Matrix2, Vector2};

/// Components of strain and of curvature.
pub(super) const MACROSCOPIC: usize = 6;

/// Rates of the measures of some elements, all of them lengths: a fold angle counts times the root of the cell's area,
/// so that no unit decides which of them matter.
pub(super) struct Rates {
    /// Per unit velocity of the vertices of the cell: a row for each element, three columns for each vertex.
    pub by_vertices: DenseMatrix,
    /// Per unit of `[e11, e22, e12, k11, k22, k12]`.
    pub by_lattice: DenseMatrix,
    /// Magnitude of the terms of which the rates by vertices are sums.
    pub terms: f64,
}

/// Returns the rates of the measures of these elements of a cell.
pub(super) fn rates(cell: &PeriodicCell, elements: &[CellElement<'_>]) -> Rates {
    let (vertices, length) = (cell.sheet.vertices.len(), cell.area().sqrt());
    let mut terms = 0.0;
    let mut by_vertices = DenseMatrix::zeros(elements.len(), 3 * vertices);
    let mut by_lattice = DenseMatrix::zeros(elements.len(), MACROSCOPIC);
    let moving: Vec<[Moving; 2]> = (0..MACROSCOPIC).map(|component| lattice_motions(cell, component)).collect();
    let mut local = Local::default();
    for (row, element) in elements.iter().enumerate() {
        element.element.local(&cell.coordinates, false, &mut local);
        let unit = if element.element.is_angle() { length } else { 1.0 };
        for (k, place) in element.places.iter().enumerate() {
            let gradient = Vec3::from_column_slice(&local.gradient[3 * k..3 * k + 3]) * unit;
            terms = larger(terms, gradient.amax());
            (0..3).for_each(|axis| by_vertices[(row, 3 * place.vertex + axis)] += gradient[axis]);
            for (component, lattice) in moving.iter().enumerate() {
                let there = Moving::lattice_power(lattice, place.shift);
                let velocity = there.carry(&cell.sheet.vertices[place.vertex], &Vec3::zeros());
                by_lattice[(row, component)] += gradient.dot(&velocity);
            }
        }
    }
    Rates { by_vertices, by_lattice, terms }
}

/// Returns the lattice motions at the unit rate of one component of strain or curvature.
fn lattice_motions(cell: &PeriodicCell, component: usize) -> [Moving; 2] {
    let tensor = match component % 3 {
        0 => Matrix2::new(1.0, 0.0, 0.0, 0.0),
        1 => Matrix2::new(0.0, 0.0, 0.0, 1.0),
        _ => Matrix2::new(0.0, 1.0, 1.0, 0.0),
    };
    let [x, y] = cell.plane();
    let in_space = |v: Vector2<f64>| x * v[0] + y * v[1];
    let in_plane = |v: &Vec3| Vector2::new(x.dot(v), y.dot(v));
    cell.lattice.map(|l| {
        let moved = in_space(tensor * in_plane(&l));
        let (angular, chord) =
            if component < 3 { (Vec3::zeros(), 0.5 * moved) } else { (moved.cross(&cell.normal()), Vec3::zeros()) };
        Moving { motion: Motion::shift(l), twist: Twist { angular, linear: chord - angular.cross(&l) } }
    })
}
