//! Domains of a user's own: where the copies of a cell are.

use super::shared::{MOST_SHARED, Pulled, SharedMatrix};
use crate::math::{Vec3, lower_triangle};
use nalgebra::Matrix3;
use std::fmt;
use std::sync::Arc;

/// An affine map `linear * v + shift` of a point `v`, or a derivative of one.
#[derive(Clone, Debug, PartialEq)]
pub struct Affine {
    /// The linear part: a rotation, for a rigid motion.
    pub linear: Matrix3<f64>,
    /// The image of the origin.
    pub shift: Vec3,
}

impl Affine {
    fn at(&self, vertex: &Vec3) -> Vec3 {
        self.linear * vertex + self.shift
    }
}

/// The map that takes the vertices of cell (0, 0) to their copies in another cell, with its derivatives.
#[derive(Clone, Debug, PartialEq)]
pub struct CellMap {
    /// The map.
    pub map: Affine,
    /// Its derivatives by the shared coordinates.
    pub first: Vec<Affine>,
    /// Its second derivatives: the lower triangle by rows, `[11, 21, 22, 31, ..]`; empty where all are zero.
    pub second: Vec<Affine>,
}

/// A domain of one's own: where the copies of a cell's vertices are, given the coordinates that all cells share.
///
/// An [`Assembly`](crate::Assembly) on it is one cell; its elements reach the neighbouring cells as the sheet's lattice
/// says, whose vectors need not be those of the state. Relaxations, paths, wells, modes and files work with it. What
/// knows closed forms of the built-in domains (exact kinematics, landscapes, bands, responses) refuses it.
///
/// A ring of `n` equal cells, closed by a rotation about the z axis, has no shared coordinates:
///
/// ```
/// use foldwell::math::Vec3;
/// use foldwell::model::{Affine, CellMap, CellMaps};
/// use nalgebra::{Matrix3, Rotation3};
///
/// struct Ring(u32);
///
/// impl CellMaps for Ring {
///     fn shared(&self) -> usize {
///         0
///     }
///     fn map(&self, _: &[f64], cell: [i32; 2]) -> CellMap {
///         let turn = std::f64::consts::TAU / f64::from(self.0) * f64::from(cell[0]);
///         let linear: Matrix3<f64> = Rotation3::new(Vec3::z() * turn).into();
///         CellMap { map: Affine { linear, shift: Vec3::zeros() }, first: vec![], second: vec![] }
///     }
/// }
/// assert!((Ring(4).map(&[], [1, 0]).map.linear * Vec3::x() - Vec3::y()).norm() < 1e-15);
/// ```
pub trait CellMaps: Send + Sync {
    /// Returns the number of shared coordinates, at most 6.
    fn shared(&self) -> usize;

    /// Returns the map to the cell of this number. It must be a rigid motion, and the identity for cell (0, 0).
    fn map(&self, shared: &[f64], cell: [i32; 2]) -> CellMap;

    /// Returns for each shared coordinate by how much it changes where a vertex far from the origin, at the distance
    /// `length`, moves by about 1: 1 for a translation, as here for all, and `1 / length` for a rotation. Unknowns in
    /// these units have stiffnesses of one size.
    fn units(&self, length: f64) -> Vec<f64> {
        let _ = length;
        vec![1.0; self.shared()]
    }
}

/// A domain of one's own as part of an assembly.
#[derive(Clone)]
pub struct OwnDomain(Arc<dyn CellMaps>);

impl OwnDomain {
    /// Makes a domain from the maps of its cells.
    ///
    /// # Panics
    /// If it has more than 6 shared coordinates.
    pub fn new(maps: impl CellMaps + 'static) -> Self {
        assert!(maps.shared() <= MOST_SHARED, "a domain has at most {MOST_SHARED} shared coordinates");
        Self(Arc::new(maps))
    }

    pub(super) fn maps(&self) -> &dyn CellMaps {
        &*self.0
    }
}

impl fmt::Debug for OwnDomain {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "a domain of one's own with {} shared coordinates", self.0.shared())
    }
}

/// Domains are equal where they are the same object.
impl PartialEq for OwnDomain {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}

impl CellMap {
    /// Returns the copy of a vertex.
    pub(super) fn point(&self, vertex: &Vec3) -> Vec3 {
        self.map.at(vertex)
    }

    /// Returns the derivatives of the copy of a vertex by the vertex and by the shared coordinates.
    pub(super) fn derivatives(&self, vertex: &Vec3) -> (Matrix3<f64>, Option<SharedMatrix>) {
        let mut by_shared = SharedMatrix::zeros();
        for (k, first) in self.first.iter().enumerate() {
            by_shared.set_column(k, &first.at(vertex));
        }
        (self.map.linear, Some(by_shared))
    }

    /// Adds the second derivative of `force . P` to the lower triangle, `P` being the copy of a vertex: the block of
    /// the vertex (at `at`) and that of the shared coordinates (at `shared`, which come after it).
    pub(super) fn add_curvature(&self, vertex: &Vec3, force: &Vec3, (at, shared): (usize, usize), to: &mut Pulled) {
        for (k, first) in self.first.iter().enumerate() {
            let by_vertex = first.linear.transpose() * force;
            (0..3).for_each(|axis| to[(shared + k, at + axis)] += by_vertex[axis]);
        }
        for (second, (row, column)) in self.second.iter().zip(lower_triangle(self.first.len())) {
            to[(shared + row, shared + column)] += force.dot(&second.at(vertex));
        }
    }
}
