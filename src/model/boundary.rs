//! Boundary conditions of a tiling, and the drawn state in the coordinates that belong to them.

use super::domain::Domain;
use crate::math::{Vec3, fold_angle::fold_angle};
use crate::sheet::Sheet;
use crate::sheet::tiling::{Site, Tiling};
use nalgebra::Matrix3;

/// Largest distance of the first vertex from the file's origin, relative to the size of the sheet, at which the
/// file's origin is kept; beyond it the first vertex becomes the origin.
const FAR: f64 = 4.0;

/// The boundary conditions that a drawn tiling can have as it is. They and its lattice make its [`Domain`]; that of a
/// tube follows from how it is [rolled up](super::Roll), and domains of one's own bring their own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Boundary {
    /// A finite piece with free edges.
    Patch,
    /// Periodic, with the lattice vectors held at their drawn values.
    FixedTorus,
    /// Periodic, with lattice vectors that are unknowns.
    FreeTorus,
    /// One cell repeated by two screw motions about a common axis: a cylinder of any curvature.
    Screw,
}

/// The drawn state in the coordinates of its domain.
#[derive(Clone, Debug)]
pub struct Drawn {
    /// The map from coordinates to points.
    pub domain: Domain,
    /// Coordinates of all vertices, then the shared coordinates of the domain; see [`Domain`].
    pub coordinates: Vec<f64>,
    /// Indices of the coordinates that the boundary conditions hold: for a screw those of vertex 0 and y of the first
    /// lattice vector, for a patch those of vertices without edges, otherwise none.
    pub held: Vec<usize>,
    /// Rotation about `origin` from the file's frame to the domain's frame.
    pub frame: Matrix3<f64>,
    /// Point of the file that is the origin of the domain's frame: vertex 0 for a screw, otherwise the file's origin,
    /// or the sheet's first vertex if the sheet is far from the file's origin.
    pub origin: Vec3,
    /// Chords from vertex 0 to its two copies in the file, if the drawn state here is another one: that of a tube.
    /// Strains are relative to them.
    pub chords: Option<[Vec3; 2]>,
}

impl Drawn {
    /// Makes the drawn state of a tiling. For a screw, `axis` is the angle of the axis from the first lattice vector,
    /// in radians. A sheet without lattice must be a patch.
    pub(super) fn new(sheet: &Sheet, tiling: &Tiling, boundary: Boundary, axis: f64) -> Self {
        let flat = |points: &[Vec3]| points.iter().flat_map(|p| [p.x, p.y, p.z]).collect::<Vec<f64>>();
        let lattice = sheet.lattice.map(|[l1, l2]| [l1 * tiling.cells[0] as f64, l2 * tiling.cells[1] as f64]);
        let (positions, origin) = near_origin(sheet, tiling);
        let (domain, coordinates) = match (boundary, lattice) {
            (Boundary::FixedTorus, Some(lattice)) => (Domain::FixedTorus(lattice), flat(&positions)),
            (Boundary::FreeTorus, Some(lattice)) => (Domain::FreeTorus, [flat(&positions), flat(&lattice)].concat()),
            (Boundary::Screw, Some(lattice)) => return Self::screw(sheet, lattice, axis),
            _ => (Domain::Patch, flat(&positions)),
        };
        // what no edge leads to would drift: the centres of panels that a patch does not have
        let mut joined = vec![false; tiling.positions.len()];
        tiling.edges.iter().flat_map(|edge| edge.ends).for_each(|end| joined[end.vertex] = true);
        let loose = (0..joined.len()).filter(|&vertex| !joined[vertex]);
        let held = loose.flat_map(|vertex| 3 * vertex..3 * vertex + 3).collect();
        Self { held, origin, ..Self::of(domain, coordinates) }
    }

    /// Makes the drawn state of a screw: vertex 0 at the origin, the first lattice vector along x, the face normals
    /// along +z, zero curvature.
    fn screw(sheet: &Sheet, [l1, l2]: [Vec3; 2], axis: f64) -> Self {
        let along = l1.normalize();
        let across = l1.cross(&l2);
        let z = if sheet.is_counterclockwise() { across.normalize() } else { -across.normalize() };
        let frame = Matrix3::from_rows(&[along.transpose(), z.cross(&along).transpose(), z.transpose()]);
        let origin = sheet.vertices[0];
        let mut coordinates: Vec<f64> =
            sheet.vertices.iter().flat_map(|p| <[f64; 3]>::from(frame * (p - origin))).collect();
        let (l1, l2) = (frame * l1, frame * l2);
        let held = vec![0, 1, 2, coordinates.len() + 2];
        coordinates.extend([axis, 0.0, l1.y, l2.y, l1.x, l2.x]);
        Self { domain: Domain::Screw, coordinates, held, frame, origin, chords: None }
    }

    /// Makes the drawn state of a domain in whose frame the file is.
    pub(super) fn of(domain: Domain, coordinates: Vec<f64>) -> Self {
        let (frame, origin) = (Matrix3::identity(), Vec3::zeros());
        Self { domain, coordinates, held: vec![], frame, origin, chords: None }
    }

    /// Returns the distance between two sites.
    pub(super) fn distance(&self, ends: &[Site; 2]) -> f64 {
        let [a, b] = self.domain.points(&self.coordinates, ends);
        (b - a).norm()
    }

    /// Returns the mean length of the edges of the tiling.
    pub(super) fn mean_edge(&self, tiling: &Tiling) -> f64 {
        let bars = || tiling.edges.iter().filter(|edge| edge.bar);
        let total: f64 = bars().map(|edge| self.distance(&edge.ends)).sum();
        total / bars().count() as f64
    }

    /// Returns the fold angle of every edge of the tiling, in radians; NaN where there is no hinge.
    pub(super) fn fold_angles(&self, tiling: &Tiling) -> Vec<f64> {
        let angle = |sites| fold_angle(self.domain.points(&self.coordinates, &sites));
        tiling.edges.iter().map(|edge| edge.hinge().map_or(f64::NAN, angle)).collect()
    }
}

/// Returns the positions of a tiling's vertices, and the point of the file that is their origin. If the first vertex
/// is farther than [`FAR`] sizes of the sheet from the file's origin, it becomes the origin: then rounding errors are
/// relative to the size of the sheet, apart from those in the numbers of the file.
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
