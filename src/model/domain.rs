//! Domains: where the points of an element come from, and the chain rule through them.
//!
//! The coordinates of a state are three for each vertex, and after them the *shared* coordinates of the domain:
//! none on a patch or on a torus with fixed lattice, the six components of the lattice vectors on a free torus, and
//! `kappa, b1, b2, h1, h2` on a screw. A point of an element is a vertex of some cell, a [`Site`].
//!
//! Screw (commuting screw motions about an axis along x, written so that the axis may go to infinity): with
//! `b = n1 b1 + n2 b2`, `h = n1 h1 + n2 h2`, `t = kappa b` the copy of `(x, y, z)` in cell `(n1, n2)` is
//! `x + h` and, with `w = y + i z`, `e^(it) w + b phi(t)` where `phi(t) = (e^(it) - 1)/(it)`. At `kappa = 0` it is a
//! translation by `(h, b, 0)`; the derivatives with respect to `kappa` are as smooth there as elsewhere.

use crate::math::taylor::{Path, Taylor};
use crate::math::{Vec3, sinc};
use nalgebra::{Complex, Matrix3, SMatrix, SVector};
use std::f64::consts::TAU;

pub use crate::sheet::tiling::Site;

/// Most shared coordinates that a domain has.
pub const MOST_SHARED: usize = 6;
type SharedMatrix = SMatrix<f64, 3, MOST_SHARED>;
/// Room for the Hessian of an element of up to four points; only its lower triangle and leading part mean something.
type Pulled = SMatrix<f64, { 12 + MOST_SHARED }, { 12 + MOST_SHARED }>;

/// Rotation angles above this are taken back by a turn; above pi, so that an angle that stays near pi is left alone.
const WOUND: f64 = 4.0;

/// Where points come from.
#[derive(Clone, Debug, PartialEq)]
pub enum Domain {
    /// Vertices, free edges.
    Patch,
    /// Periodic, with this lattice.
    FixedTorus([Vec3; 2]),
    /// Periodic, the lattice vectors are coordinates.
    FreeTorus,
    /// One cell moved by commuting screw motions about an axis along x.
    Screw,
}

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
            Self::FreeTorus => 6,
            Self::Screw => 5,
        }
    }

    /// Where a site is. `x` holds all coordinates, the shared ones last.
    #[inline]
    pub fn point(&self, x: &[f64], site: Site) -> Vec3 {
        let v = vertex(x, site);
        let [n1, n2] = site.shift.map(f64::from);
        let shared = &x[x.len() - self.shared()..];
        match self {
            Self::Patch => v,
            Self::FixedTorus([l1, l2]) => v + n1 * l1 + n2 * l2,
            Self::FreeTorus => {
                v + n1 * Vec3::from_column_slice(&shared[..3]) + n2 * Vec3::from_column_slice(&shared[3..])
            }
            Self::Screw => Screw::new(shared, site).point(&v),
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
                let screw = Screw::new(&x[x.len() - 5..], site);
                vertex_part = screw.rotation();
                shared_part = screw.shared_derivative(&vertex(x, site));
            }
        }
        Placed { vertex: vertex_part, shared: shared_part }
    }

    /// Velocity of a site when all coordinates have these rates.
    pub fn velocity(&self, x: &[f64], site: Site, rates: &[f64]) -> Vec3 {
        let placed = self.place(x, site);
        let shared = &rates[rates.len() - self.shared()..];
        let by_shared: Vec3 = shared.iter().enumerate().map(|(k, rate)| placed.shared.column(k) * *rate).sum();
        placed.vertex * vertex(rates, site) + by_shared
    }

    /// A site on the path `x[0] + a x[1] + a^2 x[2]` of all coordinates. Not for screws, whose maps are not linear.
    pub fn path(&self, x: &[&[f64]; 3], site: Site) -> Path {
        let start = self.point(x[0], site);
        let [first, second] = [x[1], x[2]].map(|rates| self.velocity(x[0], site, rates));
        std::array::from_fn(|axis| Taylor([start[axis], first[axis], second[axis], 0.0, 0.0]))
    }

    /// Appends to `out` the gradient in the element's coordinates of a function whose gradient in its points is `g`.
    pub fn pull_gradient<const N: usize, const D: usize>(
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

    /// Appends to `out` the lower triangle, row by row, of the Hessian in the element's coordinates of a function with
    /// gradient `g` and Hessian `h` in its points: `J^T h J` plus the curvature of the map itself, weighted by `g`.
    pub fn pull_hessian<const N: usize, const D: usize>(
        &self,
        x: &[f64],
        sites: &[Site; N],
        g: &SVector<f64, D>,
        h: &SMatrix<f64, D, D>,
        out: &mut Vec<f64>,
    ) {
        if self.shared() == 0 {
            return append_lower(D, |row, column| h[(row, column)], out);
        }
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
                Screw::new(&x[x.len() - 5..], site).add_curvature(&vertex(x, site), &force, 3 * k, D, &mut pulled);
            }
        }
        append_lower(D + self.shared(), |row, column| pulled[(row, column)], out);
    }

    /// Keeps the chart of a screw away from its two singular places; returns whether coordinates were changed. The maps stay
    /// the same.
    ///
    /// At the axis `kappa` is infinite: moving all z by `d` and `1/kappa` with them changes nothing (`theta = kappa b`
    /// stays). Done when the axis comes nearer to z = 0 than `length`; then it is put at twice that. And a rotation
    /// that has wound once round would need an infinite `b` where the sheet stretches out again: `theta` is
    /// taken back by `2 pi` where it is clearly larger than `pi`.
    pub fn recentre(&self, x: &mut [f64], length: f64) -> bool {
        let shared = x.len() - self.shared();
        if !matches!(self, Self::Screw) {
            return false;
        }
        let kappa = x[shared];
        let close = kappa.abs() * length > 1.0;
        if close {
            let moved = 1.0 / (2.0 * length * kappa.signum());
            let d = 1.0 / moved - 1.0 / kappa;
            x[..shared].iter_mut().skip(2).step_by(3).for_each(|z| *z += d);
            x[shared] = moved;
            x[shared + 1..shared + 3].iter_mut().for_each(|b| *b *= kappa / moved);
        }
        let kappa = x[shared];
        let mut unwound = false;
        for b in x[shared + 1..shared + 3].iter_mut().filter(|b| (kappa * **b).abs() > WOUND) {
            *b -= TAU / kappa * (kappa * *b / TAU).round();
            unwound = true;
        }
        close || unwound
    }

    /// All points of one element.
    #[inline]
    pub fn points<const N: usize>(&self, x: &[f64], sites: &[Site; N]) -> [Vec3; N] {
        sites.map(|site| self.point(x, site))
    }
}

/// Adds a block whose first entry is at `(row, column)`.
fn add<const R: usize, const C: usize>(to: &mut Pulled, (row, column): (usize, usize), block: SMatrix<f64, R, C>) {
    let mut place = to.fixed_view_mut::<R, C>(row, column);
    place += block;
}

fn append_lower(size: usize, entry: impl Fn(usize, usize) -> f64, out: &mut Vec<f64>) {
    for row in 0..size {
        out.extend((0..=row).map(|column| entry(row, column)));
    }
}

#[inline]
fn vertex(x: &[f64], site: Site) -> Vec3 {
    Vec3::from_column_slice(&x[3 * site.vertex..3 * site.vertex + 3])
}

/// The screw motion of one cell.
struct Screw {
    kappa: f64,
    b: f64,
    h: f64,
    n: [f64; 2],
    turn: Complex<f64>,
    phi: sinc::Phi,
}

const I: Complex<f64> = Complex::new(0.0, 1.0);

impl Screw {
    fn new(shared: &[f64], site: Site) -> Self {
        let n = site.shift.map(f64::from);
        let (kappa, b, h) = (shared[0], n[0] * shared[1] + n[1] * shared[2], n[0] * shared[3] + n[1] * shared[4]);
        let (sin, cos) = (kappa * b).sin_cos();
        Self { kappa, b, h, n, turn: Complex::new(cos, sin), phi: sinc::phi(kappa * b) }
    }

    fn point(&self, v: &Vec3) -> Vec3 {
        let w = self.turn * Complex::new(v.y, v.z) + self.b * self.phi.value;
        Vec3::new(v.x + self.h, w.re, w.im)
    }

    fn rotation(&self) -> Matrix3<f64> {
        let (c, s) = (self.turn.re, self.turn.im);
        Matrix3::new(1.0, 0.0, 0.0, 0.0, c, -s, 0.0, s, c)
    }

    /// `d w'/d kappa` and `d w'/d b`.
    fn first(&self, w: Complex<f64>) -> [Complex<f64>; 2] {
        let by_kappa = I * self.b * self.turn * w + self.b * self.b * self.phi.first;
        let by_b = self.turn * (I * self.kappa * w + 1.0);
        [by_kappa, by_b]
    }

    fn shared_derivative(&self, v: &Vec3) -> SharedMatrix {
        let [by_kappa, by_b] = self.first(Complex::new(v.y, v.z));
        let mut out = SharedMatrix::zeros();
        let mut column = |k: usize, w: Complex<f64>| (out[(1, k)], out[(2, k)]) = (w.re, w.im);
        column(0, by_kappa);
        column(1, self.n[0] * by_b);
        column(2, self.n[1] * by_b);
        (out[(0, 3)], out[(0, 4)]) = (self.n[0], self.n[1]);
        out
    }

    /// Adds `force . d^2 P` to the lower triangle: the block of this point's vertex (at `at`) and of the shared coordinates
    /// (at `shared`, behind it).
    fn add_curvature(&self, v: &Vec3, force: &Vec3, at: usize, shared: usize, hessian: &mut Pulled) {
        let w = Complex::new(v.y, v.z);
        let along = |z: Complex<f64>| force.y * z.re + force.z * z.im;
        let mut add = |row: usize, column: usize, value: f64| hessian[(row, column)] += value;
        let turn_rate = [self.b, self.n[0] * self.kappa, self.n[1] * self.kappa];
        for (s, rate) in turn_rate.into_iter().enumerate() {
            add(shared + s, at + 1, along(I * rate * self.turn));
            add(shared + s, at + 2, along(-rate * self.turn));
        }
        let (b, kappa) = (self.b, self.kappa);
        let by_kappa_kappa = along(b * b * (b * self.phi.second - self.turn * w));
        let by_kappa_b = along(self.turn * (I * b * (I * kappa * w + 1.0) + I * w));
        let by_b_b = along(I * kappa * self.turn * (I * kappa * w + 1.0));
        add(shared, shared, by_kappa_kappa);
        for p in 0..2 {
            add(shared + 1 + p, shared, self.n[p] * by_kappa_b);
            for q in 0..=p {
                add(shared + 1 + p, shared + 1 + q, self.n[p] * self.n[q] * by_b_b);
            }
        }
    }
}

#[cfg(test)]
mod recentre_tests {
    use super::*;

    /// Claim (theory of the screw chart): the gauge moves every copy of every vertex by the same height, whatever the
    /// curvature; so lengths and fold angles stay. Tolerance: rounding of numbers of size 1.
    #[test]
    fn recentring_moves_all_points_by_the_same_height() {
        for kappa in [3.0, -2.5, 1e4, 1e-3] {
            let old = vec![0.0, 0.0, 0.0, 0.7, -0.2, 0.4, kappa, 0.3 / kappa, -0.9 / kappa, 1.1, 0.2];
            let mut new = old.clone();
            let changed = Domain::Screw.recentre(&mut new, 0.8);
            assert_eq!(changed, kappa.abs() * 0.8 > 1.0);
            assert!(new[6].abs() * 0.8 <= 1.0);
            let height = new[2] - old[2];
            for vertex in 0..2 {
                for shift in [[0, 0], [1, 0], [0, 1], [-2, 3]] {
                    let site = Site { vertex, shift };
                    let moved = Domain::Screw.point(&new, site) - Domain::Screw.point(&old, site);
                    assert!((moved - Vec3::new(0.0, 0.0, height)).norm() < 1e-14, "{kappa} {site:?} {moved}");
                }
            }
        }
    }

    /// Claim: a turn more or less of a lattice rotation is the same map, and after it no rotation is larger than pi by much.
    /// Tolerance: rounding of numbers of size 50.
    #[test]
    fn whole_turns_are_taken_back() {
        for (kappa, theta) in [(0.12, [-6.0, 12.5]), (-0.3, [5.0, 0.4]), (0.3, [3.9, -3.9])] {
            let old = vec![0.0, 0.0, 1.2, 0.7, -0.2, 0.4, kappa, theta[0] / kappa, theta[1] / kappa, 1.1, 0.2];
            let mut new = old.clone();
            assert_eq!(Domain::Screw.recentre(&mut new, 0.8), theta.iter().any(|angle: &f64| angle.abs() > 4.0));
            for vertex in 0..2 {
                for shift in [[1, 0], [0, 1], [-2, 3]] {
                    let site = Site { vertex, shift };
                    let off = Domain::Screw.point(&new, site) - Domain::Screw.point(&old, site);
                    assert!(off.norm() < 1e-12, "{kappa} {site:?} {off}");
                }
            }
            assert!([7, 8].iter().all(|&b| (new[6] * new[b]).abs() <= 4.0), "{new:?}");
        }
    }
}
