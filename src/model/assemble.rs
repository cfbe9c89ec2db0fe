//! From a sheet and the stiffnesses of its parts to a model: the only place that decides what is built.
//!
//! A term that nothing asks for is not built. Bars always carry tensions. A hinge term carries tensions too when it is
//! rigid, or so much stiffer than the softest term that its forces would drown in its own rounding error.

use super::domain::Domain;
use super::measure::{FoldAngle, Length};
use super::problem::{Gauge, Model, Parts};
use super::term::{Element, Elements, Spring, Term, TermKind};
use crate::math::{Vec3, fold_angle::fold_angle};
use crate::sheet::tiling::{Site, Tiling};
use crate::sheet::{EdgeKind, Sheet};
use nalgebra::Matrix3;

/// Hinges stiffer than this times the softest term carry tensions.
const STIFF_RATIO: f64 = 1e4;
/// A sheet this many times its size away from the file's origin is moved to the model's.
const FAR: f64 = 4.0;

type Elementwise = Vec<Box<dyn Elements>>;

/// What surrounds the cells.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Boundary {
    /// Free edges.
    Patch,
    /// Periodic, lattice as drawn.
    FixedTorus,
    /// Periodic, lattice free.
    FreeTorus,
    /// One cell, moved by screw motions.
    Screw,
}

/// Hinges of one kind.
#[derive(Clone, Debug, PartialEq)]
pub struct Hinges {
    /// Torque per radian and unit length; infinite: rigid.
    pub stiffness: f64,
    /// Rest angle of every edge of the tiling, in radians; read where there is a hinge of this kind.
    pub rest: Vec<f64>,
}

/// What the sheet is made of and what acts on it. Everything absent is not built.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Terms {
    /// Stiffness `EA` of all bars; infinite: rigid.
    pub bars: Option<f64>,
    /// Creases.
    pub creases: Option<Hinges>,
    /// Diagonals of polygons.
    pub facets: Option<Hinges>,
    /// Edges of the tiling whose fold angle is kept, and that angle.
    pub locks: Vec<(usize, f64)>,
    /// Vertices of the tiling and the axes (x, y, z) that are held.
    pub pins: Vec<(usize, [bool; 3])>,
    /// Vertices of the tiling and the forces on them.
    pub loads: Vec<(usize, Vec3)>,
}

impl Terms {
    /// Whether bars and facets are rigid, as far as there are any.
    pub fn is_rigid(&self) -> bool {
        let facets = self.facets.as_ref().map(|facets| facets.stiffness);
        [self.bars, facets].into_iter().flatten().all(f64::is_infinite)
    }

    /// Whether any part stores energy, keeps an angle, or is pulled.
    pub fn has_energy(&self) -> bool {
        let Self { bars, creases, facets, locks, pins: _, loads } = self;
        bars.is_some() || creases.is_some() || facets.is_some() || !locks.is_empty() || !loads.is_empty()
    }
}

/// The drawn state in the coordinates of its domain.
pub struct Drawn {
    /// Where points come from.
    pub domain: Domain,
    /// All coordinates.
    pub coordinates: Vec<f64>,
    /// Coordinates that the domain itself holds: vertex 0 of a screw, and y of its first lattice vector.
    pub held: Vec<usize>,
    /// Rotation from the file's frame to the domain's, about `origin`.
    pub frame: Matrix3<f64>,
    /// What stands at the origin of the domain's frame: vertex 0 of a screw; elsewhere the file's origin, or the sheet's first vertex
    /// where the sheet is far from that.
    pub origin: Vec3,
}

impl Drawn {
    /// Coordinates of the drawn tiling. A sheet without lattice must be a patch.
    pub fn new(sheet: &Sheet, tiling: &Tiling, boundary: Boundary) -> Self {
        Self::turned(sheet, tiling, boundary, 0.0)
    }

    /// The same; the axis of a screw makes this angle with the first lattice vector, in radians.
    pub fn turned(sheet: &Sheet, tiling: &Tiling, boundary: Boundary, axis: f64) -> Self {
        let flat = |points: &[Vec3]| points.iter().flat_map(|p| [p.x, p.y, p.z]).collect::<Vec<f64>>();
        let lattice = sheet.lattice.map(|[l1, l2]| [l1 * tiling.cells[0] as f64, l2 * tiling.cells[1] as f64]);
        let frame = Matrix3::identity();
        let (positions, origin) = near_origin(sheet, tiling);
        let (domain, coordinates) = match (boundary, lattice) {
            (Boundary::FixedTorus, Some(lattice)) => (Domain::FixedTorus(lattice), flat(&positions)),
            (Boundary::FreeTorus, Some(lattice)) => (Domain::FreeTorus, [flat(&positions), flat(&lattice)].concat()),
            (Boundary::Screw, Some(lattice)) => return Self::screw(sheet, lattice, axis),
            _ => (Domain::Patch, flat(&positions)),
        };
        Self { domain, coordinates, held: vec![], frame, origin }
    }

    /// Vertex 0 at the origin, the first lattice vector along x, face normals along +z, no curvature.
    fn screw(sheet: &Sheet, [l1, l2]: [Vec3; 2], axis: f64) -> Self {
        let along = l1.normalize();
        let across = l1.cross(&l2);
        let z = if across.dot(&area_vector(sheet)) < 0.0 { -across.normalize() } else { across.normalize() };
        let frame = Matrix3::from_rows(&[along.transpose(), z.cross(&along).transpose(), z.transpose()]);
        let origin = sheet.vertices[0];
        let mut coordinates: Vec<f64> =
            sheet.vertices.iter().flat_map(|p| <[f64; 3]>::from(frame * (p - origin))).collect();
        let (l1, l2) = (frame * l1, frame * l2);
        let held = vec![0, 1, 2, coordinates.len() + 2];
        coordinates.extend([axis, 0.0, l1.y, l2.y, l1.x, l2.x]);
        Self { domain: Domain::Screw, coordinates, held, frame, origin }
    }
}

/// Positions of a tiling's vertices and what is at their origin. Where the first vertex is far off, as measured by the sheet, it is made
/// the origin: then rounding errors are those of the sheet's size and of the file's own numbers.
fn near_origin(sheet: &Sheet, tiling: &Tiling) -> (Vec<Vec3>, Vec3) {
    let Some(&first) = sheet.vertices.first() else { return (tiling.positions.clone(), Vec3::zeros()) };
    let size = tiling.positions.iter().map(|p| (p - first).norm()).fold(0.0, f64::max);
    if first.norm() <= FAR * size {
        return (tiling.positions.clone(), Vec3::zeros());
    }
    let [l1, l2] = sheet.lattice.unwrap_or_default();
    let place = |k: usize| {
        let (vertex, cell) = (k % sheet.vertices.len(), k / sheet.vertices.len());
        let [c1, c2] = [cell % tiling.cells[0], cell / tiling.cells[0]].map(|c| c as f64);
        (sheet.vertices[vertex] - first) + c1 * l1 + c2 * l2
    };
    ((0..tiling.positions.len()).map(place).collect(), first)
}

/// Sum of the area vectors of the triangles: points to the side of the face normals.
fn area_vector(sheet: &Sheet) -> Vec3 {
    let area = |corners: [crate::sheet::Corner; 3]| {
        let [a, b, c] = corners.map(|corner| sheet.position(corner));
        (b - a).cross(&(c - a))
    };
    sheet.triangles.iter().map(|t| area(t.corners)).sum()
}

/// Builds the model of a tiling. Hinges of a kind for which the terms have nothing are not built.
pub fn assemble(drawn: &Drawn, tiling: &Tiling, terms: &Terms, gauge: Gauge) -> Model {
    let (mut soft, mut stiff): (Elementwise, Elementwise) = (vec![], vec![]);
    let mean_edge = mean_edge(drawn, tiling);
    if let Some(stiffness) = terms.bars {
        stiff.push(Box::new(bars(drawn, tiling, stiffness)));
    }
    let given = [terms.creases.as_ref().map(|h| h.stiffness), terms.facets.as_ref().map(|h| h.stiffness), terms.bars];
    let softest = given.into_iter().flatten().fold(f64::INFINITY, f64::min);
    let kinds =
        [(TermKind::Creases, EdgeKind::Crease, &terms.creases), (TermKind::Facets, EdgeKind::Facet, &terms.facets)];
    for (term, kind, hinges) in kinds {
        let Some(hinges) = hinges else { continue };
        let term = Box::new(hinge_term(term, drawn, tiling, |edge| tiling.edges[edge].kind == kind, hinges));
        let list = if hinges.stiffness > STIFF_RATIO * softest || hinges.stiffness.is_infinite() {
            &mut stiff
        } else {
            &mut soft
        };
        if !term.is_empty() {
            list.push(term);
        }
    }
    if !terms.locks.is_empty() {
        let mut rest = vec![f64::NAN; tiling.edges.len()];
        terms.locks.iter().for_each(|&(edge, angle)| rest[edge] = angle);
        let locked: Vec<bool> = rest.iter().map(|angle| !angle.is_nan()).collect();
        let rigid = Hinges { stiffness: f64::INFINITY, rest };
        stiff.push(Box::new(hinge_term(TermKind::Locks, drawn, tiling, |edge| locked[edge], &rigid)));
    }
    let pins = terms.pins.iter().flat_map(|(v, axes)| (0..3).filter(|&a| axes[a]).map(move |a| 3 * v + a));
    let pinned: Vec<usize> = drawn.held.iter().copied().chain(pins).collect();
    let loads = net_loads(terms, drawn.coordinates.len(), &pinned);
    Model::new(Parts {
        domain: drawn.domain.clone(),
        drawn: drawn.coordinates.clone(),
        soft,
        stiff,
        pinned,
        loads,
        mean_edge,
        gauge,
    })
}

/// The force on every coordinate, without what pins take up; nothing where no force is left: a load that does nothing changes nothing.
fn net_loads(terms: &Terms, coordinates: usize, pinned: &[usize]) -> Vec<f64> {
    let mut loads = vec![0.0; coordinates];
    terms.loads.iter().for_each(|(v, f)| (0..3).for_each(|axis| loads[3 * v + axis] += f[axis]));
    pinned.iter().for_each(|&k| loads[k] = 0.0);
    if loads.iter().all(|force| *force == 0.0) { vec![] } else { loads }
}

fn mean_edge(drawn: &Drawn, tiling: &Tiling) -> f64 {
    let total: f64 = tiling.edges.iter().map(|e| length(drawn, &e.ends)).sum();
    total / tiling.edges.len() as f64
}

fn length(drawn: &Drawn, ends: &[Site; 2]) -> f64 {
    let [a, b] = drawn.domain.points(&drawn.coordinates, ends);
    (b - a).norm()
}

fn bars(drawn: &Drawn, tiling: &Tiling, stiffness: f64) -> Term<Length, 2, 6> {
    let element = |(edge, tiled): (usize, &crate::sheet::tiling::TiledEdge)| {
        let rest = length(drawn, &tiled.ends);
        Element { sites: tiled.ends, spring: Spring { stiffness: stiffness / rest, rest }, edge }
    };
    let elements = tiling.edges.iter().enumerate().map(element).collect();
    Term::new(TermKind::Bars, elements, &drawn.domain, &drawn.coordinates)
}

/// The sites of the hinge over an edge; `None` where a face is missing.
pub fn hinge(tiling: &Tiling, edge: usize) -> Option<[Site; 4]> {
    let tiled = &tiling.edges[edge];
    Some([tiled.ends[0], tiled.ends[1], tiled.wings[0]?, tiled.wings[1]?])
}

/// Drawn fold angle of every edge of the tiling, in radians; NaN where there is no hinge.
pub fn drawn_angles(drawn: &Drawn, tiling: &Tiling) -> Vec<f64> {
    let angle = |edge| hinge(tiling, edge).map(|sites| fold_angle(drawn.domain.points(&drawn.coordinates, &sites)));
    (0..tiling.edges.len()).map(|edge| angle(edge).unwrap_or(f64::NAN)).collect()
}

fn hinge_term(
    kind: TermKind,
    drawn: &Drawn,
    tiling: &Tiling,
    wanted: impl Fn(usize) -> bool,
    hinges: &Hinges,
) -> Term<FoldAngle, 4, 12> {
    let element = |edge: usize| {
        let sites = hinge(tiling, edge)?;
        let spring =
            Spring { stiffness: hinges.stiffness * length(drawn, &tiling.edges[edge].ends), rest: hinges.rest[edge] };
        Some(Element { sites, spring, edge })
    };
    let elements = (0..tiling.edges.len()).filter(|&edge| wanted(edge)).filter_map(element).collect();
    Term::new(kind, elements, &drawn.domain, &drawn.coordinates)
}
