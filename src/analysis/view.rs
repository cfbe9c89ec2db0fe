//! Which copies of the cell a picture shows, and where they are in a state.

use crate::math::Vec3;
use crate::model::assemble::{Drawn, Surroundings};
use crate::model::{Domain, Site};
use crate::sheet::{Sheet, Tiling, tile};
use std::collections::HashMap;

/// A patch of cells on which a state is shown: the patch itself, one period of a torus, some cells of a screw.
pub struct View {
    /// The cells shown, as a patch: no vertex is added at its rim.
    pub patch: Tiling,
    /// Edge of the model's tiling of which each line of the patch is a copy.
    pub edges: Vec<usize>,
    /// Vertex of the model, and the copy of it, at each point of the patch.
    sites: Vec<Site>,
}

impl View {
    /// The view of a tiling; of a screw `shown` cells.
    pub fn new(sheet: &Sheet, tiling: &Tiling, surroundings: Surroundings, shown: [usize; 2]) -> Self {
        let cells = if surroundings == Surroundings::Screw { shown } else { tiling.cells };
        Self::of_cells(sheet, tiling, cells, [0, 0])
    }

    /// The view of `cells`, beginning at the cell `first` of a tiling; a periodic one goes on beyond its last cell.
    pub fn of_cells(sheet: &Sheet, tiling: &Tiling, cells: [usize; 2], first: [i32; 2]) -> Self {
        let patch = tile(sheet, cells, false);
        let vertices = sheet.vertices.len();
        let period = tiling.cells.map(|n| n as i32);
        // the cell of the tiling that a cell of the patch is, and the copy of it
        let place = |cell: [usize; 2]| {
            let at = [0, 1].map(|k| cell[k] as i32 + first[k]);
            let within = [0, 1].map(|k| at[k].rem_euclid(period[k]) as usize);
            (within, [0, 1].map(|k| at[k].div_euclid(period[k])))
        };
        let site = |k: usize| {
            let (vertex, cell) = (k % vertices, k / vertices);
            let ([c1, c2], shift) = place([cell % cells[0], cell / cells[0]]);
            Site { vertex: (c2 * tiling.cells[0] + c1) * vertices + vertex, shift }
        };
        let sites = (0..patch.positions.len()).map(site).collect();
        let number: HashMap<(usize, [usize; 2]), usize> =
            tiling.edges.iter().enumerate().map(|(k, edge)| ((edge.edge, edge.cell), k)).collect();
        let edges = patch.edges.iter().map(|e| number[&(e.edge, place(e.cell).0)]).collect();
        Self { patch, edges, sites }
    }

    /// Positions of all points in the frame of the mesh file, vertex 0 of a screw where it was drawn.
    pub fn positions(&self, drawn: &Drawn, coordinates: &[f64]) -> Vec<Vec3> {
        let back = drawn.frame.transpose();
        let centre = match drawn.domain {
            Domain::Screw => Vec3::from_column_slice(&coordinates[..3]),
            _ => Vec3::zeros(),
        };
        self.sites.iter().map(|&site| back * (drawn.domain.point(coordinates, site) - centre) + drawn.origin).collect()
    }

    /// Velocities of all points when the coordinates have these rates, by central differences.
    pub fn velocities(&self, drawn: &Drawn, rates: &[f64]) -> Vec<Vec3> {
        let step = 1e-5;
        let moved = |sign: f64| {
            let x: Vec<f64> = drawn.coordinates.iter().zip(rates).map(|(x, v)| x + sign * step * v).collect();
            self.positions(drawn, &x)
        };
        moved(1.0).iter().zip(moved(-1.0)).map(|(a, b)| (a - b) / (2.0 * step)).collect()
    }

    /// Values of the edges of the model from values of lines between the points of the patch; NaN where no line is a copy of the edge.
    pub fn on_edges(&self, edges: usize, lines: &[[usize; 2]], values: &[f64]) -> Vec<f64> {
        let sorted = |[a, b]: [usize; 2]| [a.min(b), a.max(b)];
        let given: HashMap<[usize; 2], f64> =
            lines.iter().map(|line| sorted(*line)).zip(values.iter().copied()).collect();
        let mut found = vec![f64::NAN; edges];
        for (line, &edge) in self.patch.edges.iter().zip(&self.edges) {
            if let Some(value) = given.get(&sorted(line.ends.map(|site| site.vertex))) {
                found[edge] = *value;
            }
        }
        found
    }

    /// The coordinates of a state whose points are these; `None` where points do not say all (a free lattice, a screw)
    /// or their number is another one.
    pub fn coordinates(&self, drawn: &Drawn, points: &[Vec3]) -> Option<Vec<f64>> {
        let known = matches!(drawn.domain, Domain::Patch | Domain::FixedTorus(_));
        let place = |p: &Vec3| <[f64; 3]>::from(p - drawn.origin);
        (known && points.len() == self.sites.len()).then(|| points.iter().flat_map(place).collect())
    }
}
