//! Energies over the sphere of folding modes, and where they vanish.
#![allow(clippy::unwrap_used)] // in helpers of tests as in tests

mod common;

use common::Case;
use foldwell::analysis::landscape::cone::{Cone, distance};
use foldwell::analysis::landscape::sphere::{Direction, Net, curvature, point, samples};
use foldwell::analysis::landscape::{Course, HeldSheet, Prediction, Samples};
use foldwell::math::Vec3;
use foldwell::model::assemble::Recipe;
use foldwell::numerics::parallel;
use std::f64::consts::{FRAC_PI_4, PI, TAU};

fn recipe(case: &Case) -> Recipe {
    case.recipe(f64::INFINITY, 1.0, case.angles.clone())
}

fn held(case: &Case) -> HeldSheet {
    HeldSheet::patch(&case.sheet, &case.tiling, &recipe(case), &case.angles).unwrap()
}

/// Claim: the net covers the sphere once (area 4 pi but for its coarseness, Euler characteristic 2), its 45-degree rings are tensors of rank
/// one, and points and tensors name each other. Tolerances: rounding; 3% of the area for 6 rings.
#[test]
fn the_net_is_a_sphere() {
    let net = Net::new(6);
    let points: Vec<Vec3> = net.directions.iter().map(Direction::point).collect();
    let volume = |t: &[usize; 3]| points[t[0]].dot(&points[t[1]].cross(&points[t[2]])) / 6.0;
    assert!(net.triangles.iter().all(|t| volume(t) > 0.0));
    let filled = net.triangles.iter().map(volume).sum::<f64>() / (4.0 * PI / 3.0);
    assert!((filled - 1.0).abs() <= 0.03, "{filled}");
    assert_eq!(points.len() + net.triangles.len(), 2 + 3 * net.triangles.len() / 2);
    for direction in &net.directions {
        let tensor = direction.curvature();
        assert!((point(tensor) - direction.point()).norm() <= 1e-15);
        assert!((Direction::of(&direction.point()).point() - direction.point()).norm() <= 1e-15);
        if (direction.polar - FRAC_PI_4).abs() <= 1e-12 {
            assert!((tensor[0] * tensor[1] - tensor[2] * tensor[2]).abs() <= 1e-15);
        }
    }
}

/// Claim: the energy vanishes where the exact kinematics has its cylinders, at finite amplitude too, where the linear cone is off by the
/// order of the amplitude. Two nappes, eight azimuths, patches of 4 x 4 cells. Tolerance 1e-6 (asked for); the linear cone is off
/// by more than a hundred times that.
#[test]
fn energy_vanishes_on_the_exact_cone() {
    let case = Case::patch("open-star", [4, 4]);
    let mut held = held(&case);
    let prediction = Prediction::new(&held).unwrap();
    let modes = held.bending.clone().unwrap();
    let cone = Cone::new(&case.sheet, &modes, &[]).unwrap();
    for amplitude in [0.005, 0.02] {
        let (mut largest, mut linear) = (0.0f64, 0.0f64);
        for (nappe, k) in [1, -1].into_iter().flat_map(|nappe| (0..8).map(move |k| (nappe, k))) {
            let exact = cone.point(f64::from(k) * TAU / 8.0, nappe, amplitude).unwrap();
            let straight = Direction { polar: FRAC_PI_4, ..Direction::of(&(exact * f64::from(nappe))) };
            linear = linear.max((straight.point() * f64::from(nappe) - exact).norm());
            largest = largest.max(distance(&mut held, &prediction, &exact, amplitude).unwrap());
        }
        println!("amplitude {amplitude}: exact cone off by {largest:.1e}, linear one by {linear:.1e}");
        assert!(largest <= 1e-6 && linear >= 1e-4, "{largest:e} {linear:e}");
    }
}

/// Claim: samples over the sphere are the same bits for one thread and for two; near zero amplitude they are what the prediction says; and
/// starting from second order halves the Newton steps, at least, against starting from the drawn sheet.
/// Tolerance 1%: the next orders at this amplitude.
#[test]
fn samples_do_not_know_each_other() {
    let case = Case::patch("open-star", [6, 6]);
    let prediction = Prediction::new(&held(&case)).unwrap();
    let net = Net::new(2);
    let points: Vec<Vec3> = net.directions.iter().map(Direction::point).collect();
    let amplitude = 5e-4;
    let run = |threads: usize| -> Vec<(f64, usize)> {
        parallel::set_threads(threads);
        let make = || HeldSheet::patch(&case.sheet, &case.tiling, &recipe(&case), &case.angles);
        let found = samples(&make, &prediction, &points, amplitude, &|| true);
        found.into_iter().map(|s| s.unwrap().unwrap()).map(|s| (s.relaxed.state.total(), s.iterations)).collect()
    };
    let (one, two) = (run(1), run(2));
    assert!(one.iter().zip(&two).all(|(a, b)| a.0.to_bits() == b.0.to_bits() && a.1 == b.1));
    let mut cold = 0;
    for (at, (energy, _)) in points.iter().zip(&one) {
        let mut sheet = held(&case);
        let rates = sheet.named(curvature(at)).unwrap();
        let expected = prediction.coefficient(&rates) * amplitude.powi(4);
        assert!((energy - expected).abs() <= 0.01 * expected.max(1e-10), "{energy:e} {expected:e}");
        let warm = prediction.course(&sheet, &rates);
        let still = |list: &[f64]| vec![0.0; list.len()];
        let course = Course {
            first: still(&warm.first),
            second: still(&warm.second),
            tension: still(&warm.tension),
            rest: &warm.rest * 0.0,
            rates,
        };
        cold += Samples::new(&mut sheet, course).at(amplitude, &mut |_| true).unwrap().iterations;
    }
    let warm: usize = one.iter().map(|(_, iterations)| iterations).sum();
    println!("{} samples: {warm} Newton steps from second order, {cold} from the drawn sheet", points.len());
    assert!(2 * warm <= cold, "{warm} {cold}");
}
