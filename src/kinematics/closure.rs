//! Closure of the faces around vertices: the exact conditions on fold angles.
//!
//! Around an interior vertex, counter-clockwise seen from the side of the face normals, edges with fold angles `rho_k`
//! alternate with sectors of angle `alpha_k` of the faces. Take a frame with x along an edge and z along the normal of
//! the face before that edge. It is taken to the corresponding frame of the next edge by `R_x(rho_k) R_z(alpha_k)`, and
//! the product of these rotations around the vertex is the identity (s.-m. belcastro and T. C. Hull, "Modelling the
//! folding of paper into three dimensions using affine transformations", Linear Algebra and its Applications 348 (2002)
//! 273-282). The conditions contain the sectors of the drawn faces only; positions follow from the angles.

use super::KinematicsError;
use super::error::check_surface;
use crate::math::{Vec3, rotation};
use crate::numerics::DenseMatrix;
use crate::numerics::dense::{DenseError, NullSpace, null_space_of_sums};
use crate::sheet::tiling::{Tiling, tile};
use crate::sheet::{Corner, Sheet, TiledEdge};
use nalgebra::{DVector, Matrix3};

mod opening;
mod second_derivative;

use opening::Opening;

/// Magnitude of the terms of which the entries of the Jacobian are sums: directions of edges. An edge between two
/// copies of one vertex has two terms, which cancel where it passes straight through.
pub(crate) const DIRECTION: f64 = 1.0;

/// The closure conditions of a sheet: three for each interior vertex, and six for each opening of a finite sheet.
///
/// A vertex is interior if each of its edges has two faces. On a torus all vertices are interior, on a finite sheet
/// those that are not on the rim. The conditions are complete only if [`unchecked_loops`](Self::unchecked_loops) is
/// zero.
#[derive(Clone, Debug)]
pub struct Closure {
    rounds: Vec<Round>,
    openings: Vec<Opening>,
    /// Number of the edge of every column of the Jacobian.
    folding: Vec<usize>,
    edges: usize,
    /// Number of independent loops that the conditions do not close, except for the two of a torus: the openings of a
    /// periodic sheet. If it is not zero, the conditions are incomplete.
    pub(crate) unchecked_loops: usize,
}

/// An interior vertex with its edges, counter-clockwise.
#[derive(Clone, Debug)]
struct Round {
    vertex: usize,
    spokes: Vec<Spoke>,
}

#[derive(Clone, Copy, Debug)]
struct Spoke {
    edge: usize,
    /// Column of the Jacobian; `None` if the edge is locked.
    column: Option<usize>,
    /// Sine and cosine of the angle from this edge to the next.
    sector: (f64, f64),
}

/// An edge as seen from one of its ends, with that end in cell (0, 0).
#[derive(Clone, Copy, Debug)]
struct HalfEdge {
    edge: usize,
    to: Corner,
    /// The other end of the next edge counter-clockwise, and of the previous one.
    wings: [Option<Corner>; 2],
}

/// Returns the edge of this number as seen from its first (0) or second (1) end.
fn half(TiledEdge { ends, wings, .. }: &TiledEdge, edge: usize, side: usize) -> HalfEdge {
    let back = ends[side].shift.map(|n| -n);
    let seen = |corner: Corner| corner.translated(back);
    HalfEdge { edge, to: seen(ends[1 - side]), wings: [wings[side].map(seen), wings[1 - side].map(seen)] }
}

impl Closure {
    /// Returns the closure of one cell of a periodic sheet, or of a finite sheet; edges are numbered as in the sheet.
    ///
    /// # Errors
    /// [`KinematicsError`] if the faces at an interior vertex do not form one closed cycle.
    pub fn of_cell(sheet: &Sheet) -> Result<Self, KinematicsError> {
        check_surface(sheet)?;
        Self::of_edges(&tile(sheet, [1, 1], true).edges, |corner| sheet.position(corner))
    }

    /// Returns the closure of several cells of a sheet; edges and vertices are numbered as in the tiling.
    pub(crate) fn of_tiling(sheet: &Sheet, tiling: &Tiling) -> Result<Self, KinematicsError> {
        check_surface(sheet)?;
        if sheet.screws.is_some() {
            return Err(KinematicsError::Rolled);
        }
        let lattice = sheet.lattice.unwrap_or([Vec3::zeros(); 2]);
        Self::of_edges(&tiling.edges, |Corner { vertex, shift }| {
            let steps = [0, 1].map(|a| f64::from(shift[a]) * tiling.cells[a] as f64);
            tiling.positions[vertex] + lattice[0] * steps[0] + lattice[1] * steps[1]
        })
    }

    /// Returns the closure of any list of edges, which are numbered as in the list; vertices are numbered as in their
    /// corners. `position` returns the position of a corner in any state in which the faces have their shape.
    pub(crate) fn of_edges(edges: &[TiledEdge], position: impl Fn(Corner) -> Vec3) -> Result<Self, KinematicsError> {
        let halves = halves_by_vertex(edges);
        let is_interior = |halves: &[HalfEdge]| halves.iter().all(|half| half.wings.iter().all(Option::is_some));
        let interior = halves.iter().enumerate().filter(|(_, halves)| !halves.is_empty() && is_interior(halves));
        let rounds = interior.map(|(vertex, halves)| Round::new(vertex, halves, &position));
        let rounds: Vec<Round> = rounds.collect::<Result<_, _>>()?;
        let folding = (0..edges.len()).filter(|&edge| edges[edge].hinge().is_some()).collect();
        let vertices = halves.iter().filter(|halves| !halves.is_empty()).count();
        let unchecked = unchecked_loops(edges, vertices);
        let inside: Vec<usize> = rounds.iter().map(|round: &Round| round.vertex).collect();
        let has_openings = unchecked > 0 && !is_periodic(edges);
        let openings = if has_openings { opening::openings(edges, &inside, &position) } else { Vec::new() };
        let unchecked_loops = unchecked.saturating_sub(openings.len());
        Ok(Self { rounds, openings, folding, edges: edges.len(), unchecked_loops }.with_columns())
    }

    /// Returns the same conditions with some edges locked: the Jacobian has no columns for these.
    pub fn with_locked(mut self, locked: &[usize]) -> Self {
        self.folding.retain(|edge| !locked.contains(edge));
        self.with_columns()
    }

    /// Assigns to every edge at a vertex its column of the Jacobian.
    fn with_columns(mut self) -> Self {
        let mut columns = vec![None; self.edges];
        self.folding.iter().enumerate().for_each(|(column, &edge)| columns[edge] = Some(column));
        let spokes = self.rounds.iter_mut().flat_map(|round| &mut round.spokes);
        spokes.for_each(|spoke| spoke.column = columns[spoke.edge]);
        self.openings.iter_mut().for_each(|opening| opening.set_columns(&columns));
        self
    }

    /// Returns the edge of every column of the Jacobian: those with two faces that are not locked, in increasing order.
    pub fn folding_edges(&self) -> &[usize] {
        &self.folding
    }

    /// Number of conditions.
    pub(crate) fn rows(&self) -> usize {
        3 * self.rounds.len() + opening::ROWS * self.openings.len()
    }

    /// Returns an error if a loop is left that the conditions do not close.
    pub(crate) fn is_complete(&self) -> Result<(), KinematicsError> {
        match self.unchecked_loops {
            0 => Ok(()),
            loops => Err(KinematicsError::Openings { loops }),
        }
    }

    /// Returns the closure residual: the rotation vector of the product around each vertex, three numbers per interior
    /// vertex; then six per opening, the rotation vector of the product of motions around it and its translation
    /// relative to the size of the loop.
    ///
    /// `angles` holds the fold angle of every edge, valley positive, in radians; those of the rim are not read.
    /// # Panics
    /// If the length of `angles` is not the number of edges.
    pub fn residual(&self, angles: &[f64]) -> DVector<f64> {
        let mut residual = DVector::zeros(self.rows());
        self.residual_into(angles, residual.as_mut_slice());
        residual
    }

    /// Returns the derivative of [`residual`](Self::residual), with a column per folding edge.
    ///
    /// If the faces close, a column holds the direction of the edge in the frame of the first edge of each vertex at
    /// its ends: null vectors are self stresses of the edges.
    /// # Panics
    /// As [`residual`](Self::residual).
    pub fn jacobian(&self, angles: &[f64]) -> DenseMatrix {
        let mut residual = vec![0.0; self.rows()];
        let mut jacobian = DenseMatrix::zeros(residual.len(), self.folding.len());
        self.linearize_into(angles, &mut residual, &mut jacobian);
        jacobian
    }

    /// Returns the linear motions of a closed state: the null space of the [`jacobian`](Self::jacobian).
    ///
    /// # Panics
    /// As [`residual`](Self::residual).
    pub(crate) fn motions(&self, angles: &[f64]) -> Result<NullSpace, DenseError> {
        null_space_of_sums(&self.jacobian(angles), DIRECTION)
    }

    /// Writes the [`residual`](Self::residual) into a slice of as many numbers, without allocation.
    /// # Panics
    /// If `angles` or `residual` has the wrong length.
    pub fn residual_into(&self, angles: &[f64], residual: &mut [f64]) {
        self.check(angles, residual);
        for (round, rows) in self.rounds.iter().zip(residual.chunks_exact_mut(3)) {
            let product = round.walk(angles, |_, _| {});
            rows.copy_from_slice(rotation::log(&product).as_slice());
        }
        let loops = residual[3 * self.rounds.len()..].chunks_exact_mut(opening::ROWS);
        self.openings.iter().zip(loops).for_each(|(opening, rows)| opening.residual_into(angles, rows));
    }

    /// Writes [`residual`](Self::residual) and [`jacobian`](Self::jacobian) at once, without allocation.
    /// # Panics
    /// If `angles` or `residual` has the wrong length, or `jacobian` the wrong shape.
    pub fn linearize_into(&self, angles: &[f64], residual: &mut [f64], jacobian: &mut DenseMatrix) {
        self.check(angles, residual);
        assert_eq!(jacobian.shape(), (residual.len(), self.folding.len()), "shape of the Jacobian");
        jacobian.fill(0.0);
        for (row, round) in self.rounds.iter().enumerate() {
            let product = round.walk(angles, |spoke, direction| {
                if let Some(column) = spoke.column {
                    let mut place = jacobian.fixed_view_mut::<3, 1>(3 * row, column);
                    place += direction;
                }
            });
            let defect = rotation::log(&product);
            residual[3 * row..3 * row + 3].copy_from_slice(defect.as_slice());
            round.put_into_chart(&rotation::inverse_left_jacobian(&defect), row, jacobian);
        }
        for (number, opening) in self.openings.iter().enumerate() {
            let row = 3 * self.rounds.len() + opening::ROWS * number;
            opening.linearize_into(angles, &mut residual[row..row + opening::ROWS], (jacobian, row));
        }
    }

    fn check(&self, angles: &[f64], residual: &[f64]) {
        assert_eq!(angles.len(), self.edges, "one fold angle for every edge");
        assert_eq!(residual.len(), self.rows(), "three numbers for every interior vertex and six for every opening");
    }
}

impl Round {
    fn new(vertex: usize, halves: &[HalfEdge], position: &impl Fn(Corner) -> Vec3) -> Result<Self, KinematicsError> {
        let broken = || KinematicsError::BrokenRound { vertex };
        let center = position(Corner::home(vertex));
        let mut spokes = Vec::with_capacity(halves.len());
        let mut half = halves.first().ok_or_else(broken)?;
        for _ in halves {
            let next = half.wings[0].ok_or_else(broken)?;
            let sector = angle(position(half.to) - center, position(next) - center).sin_cos();
            spokes.push(Spoke { edge: half.edge, column: None, sector });
            half = halves.iter().find(|other| other.to == next).ok_or_else(broken)?;
            if half.to == halves[0].to {
                break;
            }
        }
        if spokes.len() == halves.len() { Ok(Self { vertex, spokes }) } else { Err(broken()) }
    }

    /// Passes once around the vertex, calls `visit` with every edge and its direction in the frame of the first edge,
    /// and returns the product of the rotations.
    ///
    /// The axes of the current frame are the columns of the product so far: `R_x(rho)` rotates y and z, then
    /// `R_z(alpha)` rotates x and y.
    fn walk(&self, angles: &[f64], mut visit: impl FnMut(&Spoke, &Vec3)) -> Matrix3<f64> {
        let [mut x, mut y, mut z] = [Vec3::x(), Vec3::y(), Vec3::z()];
        for spoke in &self.spokes {
            visit(spoke, &x);
            (y, z) = turned(y, z, angles[spoke.edge].sin_cos());
            (x, y) = turned(x, y, spoke.sector);
        }
        Matrix3::from_columns(&[x, y, z])
    }

    /// Converts the columns from directions of edges to rates of the rotation vector, each column once.
    fn put_into_chart(&self, chart: &Matrix3<f64>, row: usize, jacobian: &mut DenseMatrix) {
        for (number, spoke) in self.spokes.iter().enumerate() {
            let Some(column) = spoke.column else { continue };
            if self.spokes[..number].iter().all(|earlier| earlier.edge != spoke.edge) {
                let mut place = jacobian.fixed_view_mut::<3, 1>(3 * row, column);
                let rate = chart * &place;
                place.copy_from(&rate);
            }
        }
    }
}

/// Returns two axes rotated in their plane, from the first to the second, by an angle with this sine and cosine.
fn turned(a: Vec3, b: Vec3, (sin, cos): (f64, f64)) -> (Vec3, Vec3) {
    (cos * a + sin * b, cos * b - sin * a)
}

/// Returns the fold angles of all edges of a sheet as drawn, in radians, valley positive; zero on the rim.
pub fn drawn_fold_angles(sheet: &Sheet) -> Vec<f64> {
    sheet.edges.iter().map(|edge| sheet.drawn_angle(edge).unwrap_or(0.0)).collect()
}

fn halves_by_vertex(edges: &[TiledEdge]) -> Vec<Vec<HalfEdge>> {
    let vertices = edges.iter().flat_map(|edge| edge.ends).map(|end| end.vertex + 1).max().unwrap_or(0);
    let mut halves = vec![Vec::new(); vertices];
    for (number, edge) in edges.iter().enumerate() {
        for side in [0, 1] {
            halves[edge.ends[side].vertex].push(half(edge, number, side));
        }
    }
    halves
}

/// Returns the number of unchecked loops from the Euler characteristic, which is 0 for a torus and 1 for a disk, and
/// smaller by one for every opening.
fn unchecked_loops(edges: &[TiledEdge], vertices: usize) -> usize {
    let sides = edges.iter().flat_map(|edge| edge.wings).flatten().count();
    let euler_of_whole = if is_periodic(edges) { 0 } else { 1 };
    (euler_of_whole + edges.len()).saturating_sub(vertices + sides / 3)
}

/// Whether an edge leads to another cell.
fn is_periodic(edges: &[TiledEdge]) -> bool {
    edges.iter().any(|edge| edge.ends[0].shift != edge.ends[1].shift)
}

fn angle(a: Vec3, b: Vec3) -> f64 {
    a.cross(&b).norm().atan2(a.dot(&b))
}

#[cfg(test)]
mod tests {
    use super::super::test_sheets::*;
    use super::*;
    use crate::numerics::dense::null_space;
    use crate::numerics::derivatives::{TOLERANCE, check_jacobian};

    fn nullity(closure: &Closure, angles: &[f64]) -> usize {
        null_space(&closure.jacobian(angles)).unwrap().basis.ncols()
    }

    /// Claim: drawn sheets close, periodic and finite ones. Tolerance: rounding of products of some six rotations.
    #[test]
    fn drawn_sheets_close() {
        for sheet in [open_star(), open_flat(), miura(), finite_grid(3, 4, 0.3)] {
            let closure = Closure::of_cell(&sheet).unwrap();
            assert!(closure.residual(&drawn_fold_angles(&sheet)).amax() <= 5e-15, "{}", sheet.title);
            assert_eq!(closure.unchecked_loops, 0);
        }
    }

    /// Claim: the drawn fold angles, and the folded cylinders that an independent program found, are solutions, in the
    /// sign convention and order of that program; the null space has dimension 3 at the drawn state and 2 on the
    /// cylinders. Source: theory (3 at a generic spatially periodic state, 2 on a cylinder). Tolerance 1e-12: that of
    /// the states of that program.
    #[test]
    fn stored_states_of_open_star() {
        let (sheet, reference) = (open_star(), open_star_reference());
        let closure = Closure::of_cell(&sheet).unwrap();
        let drawn = reference.in_sheet_order(&sheet, &reference.numbers("rest_fold_angles"));
        let difference = drawn_fold_angles(&sheet).iter().zip(&drawn).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(difference <= 1e-14);
        assert!(closure.residual(&drawn).amax() <= 5e-15);
        assert_eq!(nullity(&closure, &drawn), 3);
        for folded in reference.cylinders(&sheet) {
            assert!(closure.residual(&folded).amax() <= 1e-12);
            assert_eq!(nullity(&closure, &folded), 2);
            let mirrored: Vec<f64> = folded.iter().map(|angle| -angle).collect();
            assert!(closure.residual(&mirrored).amax() <= 1e-12, "the mirror image closes too");
            let mut wrong = folded.clone();
            wrong[3] = -wrong[3];
            assert!(closure.residual(&wrong).amax() > 1e-2);
        }
    }

    /// Claim: a flat developable state has Nv + 2 null vectors; each lock removes one.
    #[test]
    fn flat_sheet_has_two_more_than_vertices() {
        let sheet = open_flat();
        let closure = Closure::of_cell(&sheet).unwrap();
        let flat = vec![0.0; sheet.edges.len()];
        assert_eq!(nullity(&closure, &flat), sheet.vertices.len() + 2);
        let locked = closure.with_locked(&[0]);
        assert_eq!(locked.folding_edges(), (1..12).collect::<Vec<_>>());
        assert_eq!(nullity(&locked, &flat), sheet.vertices.len() + 1);
    }

    /// Claim: a finite sheet without flat vertices has as many folding modes as rim vertices minus three: each interior
    /// vertex gives three conditions, and E = 3 V - 3 - b for a triangulated disk with b rim vertices.
    #[test]
    fn finite_sheet_counts_its_rim() {
        let sheet = finite_grid(4, 5, 0.3);
        let closure = Closure::of_cell(&sheet).unwrap();
        assert_eq!(closure.rounds.len(), 3 * 4);
        assert_eq!(closure.folding_edges().len(), sheet.edges.len() - 18);
        assert_eq!(nullity(&closure, &drawn_fold_angles(&sheet)), 18 - 3);
    }

    /// Claim: several cells close with the angles of one cell repeated. A torus of two by two cells has the three modes
    /// of one cell: no mode of open-star has a wavelength of just two cells. On a patch every interior vertex gives
    /// three independent conditions on the folding edges, as it does if no vertex is flat.
    #[test]
    fn several_cells() {
        let sheet = open_star();
        let drawn = drawn_fold_angles(&sheet);
        for (n, periodic) in [(2, true), (4, false)] {
            let tiling = tile(&sheet, [n, n], periodic);
            let closure = Closure::of_tiling(&sheet, &tiling).unwrap();
            let angles: Vec<f64> = tiling.edges.iter().map(|edge| drawn[edge.edge]).collect();
            assert!(closure.residual(&angles).amax() <= 5e-15);
            let (interior, folding) = (closure.rounds.len(), closure.folding_edges().len());
            assert_eq!(interior == 4 * n * n, periodic);
            assert_eq!(nullity(&closure, &angles), if periodic { 3 } else { folding - 3 * interior });
        }
    }

    /// Claim: every entry of the Jacobian is the derivative of the residual, at closed states and at random angles,
    /// which do not close; on a torus, on a finite sheet, in a cell so narrow that edges lead from a vertex to its own
    /// copy, on a column, which closes round itself, and with locked edges.
    #[test]
    fn jacobian_is_the_derivative() {
        for (seed, sheet) in
            [open_star(), open_flat(), finite_grid(3, 3, 0.4), narrow(), column()].into_iter().enumerate()
        {
            let closure = Closure::of_cell(&sheet).unwrap().with_locked(&[0, 7]);
            let drawn = drawn_fold_angles(&sheet);
            for amplitude in [0.0, 0.3, 1.2] {
                let mut angles = drawn.clone();
                random_numbers(seed as u64, angles.len())
                    .iter()
                    .zip(&mut angles)
                    .for_each(|(r, a)| *a += amplitude * r);
                let folding = closure.folding_edges();
                let residual = |moved: &[f64]| {
                    let mut angles = angles.clone();
                    folding.iter().zip(moved).for_each(|(&edge, &angle)| angles[edge] = angle);
                    closure.residual(&angles).as_slice().to_vec()
                };
                let point: Vec<f64> = folding.iter().map(|&edge| angles[edge]).collect();
                check_jacobian(residual, &point, &closure.jacobian(&angles), TOLERANCE).unwrap();
            }
        }
    }

    /// Claim (duality): null vectors of the Jacobian at the drawn state are self stresses of the bars on the torus with
    /// fixed lattice: around every vertex, rate times unit edge direction adds up to zero.
    #[test]
    fn null_vectors_are_self_stresses() {
        let sheet = open_star();
        let closure = Closure::of_cell(&sheet).unwrap();
        let basis = null_space(&closure.jacobian(&drawn_fold_angles(&sheet))).unwrap().basis;
        for rates in basis.column_iter() {
            let mut forces = vec![Vec3::zeros(); sheet.vertices.len()];
            for (edge, rate) in sheet.edges.iter().zip(rates.iter()) {
                let [i, j] = edge.key.ends();
                let pull = (sheet.position(j) - sheet.position(i)).normalize() * *rate;
                forces[i.vertex] += pull;
                forces[j.vertex] -= pull;
            }
            assert!(forces.iter().all(|force| force.norm() <= 1e-14));
        }
    }

    /// Claim: a vertex at which two cycles of faces touch is refused with its number; the opening of a finite sheet is
    /// closed by a loop of its own.
    #[test]
    fn broken_rounds_and_openings() {
        let mut edges = tile(&finite_grid(2, 2, 0.3), [1, 1], true).edges;
        let at_center = |edge: &TiledEdge| edge.ends.iter().any(|end| end.vertex == 4);
        let spoke = edges.iter().position(at_center).unwrap();
        edges[spoke].wings = [Some(Corner::home(0)); 2];
        let position = |corner: Corner| Vec3::new(corner.vertex as f64, (corner.vertex as f64).cos(), 0.0);
        let error = Closure::of_edges(&edges, position).unwrap_err();
        assert_eq!(error, KinematicsError::BrokenRound { vertex: 4 });
        let ring = Closure::of_cell(&ring()).unwrap();
        assert_eq!((ring.unchecked_loops, ring.rounds.len(), ring.rows()), (0, 0, 6));
    }
}
