//! Tests of terms: angles continue from the last accepted state.

use crate::model::element::{Local, Term, TermKind};
use crate::model::law::{Spring, Stored};
use crate::model::measure::FoldAngle;
use crate::model::problem::{Bodies, Equations, Gauge, Model};
use crate::model::{Domain, Site};
use std::f64::consts::{PI, TAU};
use std::sync::Arc;

/// A hinge `[i, j, left, right]` along x with both wings of length 1, folded by an angle.
fn hinge(angle: f64) -> Vec<f64> {
    let (sin, cos) = (0.5 * angle).sin_cos();
    vec![0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.5, cos, sin, 0.5, -cos, sin]
}

fn model_of_one_hinge(drawn: Vec<f64>) -> Model {
    let sites = [0, 1, 2, 3].map(|vertex| Site { vertex, shift: [0, 0] });
    let term = Term::new((TermKind::Creases, "creases"), FoldAngle, vec![(sites, None)], |_| Stored::Spring);
    let equations = Equations {
        domain: Domain::Patch,
        drawn,
        bodies: Bodies::default(),
        soft: vec![Arc::new(term)],
        stiff: vec![],
        edges: 1,
        mean_edge: 1.0,
        gauge: Gauge::Held,
    };
    Model::new(equations, vec![Spring { stiffness: 1.0, rest: 0.0 }], vec![], vec![], vec![])
}

/// Claim: in steps of less than half a turn the angle is followed over two turns and back, by the functions for the
/// value and for the gradient alike; without accepted steps it is the angle nearest to the last accepted state.
/// Source: the definition that a fold angle is continuous through pi. Tolerance: rounding.
#[test]
fn angles_continue_through_pi() {
    let mut model = model_of_one_hinge(hinge(0.2));
    let mut local = Local::default();
    let there: Vec<f64> = (1..40).map(|k| 0.2 + 0.35 * f64::from(k)).collect();
    for &angle in there.iter().chain(there.iter().rev()) {
        let x = hinge(angle);
        let element = model.elements().next().unwrap();
        element.local(&x, true, &mut local);
        let values = [element.value(&x), local.value];
        assert!(values.iter().all(|value| (value - angle).abs() < 1e-12), "{values:?} for {angle}");
        model.accept_angles(&x);
    }
    assert!(there[there.len() - 1] > 2.0 * TAU);
    model.set_angles(&[TAU + 3.0]);
    for (angle, expected) in [(3.3, TAU + 3.3), (-3.0, TAU + TAU - 3.0), (0.0, TAU)] {
        let found = model.elements().next().unwrap().value(&hinge(angle));
        assert!((found - expected).abs() < 1e-12, "{found} for {angle}");
    }
    model.accept_angles(&hinge(PI + 0.1));
    assert!((model.angles()[0] - (TAU + PI + 0.1)).abs() < 1e-12);
}
