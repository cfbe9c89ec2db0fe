//! Domains: the maps from the coordinates of a state to the points of an element, and the chain rule through them.
//!
//! The coordinates of a state are three for each vertex, followed by the *shared* coordinates of the domain: none for
//! a patch or a torus with fixed lattice, the six components of the lattice vectors for a free torus, `direction,
//! kappa, y1, y2, x1, x2` for a screw, with the lattice vectors `l1 = (x1, y1)` and `l2 = (x2, y2)`, and turn and
//! translation from one row of cells to the next for a tube about the z axis. A point of an element is a vertex of some
//! cell, a [`Site`].
//!
//! A screw repeats the cell by commuting screw motions about an axis parallel to the plane of x and y, in a form that
//! stays regular when the axis goes to infinity. Let `e` be the direction of the axis, at the angle `direction` from
//! x, `m` the direction across it, `l = n1 l1 + n2 l2` the lattice vector of cell `(n1, n2)`, `b = m . l` and `t =
//! kappa b`. The copy of a point `q + z e_z` in cell `(n1, n2)` is `q + l + m Re d + (z + Im d) e_z` with `d = i
//! kappa b (phi(t) w + b psi(t))`, where `w = m . q + i z`, `phi(t) = (e^(it) - 1)/(it)` and `psi = (phi - 1)/(it) =
//! phi + i phi'`. This is the rotation `e^(it) w + b phi(t)` across the axis and the translation `e . l` along it.
//!
//! The displacement `d` has the factor `kappa`, and so has its derivative by the direction. Near zero curvature,
//! where direction and curvature are polar coordinates, that derivative is small but keeps its digits. At `kappa = 0`
//! the map is the translation by `l` and does not depend on the direction; the derivatives by `kappa` are regular
//! there.

mod own;
mod recentre;
mod screw;
mod shared;
mod tube;

use crate::math::taylor::{Path, Taylor};
use crate::math::{Vec3, point};
pub use crate::sheet::tiling::Site;
use crate::sheet::{Seam, SeamKept};
use nalgebra::{Matrix3, SMatrix, SVector};
pub use own::{Affine, CellMap, CellMaps, OwnDomain};
use recentre::{raise_axis, turn_back, unwind};
use screw::ScrewMotion;
pub(crate) use shared::{MOST_SHARED, ScrewTurns};
use shared::{Pulled, SharedMatrix};
use tube::TubeMotion;

/// The map from the coordinates of a state to points; see the module's page for the coordinates of each kind.
#[derive(Clone, Debug, PartialEq)]
pub enum Domain {
    /// Free edges: points are vertices.
    Patch,
    /// Periodic with these fixed lattice vectors.
    FixedTorus([Vec3; 2]),
    /// Periodic with lattice vectors that are coordinates.
    FreeTorus,
    /// One cell repeated by commuting screw motions about an axis parallel to the plane of x and y.
    Screw,
    /// One cell repeated about the z axis, closed along a seam.
    Tube {
        /// The seam.
        seam: Seam,
        /// The closing conditions that hold identically; a shared coordinate is free for each of the others.
        kept: SeamKept,
        /// Whether the drawn lattice vectors turn counter-clockwise seen from the side of the face normals.
        counterclockwise: bool,
    },
    /// One cell repeated by the maps of a user's own.
    Own(OwnDomain),
}

/// Curvature times the unit length up to which a screw is straight: the direction of its axis has next to no effect
/// there, and its unit would grow without bound.
pub(super) const STRAIGHT: f64 = 1e-8;

/// A point of an element with the derivatives of its position.
pub(crate) struct Placed {
    /// The position.
    pub point: Vec3,
    /// The vertex of cell (0, 0) of which the point is a copy.
    vertex: Vec3,
    motion: CopyMotion,
    /// Derivatives of the position by the vertex.
    pub by_vertex: Matrix3<f64>,
    /// Derivatives of the position by the shared coordinates; `None` where it does not depend on them.
    pub by_shared: Option<SharedMatrix>,
}

/// The motion that takes a vertex of cell (0, 0) to its copy in another cell.
enum CopyMotion {
    Translation(Vec3),
    Screw(ScrewMotion),
    Tube(TubeMotion),
    Own(CellMap),
}

impl CopyMotion {
    fn point(&self, v: &Vec3) -> Vec3 {
        match self {
            Self::Translation(by) => v + by,
            Self::Screw(screw) => screw.at(v).point(),
            Self::Tube(tube) => tube.point(v),
            Self::Own(map) => map.point(v),
        }
    }
}

impl Domain {
    /// Whether opposite sides of the tiling are joined.
    pub fn is_periodic(&self) -> bool {
        *self != Self::Patch
    }

    /// Whether opposite sides of the tiling are joined by translations.
    pub fn is_torus(&self) -> bool {
        matches!(self, Self::FixedTorus(_) | Self::FreeTorus)
    }

    /// Whether the model is one cell, whose copies are moved by motions other than translations.
    pub fn is_one_cell(&self) -> bool {
        matches!(self, Self::Screw | Self::Tube { .. } | Self::Own(_))
    }

    /// Returns the number of shared coordinates.
    pub fn shared(&self) -> usize {
        match self {
            Self::Patch | Self::FixedTorus(_) => 0,
            Self::FreeTorus | Self::Screw => 6,
            Self::Tube { kept, .. } => 2 + kept.free(),
            Self::Own(own) => own.maps().shared(),
        }
    }

    /// Whether points are vertices plus constants, so that derivatives by points are those by coordinates.
    #[inline]
    pub(crate) fn is_fixed_translation(&self) -> bool {
        matches!(self, Self::Patch | Self::FixedTorus(_))
    }

    /// Returns the shared coordinates, which are the last of all coordinates.
    #[inline]
    fn shared_of<'a>(&self, x: &'a [f64]) -> &'a [f64] {
        &x[x.len() - self.shared()..]
    }

    /// Returns the motion to the cell of this number; all coordinates are `x`.
    #[inline]
    fn motion(&self, x: &[f64], shift: [i32; 2]) -> CopyMotion {
        let (shared, [n1, n2]) = (self.shared_of(x), shift.map(f64::from));
        match self {
            Self::FixedTorus([l1, l2]) => CopyMotion::Translation(n1 * l1 + n2 * l2),
            Self::Patch => CopyMotion::Translation(Vec3::zeros()),
            _ if shift == [0, 0] => CopyMotion::Translation(Vec3::zeros()),
            Self::FreeTorus => {
                let [l1, l2] = [&shared[..3], &shared[3..]].map(Vec3::from_column_slice);
                CopyMotion::Translation(n1 * l1 + n2 * l2)
            }
            Self::Screw => CopyMotion::Screw(ScrewMotion::new(shared, shift)),
            Self::Tube { seam, kept, .. } => CopyMotion::Tube(TubeMotion::new(seam, *kept, shared, shift)),
            Self::Own(own) => CopyMotion::Own(own.maps().map(shared, shift)),
        }
    }

    /// Returns the position of a site. `x` holds all coordinates, the shared ones last.
    #[inline]
    pub(crate) fn point(&self, x: &[f64], site: Site) -> Vec3 {
        self.motion(x, site.shift).point(&vertex(x, site))
    }

    /// Returns the position of a site with its derivatives.
    pub(crate) fn place(&self, x: &[f64], site: Site) -> Placed {
        let (vertex, motion) = (vertex(x, site), self.motion(x, site.shift));
        let point = motion.point(&vertex);
        let (by_vertex, by_shared) = match &motion {
            _ if site.shift == [0, 0] => (Matrix3::identity(), None),
            CopyMotion::Translation(_) => (Matrix3::identity(), (self.shared() > 0).then(|| by_lattice(site.shift))),
            CopyMotion::Screw(screw) => screw.at(&vertex).derivatives(),
            CopyMotion::Tube(tube) => tube.derivatives(&point),
            CopyMotion::Own(map) => map.derivatives(&vertex),
        };
        Placed { point, vertex, motion, by_vertex, by_shared }
    }

    /// Returns the velocity of a site for given rates of all coordinates.
    pub(crate) fn velocity(&self, x: &[f64], site: Site, rates: &[f64]) -> Vec3 {
        let (placed, shared) = (self.place(x, site), self.shared_of(rates));
        let by = |m: &SharedMatrix| shared.iter().enumerate().map(|(k, rate)| m.column(k) * *rate).sum::<Vec3>();
        placed.by_vertex * vertex(rates, site) + placed.by_shared.as_ref().map_or(Vec3::zeros(), by)
    }

    /// Returns the Taylor series of a site along the path `x[0] + a x[1] + a^2 x[2]` of all coordinates. It is not
    /// valid for screws and tubes, whose maps are not linear in the coordinates.
    pub(crate) fn path(&self, x: &[&[f64]; 3], site: Site) -> Path {
        let start = self.point(x[0], site);
        let [first, second] = [x[1], x[2]].map(|rates| self.velocity(x[0], site, rates));
        std::array::from_fn(|axis| Taylor([start[axis], first[axis], second[axis], 0.0, 0.0]))
    }

    /// Appends to `out` the gradient of a function in the element's coordinates (those of its points, then the shared
    /// ones); `g` is its gradient in the element's points.
    pub(crate) fn pull_gradient<const N: usize, const D: usize>(
        &self,
        placed: &[Placed; N],
        g: &SVector<f64, D>,
        out: &mut Vec<f64>,
    ) {
        let mut shared = SVector::<f64, MOST_SHARED>::zeros();
        for (k, at) in placed.iter().enumerate() {
            let force = g.fixed_rows::<3>(3 * k);
            out.extend_from_slice((at.by_vertex.transpose() * force).as_slice());
            at.by_shared.iter().for_each(|by_shared| shared += by_shared.transpose() * force);
        }
        out.extend_from_slice(&shared.as_slice()[..self.shared()]);
    }

    /// Replaces `lower` by the Hessian of a function in the element's coordinates: `J^T H J` plus the second
    /// derivative of the map, weighted by `g`. On entry `lower` is the Hessian `H` of the function in the element's
    /// points, and `g` its gradient there. Both Hessians are stored as lower triangles, row by row.
    pub(crate) fn pull_hessian<const N: usize, const D: usize>(
        &self,
        placed: &[Placed; N],
        g: &SVector<f64, D>,
        lower: &mut Vec<f64>,
    ) {
        let entry = |row: usize, column: usize| lower[row * (row + 1) / 2 + column];
        let h = SMatrix::<f64, D, D>::from_fn(|k, l| entry(k.max(l), k.min(l)));
        let mut pulled = Pulled::zeros();
        for (k, left) in placed.iter().enumerate() {
            let block = |l: usize| h.fixed_view::<3, 3>(3 * k, 3 * l);
            for (l, right) in placed[..=k].iter().enumerate() {
                add(&mut pulled, (3 * k, 3 * l), left.by_vertex.transpose() * block(l) * right.by_vertex);
            }
            let mut to_shared = SharedMatrix::zeros();
            for (l, right) in placed.iter().enumerate() {
                right.by_shared.iter().for_each(|by_shared| to_shared += block(l) * by_shared);
            }
            add(&mut pulled, (D, 3 * k), to_shared.transpose() * left.by_vertex);
            left.by_shared.iter().for_each(|by_shared| add(&mut pulled, (D, D), by_shared.transpose() * to_shared));
            let force = g.fixed_rows::<3>(3 * k).into_owned();
            self.add_curvature(left, &force, (3 * k, D), &mut pulled);
        }
        lower.clear();
        for row in 0..D + self.shared() {
            lower.extend((0..=row).map(|column| pulled[(row, column)]));
        }
    }

    /// Adds the second derivative of `force . P` of a position `P`, with the blocks of its vertex and of the shared
    /// coordinates at these places.
    fn add_curvature(&self, placed: &Placed, force: &Vec3, (at, first): (usize, usize), pulled: &mut Pulled) {
        match &placed.motion {
            CopyMotion::Translation(_) => {}
            CopyMotion::Screw(screw) => screw.at(&placed.vertex).add_curvature(force, at, first, pulled),
            CopyMotion::Tube(tube) => tube.add_curvature(&placed.point, force, at, (first, self.shared()), pulled),
            CopyMotion::Own(map) => map.add_curvature(&placed.vertex, force, (at, first), pulled),
        }
    }

    /// Returns the screw motions of a state about an axis in the plane of x and y; `None` for other domains.
    pub(crate) fn turns(&self, x: &[f64]) -> Option<ScrewTurns> {
        matches!(self, Self::Screw).then(|| ScrewTurns::new(self.shared_of(x)))
    }

    /// Returns the turns about the z axis and the translations along it of the two lattice vectors of a tube; `None`
    /// for other domains.
    pub(crate) fn tube_motions(&self, x: &[f64]) -> Option<[[f64; 2]; 2]> {
        let Self::Tube { seam, kept, .. } = self else { return None };
        Some(tube::lattice_motions(seam, *kept, self.shared_of(x)))
    }

    /// Mirrors a tube at the plane across its axis, which turns it inside out. Returns whether it is a tube.
    pub(crate) fn evert(&self, x: &mut [f64]) -> bool {
        let Self::Tube { kept, .. } = self else { return false };
        let first = x.len() - self.shared();
        let heights = (2..first).step_by(3).chain([first + 1]).chain((!kept.rise).then_some(first + 2));
        heights.for_each(|k| x[k] = -x[k]);
        true
    }

    /// Sets the direction of the axis of a screw, in radians from x; all other coordinates stay. Does nothing for
    /// other domains.
    pub(crate) fn point_axis(&self, x: &mut [f64], direction: f64) {
        if matches!(self, Self::Screw) {
            let first = x.len() - self.shared();
            x[first] = direction;
        }
    }

    /// Sets the direction (radians from x) and the curvature of a screw; its lattice and vertices stay. Does nothing
    /// for other domains.
    pub(crate) fn bend(&self, x: &mut [f64], direction: f64, kappa: f64) {
        if matches!(self, Self::Screw) {
            let first = x.len() - self.shared();
            (x[first], x[first + 1]) = (direction, kappa);
        }
    }

    /// Returns the scale factors of the shared coordinates that turn them into lengths, so that all unknowns have the
    /// same unit. Changing a scaled coordinate by `length` moves points about as much as moving a vertex by `length`.
    /// Empty for domains whose shared coordinates are lengths already.
    ///
    /// A change of the curvature moves points in proportion to the square of lengths, and a change of the axis
    /// direction by that times the curvature. The factor of the direction is therefore bounded at curvatures below
    /// [`STRAIGHT`]; above, both coordinates are found with the same error.
    pub(crate) fn units(&self, x: &[f64], length: f64) -> Vec<f64> {
        self.units_above(x, length, STRAIGHT)
    }

    /// Returns the same with the factor of the direction bounded below another curvature times the unit length.
    pub(crate) fn units_above(&self, x: &[f64], length: f64, straight: f64) -> Vec<f64> {
        if let Self::Tube { kept, .. } = self {
            let (turn, shift) = (1.0 / length, 1.0);
            let free = [(!kept.rise).then_some(shift), (!kept.turn).then_some(turn)];
            return [turn, shift].into_iter().chain(free.into_iter().flatten()).collect();
        }
        if let Self::Own(own) = self {
            return own.maps().units(length);
        }
        let Some(ScrewTurns { kappa, .. }) = self.turns(x) else { return vec![] };
        let curvature = 1.0 / (length * length);
        vec![curvature / f64::max(kappa.abs(), straight / length), curvature, 1.0, 1.0, 1.0, 1.0]
    }

    /// Moves the coordinates of a screw away from the singular places of the chart, and returns whether they were
    /// changed. The sheet moves only as a rigid body.
    ///
    /// There are three such places. At the axis `kappa` is infinite: shifting all z and `1/kappa` by the same `d`
    /// leaves the sheet as it is (`theta = kappa b` stays), which is done when the axis is nearer to z = 0 than
    /// `length`; then its distance becomes twice that. A rotation by more than a whole turn would need an infinite
    /// `b` when the sheet flattens: `2 pi` is subtracted from `theta` when it is clearly larger than `pi`, and
    /// likewise from the direction of the axis. And the first lattice vector, whose y component is held, must not lie
    /// across x, where holding y does not prevent rotations in the plane: then the whole sheet is rotated.
    pub(crate) fn recentre(&self, x: &mut [f64], length: f64) -> bool {
        if !matches!(self, Self::Screw) {
            return false;
        }
        let (points, shared) = x.split_at_mut(x.len() - self.shared());
        let raised = raise_axis(points, shared, length);
        let unwound = unwind(shared);
        turn_back(points, shared) || raised || unwound
    }

    /// Returns all points of one element.
    #[inline]
    pub fn points<const N: usize>(&self, x: &[f64], sites: &[Site; N]) -> [Vec3; N] {
        match self {
            // matched once for all points: a patch takes two fifths of the time (`cargo bench --bench iteration --
            // assembly`, evaluate)
            Self::Patch => sites.map(|site| vertex(x, site)),
            _ => sites.map(|site| self.point(x, site)),
        }
    }
}

/// Returns the derivatives of a position by the two lattice vectors.
fn by_lattice(shift: [i32; 2]) -> SharedMatrix {
    let mut by_shared = SharedMatrix::zeros();
    (0..2).for_each(|k| by_shared.fixed_columns_mut::<3>(3 * k).fill_diagonal(f64::from(shift[k])));
    by_shared
}

/// Adds `block` to `to`, with its first entry at `(row, column)`.
fn add<const R: usize, const C: usize>(to: &mut Pulled, (row, column): (usize, usize), block: SMatrix<f64, R, C>) {
    let mut place = to.fixed_view_mut::<R, C>(row, column);
    place += block;
}

#[inline]
fn vertex(x: &[f64], site: Site) -> Vec3 {
    point(x, site.vertex)
}
