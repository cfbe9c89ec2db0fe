//! Exact folding, against relaxations along the same trajectories, surfaces that contain them, and landscapes.

use crate::common::{Numbers, Testing, on};
use crate::report::Report;
use crate::trial::Trial;
use foldwell::analysis::along::{cylinder_errors, relax_along};
use foldwell::analysis::landscape::fit::{agrees, coefficient};
use foldwell::analysis::landscape::samples::landscape;
use foldwell::analysis::landscape::{Expansion, HeldSheet};
use foldwell::analysis::surface::{FoldedSurface, SurfaceOptions, surface};
use foldwell::analysis::trace::{Stop, TraceOptions, Traced, trace};
use foldwell::model::{Assembly, Boundary, Terms};
use foldwell::sheet::EdgeKind;
use foldwell::solver::Options;
use foldwell::solver::atlas::Coverage;
use foldwell::solver::continuation::End;
use std::f64::consts::TAU;

/// How far trajectories are followed.
const LENGTH: f64 = 0.6;
const CURVATURE: f64 = 0.2;
/// Trajectories of a cell beside which relaxations go; a flat cell has dozens.
const RAYS: usize = 4;
/// Radius of charts of surfaces.
const RADIUS: f64 = 0.1;
/// Angles, in radians, to which a relaxation that converged is known.
const CERTAIN: f64 = 1e-7;

/// The rigid cell, periodic up to screws, with one crease that keeps its angle.
pub fn examine(seed: u64, report: &mut Report) {
    let trial = Trial::new(seed);
    let what = format!("seed {seed}, {}, folded", trial.sheet.title);
    let case = on(trial.sheet.clone(), [1, 1], Boundary::Screw);
    let creases: Vec<usize> = (0..case.edges()).filter(|&k| case.tiling().edges[k].kind == EdgeKind::Crease).collect();
    let locked = creases[seed as usize % creases.len()];
    let terms = Terms {
        facets: case.facets(f64::INFINITY).filter(|_| case.count(EdgeKind::Facet) > 0),
        locks: vec![(locked, case.drawn_angles()[locked])],
        ..Terms::bars_and_creases(f64::INFINITY, 1.0, case.drawn_angles().to_vec())
    };
    let cell = case.with_terms(terms);
    let stop = Stop { arc_length: Some(LENGTH), curvature: Some(CURVATURE), ..Stop::default() };
    let options = TraceOptions { max_step: 0.1, tolerance: 3e-14, branch: None, stop };
    match trace(&cell, &options, None, &mut |_, _| true) {
        Ok(traced) => {
            traced.iter().take(RAYS).for_each(|traced| driven(&cell, traced, report, &what));
            covered(&cell, &traced, report, &what);
        }
        Err(error) => report.unanswered("trajectories", &error.to_string()),
    }
    costs(&trial, seed, report, &what);
}

/// Relaxations follow the trajectory to its end, with cylinders as near to its own as relaxations know them.
fn driven(cell: &Assembly, traced: &Traced, report: &mut Report, what: &str) {
    if traced.end == End::Failed || traced.states.len() < 2 {
        return report.unanswered("driven", "the trajectory fails");
    }
    let found = relax_along(cell, Options::default(), traced, &mut |_| true);
    let closed = usize::from(matches!(traced.end, End::Closed(_)));
    let what = || format!("{what}, ray {:?}", traced.branch);
    if let Some(failure) = &found.failure {
        return report.unanswered("driven", &failure.to_string());
    }
    report.judge("driven", found.states.len() + 1 + closed == traced.states.len(), || format!("{}: states", what()));
    let error = found.error();
    report.judge("driven angles", error.is_some_and(|error| error <= CERTAIN), || format!("{}: {error:?}", what()));
    let cylinders = cylinder_errors(cell.drawn(), traced, &found);
    let ok = cylinders.is_some_and(|e| [e.curvature, e.strain, e.theta].iter().all(|error| *error <= CERTAIN));
    report.judge("driven cylinders", ok, || format!("{}: {cylinders:?}", what()));
}

/// Every state of a trajectory lies on the surface of the cell without the lock.
fn covered(cell: &Assembly, traced: &[Traced], report: &mut Report, what: &str) {
    let free = cell.with_terms(Terms { locks: vec![], ..cell.terms().clone() });
    let options = SurfaceOptions { radius: RADIUS, tolerance: 3e-14, max_curvature: CURVATURE, max_points: 5_000 };
    let surface = match surface(&free, &options, &mut |count| count < 5_000) {
        Ok(found) => found,
        Err(error) => return report.unanswered("surface", &error.to_string()),
    };
    let away = traced.iter().any(|traced| traced.states.len() > 1);
    report.judge("surface where there is a trajectory", !(away && surface.negative.is_some()), || what.to_owned());
    if surface.negative.is_some() || surface.coverage != Coverage::Complete {
        return report.unanswered("trajectory on the surface", "the surface is not covered");
    }
    for traced in traced.iter().filter(|traced| traced.end != End::Failed) {
        for state in
            traced.states.iter().filter(|state| state.shape.as_ref().is_some_and(|s| s.curvature.abs() < CURVATURE))
        {
            let apart = nearest(&surface, &state.angles);
            report.judge("trajectory on the surface", apart <= 1.2 * surface.radius, || {
                format!("{what}, ray {:?} at {}: {apart} from the surface", traced.branch, state.arc_length)
            });
        }
    }
}

/// Distance of fold angles to the nearest state of a surface, whole turns taken off.
fn nearest(surface: &FoldedSurface, angles: &[f64]) -> f64 {
    let turned = |a: &f64, b: &f64| a - b - TAU * ((a - b) / TAU).round();
    let square = |other: &[f64]| angles.iter().zip(other).map(|(a, b)| turned(a, b).powi(2)).sum::<f64>();
    surface.points.iter().map(|point| square(&point.angles)).fold(f64::INFINITY, f64::min).sqrt()
}

/// A patch bent along a mode costs what the expansion says.
fn costs(trial: &Trial, seed: u64, report: &mut Report, what: &str) {
    let case = on(trial.sheet.clone(), [3, 3], Boundary::Patch);
    let terms = Terms {
        facets: case.facets(trial.facets).filter(|_| case.count(EdgeKind::Facet) > 0),
        ..Terms::bars_and_creases(trial.bars, 1.0, case.drawn_angles().to_vec())
    };
    let held = match HeldSheet::patch(&case.with_terms(terms)) {
        Ok(held) => held,
        Err(error) => return report.unanswered("landscape", &error.to_string()),
    };
    let mut numbers = Numbers::new(seed);
    let mode = [0; 3].map(|_| numbers.within(1.0));
    let found = held.named(mode);
    let found = found.and_then(|rates| landscape(&held, rates, &[2e-3, 3e-3, 5e-3, 8e-3], &mut |_| true));
    let found = match found {
        Ok(found) => found,
        Err(error) => return report.unanswered("landscape", &error.to_string()),
    };
    let known: Vec<(f64, f64)> = found
        .samples
        .iter()
        .filter(|sample| !sample.below_rounding())
        .map(|sample| (sample.amplitude, sample.relaxed.state.total()))
        .collect();
    if let Some(failure) = &found.failure {
        return report.unanswered("landscape", &failure.to_string());
    }
    let fitted = coefficient(&known).filter(|_| known.len() >= 3);
    let Some(fitted) = fitted else { return report.unanswered("landscape", "too few samples above rounding") };
    let (least, Expansion { fourth, fifth, sixth }) = (known[0].0, found.predicted);
    if !(fifth.abs() * least + sixth.abs() * least * least <= fourth.abs()) {
        return report.unanswered("landscape", "amplitudes beyond the reach of the series");
    }
    report.judge("landscape", agrees(&known, fitted, found.predicted), || {
        format!("{what} {mode:?}: {fitted:?} and {:?}", found.predicted)
    });
}
