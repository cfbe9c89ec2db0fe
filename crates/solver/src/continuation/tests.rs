//! Curves of the textbook.

use super::*;
use crate::Implicit;
use foldwell_numerics::DenseMatrix;
use foldwell_numerics::derivatives::{TOLERANCE, check_jacobian};
use std::f64::consts::{PI, TAU};

/// `F` and its Jacobian, row by row.
type Equations = fn(&[f64]) -> (Vec<f64>, Vec<f64>);

struct TextbookCurve {
    unknowns: usize,
    equations: Equations,
    indicator: fn(&CurvePoint) -> f64,
}

impl Implicit for TextbookCurve {
    fn unknowns(&self) -> usize {
        self.unknowns
    }

    fn equations(&self) -> usize {
        (self.equations)(&vec![0.1; self.unknowns]).0.len()
    }

    fn linearize(&mut self, x: &[f64], residual: &mut [f64], jacobian: &mut DenseMatrix) {
        let (value, rows) = (self.equations)(x);
        residual.copy_from_slice(&value);
        *jacobian = DenseMatrix::from_row_slice(value.len(), x.len(), &rows);
    }
}

fn no_indicator(_: &CurvePoint) -> f64 {
    1.0
}

fn run(curve: &mut TextbookCurve, x: &[f64], tangent: &[f64], options: &CurveOptions) -> Trajectory {
    let mut indicators =
        |curve: &mut TextbookCurve, point: &CurvePoint, out: &mut Vec<f64>| out.push((curve.indicator)(point));
    follow(curve, x.to_vec(), tangent.to_vec(), options, &mut indicators, &mut |_| true)
}

/// Of radius 1/2; the second and third row say the same as the first.
fn circle(x: &[f64]) -> (Vec<f64>, Vec<f64>) {
    let value = x[0] * x[0] + x[1] * x[1] - 0.25;
    let row = [2.0 * x[0], 2.0 * x[1]];
    (vec![value, 3.0 * value, -value], [1.0, 3.0, -1.0].iter().flat_map(|f| row.map(|r| f * r)).collect())
}

/// Bernoulli's lemniscate `(x^2 + y^2)^2 = x^2 - y^2`, which crosses itself at the origin.
fn lemniscate(p: &[f64]) -> (Vec<f64>, Vec<f64>) {
    let (x, y) = (p[0], p[1]);
    let square = x * x + y * y;
    let value = square * square - x * x + y * y;
    (vec![value], vec![4.0 * square * x - 2.0 * x, 4.0 * square * y + 2.0 * y])
}

/// The line `2 u = 3 v`, on the torus of angles a knot; a sine makes it curved without changing where it closes.
fn knot(p: &[f64]) -> (Vec<f64>, Vec<f64>) {
    let wave = 2.0 * p[0] - 3.0 * p[1];
    (vec![wave, p[2] - 0.3 * p[0].sin()], vec![2.0, -3.0, 0.0, -0.3 * p[0].cos(), 0.0, 1.0])
}

/// Viviani's curve: a sphere of radius 1 cut by a cylinder through its centre; it crosses itself at (1, 0, 0).
fn viviani(p: &[f64]) -> (Vec<f64>, Vec<f64>) {
    let sphere = p.iter().map(|a| a * a).sum::<f64>() - 1.0;
    let cylinder = (p[0] - 0.5).powi(2) + p[1] * p[1] - 0.25;
    (vec![sphere, cylinder], vec![2.0 * p[0], 2.0 * p[1], 2.0 * p[2], 2.0 * p[0] - 1.0, 2.0 * p[1], 0.0])
}

fn closed(period: f64) -> CurveOptions {
    CurveOptions { period: Some(period), ..CurveOptions::default() }
}

#[test]
fn jacobians() {
    let equations: [(usize, Equations); 4] = [(2, circle), (2, lemniscate), (3, knot), (3, viviani)];
    for (unknowns, equations) in equations {
        let x = &[0.3, -0.7, 0.4][..unknowns];
        let (value, rows) = equations(x);
        let jacobian = DenseMatrix::from_row_slice(value.len(), unknowns, &rows);
        check_jacobian(|x: &[f64]| equations(x).0, x, &jacobian, TOLERANCE).unwrap();
    }
}

/// Claim: a circle given three times over closes after its circumference, smoothly, in tens of steps of two
/// corrections. Tolerance: the interpolant of degree five over steps that turn by less than half a radian.
#[test]
fn circle_closes() {
    let mut curve = TextbookCurve { unknowns: 2, equations: circle, indicator: no_indicator };
    let found = run(&mut curve, &[0.5, 0.0], &[0.0, 1.0], &closed(100.0));
    let End::Closed(back) = &found.end else { panic!("{:?}", found.end) };
    assert!((back.arc_length - PI).abs() <= 1e-6, "{:e}", back.arc_length - PI);
    assert!((back.arrival[1] - 1.0).abs() <= 1e-6);
    assert!(back.windings.iter().all(|turns| *turns == 0));
    assert!(found.points.len() < 60, "{}", found.points.len());
    assert!(found.points.iter().all(|point| point.residual <= 1e-13 && point.corrections <= 3));
}

/// Claim: the lemniscate goes straight through its double point and closes after `Gamma(1/4)^2 / sqrt(2 pi)`; from the
/// double point itself it comes back after half of that, along its other direction. Tolerance as above.
#[test]
fn lemniscate_crosses_itself() {
    const LENGTH: f64 = 5.244_115_108_584_24;
    let mut curve = TextbookCurve { unknowns: 2, equations: lemniscate, indicator: no_indicator };
    let whole = run(&mut curve, &[1.0, 0.0], &[0.0, 1.0], &closed(100.0));
    let End::Closed(back) = &whole.end else { panic!("{:?}", whole.end) };
    assert!((back.arc_length - LENGTH).abs() <= 1e-6, "{:e}", back.arc_length - LENGTH);
    let diagonal = 0.5f64.sqrt();
    let half = run(&mut curve, &[0.0, 0.0], &[diagonal, diagonal], &closed(100.0));
    let End::Closed(back) = &half.end else { panic!("{:?}", half.end) };
    assert!((back.arc_length - LENGTH / 2.0).abs() <= 1e-6, "{:e}", back.arc_length - LENGTH / 2.0);
    assert!((back.arrival[0] + diagonal).abs() <= 1e-6 && (back.arrival[1] - diagonal).abs() <= 1e-6);
}

/// Claim: a curve on the torus of angles closes modulo 2 pi and says how often it went round in each. Its length from a
/// fine sum of chords.
#[test]
fn knot_closes_modulo_turns() {
    let mut curve = TextbookCurve { unknowns: 3, equations: knot, indicator: no_indicator };
    let slope = [3.0, 2.0, 0.9];
    let length = slope.iter().map(|a| a * a).sum::<f64>().sqrt();
    let found = run(&mut curve, &[0.0; 3], &slope.map(|a| a / length), &closed(TAU));
    let End::Closed(back) = &found.end else { panic!("{:?}", found.end) };
    assert_eq!(back.windings, [3, 2, 0]);
    let count = 200_000;
    let place = |k: usize| {
        let u = 3.0 * TAU * k as f64 / count as f64;
        [u, 2.0 * u / 3.0, 0.3 * u.sin()]
    };
    let chord = |k: usize| place(k).iter().zip(place(k + 1)).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt();
    let expected: f64 = (0..count).map(chord).sum();
    assert!((back.arc_length - expected).abs() <= 2e-6, "{:e}", back.arc_length - expected);
}

/// Claim: Viviani's curve closes through its double point. Its length is `4 sqrt(2) E(1/2)`, E the complete elliptic
/// integral of the second kind: 7.640395578055424 (arc length of `(cos^2 t, cos t sin t, sin t)`).
#[test]
fn viviani_closes() {
    let mut curve = TextbookCurve { unknowns: 3, equations: viviani, indicator: no_indicator };
    let found = run(&mut curve, &[0.0, 0.0, 1.0], &[0.0, 1.0, 0.0], &closed(100.0));
    let End::Closed(back) = &found.end else { panic!("{:?}", found.end) };
    assert!((back.arc_length - 7.640_395_578_055_424).abs() <= 1e-6, "{:e}", back.arc_length - 7.640_395_578_055_424);
}

/// Claim: events are located on the curve to 1e-10 in arc length, those that jump instead of vanishing too; stopping
/// ones end the trajectory there, and so does a wanted length.
#[test]
fn events_are_located() {
    let smooth: fn(&CurvePoint) -> f64 = |point| point.x[1] - 0.3;
    let jump: fn(&CurvePoint) -> f64 = |point| if point.x[1] < 0.3 { -1.0 } else { 1.0 };
    let expected = 0.5 * (0.6f64).asin();
    for indicator in [smooth, jump] {
        let mut curve = TextbookCurve { unknowns: 2, equations: circle, indicator };
        let seen = run(&mut curve, &[0.5, 0.0], &[0.0, 1.0], &CurveOptions { length: 1.5, ..CurveOptions::default() });
        assert_eq!(seen.end, End::Length);
        assert!((seen.points[seen.points.len() - 1].arc_length - 1.5).abs() <= 1e-12);
        assert_eq!(seen.events.len(), 2);
        assert!((seen.events[0].point.x[1] - 0.3).abs() <= 1e-10, "{:?}", seen.events[0]);
        let options = CurveOptions { stops: vec![0], ..CurveOptions::default() };
        let stopped = run(&mut curve, &[0.5, 0.0], &[0.0, 1.0], &options);
        assert_eq!(stopped.end, End::Stopped { indicator: 0 });
        let last = &stopped.points[stopped.points.len() - 1];
        assert!((last.x[1] - 0.3).abs() <= 1e-10 && (last.arc_length - expected).abs() <= 1e-6);
    }
}

/// Claim: a dead end (the cusp of `y^2 = x^3`) is a failure that keeps the points up to there.
#[test]
fn dead_end() {
    let cusp: Equations = |p| (vec![p[1] * p[1] - p[0].powi(3)], vec![-3.0 * p[0] * p[0], 2.0 * p[1]]);
    let mut curve = TextbookCurve { unknowns: 2, equations: cusp, indicator: no_indicator };
    let slope = [-2.0 / 13f64.sqrt(), -3.0 / 13f64.sqrt()];
    let found = run(&mut curve, &[1.0, 1.0], &slope, &CurveOptions::default());
    assert_eq!(found.end, End::Failed);
    let last = &found.points[found.points.len() - 1];
    assert!(last.x[0].abs() < 0.01, "{:?}", last);
}

/// Claim: events of the last step behind the length at which a curve is cut are left out; those before it are kept.
/// Source: a circle of radius 1/2 is at `(-1/2, 0)` after a length of pi/2.
#[test]
fn events_behind_the_end_are_left_out() {
    for shorter in (-10..40).filter(|k| *k != 0).map(|k| 1e-3 * f64::from(k)) {
        let mut curve = TextbookCurve { unknowns: 2, equations: circle, indicator: |point| point.x[1] };
        // it starts at an angle of 0.1, half of which is the length from (1/2, 0) to there
        let options = CurveOptions { length: 0.5 * PI - 0.05 - shorter, ..CurveOptions::default() };
        let (sin, cos) = 0.1f64.sin_cos();
        let found = run(&mut curve, &[0.5 * cos, 0.5 * sin], &[-sin, cos], &options);
        assert_eq!(found.end, End::Length);
        assert_eq!(found.events.len(), usize::from(shorter < 0.0), "{shorter}");
    }
}
