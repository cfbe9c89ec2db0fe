//! Tests of rigid parts and drives: derivatives by poses, rigid motions, and the rates by a driven quantity.

use super::RandomNumbers;
use super::whole::check;
use crate::math::{Vec3, rotation};
use crate::model::{
    Assembly, Boundary, Drive, Driven, DrivenModel, Gauge, Hinges, Model, OwnTerm, Part, TermKind, Terms,
};
use crate::numerics::DenseMatrix;
use crate::numerics::derivatives::{TOLERANCE, check_jacobian};
use crate::sheet::generate::{Miura, Pattern};
use crate::sheet::{EdgeKind, generate};
use crate::solver::path::{ParametrizedProblem, Rates};
use crate::solver::{HessianKind, Linearization, Problem};

const ALL: [bool; 6] = [true; 6];

fn patch() -> Assembly {
    let sheet = generate(&Pattern::Miura(Miura { fold: 0.4, ..Miura::default() })).unwrap();
    Assembly::without_terms(sheet, [2, 2], Boundary::Patch).unwrap()
}

/// Bars, creases and facets, loads on parts and beside them, a lock and a guide.
fn terms(assembly: &Assembly, parts: Vec<Part>) -> Terms {
    let mut numbers = RandomNumbers::new(11);
    let (tiling, angles) = (assembly.tiling(), assembly.drawn_angles());
    let rest: Vec<f64> = angles.iter().map(|angle| angle + numbers.within(0.2)).collect();
    let hinges = |stiffness: f64| Some(Hinges { stiffness: stiffness.into(), rest: rest.clone() });
    let free = |v: &usize| parts.iter().all(|part| !part.vertices.contains(v));
    let beside: Vec<usize> = (0..tiling.positions.len()).filter(free).collect();
    let mut folding =
        (0..tiling.edges.len()).filter(|&e| tiling.edges[e].kind == EdgeKind::Crease && !angles[e].is_nan());
    let crease = folding.next_back().unwrap();
    Terms {
        bars: Some(30.0.into()),
        creases: hinges(1.0),
        facets: hinges(3.0),
        locks: vec![(crease, angles[crease] + 0.1)],
        loads: [(parts[0].vertices[1], 1.0), (beside[0], -1.0), (beside[1], 0.3)]
            .map(|(v, f)| (v, f * Vec3::new(0.1, 0.2, -0.3)))
            .to_vec(),
        guides: vec![(beside[2], Vec3::new(0.6, 0.0, 0.8))],
        parts,
        ..Terms::default()
    }
}

fn parts(free: [bool; 6]) -> Vec<Part> {
    vec![Part { vertices: vec![0, 1, 2], free }, Part { vertices: vec![12, 13, 14, 15], free: ALL }]
}

/// Claim: with rigid parts, whatever they keep free, the gradient is the derivative of the energy, the Jacobian that of
/// the gaps, and the Hessian that of gradient plus tensions, also far from the drawn state. Source: differences.
#[test]
fn derivatives_by_poses() {
    let assembly = patch();
    for free in [ALL, [false; 6], [false, false, true, false, false, true], [true, true, false, true, true, false]] {
        for turned in [0.0, 0.8] {
            let mut model = assembly.with_terms(terms(&assembly, parts(free))).model(Gauge::Held);
            let mut numbers = RandomNumbers::new(3);
            let x: Vec<f64> = model.start().iter().map(|x| x + numbers.within(turned)).collect();
            model.start_from(model.coordinates(&x));
            check(&mut model, &mut numbers, &format!("parts free {free:?}, turned by {turned}"));
        }
    }
}

/// Claim: poses are found again from positions, of rotations up to several turns too when they are near the last one.
#[test]
fn poses_are_found_again() {
    let assembly = patch();
    let model = |free| assembly.with_terms(terms(&assembly, parts(free))).model(Gauge::Free);
    let mut model = model(ALL);
    let mut x = model.start();
    for step in 0..40 {
        let poses = x.len() - 12;
        x[poses + 3..poses + 6].iter_mut().for_each(|turn| *turn += 0.2 * f64::from(step % 3));
        x[poses] += 0.1;
        let coordinates = model.coordinates(&x);
        let again = model.start_from(coordinates);
        let most = x.iter().zip(&again).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(most <= 1e-12, "{step}: {most}");
    }
}

/// Claim: the energy of a sheet with rigid parts does not change when all of it turns and moves, and the gauge leaves
/// as many unknowns as the pins, guides and parts do, less the rigid motions that remain.
#[test]
fn rigid_motions_cost_nothing() {
    let assembly = patch();
    let plain = Terms { loads: vec![], guides: vec![], ..terms(&assembly, parts(ALL)) };
    let model = assembly.with_terms(plain.clone()).model(Gauge::Held);
    let turn = rotation::exp(&Vec3::new(0.3, -0.5, 0.4));
    let drawn = &assembly.drawn().coordinates;
    let turned: Vec<f64> = drawn
        .chunks_exact(3)
        .flat_map(|p| <[f64; 3]>::from(turn * Vec3::from_column_slice(p) + Vec3::new(1.0, 2.0, 3.0)))
        .collect();
    let energy = |model: &Model, coordinates: &[f64]| {
        let mut moved = assembly.with_terms(plain.clone()).model(Gauge::Held);
        let x = moved.start_from(coordinates.to_vec());
        let _ = model;
        moved.energy(&x)
    };
    let [before, after] = [energy(&model, drawn), energy(&model, &turned)];
    assert!((before - after).abs() <= 1e-13 * before.abs().max(1e-3), "{before} {after}");
    let vertices = assembly.tiling().positions.len();
    assert_eq!(model.layout().unknowns, 3 * (vertices - 7) + 12 - 6);
    let held = Terms { parts: parts([false; 6]), ..plain };
    let model = assembly.with_terms(held).model(Gauge::Held);
    assert_eq!(model.layout().unknowns, 3 * (vertices - 7) + 6, "a held part leaves no rigid motion");
}

/// Claim: rates by every kind of drive, of the gradient, of the stretches and of the conjugate, are derivatives; and
/// for a prescribed value the conjugate is minus its tension. Source: differences.
#[test]
fn rates_of_drives() {
    let assembly = patch();
    let all = terms(&assembly, parts([false, false, true, false, false, true]));
    let lock = all.locks[0].0;
    let drives = [
        Driven::Part { part: 0, axis: 2 },
        Driven::Part { part: 0, axis: 5 },
        Driven::Vertices { vertices: vec![5, 9], direction: Vec3::new(0.0, 0.6, 0.8) },
        Driven::Loads,
        Driven::Lock(vec![lock]),
        Driven::Rest,
        Driven::Stiffness(TermKind::Bars),
        Driven::Stiffness(TermKind::Creases),
    ];
    for quantity in drives {
        let pinned = Terms { pins: vec![(8, [true; 3])], ..all.clone() };
        check_rates(assembly.with_terms(pinned).model(Gauge::Held), quantity);
    }
}

/// Claim: so are those by a factor of loads and pressures, by a pressure and by a volume, of faces and plates. Source: differences.
#[test]
fn rates_of_loads_and_pressures() {
    let pattern = Pattern::of(&"pattern = \"kresling\"\nlevels = 2".parse().unwrap()).unwrap();
    let tube = Assembly::patch(generate(&pattern).unwrap(), [1, 1]).bars(10.0).creases(0.3);
    let rings = [0..6, 12..18].map(|ring| ring.map(|vertex| (vertex, [0, 0])).collect::<Vec<_>>());
    let [floor, lid] = rings;
    let held =
        tube.part(floor, [false; 6]).part(lid, ALL).load(7, [0, 0], [0.1, 0.0, -0.2]).load(14, [0, 0], [0.0, 0.3, 0.1]);
    let assembly = held.build().unwrap();
    let pressed = assembly.with_own_term(OwnTerm::pressure(&assembly, "air", 0.7, |_| true).unwrap());
    let pressed = pressed.with_terms(Terms { guides: vec![(8, Vec3::new(0.6, 0.8, 0.0))], ..pressed.terms().clone() });
    for quantity in [Driven::Loads, Driven::Pressure("air".into()), Driven::Volume("air".into())] {
        check_rates(pressed.model(Gauge::Held), quantity);
    }
    // the volume comes after the elements and before the guide
    let (model, measures) = (pressed.model(Gauge::Held), pressed.model(Gauge::Held).compliance().len());
    let drive = Drive { quantity: Driven::Volume("air".into()), to: 0.1 };
    let driven = DrivenModel::new(model.clone(), &drive, model.values(&model.start()), false).unwrap();
    let tension = driven.with_drive(vec![1.0; measures]);
    assert_eq!(tension.iter().position(|tension| *tension == 0.0), Some(measures - 1));
    assert_eq!(driven.without_drive(&tension), vec![1.0; measures]);
}

/// Claim: so are those by a factor of a torque. Source: differences.
#[test]
fn rates_of_torques() {
    let assembly = patch();
    let all = terms(&assembly, parts([false, false, true, false, false, true]));
    let held = assembly.with_terms(Terms { pins: vec![(8, [true; 3])], ..all });
    let guided = held.with_terms(Terms { guides: vec![], ..held.terms().clone() });
    let turned = guided.with_own_term(OwnTerm::torque(&guided, 0, 2, 0.3).unwrap());
    check_rates(turned.model(Gauge::Held), Driven::Loads);
}

/// Checks the rates of a drive of this quantity in a random state near the drawn one.
fn check_rates(model: Model, quantity: Driven) {
    let what = format!("{quantity:?}");
    let drawn = model.values(&model.start());
    let drive = Drive { quantity, to: 0.37 };
    let mut driven = DrivenModel::new(model, &drive, drawn, false).unwrap();
    let mut numbers = RandomNumbers::new(5);
    let x: Vec<f64> = driven.model.start().iter().map(|x| x + numbers.within(0.05)).collect();
    let tension = numbers.many(driven.layout().stiff.len(), 1.0);
    let home = driven.parameter() + 0.1 * driven.parameter_scale();
    driven.set_parameter(home);
    let mut at = Linearization::new(driven.layout());
    driven.linearize(&x, &tension, HessianKind::Full, &mut at);
    let [force, gap] = driven.parameter_rates(&at, &x, &tension);
    let rates = Rates {
        x: numbers.many(x.len(), 1.0),
        tension: numbers.many(tension.len(), 1.0),
        parameter: numbers.within(0.2),
    };
    let rate = driven.conjugate_rate(&at, &x, &tension, &rates);
    let model = std::cell::RefCell::new(driven);
    let equations = |parameter: &[f64]| {
        let mut driven = model.borrow_mut();
        driven.set_parameter(parameter[0]);
        let mut at = Linearization::new(driven.layout());
        driven.linearize(&x, &tension, HessianKind::Full, &mut at);
        let missing = at.missing(&tension, driven.compliance());
        at.force(&tension).iter().chain(&missing).map(|v| -v).collect()
    };
    let column = DenseMatrix::from_iterator(x.len() + tension.len(), 1, force.iter().chain(&gap).copied());
    check_jacobian(equations, &[home], &column, TOLERANCE).unwrap_or_else(|e| panic!("{what}: {e}"));
    let conjugate = |s: &[f64]| {
        let mut driven = model.borrow_mut();
        driven.set_parameter(home + s[0] * rates.parameter);
        let moved = |v: &[f64], rate: &[f64]| v.iter().zip(rate).map(|(v, r)| v + s[0] * r).collect::<Vec<f64>>();
        let (x, tension) = (moved(&x, &rates.x), moved(&tension, &rates.tension));
        let mut at = Linearization::new(driven.layout());
        driven.linearize(&x, &tension, HessianKind::Full, &mut at);
        vec![driven.conjugate(&at, &x, &tension)]
    };
    let found = DenseMatrix::from_element(1, 1, rate);
    check_jacobian(conjugate, &[0.0], &found, TOLERANCE).unwrap_or_else(|e| panic!("{what}, conjugate: {e}"));
}

/// Claim: the derivatives of a turned vector are those of the rotation matrix times the vector, at 0, on both
/// sides of the end of the series, beyond pi and beyond a whole turn. Source: extrapolated differences.
#[test]
fn turned_vectors_and_their_derivatives() {
    let arm = Vec3::new(0.3, -1.1, 0.7);
    for axis in [[1.0, 0.0, 0.0], [0.6, -0.64, 0.48], [-1e-9, 1.0, 0.0], [2.0, 2.0, 1.0]] {
        let axis = Vec3::from(axis).normalize();
        for angle in [0.0, 1e-9, 0.4, 1.4999, 1.5001, 3.0, 4.0, 7.0] {
            let v = axis * angle;
            let found = rotation::turned(&v, &arm);
            let rows = |columns: [Vec3; 3]| DenseMatrix::from_fn(3, 3, |row, column| columns[column][row]);
            let value = |v: &[f64]| (rotation::exp(&Vec3::from_column_slice(v)) * arm).as_slice().to_vec();
            check_jacobian(value, v.as_slice(), &rows(found.first), TOLERANCE).unwrap();
            for k in 0..3 {
                let first =
                    |v: &[f64]| rotation::turned(&Vec3::from_column_slice(v), &arm).first[k].as_slice().to_vec();
                check_jacobian(first, v.as_slice(), &rows(found.second[k]), TOLERANCE).unwrap();
            }
        }
    }
}
