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
use crate::math::{Vec3, point};
use crate::model::Local;
use crate::numerics::{DenseMatrix, larger};
use nalgebra::{Matrix2, Vector2};
use std::f64::consts::SQRT_2;

/// Components of strain and of curvature.
pub(super) const MACROSCOPIC: usize = 6;

/// Rates of the measures of some elements, all of them lengths: a fold angle counts times the root of the cell's area,
/// so that no unit decides which of them matter.
pub(super) struct MeasureRates {
    /// Per unit velocity of the vertices of the cell: a row for each element, three columns for each vertex.
    pub by_vertices: DenseMatrix,
    /// Per unit of `[e11, e22, e12, k11, k22, k12]`.
    pub by_lattice: DenseMatrix,
    /// Magnitude of the terms of which the rates by vertices are sums.
    pub terms: f64,
}

/// Returns the components of a strain and a curvature in their norm, that of tensors with lengths in this unit, per
/// component of `[e11, e22, e12, k11, k22, k12]`.
pub(super) fn units(length: f64) -> [f64; MACROSCOPIC] {
    [1.0, 1.0, SQRT_2, length, length, SQRT_2 * length]
}

impl MeasureRates {
    /// Returns the rates by motions of the cell in which vertex 0 does not move: the velocities of the other vertices,
    /// then strain and curvature in their norm, lengths in this unit.
    pub(super) fn by_motions(&self, length: f64) -> DenseMatrix {
        let (vertices, units) = (self.by_vertices.ncols() - 3, units(length));
        DenseMatrix::from_fn(self.by_vertices.nrows(), vertices + MACROSCOPIC, |row, column| {
            match column.checked_sub(vertices) {
                Some(component) => self.by_lattice[(row, component)] / units[component] / length,
                None => self.by_vertices[(row, column + 3)],
            }
        })
    }
}

/// Returns the rates of the measures of these elements of a cell.
pub(super) fn rates(cell: &PeriodicCell, elements: &[CellElement<'_>]) -> MeasureRates {
    let (vertices, length) = (cell.sheet.vertices.len(), cell.area().sqrt());
    let mut terms = 0.0;
    let mut by_vertices = DenseMatrix::zeros(elements.len(), 3 * vertices);
    let mut by_lattice = DenseMatrix::zeros(elements.len(), MACROSCOPIC);
    let unit = |k: usize| [0, 1, 2, 3, 4, 5].map(|component| f64::from(u8::from(component == k)));
    let moving: Vec<[Moving; 2]> = (0..MACROSCOPIC).map(|component| lattice_motions(cell, unit(component))).collect();
    let mut local = Local::default();
    for (row, element) in elements.iter().enumerate() {
        element.element.local(&cell.coordinates, false, &mut local);
        let unit = if element.element.is_angle() { length } else { 1.0 };
        for (k, place) in element.places.iter().enumerate() {
            let gradient = point(&local.gradient, k) * unit;
            terms = larger(terms, gradient.amax());
            (0..3).for_each(|axis| by_vertices[(row, 3 * place.vertex + axis)] += gradient[axis]);
            for (component, lattice) in moving.iter().enumerate() {
                let there = Moving::lattice_power(lattice, place.shift);
                let velocity = there.carry(&cell.sheet.vertices[place.vertex], &Vec3::zeros());
                by_lattice[(row, component)] += gradient.dot(&velocity);
            }
        }
    }
    MeasureRates { by_vertices, by_lattice, terms }
}

/// Returns the lattice motions at these rates of `[e11, e22, e12, k11, k22, k12]`.
pub(super) fn lattice_motions(cell: &PeriodicCell, [e11, e22, e12, k11, k22, k12]: [f64; MACROSCOPIC]) -> [Moving; 2] {
    let [strain, curvature] = [Matrix2::new(e11, e12, e12, e22), Matrix2::new(k11, k12, k12, k22)];
    let [x, y] = cell.plane();
    let in_space = |v: Vector2<f64>| x * v[0] + y * v[1];
    let in_plane = |v: &Vec3| Vector2::new(x.dot(v), y.dot(v));
    cell.lattice.map(|l| {
        let chord = 0.5 * in_space(strain * in_plane(&l));
        let angular = in_space(curvature * in_plane(&l)).cross(&cell.normal());
        Moving { motion: Motion::shift(l), twist: Twist { angular, linear: chord - angular.cross(&l) } }
    })
}
