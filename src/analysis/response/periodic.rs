//! The cell of a sheet in a spatially periodic state, and the response of its modes.

use super::mode::{Field, LinearMode, ModeTable, RawTable};
use super::poisson::Poisson;
use super::stresses;
use super::tensors::mixed_determinant;
use super::{LatticeMotions, Response, ResponseError};
use crate::kinematics::metric::LatticeFrame;
use crate::kinematics::{Displacement, Embedding, FoldingModes, folding_modes_with_locked};
use crate::math::Vec3;
use crate::model::{Assembly, Domain, Elements, Model, Site};
use crate::numerics::larger;
use crate::sheet::{Corner, Sheet};
use nalgebra::DVector;

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
    pub locked: Vec<usize>,
    /// The model of the assembly, whose angles continue from those of the state.
    pub model: Model,
    /// Numbers of cells of the model.
    pub cells: [usize; 2],
    /// The map from `coordinates` to points: a torus with the lattice of the state.
    pub domain: Domain,
    /// Positions of all vertices of the model.
    pub coordinates: Vec<f64>,
}

/// An element of the cell: a term of the model, and the number of the element in it.
pub(super) struct CellElement<'a> {
    /// The term.
    pub term: &'a dyn Elements,
    /// Number of the element in the term.
    pub number: usize,
    /// Vertices of the cell and their cells at the points of the element.
    pub places: Vec<Site>,
}

impl PeriodicCell {
    /// Makes the cell of a state with a model of the assembly; `None` if the state is rolled up to a cylinder.
    ///
    /// # Errors
    /// [`ResponseError`] for a patch, for several cells in another state than the drawn one, and for cells that differ.
    pub(super) fn of_state(assembly: &Assembly, x: &[f64], model: Model) -> Result<Option<Self>, ResponseError> {
        let (drawn, cells) = (assembly.drawn(), assembly.tiling().cells);
        if matches!(drawn.domain, Domain::Patch) {
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
        let locked = assembly.locked_edges().into_iter().map(|edge| assembly.tiling().edges[edge].edge);
        let mut locked: Vec<usize> = locked.collect();
        locked.sort_unstable();
        locked.dedup();
        let cell = Self { sheet, lattice, locked, model, cells, domain, coordinates };
        cell.check_even(assembly)?;
        Ok(Some(cell))
    }

    /// Checks that all cells have the same elements.
    fn check_even(&self, assembly: &Assembly) -> Result<(), ResponseError> {
        let edges = &assembly.tiling().edges;
        let close = |a: f64, b: f64| a == b || (a - b).abs() <= SAME_VALUE * a.abs().max(b.abs()).max(1.0);
        for element in self.elements(assembly) {
            let (term, spring) = (element.term, element.term.spring(element.number));
            let edge = edges[term.edge(element.number)].edge;
            let same = (0..term.len()).filter(|&k| edges[term.edge(k)].edge == edge).collect::<Vec<_>>();
            let even = |k: &usize| {
                let other = term.spring(*k);
                close(spring.stiffness, other.stiffness) && close(spring.rest, other.rest)
            };
            if same.len() % (self.cells[0] * self.cells[1]) != 0 || !same.iter().all(even) {
                return Err(ResponseError::UnevenCells { edge });
            }
        }
        Ok(())
    }

    /// Returns the elements of one cell.
    pub(super) fn elements<'a>(&'a self, assembly: &'a Assembly) -> Vec<CellElement<'a>> {
        let (edges, vertices) = (&assembly.tiling().edges, self.sheet.vertices.len());
        let place = |site: &Site| {
            let cell = [(site.vertex / vertices) % self.cells[0], (site.vertex / vertices) / self.cells[0]];
            let shift = [0, 1].map(|k| cell[k] as i32 + site.shift[k] * self.cells[k] as i32);
            Site { vertex: site.vertex % vertices, shift }
        };
        let mut found = Vec::new();
        for term in self.model.soft().iter().chain(self.model.stiff()) {
            for number in (0..term.len()).filter(|&k| edges[term.edge(k)].cell == [0, 0]) {
                let places = term.sites(number).iter().map(place).collect();
                found.push(CellElement { term: term.as_ref(), number, places });
            }
        }
        found
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

/// Computes the response of a spatially periodic state; `self_stresses` is left to be counted.
///
/// # Errors
/// [`ResponseError`] as [`super::response_at`].
pub(super) fn response(assembly: &Assembly, cell: &PeriodicCell) -> Result<Response, ResponseError> {
    let CellModes { modes, table, poisson, error } = modes_of(cell)?;
    let lattice = LatticeMotions { chords: cell.lattice, theta: [0.0; 2], axis: None, curvature: 0.0 };
    let stresses = stresses::of_cell(assembly, cell)?;
    Ok(Response { modes, table, lattice, self_stresses: 0, stresses, poisson: Some(poisson), error })
}

/// The modes of a cell.
pub(super) struct CellModes {
    modes: Vec<LinearMode>,
    table: ModeTable,
    /// Poisson's ratios of the modes.
    pub poisson: Poisson,
    error: f64,
}

/// Computes the modes of a cell and their Poisson's ratios.
///
/// # Errors
/// [`ResponseError`] as [`super::response_at`].
pub(super) fn modes_of(cell: &PeriodicCell) -> Result<CellModes, ResponseError> {
    let found = folding_modes_with_locked(&cell.sheet, &cell.locked)?;
    let embedding = Embedding::new(&cell.sheet)?;
    let mixed = |mix: DVector<f64>| mode(cell, &embedding, &found, mix);
    let basis: Vec<LinearMode> = (0..found.count()).map(|k| mixed(unit(found.count(), k))).collect::<Result<_, _>>()?;
    let raw = RawTable {
        strains: basis.iter().map(|mode| mode.strain).collect(),
        curvatures: basis.iter().map(|mode| mode.curvature).collect(),
        length: cell.area().sqrt(),
    };
    let amplitudes = raw.arranged()?;
    let modes: Vec<LinearMode> =
        amplitudes.column_iter().map(|mix| mixed(mix.into_owned())).collect::<Result<_, _>>()?;
    let disagreement = basis.iter().map(|mode| match &mode.field {
        Field::OfCells(field) => field.disagreement,
        Field::OfCoordinates(_) => 0.0,
    });
    let error = larger(disagreement.fold(0.0, larger), defect_of_reciprocity(&raw));
    let table = raw.ranks()?;
    let poisson = Poisson::new(&cell.sheet, &modes, &table, !cell.locked.is_empty(), raw.length)?;
    Ok(CellModes { modes, table, poisson, error })
}

fn unit(count: usize, k: usize) -> DVector<f64> {
    DVector::from_fn(count, |row, _| f64::from(u8::from(row == k)))
}

/// Returns the mode with these amplitudes along the basis.
fn mode(
    cell: &PeriodicCell,
    embedding: &Embedding,
    found: &FoldingModes,
    mix: DVector<f64>,
) -> Result<LinearMode, ResponseError> {
    let rates = (&found.basis * &mix).as_slice().to_vec();
    let curvature = &found.curvatures * &mix;
    let field = Displacement::new(embedding, embedding.drawn_angles(), &rates);
    let moving = field.lattice.ok_or(ResponseError::NotPeriodic)?;
    let chords = [0, 1].map(|a| moving[a].twist.at(&cell.lattice[a]));
    Ok(LinearMode {
        rates,
        strain: LatticeFrame::new(&cell.lattice).strain_rate(&cell.lattice, &chords),
        curvature: [curvature[0], curvature[1], curvature[2]],
        lattice_rotations: moving.map(|moving| moving.twist.angular),
        field: Field::OfCells(Box::new(field)),
    })
}

/// Returns the largest `cof(K') : E - cof(K) : E'` of two modes of norm 1.
///
/// It is zero: the rates of a mode are a self stress of the bars, its forces on the lattice are `cof(K)/2` and its
/// moments `-cof(E)/2`, and a self stress does no work on the other mode.
fn defect_of_reciprocity(raw: &RawTable) -> f64 {
    let pairs = (0..raw.strains.len()).flat_map(|a| (0..a).map(move |b| (a, b)));
    let defect = |(a, b): (usize, usize)| {
        mixed_determinant(raw.curvatures[b], raw.strains[a]) - mixed_determinant(raw.curvatures[a], raw.strains[b])
    };
    pairs.map(|pair| (raw.length * defect(pair)).abs()).fold(0.0, larger)
}
