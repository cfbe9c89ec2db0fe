//! The fold angle of four points, with its gradient and Hessian.
//!
//! With `e = j - i`, `a = left - i`, `b = right - i` and the face normals `n = e x a` (left) and `m = b x e` (right),
//! `rho = atan2(|e| a.m, n.m)`: zero where the faces lie in one plane, positive for a valley, that is where the faces
//! rise towards the side of their normals. `atan2` keeps all digits at 0 and at pi and knows the sign.
//!
//! In the variables `(e, a, b)` the derivatives are short. With `N = n/|n|^2` and `s = a.e/|e|^2` (where the foot of
//! `left` divides the hinge), and likewise `M`, `r` for the right side,
//! `d rho/da = |e| N`, `d rho/db = |e| M`, `d rho/de = -s |e| N - r |e| M`.
//! The Hessian follows with `dN = (I - 2 n n^T/|n|^2) dn / |n|^2`. With `[p, q] = p q^T + q p^T` and
//! `v = e/|e| + 2 |e| N x a`, and symmetric where it must be, it is on the left side
//! `aa = [N, |e| e x N]`, `ae = N v^T - |e| |N|^2 [a]_x`, `ee = -[N, |e| ds/de + s v]/2`,
//! on the right one the same with `M`, `b`, `r` and `-|e|` before cross products, and `ab = 0`. The lengths and angles
//! in these formulas are those of R. Tamstorf and E. Grinspun, "Discrete bending forces and their Jacobians", Graphical
//! Models 75 (2013) 362-370.

use super::Vec3;
use super::taylor::{Path, Taylor, cross, difference, dot};
use nalgebra::{Matrix3, SVector};

/// Largest magnitude of a fold angle, in radians, at which a hinge counts as flat.
pub(crate) const FLAT_RAD: f64 = 1e-9;

/// Gradient over the twelve coordinates of `[i, j, left, right]`.
pub(crate) type HingeGradient = SVector<f64, 12>;
/// Number of entries of the lower triangle of the Hessian over these coordinates.
const TRIANGLE_ENTRIES: usize = 78;

/// Fold angle of the hinge `[i, j, left, right]`, in radians, in `(-pi, pi]`.
///
/// ```text
///           left
///          /    \
///         i ---- j        both faces counter-clockwise: (i, j, left) and (j, i, right)
///          \    /
///           right
/// ```
///
/// The angle is not a number where a coordinate is none, and zero where a face has no area.
pub fn fold_angle(points: [Vec3; 4]) -> f64 {
    Hinge::new(&points).angle()
}

/// Fold angle, in radians, and its gradient, in radians per unit length, which is infinite where a face has no area.
pub fn fold_angle_gradient(points: &[Vec3; 4]) -> (f64, HingeGradient) {
    let hinge = Hinge::new(points);
    (hinge.angle(), hinge.gradient())
}

/// Fold angle and its gradient; `lower` is overwritten by the lower triangle of the Hessian, row by row.
///
/// The function is inlined into the loop over hinges and writes in place: no matrix is copied on the way.
#[inline(always)]
pub(crate) fn fold_angle_hessian(points: &[Vec3; 4], lower: &mut Vec<f64>) -> (f64, HingeGradient) {
    let hinge = Hinge::new(points);
    lower.resize(TRIANGLE_ENTRIES, 0.0);
    hinge.hessian(&mut lower[..TRIANGLE_ENTRIES]);
    (hinge.angle(), hinge.gradient())
}

/// Taylor series of the fold angle while its points move, to the fourth power of their parameter.
pub(crate) fn fold_angle_along([i, j, left, right]: &[Path; 4]) -> Taylor {
    let [e, a, b] = [j, left, right].map(|point| difference(point, i));
    let (n, m) = (cross(&e, &a), cross(&b, &e));
    (dot(&e, &e).sqrt() * dot(&a, &m)).atan2(dot(&n, &m))
}

/// The hinge in the variables of the module's formulas: one side for `left`, one for `right`.
struct Hinge {
    e: Vec3,
    length: f64,
    left: HingeSide,
    right: HingeSide,
}

/// A face beside the hinge: `wing` is `a` or `b`, `foot` is `s` or `r`.
struct HingeSide {
    wing: Vec3,
    normal: Vec3,
    /// The inverse normal `N` or `M`: the normal divided by its squared length.
    inverse: Vec3,
    foot: f64,
}

impl HingeSide {
    fn new(wing: Vec3, normal: Vec3, e: &Vec3) -> Self {
        Self { wing, normal, inverse: normal / normal.norm_squared(), foot: wing.dot(e) / e.norm_squared() }
    }
}

impl Hinge {
    fn new([i, j, left, right]: &[Vec3; 4]) -> Self {
        let (e, a, b) = (j - i, left - i, right - i);
        Self {
            e,
            length: e.norm(),
            left: HingeSide::new(a, e.cross(&a), &e),
            right: HingeSide::new(b, b.cross(&e), &e),
        }
    }

    fn angle(&self) -> f64 {
        let (n, m) = (&self.left.normal, &self.right.normal);
        (self.length * self.left.wing.dot(m)).atan2(n.dot(m))
    }

    fn gradient(&self) -> HingeGradient {
        let (ga, gb) = (self.length * self.left.inverse, self.length * self.right.inverse);
        let ge = -self.left.foot * ga - self.right.foot * gb;
        let gi = -(ga + gb) - ge;
        let mut gradient = HingeGradient::zeros();
        for (k, block) in [gi, ge, ga, gb].iter().enumerate() {
            gradient.fixed_rows_mut::<3>(3 * k).copy_from(block);
        }
        gradient
    }

    /// Writes the second derivatives, which are blocks in `(e, a, b)`, by the twelve coordinates, where
    /// `e = j - i`, `a = left - i` and `b = right - i`.
    #[inline(always)]
    fn hessian(&self, lower: &mut [f64]) {
        let ([aa, ae, left], [bb, be, right]) = (self.curvature(&self.left, 1.0), self.curvature(&self.right, -1.0));
        let ee = left + right;
        let (ei, ai, bi) = (-(ee + ae.transpose() + be.transpose()), -(ae + aa), -(be + bb));
        let ii = -(ei + ai + bi);
        put::<0, 0>(&ii, lower);
        put::<1, 0>(&ei, lower);
        put::<1, 1>(&ee, lower);
        put::<2, 0>(&ai, lower);
        put::<2, 1>(&ae, lower);
        put::<2, 2>(&aa, lower);
        put::<3, 0>(&bi, lower);
        put::<3, 1>(&be, lower);
        put::<3, 2>(&Matrix3::zeros(), lower);
        put::<3, 3>(&bb, lower);
    }

    /// Second derivatives on the left side, `turn = 1`, or on the right one, `turn = -1`: twice by its wing, by its
    /// wing and `e`, and this side's part of those twice by `e`.
    #[inline(always)]
    fn curvature(&self, side: &HingeSide, turn: f64) -> [Matrix3<f64>; 3] {
        let HingeSide { wing, inverse, foot, .. } = side;
        let (e, turned) = (&self.e, turn * self.length);
        let along = e / self.length + 2.0 * turned * inverse.cross(wing);
        let sliding = (wing - 2.0 * *foot * e) / self.length;
        [
            symmetric(inverse, &(turned * e.cross(inverse))),
            inverse * along.transpose() - turned * inverse.norm_squared() * wing.cross_matrix(),
            -0.5 * symmetric(inverse, &(sliding + *foot * along)),
        ]
    }
}

/// The symmetric product `p q^T + q p^T`.
#[inline(always)]
fn symmetric(p: &Vec3, q: &Vec3) -> Matrix3<f64> {
    let product = p * q.transpose();
    product + product.transpose()
}

/// Puts the block of points `K` and `L <= K` in its place in a lower triangle.
#[inline(always)]
fn put<const K: usize, const L: usize>(block: &Matrix3<f64>, lower: &mut [f64]) {
    for r in 0..3 {
        let (row, columns) = (3 * K + r, if K == L { r + 1 } else { 3 });
        for c in 0..columns {
            lower[row * (row + 1) / 2 + 3 * L + c] = block[(r, c)];
        }
    }
}
