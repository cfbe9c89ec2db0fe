//! The screw motion of one cell and its derivatives.

use super::shared::{Pulled, SharedMatrix};
use crate::math::{Vec3, sinc};
use nalgebra::{Complex, Matrix3};

/// The screw motion of one cell. Points are seen along the axis: a complex number is a position across the axis (real
/// part) and along z (imaginary part).
pub(super) struct ScrewMotion {
    kappa: f64,
    /// Translation of the cell across (`b`) and along (`h`) the axis.
    b: f64,
    h: f64,
    n: [f64; 2],
    /// Unit vector along the axis, in the plane of x and y.
    e: [f64; 2],
    /// Translation of the cell in the plane of x and y.
    l: [f64; 2],
    phi: sinc::Phi,
}

/// A point of cell `(0, 0)` together with a screw motion that is applied to it.
pub(super) struct Screwed<'a> {
    screw: &'a ScrewMotion,
    v: Vec3,
    /// Coordinate of the point along the axis; `w` is its position across.
    along: f64,
    w: Complex<f64>,
}

pub(super) const I: Complex<f64> = Complex::new(0.0, 1.0);

impl ScrewMotion {
    pub(super) fn new(shared: &[f64], shift: [i32; 2]) -> Self {
        let n = shift.map(f64::from);
        let l = [n[0] * shared[4] + n[1] * shared[5], n[0] * shared[2] + n[1] * shared[3]];
        let (sine, cosine) = shared[0].sin_cos();
        let (h, b, kappa) = (cosine * l[0] + sine * l[1], cosine * l[1] - sine * l[0], shared[1]);
        Self { kappa, b, h, n, e: [cosine, sine], l, phi: sinc::phi(kappa * b) }
    }

    pub(super) fn at(&self, v: &Vec3) -> Screwed<'_> {
        let [cosine, sine] = self.e;
        let w = Complex::new(cosine * v.y - sine * v.x, v.z);
        Screwed { along: cosine * v.x + sine * v.y, v: *v, screw: self, w }
    }
}

/// The bending displacement `d` of a point and its derivatives: by the position `w` across the axis (times `i`: by
/// z), by `kappa` and by `b`.
struct Bend {
    value: Complex<f64>,
    by_w: Complex<f64>,
    by_kappa: Complex<f64>,
    by_b: Complex<f64>,
}

impl Screwed<'_> {
    fn bend(&self) -> Bend {
        let (ScrewMotion { kappa, b, phi, .. }, w) = (self.screw, self.w);
        let psi = phi.value + I * phi.first;
        Bend {
            value: I * *kappa * *b * (phi.value * w + psi * *b),
            by_w: I * *kappa * *b * phi.value,
            by_kappa: I * *b * phi.turn * w + *b * *b * phi.first,
            by_b: I * *kappa * (phi.turn * w + phi.value * *b),
        }
    }

    /// Derivative of the bending displacement by the direction of the axis: coordinates across the axis change by
    /// minus those along it.
    fn bend_by_direction(&self, bend: &Bend) -> Complex<f64> {
        -(bend.by_w * self.along + bend.by_b * self.screw.h)
    }

    /// Returns the vector of a position across the axis.
    fn across(&self, w: Complex<f64>) -> Vec3 {
        let [cosine, sine] = self.screw.e;
        Vec3::new(-sine * w.re, cosine * w.re, w.im)
    }

    pub(super) fn point(&self) -> Vec3 {
        self.v + Vec3::new(self.screw.l[0], self.screw.l[1], 0.0) + self.across(self.bend().value)
    }

    /// Returns the derivatives of the point by its vertex and by the shared coordinates.
    pub(super) fn derivatives(&self) -> (Matrix3<f64>, Option<SharedMatrix>) {
        let (bend, [cosine, sine], n) = (self.bend(), self.screw.e, self.screw.n);
        let (by_across, by_z) = (self.across(bend.by_w), self.across(I * bend.by_w));
        let by_vertex = Matrix3::identity() + Matrix3::from_columns(&[-sine * by_across, cosine * by_across, by_z]);
        let turned = self.across(self.bend_by_direction(&bend)) - bend.value.re * Vec3::new(cosine, sine, 0.0);
        let by_across = self.across(bend.by_b);
        let (by_y, by_x) = (Vec3::y() + cosine * by_across, Vec3::x() - sine * by_across);
        let columns = [turned, self.across(bend.by_kappa), n[0] * by_y, n[1] * by_y, n[0] * by_x, n[1] * by_x];
        (by_vertex, Some(SharedMatrix::from_columns(&columns)))
    }

    /// Adds the second derivative of `force . P` to the lower triangle, `P` being the position of this point: the
    /// block of the point's vertex (at `at`) and that of the shared coordinates (at `shared`, which come after it).
    pub(super) fn add_curvature(&self, force: &Vec3, at: usize, shared: usize, hessian: &mut Pulled) {
        let (ScrewMotion { kappa, b, h, n, e: [cosine, sine], phi, .. }, w) = (self.screw, self.w);
        let (m, e) = ([-sine, *cosine], [*cosine, *sine]);
        let (pull, along) = (m[0] * force.x + m[1] * force.y, e[0] * force.x + e[1] * force.y);
        let across = |z: Complex<f64>| pull * z.re + force.z * z.im;
        let bend = self.bend();
        let by_w_kappa = I * *b * phi.turn;
        let by_w_b = I * *kappa * phi.turn;
        let by_b_b = by_w_b * (I * *kappa * w + 1.0);
        let by_kappa_b = phi.turn * (I * *b * (I * *kappa * w + 1.0) + I * w);
        let by_kappa_kappa = (phi.second * *b - phi.turn * w) * (*b * *b);
        let [by_x, by_y, by_z] = [Complex::from(m[0]), Complex::from(m[1]), I];
        let mut add = |row: usize, column: usize, value: f64| hessian[(row, column)] += value;
        // the vertex with the direction, the curvature and the lattice
        let lattice = [n[0] * m[1], n[1] * m[1], n[0] * m[0], n[1] * m[0]];
        for (axis, place) in [by_x, by_y, by_z].into_iter().enumerate() {
            let turned = if axis < 2 { e[axis] * across(bend.by_w) } else { 0.0 };
            add(shared, at + axis, -turned - h * across(place * by_w_b) - along * (place * bend.by_w).re);
            add(shared + 1, at + axis, across(place * by_w_kappa));
            (0..4).for_each(|k| add(shared + 2 + k, at + axis, lattice[k] * across(place * by_w_b)));
        }
        // the direction and the curvature
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
