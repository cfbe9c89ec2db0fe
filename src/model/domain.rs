//! Domains: where the points of an element come from, and the chain rule through them.
//!
//! The coordinates of a state are three for each vertex, and after them the *shared* coordinates of the domain:
//! none on a patch or on a torus with fixed lattice, the six components of the lattice vectors on a free torus, and
//! `direction, kappa, y1, y2, x1, x2` on a screw, `l1 = (x1, y1)` and `l2 = (x2, y2)`. A point of an element is a
//! vertex of some cell, a [`Site`].
//!
//! Screw (commuting screw motions about an axis in the plane of x and y, written so that the axis may go to infinity):
//! with `e` the direction of the axis, at the angle `direction` from x, `m` across it, `l = n1 l1 + n2 l2` the part of
//! the lattice in the plane, `b = m . l` and `t = kappa b`, the copy of a point `q + z e_z` in cell `(n1, n2)` is
//! `q + l + m Re d + (z + Im d) e_z` with `d = i kappa b (phi(t) w + b psi(t))`, where `w = m . q + i z`,
//! `phi(t) = (e^(it) - 1)/(it)` and `psi = (phi - 1)/(it) = phi + i phi'`. That is the turn `e^(it) w + b phi(t)` across the
//! axis and the shift `e . l` along it.
//!
//! All that bends has the factor `kappa`, so also the derivative by the direction: near zero curvature, where direction
//! and curvature are polar coordinates, it is small but keeps its digits. At `kappa = 0` the map is the translation by `l` and
//! the direction means nothing; the derivatives by `kappa` are as smooth there as elsewhere.

mod recentre;
mod screw;
mod shared;

use crate::math::Vec3;
use crate::math::taylor::{Path, Taylor};
pub use crate::sheet::tiling::Site;
use nalgebra::{Matrix3, SMatrix, SVector};
use recentre::{raise_axis, turn_back, unwind};
use screw::ScrewMotion;
pub(crate) use shared::{MOST_SHARED, Turns};
use shared::{Pulled, SharedMatrix};

/// Where points come from.
#[derive(Clone, Debug, PartialEq)]
pub enum Domain {
    /// Vertices, free edges.
    Patch,
    /// Periodic, with this lattice.
    FixedTorus([Vec3; 2]),
    /// Periodic, the lattice vectors are coordinates.
    FreeTorus,
    /// One cell moved by commuting screw motions about an axis in the plane of x and y.
    Screw,
}

/// Curvatures below this, over one by the unit of length, do not make the unit of the direction larger: there it has no meaning.
const STRAIGHT: f64 = 1e-8;

/// Derivatives of a point: `vertex` with respect to the vertex, `shared` with respect to the shared coordinates.
struct Placed {
    vertex: Matrix3<f64>,
    shared: SharedMatrix,
}

impl Domain {
    /// Number of shared coordinates.
    pub fn shared(&self) -> usize {
        match self {
            Self::Patch | Self::FixedTorus(_) => 0,
            Self::FreeTorus | Self::Screw => 6,
        }
    }

    /// The shared ones of all coordinates.
    #[inline]
    fn shared_of<'a>(&self, x: &'a [f64]) -> &'a [f64] {
        &x[x.len() - self.shared()..]
    }

    /// Where a site is. `x` holds all coordinates, the shared ones last.
    #[inline]
    pub(crate) fn point(&self, x: &[f64], site: Site) -> Vec3 {
        let v = vertex(x, site);
        let [n1, n2] = site.shift.map(f64::from);
        let shared = self.shared_of(x);
        match self {
            Self::Patch => v,
            Self::FixedTorus([l1, l2]) => v + n1 * l1 + n2 * l2,
            Self::FreeTorus => {
                v + n1 * Vec3::from_column_slice(&shared[..3]) + n2 * Vec3::from_column_slice(&shared[3..])
            }
            Self::Screw => ScrewMotion::new(shared, site).at(&v).point(),
        }
    }

    fn place(&self, x: &[f64], site: Site) -> Placed {
        let (mut vertex_part, mut shared_part) = (Matrix3::identity(), SharedMatrix::zeros());
        match self {
            Self::Patch | Self::FixedTorus(_) => {}
            Self::FreeTorus => {
                for axis in 0..3 {
                    shared_part[(axis, axis)] = f64::from(site.shift[0]);
                    shared_part[(axis, 3 + axis)] = f64::from(site.shift[1]);
                }
            }
            Self::Screw => {
                let screw = ScrewMotion::new(self.shared_of(x), site);
                let at = screw.at(&vertex(x, site));
                vertex_part = at.vertex_derivative();
                shared_part = at.shared_derivative();
            }
        }
        Placed { vertex: vertex_part, shared: shared_part }
    }

    /// Velocity of a site when all coordinates have these rates.
    pub(crate) fn velocity(&self, x: &[f64], site: Site, rates: &[f64]) -> Vec3 {
        let placed = self.place(x, site);
        let shared = &rates[rates.len() - self.shared()..];
        let by_shared: Vec3 = shared.iter().enumerate().map(|(k, rate)| placed.shared.column(k) * *rate).sum();
        placed.vertex * vertex(rates, site) + by_shared
    }

    /// A site on the path `x[0] + a x[1] + a^2 x[2]` of all coordinates. Not for screws, whose maps are not linear.
    pub(crate) fn path(&self, x: &[&[f64]; 3], site: Site) -> Path {
        let start = self.point(x[0], site);
        let [first, second] = [x[1], x[2]].map(|rates| self.velocity(x[0], site, rates));
        std::array::from_fn(|axis| Taylor([start[axis], first[axis], second[axis], 0.0, 0.0]))
    }

    /// Appends to `out` the gradient in the element's coordinates of a function whose gradient in its points is `g`.
    pub(crate) fn pull_gradient<const N: usize, const D: usize>(
        &self,
        x: &[f64],
        sites: &[Site; N],
        g: &SVector<f64, D>,
        out: &mut Vec<f64>,
    ) {
        if self.shared() == 0 {
            return out.extend_from_slice(g.as_slice());
        }
        let mut shared = SVector::<f64, MOST_SHARED>::zeros();
        for (k, &site) in sites.iter().enumerate() {
            let (placed, force) = (self.place(x, site), g.fixed_rows::<3>(3 * k));
            out.extend_from_slice((placed.vertex.transpose() * force).as_slice());
            shared += placed.shared.transpose() * force;
        }
        out.extend_from_slice(&shared.as_slice()[..self.shared()]);
    }

    /// Turns `lower`, the lower triangle, row by row, of the Hessian of a function in its points, where its gradient is `g`, into the
    /// one in the element's coordinates: `J^T H J` plus the curvature of the map itself, weighted by `g`.
    pub(crate) fn pull_hessian<const N: usize, const D: usize>(
        &self,
        x: &[f64],
        sites: &[Site; N],
        g: &SVector<f64, D>,
        lower: &mut Vec<f64>,
    ) {
        if self.shared() == 0 {
            return;
        }
        let entry = |row: usize, column: usize| lower[row * (row + 1) / 2 + column];
        let h = SMatrix::<f64, D, D>::from_fn(|k, l| entry(k.max(l), k.min(l)));
        let placed = sites.map(|site| self.place(x, site));
        let mut pulled = Pulled::zeros();
        for (k, left) in placed.iter().enumerate() {
            for (l, right) in placed.iter().enumerate() {
                let block = h.fixed_view::<3, 3>(3 * k, 3 * l);
                let (to_right, to_shared) = (block * right.vertex, block * right.shared);
                add(&mut pulled, (3 * k, 3 * l), left.vertex.transpose() * to_right);
                add(&mut pulled, (D, 3 * l), left.shared.transpose() * to_right);
                add(&mut pulled, (D, D), left.shared.transpose() * to_shared);
            }
        }
        if matches!(self, Self::Screw) {
            for (k, &site) in sites.iter().enumerate() {
                let force = g.fixed_rows::<3>(3 * k).into_owned();
                ScrewMotion::new(self.shared_of(x), site).at(&vertex(x, site)).add_curvature(
                    &force,
                    3 * k,
                    D,
                    &mut pulled,
                );
            }
        }
        lower.clear();
        for row in 0..D + self.shared() {
            lower.extend((0..=row).map(|column| pulled[(row, column)]));
        }
    }

    /// The screw motions of a state; `None` where there are none.
    pub(crate) fn turns(&self, x: &[f64]) -> Option<Turns> {
        matches!(self, Self::Screw).then(|| Turns::new(self.shared_of(x)))
    }

    /// Gives the axis of a screw this direction; nothing else changes.
    pub(crate) fn point_axis(&self, x: &mut [f64], direction: f64) {
        if matches!(self, Self::Screw) {
            let first = x.len() - self.shared();
            x[first] = direction;
        }
    }

    /// Gives a screw an axis of this direction and this curvature; its lattice and its vertices stay.
    pub(crate) fn bend(&self, x: &mut [f64], direction: f64, kappa: f64) {
        if matches!(self, Self::Screw) {
            let first = x.len() - self.shared();
            (x[first], x[first + 1]) = (direction, kappa);
        }
    }

    /// Sizes of the shared coordinates in which they weigh as much as a `length` in the position of a point, or as
    /// little as nothing else: then all unknowns are lengths, whatever the unit. Empty where the coordinates are lengths themselves.
    ///
    /// Curvature moves points by the square of lengths. The direction of the axis moves them as much, times the curvature; as long as
    /// that is not next to nothing it counts, so that both are known with the same error.
    pub(crate) fn units(&self, x: &[f64], length: f64) -> Vec<f64> {
        let Some(Turns { kappa, .. }) = self.turns(x) else { return vec![] };
        let curvature = 1.0 / (length * length);
        vec![curvature / f64::max(kappa.abs(), STRAIGHT / length), curvature, 1.0, 1.0, 1.0, 1.0]
    }

    /// Keeps the chart of a screw away from its singular places; returns whether coordinates were changed. The sheet stays
    /// the same, but for its place in space.
    ///
    /// At the axis `kappa` is infinite: moving all z by `d` and `1/kappa` with them changes nothing (`theta = kappa b`
    /// stays). Done when the axis comes nearer to z = 0 than `length`; then it is put at twice that. A rotation
    /// that has wound once round would need an infinite `b` where the sheet stretches out again: `theta` is
    /// taken back by `2 pi` where it is clearly larger than `pi`; so is the direction of the axis. And the first lattice
    /// vector, whose y is held while the sheet moves, must not come to lie across x, where that would not keep the sheet
    /// from turning in the plane: then all is turned.
    pub(crate) fn recentre(&self, x: &mut [f64], length: f64) -> bool {
        if !matches!(self, Self::Screw) {
            return false;
        }
        let (points, shared) = x.split_at_mut(x.len() - self.shared());
        let raised = raise_axis(points, shared, length);
        let unwound = unwind(shared);
        turn_back(points, shared) || raised || unwound
    }

    /// All points of one element.
    #[inline]
    pub fn points<const N: usize>(&self, x: &[f64], sites: &[Site; N]) -> [Vec3; N] {
        match self {
            // asked once for all points: a patch takes two fifths of the time (`cargo bench --bench iteration -- assembly`, evaluate)
            Self::Patch => sites.map(|site| vertex(x, site)),
            _ => sites.map(|site| self.point(x, site)),
        }
    }
}

/// Adds a block whose first entry is at `(row, column)`.
fn add<const R: usize, const C: usize>(to: &mut Pulled, (row, column): (usize, usize), block: SMatrix<f64, R, C>) {
    let mut place = to.fixed_view_mut::<R, C>(row, column);
    place += block;
}

#[inline]
fn vertex(x: &[f64], site: Site) -> Vec3 {
    Vec3::from_column_slice(&x[3 * site.vertex..3 * site.vertex + 3])
}
