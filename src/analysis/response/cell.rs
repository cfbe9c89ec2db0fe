//! The cell of a sheet in a spatially periodic state: its geometry, and the elements of a model in it.

use super::error::ResponseError;
use crate::math::Vec3;
use crate::model::{Assembly, Domain, Element, Model, Site};
use crate::sheet::{Corner, Sheet};
use std::collections::BTreeSet;

/// Rotation of a cell in radians below which the state counts as spatially periodic: the axis of a screw is known to
/// rounding over this angle.
const NO_TURN: f64 = 1e-8;
/// Largest relative difference of a stiffness or a rest value between two cells.
const SAME_VALUE: f64 = 1e-12;

/// One cell of a periodic state.
pub(super) struct PeriodicCell {
    /// The cell in this state, vertex 0 at the origin, in the orientation of the mesh file.
    pub sheet: Sheet,
    /// The lattice vectors of the state.
    pub lattice: [Vec3; 2],
    /// The edges that keep their fold angles.
    pub locked: BTreeSet<usize>,
    /// The model of the assembly, whose angles continue from those of the state.
    pub model: Model,
    /// Numbers of cells of the model.
    pub cells: [usize; 2],
    /// The map from `coordinates` to points: a torus with the lattice of the state.
    pub domain: Domain,
    /// Positions of all vertices of the model.
    pub coordinates: Vec<f64>,
}

/// An element of the cell.
pub(super) struct CellElement<'a> {
    /// The element of the model, with its points on the torus of the state.
    pub element: Element<'a>,
    /// Its edge in the tiling.
    pub edge: usize,
    /// Vertices of the cell and their cells at the points of the element.
    pub places: Vec<Site>,
}

impl PeriodicCell {
    /// Makes the cell of a state with a model of the assembly; `None` if the state is rolled up to a cylinder.
    pub(super) fn of_state(assembly: &Assembly, x: &[f64], model: Model) -> Result<Option<Self>, ResponseError> {
        let (drawn, cells) = (assembly.drawn(), assembly.tiling().cells);
        if matches!(drawn.domain, Domain::Patch | Domain::Own(_)) {
            return Err(ResponseError::NotPeriodic);
        }
        if drawn.domain.turns(x).is_some_and(|turns| turns.theta.iter().any(|theta| theta.abs() > NO_TURN)) {
            return Ok(None);
        }
        let count = cells[0] * cells[1];
        if count > 1 && *x != drawn.coordinates[..] {
            return Err(ResponseError::SeveralCells { cells: count });
        }
        let back = drawn.frame.transpose();
        let origin = drawn.domain.point(x, Site { vertex: 0, shift: [0, 0] });
        let at = |vertex: usize, shift: [i32; 2]| back * (drawn.domain.point(x, Site { vertex, shift }) - origin);
        let lattice = match assembly.sheet().lattice {
            Some(lattice) if count > 1 => lattice,
            _ => [at(0, [1, 0]), at(0, [0, 1])],
        };
        let vertices: Vec<Vec3> = (0..assembly.sheet().vertices.len()).map(|vertex| at(vertex, [0, 0])).collect();
        let number = vertices.len();
        let copies = (0..number * count).map(|k| {
            let cell = k / number;
            let [c1, c2] = [cell % cells[0], cell / cells[0]].map(|c| c as f64);
            vertices[k % number] + c1 * lattice[0] + c2 * lattice[1]
        });
        let coordinates = copies.flat_map(<[f64; 3]>::from).collect();
        let domain = Domain::FixedTorus([0, 1].map(|k| cells[k] as f64 * lattice[k]));
        let sheet = Sheet { vertices, lattice: Some(lattice), ..assembly.sheet().clone() };
        let locked = assembly.locked_edges().into_iter().map(|edge| assembly.tiling().edges[edge].edge).collect();
        let cell = Self { sheet, lattice, locked, model, cells, domain, coordinates };
        cell.check_even(assembly)?;
        Ok(Some(cell))
    }

    /// Checks that all cells have the same elements, which are springs at rest.
    fn check_even(&self, assembly: &Assembly) -> Result<(), ResponseError> {
        if let Some(element) = self.model.elements().find(|element| !element.is_spring_at_rest()) {
            return Err(ResponseError::NoSpringAtRest { term: element.kind().name() });
        }
        let edges = &assembly.tiling().edges;
        let close = |a: f64, b: f64| a == b || (a - b).abs() <= SAME_VALUE * a.abs().max(b.abs()).max(1.0);
        let of_cell = |element: &Element<'_>| element.edge().map(|edge| edges[edge].edge);
        for CellElement { element, edge, .. } in self.elements(assembly, &self.model) {
            let (spring, edge) = (element.spring, edges[edge].edge);
            let alike = |other: &Element<'_>| other.kind() == element.kind() && !other.is_beyond_spring();
            let same = self.model.elements().filter(alike);
            let same: Vec<_> = same.filter(|other| of_cell(other) == Some(edge)).collect();
            let even = |other: &Element<'_>| {
                close(spring.stiffness, other.spring.stiffness) && close(spring.rest, other.spring.rest)
            };
            if same.len() % (self.cells[0] * self.cells[1]) != 0 || !same.iter().all(even) {
                return Err(ResponseError::UnevenCells { edge });
            }
        }
        Ok(())
    }

    /// Returns the elements that a model of the assembly has in one cell.
    pub(super) fn elements<'a>(&'a self, assembly: &'a Assembly, model: &'a Model) -> Vec<CellElement<'a>> {
        let (edges, vertices) = (&assembly.tiling().edges, self.sheet.vertices.len());
        let place = |site: &Site| {
            let cell = [(site.vertex / vertices) % self.cells[0], (site.vertex / vertices) / self.cells[0]];
            let shift = [0, 1].map(|k| cell[k] as i32 + site.shift[k] * self.cells[k] as i32);
            Site { vertex: site.vertex % vertices, shift }
        };
        // a law is a spring at rest: what it stores beyond that has no stiffness there
        let springs = model.elements().filter(|element| !element.is_beyond_spring());
        let placed = |element: Element<'a>| {
            let edge = element.edge().filter(|edge| edges[*edge].cell == [0, 0])?;
            let places = element.sites().iter().map(place).collect();
            Some(CellElement { element: element.on(&self.domain), edge, places })
        };
        springs.filter_map(placed).collect()
    }

    /// Area of the cell, between the lattice vectors.
    pub(super) fn area(&self) -> f64 {
        self.lattice[0].cross(&self.lattice[1]).norm()
    }

    /// Unit normal of the lattice on the side of the face normals.
    pub(super) fn normal(&self) -> Vec3 {
        let area = |corners: [Corner; 3]| {
            let [a, b, c] = corners.map(|corner| self.sheet.position(corner));
            (b - a).cross(&(c - a))
        };
        let faces: Vec3 = self.sheet.triangles.iter().map(|triangle| area(triangle.corners)).sum();
        let across = self.lattice[0].cross(&self.lattice[1]).normalize();
        if across.dot(&faces) < 0.0 { -across } else { across }
    }

    /// Unit vectors in the plane of the lattice: along the first lattice vector, and across it towards the second.
    pub(super) fn plane(&self) -> [Vec3; 2] {
        let [l1, l2] = &self.lattice;
        let x = l1.normalize();
        [x, (l2 - x * x.dot(l2)).normalize()]
    }
}
