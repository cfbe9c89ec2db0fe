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
    /// One cell moved by commuting screw motions about an axis in the plane of x and y.
    Screw,
}

/// The screw motions of a state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Turns {
    /// Direction of the axis: its angle from x, in radians.
    pub direction: f64,
    /// One over the height of the axis above z = 0.
    pub kappa: f64,
    /// Angles, in radians, by which the two lattice vectors turn about the axis.
    pub theta: [f64; 2],
}

impl Turns {
    /// Of shared coordinates of a screw.
    fn new(shared: &[f64]) -> Self {
        let (direction, kappa) = (shared[0], shared[1]);
        Self { direction, kappa, theta: seen_along(shared).map(|l| kappa * l.im) }
    }

    /// Unit vector along the axis.
    pub fn axis(&self) -> Vec3 {
        Vec3::new(self.direction.cos(), self.direction.sin(), 0.0)
    }
}

/// The parts of the lattice vectors in the plane, as complex numbers: along the axis and across.
fn seen_along(shared: &[f64]) -> [Complex<f64>; 2] {
    let back = Complex::new(shared[0].cos(), -shared[0].sin());
    [2, 3].map(|k| back * Complex::new(shared[k + 2], shared[k]))
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
    pub fn point(&self, x: &[f64], site: Site) -> Vec3 {
        let v = vertex(x, site);
        let [n1, n2] = site.shift.map(f64::from);
        let shared = self.shared_of(x);
        match self {
            Self::Patch => v,
            Self::FixedTorus([l1, l2]) => v + n1 * l1 + n2 * l2,
            Self::FreeTorus => {
                v + n1 * Vec3::from_column_slice(&shared[..3]) + n2 * Vec3::from_column_slice(&shared[3..])
            }
            Self::Screw => Screw::new(shared, site).at(&v).point(),
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
                let screw = Screw::new(self.shared_of(x), site);
                let at = screw.at(&vertex(x, site));
                vertex_part = at.vertex_derivative();
                shared_part = at.shared_derivative();
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

    /// Turns `lower`, the lower triangle, row by row, of the Hessian of a function in its points, where its gradient is `g`, into the
    /// one in the element's coordinates: `J^T H J` plus the curvature of the map itself, weighted by `g`.
    pub fn pull_hessian<const N: usize, const D: usize>(
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
                Screw::new(self.shared_of(x), site).at(&vertex(x, site)).add_curvature(&force, 3 * k, D, &mut pulled);
            }
        }
        lower.clear();
        for row in 0..D + self.shared() {
            lower.extend((0..=row).map(|column| pulled[(row, column)]));
        }
    }

    /// The screw motions of a state; `None` where there are none.
    pub fn turns(&self, x: &[f64]) -> Option<Turns> {
        matches!(self, Self::Screw).then(|| Turns::new(self.shared_of(x)))
    }

    /// Gives the axis of a screw this direction; nothing else changes.
    pub fn point_axis(&self, x: &mut [f64], direction: f64) {
        if matches!(self, Self::Screw) {
            let first = x.len() - self.shared();
            x[first] = direction;
        }
    }

    /// Gives a screw an axis of this direction and this curvature; its lattice and its vertices stay.
    pub fn bend(&self, x: &mut [f64], direction: f64, kappa: f64) {
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
    pub fn units(&self, x: &[f64], length: f64) -> Vec<f64> {
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
    pub fn recentre(&self, x: &mut [f64], length: f64) -> bool {
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

/// Puts the axis at twice `length` above z = 0 where it is nearer than that; returns whether it was.
fn raise_axis(points: &mut [f64], shared: &mut [f64], length: f64) -> bool {
    let kappa = shared[1];
    if kappa.abs() * length <= 1.0 {
        return false;
    }
    let moved = 1.0 / (2.0 * length * kappa.signum());
    let d = 1.0 / moved - 1.0 / kappa;
    points.iter_mut().skip(2).step_by(3).for_each(|z| *z += d);
    let lattice = seen_along(shared).map(|l| Complex::new(l.re, l.im * kappa / moved));
    shared[1] = moved;
    lay(lattice, shared);
    true
}

/// Takes whole turns off the rotations and off the direction of the axis; returns whether there were any.
fn unwind(shared: &mut [f64]) -> bool {
    let around = shared[0].abs() > WOUND;
    if around {
        shared[0] -= TAU * (shared[0] / TAU).round();
    }
    let (kappa, lattice) = (shared[1], seen_along(shared));
    let wound = |l: &Complex<f64>| (kappa * l.im).abs() > WOUND;
    if !lattice.iter().any(wound) {
        return around;
    }
    let turns = |l: Complex<f64>| if wound(&l) { (kappa * l.im / TAU).round() } else { 0.0 };
    lay(lattice.map(|l| l - I * (TAU / kappa * turns(l))), shared);
    true
}

/// Turns all so that the first lattice vector lies along x again where it lies rather across; returns whether it did.
fn turn_back(points: &mut [f64], shared: &mut [f64]) -> bool {
    let first = Complex::new(shared[4], shared[2]);
    if first.im.abs() <= first.re.abs() {
        return false;
    }
    let back = first.conj() / first.norm();
    for point in points.chunks_exact_mut(3) {
        let turned = back * Complex::new(point[0], point[1]);
        (point[0], point[1]) = (turned.re, turned.im);
    }
    for k in [2, 3] {
        let turned = back * Complex::new(shared[k + 2], shared[k]);
        (shared[k + 2], shared[k]) = (turned.re, turned.im);
    }
    shared[0] += back.arg();
    true
}

/// Sets the lattice to vectors along the axis and across.
fn lay(lattice: [Complex<f64>; 2], shared: &mut [f64]) {
    let forth = Complex::new(shared[0].cos(), shared[0].sin());
    for (k, l) in lattice.into_iter().enumerate() {
        let l = forth * l;
        (shared[k + 4], shared[k + 2]) = (l.re, l.im);
    }
}

/// The screw motion of one cell, seen along the axis: complex numbers are places across it, imaginary is z.
struct Screw {
    kappa: f64,
    /// Shift of the cell: across the axis and along it.
    b: f64,
    h: f64,
    n: [f64; 2],
    /// Direction of the axis.
    e: [f64; 2],
    /// The same shift in the plane of x and y.
    l: [f64; 2],
    turn: Complex<f64>,
    phi: sinc::Phi,
}

/// A point of the cell `(0, 0)` and the screw motion that it takes part in.
struct Screwed {
    screw: Screw,
    v: Vec3,
    /// Its place along the axis and across.
    along: f64,
    w: Complex<f64>,
}

const I: Complex<f64> = Complex::new(0.0, 1.0);

impl Screw {
    fn new(shared: &[f64], site: Site) -> Self {
        let n = site.shift.map(f64::from);
        let l = [n[0] * shared[4] + n[1] * shared[5], n[0] * shared[2] + n[1] * shared[3]];
        let (sine, cosine) = shared[0].sin_cos();
        let (h, b, kappa) = (cosine * l[0] + sine * l[1], cosine * l[1] - sine * l[0], shared[1]);
        let (sin, cos) = (kappa * b).sin_cos();
        Self { kappa, b, h, n, e: [cosine, sine], l, turn: Complex::new(cos, sin), phi: sinc::phi(kappa * b) }
    }

    fn at(self, v: &Vec3) -> Screwed {
        let [cosine, sine] = self.e;
        let w = Complex::new(cosine * v.y - sine * v.x, v.z);
        Screwed { along: cosine * v.x + sine * v.y, v: *v, screw: self, w }
    }
}

/// Derivatives of the bend `d` of a point: by its place across the axis (times `i`: by z), by `kappa`, by `b`.
struct Bend {
    value: Complex<f64>,
    by_w: Complex<f64>,
    by_kappa: Complex<f64>,
    by_b: Complex<f64>,
}

impl Screwed {
    fn bend(&self) -> Bend {
        let (Screw { kappa, b, turn, phi, .. }, w) = (&self.screw, self.w);
        let psi = phi.value + I * phi.first;
        Bend {
            value: I * *kappa * *b * (phi.value * w + psi * *b),
            by_w: I * *kappa * *b * phi.value,
            by_kappa: I * *b * turn * w + *b * *b * phi.first,
            by_b: I * *kappa * (turn * w + phi.value * *b),
        }
    }

    /// Derivative of the bend by the direction: places across the axis change by minus those along it.
    fn bend_by_direction(&self, bend: &Bend) -> Complex<f64> {
        -(bend.by_w * self.along + bend.by_b * self.screw.h)
    }

    /// A place across the axis as a vector.
    fn across(&self, w: Complex<f64>) -> Vec3 {
        let [cosine, sine] = self.screw.e;
        Vec3::new(-sine * w.re, cosine * w.re, w.im)
    }

    fn point(&self) -> Vec3 {
        self.v + Vec3::new(self.screw.l[0], self.screw.l[1], 0.0) + self.across(self.bend().value)
    }

    fn vertex_derivative(&self) -> Matrix3<f64> {
        let ([cosine, sine], by_w) = (self.screw.e, self.bend().by_w);
        let (by_across, by_z) = (self.across(by_w), self.across(I * by_w));
        Matrix3::identity() + Matrix3::from_columns(&[-sine * by_across, cosine * by_across, by_z])
    }

    fn shared_derivative(&self) -> SharedMatrix {
        let (bend, [cosine, sine], n) = (self.bend(), self.screw.e, self.screw.n);
        let turned = self.across(self.bend_by_direction(&bend)) - bend.value.re * Vec3::new(cosine, sine, 0.0);
        let by_across = self.across(bend.by_b);
        let (by_y, by_x) = (Vec3::y() + cosine * by_across, Vec3::x() - sine * by_across);
        let columns = [turned, self.across(bend.by_kappa), n[0] * by_y, n[1] * by_y, n[0] * by_x, n[1] * by_x];
        SharedMatrix::from_columns(&columns)
    }

    /// Adds `force . d^2 P` to the lower triangle: the block of this point's vertex (at `at`) and of the shared coordinates
    /// (at `shared`, behind it).
    fn add_curvature(&self, force: &Vec3, at: usize, shared: usize, hessian: &mut Pulled) {
        let (Screw { kappa, b, h, n, e: [cosine, sine], turn, phi, .. }, w) = (&self.screw, self.w);
        let (m, e) = ([-sine, *cosine], [*cosine, *sine]);
        let (pull, along) = (m[0] * force.x + m[1] * force.y, e[0] * force.x + e[1] * force.y);
        let across = |z: Complex<f64>| pull * z.re + force.z * z.im;
        let bend = self.bend();
        let by_w_kappa = I * *b * turn;
        let by_w_b = I * *kappa * turn;
        let by_b_b = by_w_b * (I * *kappa * w + 1.0);
        let by_kappa_b = turn * (I * *b * (I * *kappa * w + 1.0) + I * w);
        let by_kappa_kappa = (phi.second * *b - turn * w) * (*b * *b);
        let [by_x, by_y, by_z] = [Complex::from(m[0]), Complex::from(m[1]), I];
        let mut add = |row: usize, column: usize, value: f64| hessian[(row, column)] += value;
        // the vertex with direction, curvature and lattice
        let lattice = [n[0] * m[1], n[1] * m[1], n[0] * m[0], n[1] * m[0]];
        for (axis, place) in [by_x, by_y, by_z].into_iter().enumerate() {
            let turned = if axis < 2 { e[axis] * across(bend.by_w) } else { 0.0 };
            add(shared, at + axis, -turned - h * across(place * by_w_b) - along * (place * bend.by_w).re);
            add(shared + 1, at + axis, across(place * by_w_kappa));
            (0..4).for_each(|k| add(shared + 2 + k, at + axis, lattice[k] * across(place * by_w_b)));
        }
        // direction and curvature
        let by_direction = self.bend_by_direction(&bend);
        let x = self.along;
        let twice = by_w_b * (2.0 * x * h) + by_b_b * (h * h) - bend.by_w * w.re - bend.by_b * *b;
        add(shared, shared, across(twice) - 2.0 * along * by_direction.re - pull * bend.value.re);
        add(shared + 1, shared, -across(by_w_kappa * x + by_kappa_b * *h) - along * bend.by_kappa.re);
        add(shared + 1, shared + 1, across(by_kappa_kappa));
        // the lattice with all shared coordinates
        let turned = -across(by_w_b * x + by_b_b * *h) - along * bend.by_b.re;
        let lengthwise = [n[0] * e[1], n[1] * e[1], n[0] * e[0], n[1] * e[0]];
        for k in 0..4 {
            add(shared + 2 + k, shared, lattice[k] * turned - lengthwise[k] * across(bend.by_b));
            add(shared + 2 + k, shared + 1, lattice[k] * across(by_kappa_b));
            (0..=k).for_each(|j| add(shared + 2 + k, shared + 2 + j, lattice[k] * lattice[j] * across(by_b_b)));
        }
    }
}

#[cfg(test)]
mod recentre_tests {
    use super::*;
    use nalgebra::Rotation3;

    /// Claim (theory of the screw chart): the gauge moves every copy of every vertex by the same height, whatever the
    /// curvature; so lengths and fold angles stay. Tolerance: rounding of numbers of size 1.
    #[test]
    fn recentring_moves_all_points_by_the_same_height() {
        for kappa in [3.0, -2.5, 1e4, 1e-3] {
            let old = vec![0.0, 0.0, 0.0, 0.7, -0.2, 0.4, 0.0, kappa, 0.3 / kappa, -0.9 / kappa, 1.1, 0.2];
            let mut new = old.clone();
            let (points, shared) = new.split_at_mut(6);
            assert_eq!(raise_axis(points, shared, 0.8), kappa.abs() * 0.8 > 1.0);
            assert!(new[7].abs() * 0.8 <= 1.0);
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

    /// Claim: a turn more or less of a lattice rotation is the same map, and after it no rotation is larger than pi by much,
    /// whatever the direction of the axis. Tolerance: rounding of numbers of size 50.
    #[test]
    fn whole_turns_are_taken_back() {
        let cases =
            [(0.12, [-6.0, 12.5], 0.0), (-0.3, [5.0, 0.4], 1.1), (0.3, [3.9, -3.9], -2.0), (0.3, [0.1, 0.2], -40.0)];
        for (kappa, theta, direction) in cases {
            let mut old = vec![0.0, 0.0, 1.2, 0.7, -0.2, 0.4, direction, kappa, 0.0, 0.0, 0.0, 0.0];
            lay([Complex::new(1.1, theta[0] / kappa), Complex::new(0.2, theta[1] / kappa)], &mut old[6..]);
            let mut new = old.clone();
            let wound = theta.iter().chain([&direction]).any(|angle: &f64| angle.abs() > 4.0);
            assert_eq!(unwind(&mut new[6..]), wound);
            for vertex in 0..2 {
                for shift in [[1, 0], [0, 1], [-2, 3]] {
                    let site = Site { vertex, shift };
                    let off = Domain::Screw.point(&new, site) - Domain::Screw.point(&old, site);
                    assert!(off.norm() < 1e-12, "{kappa} {site:?} {off}");
                }
            }
            let Turns { direction, theta, .. } = Turns::new(&new[6..]);
            assert!(theta.iter().chain([&direction]).all(|angle| angle.abs() <= 4.0), "{new:?}");
        }
    }

    /// Claim: where the first lattice vector lies across x all points are turned about z, all by the same angle, until it
    /// lies along x; elsewhere nothing is. Tolerance: rounding of numbers of size 10.
    #[test]
    fn the_first_lattice_vector_is_kept_along_x() {
        for (x1, y1) in [(1.0, 0.9), (0.3, -1.0), (-0.2, 1.4), (-1.0, 0.1)] {
            let old = vec![0.0, 0.0, 0.3, 0.7, -0.2, 0.4, 0.6, 0.3, y1, 1.5, x1, 0.4];
            let mut new = old.clone();
            let across = f64::abs(y1) > f64::abs(x1);
            assert_eq!(Domain::Screw.recentre(&mut new, 0.8), across);
            assert!(new[8].abs() <= if across { 1e-15 } else { f64::abs(x1) });
            let turn = if across { Rotation3::new(-Vec3::z() * y1.atan2(x1)) } else { Rotation3::identity() };
            for vertex in 0..2 {
                for shift in [[0, 0], [1, 0], [0, 1], [-2, 3]] {
                    let site = Site { vertex, shift };
                    let off = Domain::Screw.point(&new, site) - turn * Domain::Screw.point(&old, site);
                    assert!(off.norm() < 1e-14, "{x1} {y1} {site:?} {off}");
                }
            }
        }
    }

    /// Claim: near zero curvature a turn of the axis by an angle of any size moves points by no more than the curvature
    /// times the square of the distances, with all digits: the part that bends is the same, to rounding, as with a thousand
    /// times the curvature, a thousand times smaller. Tolerance: the next order in the curvature.
    #[test]
    fn what_bends_keeps_its_digits_near_zero_curvature() {
        let coordinates = |kappa: f64| vec![0.0, 0.0, 0.0, 0.7, -0.2, 0.4, 0.6, kappa, 0.0, 1.5, 1.2, 0.4];
        for power in [100, 50, 20, 12] {
            let derivative = |kappa: f64| {
                let x = coordinates(kappa);
                Domain::Screw.velocity(
                    &x,
                    Site { vertex: 1, shift: [2, -1] },
                    &[&[0.0; 6][..], &[1.0], &[0.0; 5]].concat(),
                )
            };
            let kappa = 10f64.powi(-power);
            let (small, large) = (derivative(kappa) / kappa, derivative(1e3 * kappa) / (1e3 * kappa));
            let off = (small - large).norm() / small.norm();
            assert!(off <= 1e4 * kappa + 4.0 * f64::EPSILON && small.norm() > 0.1, "{kappa:e} {off:e} {small}");
        }
    }
}
