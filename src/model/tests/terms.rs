//! Tests of terms: angles continue from the last accepted state.

use crate::model::element::{Element, Elements, Local, Spring, Term, TermKind};
use crate::model::measure::FoldAngle;
use crate::model::{Domain, Site};
use std::f64::consts::{PI, TAU};

/// A hinge `[i, j, left, right]` along x with both wings of length 1, folded by an angle.
fn hinge(angle: f64) -> Vec<f64> {
    let (sin, cos) = (0.5 * angle).sin_cos();
    vec![0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.5, cos, sin, 0.5, -cos, sin]
}

/// Claim: in steps of less than half a turn the angle is followed over two turns and back, by the functions for the
/// value and for the gradient alike; without accepted steps it is the angle nearest to the last accepted state.
/// Source: the definition that a fold angle is continuous through pi. Tolerance: rounding.
#[test]
fn angles_continue_through_pi() {
    let sites = [0, 1, 2, 3].map(|vertex| Site { vertex, shift: [0, 0] });
    let element = Element { sites, spring: Spring { stiffness: 1.0, rest: 0.0 }, edge: 0 };
    let mut term = Term::<FoldAngle, 4, 12>::new(TermKind::Creases, vec![element], &Domain::Patch, &hinge(0.2));
    let mut local = Local::default();
    let there: Vec<f64> = (1..40).map(|k| 0.2 + 0.35 * f64::from(k)).collect();
    for &angle in there.iter().chain(there.iter().rev()) {
        let x = hinge(angle);
        term.local(0, &Domain::Patch, &x, true, &mut local);
        let values = [term.value(0, &Domain::Patch, &x), local.value];
        assert!(values.iter().all(|value| (value - angle).abs() < 1e-12), "{values:?} for {angle}");
        term.accept(&Domain::Patch, &x);
    }
    assert!(there[there.len() - 1] > 2.0 * TAU);
    term.set_angles(&[TAU + 3.0]);
    for (angle, expected) in [(3.3, TAU + 3.3), (-3.0, TAU + TAU - 3.0), (0.0, TAU)] {
        let found = term.value(0, &Domain::Patch, &hinge(angle));
        assert!((found - expected).abs() < 1e-12, "{found} for {angle}");
    }
    term.accept(&Domain::Patch, &hinge(PI + 0.1));
    assert!((term.angles()[0] - (TAU + PI + 0.1)).abs() < 1e-12);
}
