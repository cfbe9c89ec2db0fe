//! Energies over the sphere of folding modes, and their zeros.

use crate::common::patch;
use approx::assert_abs_diff_eq;
use foldwell::analysis::landscape::cone::{Cone, distance};
use foldwell::analysis::landscape::sphere::{Direction, SphereNet, curvature, point, samples};
use foldwell::analysis::landscape::{Expansion, HeldSheet, HeldState, Samples, TaylorPaths};
use foldwell::math::Vec3;
use foldwell::model::{Assembly, Terms};
use foldwell::numerics::parallel::Threads;
use std::f64::consts::{FRAC_PI_4, PI, TAU};

fn terms(case: &Assembly) -> Terms {
    Terms::bars_and_creases(f64::INFINITY, 1.0, case.drawn_angles().to_vec())
}

fn held(case: &Assembly) -> HeldSheet {
    HeldSheet::patch(&case.with_terms(terms(case))).unwrap()
}

/// Claim: the net covers the sphere once (area 4 pi within its coarseness, Euler characteristic 2), its 45-degree rings
/// are tensors of rank one, and points and tensors are converted into each other. Tolerances: rounding errors; 3% of
/// the area for 6 rings.
#[test]
fn the_net_is_a_sphere() {
    let net = SphereNet::new(6);
    let points: Vec<Vec3> = net.directions.iter().map(Direction::point).collect();
    let volume = |t: &[usize; 3]| points[t[0]].dot(&points[t[1]].cross(&points[t[2]])) / 6.0;
    assert!(net.triangles.iter().all(|t| volume(t) > 0.0));
    let filled = net.triangles.iter().map(volume).sum::<f64>() / (4.0 * PI / 3.0);
    assert!((filled - 1.0).abs() <= 0.03, "{filled}");
    assert_eq!(points.len() + net.triangles.len(), 2 + 3 * net.triangles.len() / 2);
    for direction in &net.directions {
        let tensor = curvature(&direction.point());
        assert!((point(tensor) - direction.point()).norm() <= 1e-15);
        assert!((Direction::of(&direction.point()).point() - direction.point()).norm() <= 1e-15);
        if (direction.polar - FRAC_PI_4).abs() <= 1e-12 {
            assert_abs_diff_eq!(tensor[0] * tensor[1], tensor[2] * tensor[2], epsilon = 1e-15);
        }
    }
}

/// Claim: the energy vanishes at the cylinders of the exact kinematics, also at finite amplitude, where the linear cone
/// differs from them to the order of the amplitude. Two nappes, eight azimuths, patches of 4 x 4 cells. Tolerance 1e-6
/// (required); the linear cone differs by more than a hundred times that.
#[test]
fn energy_vanishes_on_the_exact_cone() {
    let case = patch("open-star", [4, 4]);
    let held = held(&case);
    let courses = TaylorPaths::new(&held).unwrap();
    let modes = held.bending.clone().unwrap();
    let cone = Cone::new(case.sheet(), &modes, &[]).unwrap();
    for amplitude in [0.005, 0.02] {
        let (mut largest, mut linear) = (0.0f64, 0.0f64);
        for (nappe, k) in [1, -1].into_iter().flat_map(|nappe| (0..8).map(move |k| (nappe, k))) {
            let exact = cone.point(f64::from(k) * TAU / 8.0, nappe, amplitude).unwrap();
            let straight = Direction { polar: FRAC_PI_4, ..Direction::of(&(exact * f64::from(nappe))) };
            linear = linear.max((straight.point() * f64::from(nappe) - exact).norm());
            largest = largest.max(distance(&held, &courses, &exact, amplitude).unwrap());
        }
        println!("amplitude {amplitude}: exact cone off by {largest:.1e}, linear one by {linear:.1e}");
        assert!(largest <= 1e-6 && linear >= 1e-4, "{largest:e} {linear:e}");
    }
}

/// Claim: the path along any mode, combined from those along ten modes, is that computed along the mode itself, order
/// by order; and the relaxed sheet differs from it to the fourth power of the amplitude. Tolerances: 1e-9, rounding
/// errors of the linear solves; 0.2 on the power, by the fifth.
#[test]
fn courses_are_forms_of_the_mode() {
    let case = patch("open-star", [4, 4]);
    let mut sheet = held(&case);
    let courses = TaylorPaths::new(&sheet).unwrap();
    for tensor in [[0.8, -0.3, 0.4], [-0.1, 0.9, -0.7]] {
        let rates = sheet.named(tensor).unwrap();
        let (_, straight) = Expansion::with_course(&sheet, &rates).unwrap();
        let formed = courses.along(&sheet, &rates);
        for (a, b) in straight.orders.iter().zip(&formed.orders) {
            let near = |a: &[f64], b: &[f64]| {
                let off = a.iter().zip(b).fold(0.0f64, |most, (a, b)| most.max((a - b).abs()));
                off <= 1e-9 * a.iter().fold(0.0, |most, v| v.abs().max(most))
            };
            assert!(near(&a.x, &b.x) && near(&a.tension, &b.tension) && near(a.rest.as_slice(), b.rest.as_slice()));
        }
        let mut off = |amplitude: f64| {
            let mut place = HeldState { x: sheet.drawn(), ..sheet.still() };
            formed.advance(&mut place, 0.0, amplitude);
            let sample = Samples::new(&sheet, formed.clone()).at(amplitude, &mut |_| true).unwrap();
            let x = sheet.model.unknowns(&sample.relaxed.state.coordinates);
            let change = x.iter().zip(&place.x).map(|(a, b)| (a - b).powi(2));
            change.sum::<f64>().sqrt()
        };
        let slope = (off(4e-3) / off(2e-3)).log2();
        assert!((slope - 4.0).abs() <= 0.2, "{slope}");
    }
}

/// Claim: samples over the sphere are bitwise the same for one thread and for two; near zero amplitude they agree with
/// the prediction; and starts of third order need at most half the Newton steps of starts from the drawn sheet.
/// Tolerance 1%: the next orders at this amplitude.
#[test]
fn samples_do_not_know_each_other() {
    let case = patch("open-star", [6, 6]);
    let sheet = held(&case);
    let courses = TaylorPaths::new(&sheet).unwrap();
    let net = SphereNet::new(2);
    let points: Vec<Vec3> = net.directions.iter().map(Direction::point).collect();
    let amplitude = 5e-4;
    let run = |threads: usize| -> Vec<(f64, usize)> {
        let found = Threads::new(Some(threads)).install(|| samples(&sheet, &courses, &points, amplitude, &|| true));
        found.into_iter().map(|s| s.unwrap().unwrap()).map(|s| (s.relaxed.state.total(), s.iterations)).collect()
    };
    let (one, two) = (run(1), run(2));
    assert!(one.iter().zip(&two).all(|(a, b)| a.0.to_bits() == b.0.to_bits() && a.1 == b.1));
    let mut cold = 0;
    for (at, (energy, _)) in points.iter().zip(&one) {
        let sheet = held(&case);
        let rates = sheet.named(curvature(at)).unwrap();
        let expected = Expansion::with_course(&sheet, &rates).unwrap().0.fourth * amplitude.powi(4);
        assert!((energy - expected).abs() <= 0.01 * expected.max(1e-10), "{energy:e} {expected:e}");
        let mut course = courses.along(&sheet, &rates);
        course.orders.fill(sheet.still());
        cold += Samples::new(&sheet, course).at(amplitude, &mut |_| true).unwrap().iterations;
    }
    let warm: usize = one.iter().map(|(_, iterations)| iterations).sum();
    println!("{} samples: {warm} Newton steps from third order, {cold} from the drawn sheet", points.len());
    assert!(2 * warm <= cold, "{warm} {cold}");
}
