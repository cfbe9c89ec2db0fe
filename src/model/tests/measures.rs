//! Tests of length and fold angle: every entry of gradient and Hessian, also for nearly degenerate elements.

use super::{RandomNumbers, symmetric};
use crate::math::Vec3;
use crate::math::taylor::Taylor;
use crate::model::measure::{FoldAngle, Length, Measure};
use crate::numerics::DenseMatrix;
use crate::numerics::derivatives::{TOLERANCE, check_gradient, check_jacobian};
use nalgebra::{SMatrix, SVector};
use std::f64::consts::{PI, TAU};

fn points<const N: usize>(x: &[f64]) -> [Vec3; N] {
    std::array::from_fn(|k| Vec3::from_column_slice(&x[3 * k..3 * k + 3]))
}

/// Returns a measure, its gradient and its full Hessian. The list for the triangle is not empty before: its content
/// must not matter.
fn hessian<M: Measure<N, D> + Default, const N: usize, const D: usize>(
    points: &[Vec3; N],
) -> (f64, SVector<f64, D>, SMatrix<f64, D, D>) {
    let mut lower = vec![f64::NAN; 100];
    let (value, gradient) = M::default().hessian(points, &mut lower);
    assert_eq!(lower.len(), D * (D + 1) / 2);
    (value, gradient, SMatrix::from_column_slice(symmetric(D, &lower).as_slice()))
}

/// Checks gradient and Hessian of a measure at `x`; angles are continued from their value at `x`.
fn check<M: Measure<N, D> + Default, const N: usize, const D: usize>(x: &[f64], what: &str) {
    let home = M::default().value(&points(x));
    let value = |x: &[f64]| {
        let value = M::default().value(&points(x));
        if M::ANGLE { value + TAU * ((home - value) / TAU).round() } else { value }
    };
    let (by_gradient, gradient) = M::default().gradient(&points(x));
    let (by_hessian, again, hessian) = hessian::<M, N, D>(&points(x));
    assert_eq!([home; 2], [by_gradient, by_hessian], "{what}: three functions, one value");
    assert_eq!(gradient, again, "{what}: two functions, one gradient");
    check_along::<M, N, D>(x, (gradient.as_slice(), &hessian), what);
    let hessian = DenseMatrix::from_column_slice(D, D, hessian.as_slice());
    check_gradient(value, x, gradient.as_slice(), TOLERANCE).unwrap_or_else(|error| panic!("{what}: {error}"));
    check_jacobian(|x| M::default().gradient(&points(x)).1.as_slice().to_vec(), x, &hessian, TOLERANCE)
        .unwrap_or_else(|error| panic!("{what}, Hessian: {error}"));
}

/// Checks the Taylor series of a measure along a random path: the first two coefficients against gradient and
/// Hessian, to rounding; the third and the fourth against central differences with a step of a hundredth of the
/// element's smallest distance, whose error is the square of that and some rounding.
fn check_along<M: Measure<N, D> + Default, const N: usize, const D: usize>(
    x: &[f64],
    (gradient, hessian): (&[f64], &SMatrix<f64, D, D>),
    what: &str,
) {
    let points: [Vec3; N] = points(x);
    let pairs = (0..N).flat_map(|i| (0..i).map(move |j| (i, j)));
    let size = pairs.map(|(i, j)| (points[i] - points[j]).norm()).fold(f64::INFINITY, f64::min);
    let mut numbers = RandomNumbers::new(7);
    let [v, w] = [numbers.many(D, size), numbers.many(D, size)].map(|v| SVector::<f64, D>::from_column_slice(&v));
    let series = |start: &[f64]| {
        let at = |place: usize| Taylor([start[place], v[place], w[place], 0.0, 0.0]);
        M::default().along(&std::array::from_fn(|k| std::array::from_fn(|axis| at(3 * k + axis)))).unwrap().0
    };
    let found = series(x);
    let along = |v: &SVector<f64, D>| gradient.iter().zip(v.iter()).map(|(g, v)| g * v).sum::<f64>();
    let scale = found.iter().skip(1).fold(0.0f64, |most, c| most.max(c.abs()));
    let second = along(&w) + 0.5 * (v.transpose() * hessian * v)[0];
    let off = [found[0] - M::default().value(&points), found[1] - along(&v), found[2] - second];
    assert!(off.iter().all(|off| off.abs() <= 1e-9 * (scale + found[0].abs())), "{what}: {off:?} {found:?}");
    // the path is quadratic: after a step h its velocity is v + 2 h w
    let acceleration = |h: f64| -> f64 {
        let moved: Vec<f64> = (0..D).map(|k| x[k] + h * v[k] + h * h * w[k]).collect();
        let speed = v + 2.0 * h * w;
        let (_, gradient, hessian) = self::hessian::<M, N, D>(&self::points(&moved));
        2.0 * gradient.dot(&w) + (speed.transpose() * hessian * speed)[0]
    };
    let h = 1e-3;
    let [before, now, after] = [-h, 0.0, h].map(acceleration);
    let (third, fourth) = ((after - before) / (2.0 * h) / 6.0, (after - 2.0 * now + before) / (h * h) / 24.0);
    let close = |found: f64, expected: f64, part: f64| (found - expected).abs() <= part * scale.max(expected.abs());
    assert!(close(found[3], third, 1e-3), "{what}: third power {} and {third}", found[3]);
    assert!(close(found[4], fourth, 1e-2), "{what}: fourth power {} and {fourth}", found[4]);
}

/// The hinge `[i, j, left, right]` at a random place, with an edge of length `edge`, wings of these heights over the
/// edge, and a given fold angle.
fn hinge(numbers: &mut RandomNumbers, edge: f64, heights: [f64; 2], angle: f64) -> Vec<f64> {
    let feet = [0.5 + numbers.within(0.4), 0.5 + numbers.within(0.4)];
    let half = 0.5 * angle;
    let local = [
        Vec3::zeros(),
        Vec3::new(edge, 0.0, 0.0),
        Vec3::new(feet[0] * edge, heights[0] * half.cos(), heights[0] * half.sin()),
        Vec3::new(feet[1] * edge, -heights[1] * half.cos(), heights[1] * half.sin()),
    ];
    let turn = nalgebra::Rotation3::new(Vec3::from_column_slice(&numbers.many(3, 2.0)));
    let shift = Vec3::from_column_slice(&numbers.many(3, 0.2));
    local.iter().flat_map(|p| <[f64; 3]>::from(turn * p + shift)).collect()
}

/// Claim: gradient and Hessian of a length are right in every entry, for bars of any direction, of length 1e-3
/// between coordinates of size 1, and along an axis, where two thirds of the gradient vanish. Source: extrapolated
/// differences.
#[test]
fn lengths() {
    let mut numbers = RandomNumbers::new(1);
    for _ in 0..40 {
        check::<Length, 2, 6>(&numbers.many(6, 1.0), "random");
        let mut short = numbers.many(6, 1.0);
        (0..3).for_each(|k| short[3 + k] = short[k] + numbers.within(1e-3));
        check::<Length, 2, 6>(&short, "short");
    }
    check::<Length, 2, 6>(&[0.0, 0.0, 0.0, 2.0, 0.0, 0.0], "along an axis");
}

/// Claim: gradient and Hessian of fold angles are right at random points. Source: extrapolated differences.
#[test]
fn fold_angles_at_random() {
    let mut numbers = RandomNumbers::new(2);
    for k in 0..60 {
        check::<FoldAngle, 4, 12>(&numbers.many(12, 1.0), &format!("random {k}"));
    }
}

/// Claim: they are right where a formula with `acos` or a careless one would fail: flat, 1e-9 from flat, 1e-6 from
/// fully folded (differences reach across pi and are continued), and at a right angle. Source: extrapolated
/// differences.
#[test]
fn fold_angles_flat_and_folded() {
    let mut numbers = RandomNumbers::new(3);
    for angle in [0.0, 1e-9, -1e-9, 1e-5, PI / 2.0, PI - 1e-6, 1e-6 - PI, 3.0, -3.0] {
        for _ in 0..6 {
            let x = hinge(&mut numbers, 1.0, [0.8, 0.6], angle);
            let found = FoldAngle.value(&points(&x));
            assert!((found - angle).abs() < 1e-14, "the hinge was made with {angle:e} and has {found:e}");
            check::<FoldAngle, 4, 12>(&x, &format!("folded by {angle:e}"));
        }
    }
}

/// Claim: they are right for needles: wings a hundredth as high as the edge is long, one wing or both, and edges a
/// hundredth as long as the wings are high. Source: extrapolated differences.
#[test]
fn fold_angles_of_needles() {
    let mut numbers = RandomNumbers::new(4);
    for (edge, heights) in [(1.0, [0.01, 0.8]), (1.0, [0.7, 0.01]), (1.0, [0.01, 0.01]), (0.01, [0.9, 0.7])] {
        for angle in [1e-9, 0.4, -2.0, PI - 1e-6] {
            let x = hinge(&mut numbers, edge, heights, angle);
            check::<FoldAngle, 4, 12>(&x, &format!("edge {edge}, heights {heights:?}, folded by {angle:e}"));
        }
    }
}

/// The fold angle by the components `a`, `b` of the wings across the edge, `atan2(u . (a x b), -a . b)`, which is not
/// the formula of the code.
fn by_wings(x: &[Taylor; 12]) -> Taylor {
    let minus = |p: usize, q: usize| [0, 1, 2].map(|k| x[3 * p + k] - x[3 * q + k]);
    let dot = |a: [Taylor; 3], b: [Taylor; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let edge = minus(1, 0);
    let unit = edge.map(|c| c.over(dot(edge, edge).sqrt()));
    let across = |wing: [Taylor; 3]| {
        let along = dot(wing, unit);
        [0, 1, 2].map(|k| wing[k] - along * unit[k])
    };
    let (a, b) = (across(minus(2, 0)), across(minus(3, 0)));
    let cross = [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
    dot(unit, cross).atan2(Taylor::default() - dot(a, b))
}

/// Claim: value, gradient and Hessian of the fold angle are right. Source: dual numbers through another formula.
/// Tolerance: rounding of both, of terms up to the square (gradient) and the cube (Hessian) of the inverse height of
/// a wing.
#[test]
fn fold_angles_by_power_series() {
    let mut numbers = RandomNumbers::new(5);
    for angle in [0.0, 1e-9, 0.3, -1.7, 2.9, PI - 1e-6] {
        for heights in [[0.8, 0.6], [0.1, 0.7]] {
            let x = hinge(&mut numbers, 1.0, heights, angle);
            let series = |moves: &dyn Fn(usize) -> bool| {
                by_wings(&std::array::from_fn(|k| Taylor([x[k], f64::from(u8::from(moves(k))), 0.0, 0.0, 0.0]))).0
            };
            let gradient = SVector::<f64, 12>::from_fn(|i, _| series(&|k| k == i)[1]);
            let twice = |i: usize| series(&|k| k == i)[2];
            let hessian = SMatrix::<f64, 12, 12>::from_fn(|i, j| {
                if i == j { 2.0 * twice(i) } else { series(&|k| k == i || k == j)[2] - twice(i) - twice(j) }
            });
            let (found, g, h) = self::hessian::<FoldAngle, 4, 12>(&points(&x));
            assert!((found - series(&|_| false)[0]).abs() < 1e-14);
            let off = [(g - gradient).amax() / gradient.amax(), (h - hessian).amax() / hessian.amax()];
            assert!(off[0] < 1e-13 && off[1] < 1e-12, "at {angle:e}: gradient {:e}, Hessian {:e}", off[0], off[1]);
        }
    }
}
