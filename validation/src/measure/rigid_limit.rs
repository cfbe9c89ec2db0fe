//! The rigid limit: distance and energy of a sheet with stiff bars relative to the rigid sheet, compared with the
//! prediction to first order in `1/k`.
//!
//! Let `t` be the tensions of the rigid state, `H` its Hessian, `R` the Jacobian of its lengths and `c/k` their
//! compliances. To first order in `1/k` the state moves by `dx / k`, where `H dx + R^T dt = 0` and `R dx = c t`, and
//! its energy falls by `sum(c t^2) / 2k`, which is also the energy of the bars. The prediction takes one linear solve
//! at the rigid state, and contains no stiffness.

use super::super::findings::{ExperimentError, Findings, ReportTable};
use super::super::report::figure;
use super::super::star::Star;
use super::trial::distance;
use foldwell::analysis::relax::relax_from;
use foldwell::model::{Configuration, Model};
use foldwell::output::figure::chart::{DataPoint, LineChart, Series};
use foldwell::solver::{HessianKind, Options, Problem, Tangent};
use serde_json::json;
use std::ops::RangeInclusive;

const CELLS: [usize; 3] = [6, 12, 24];
/// Additional size, left out by `--quick`.
const MORE: usize = 48;
/// Decades of the stiffness.
const DECADES: RangeInclusive<i32> = 2..=16;
/// Stiffness from which on each sheet is relaxed from the drawn state: the rigid state and the state of the next
/// stiffness are then solutions within the tolerance, and a start from them would test nothing.
const STIFFNESS_STARTED_AS_DRAWN: f64 = 1e9;
/// Largest difference of a rest angle from the drawn angle, in radians.
const OFF: f64 = 0.1;
/// Relative deviation from the prediction up to which it counts as met.
const LAW_TOLERANCE: f64 = 0.01;
/// Largest stiffness at which the decrease of the total energy is well above its rounding error.
const ENERGY_SEEN: f64 = 1e10;

/// The prediction to first order in `1/k`.
struct Law {
    /// Stiffness times the largest change of a fold angle.
    distance: f64,
    /// Stiffness times the decrease of the energy.
    energy: f64,
}

/// The state at a finite stiffness; all numbers but the stiffness are relative to their predictions.
struct Reached {
    stiffness: f64,
    distance: f64,
    /// Decrease of the energy from that of the rigid state.
    fall: f64,
    /// Energy of the bars.
    bars: f64,
}

/// A patch at all stiffnesses.
struct Size {
    cells: usize,
    law: Law,
    reached: Vec<Reached>,
}

/// Relaxes patches of the reference cell, whose rest angles are within 0.1 rad of the drawn angles and differ from cell
/// to cell, at stiffnesses from infinity down to 100. Below [`STIFFNESS_STARTED_AS_DRAWN`] each state starts from the
/// one before, so that it is the same minimum.
pub fn measure(quick: bool) -> Result<Findings, ExperimentError> {
    let cells: Vec<usize> = CELLS.into_iter().chain((!quick).then_some(MORE)).collect();
    let mut sizes = Vec::new();
    for &n in &cells {
        sizes.push(size(n)?);
    }
    let all = |of: fn(&Reached) -> f64, within: [f64; 2]| -> Vec<f64> {
        let reached = sizes.iter().flat_map(|size| &size.reached);
        reached.filter(|r| (within[0]..=within[1]).contains(&r.stiffness)).map(|r| (of(r) - 1.0).abs()).collect()
    };
    let values = json!({
        "distance off law": all(|r| r.distance, [STIFFNESS_STARTED_AS_DRAWN, 1e14]),
        "distance off law at 1e16": all(|r| r.distance, [1e16, 1e16]),
        "fall of energy off law": all(|r| r.fall, [STIFFNESS_STARTED_AS_DRAWN, ENERGY_SEEN]),
        "energy of bars off law": all(|r| r.bars, [STIFFNESS_STARTED_AS_DRAWN, 1e16]),
    });
    let tables = vec![laws(&sizes), distances(&sizes)];
    Ok(Findings { values, tables, charts: vec![chart(&sizes)], ..Findings::default() })
}

fn size(n: usize) -> Result<Size, ExperimentError> {
    let star = Star::new([n, n], OFF)?;
    let mut model = star.model(f64::INFINITY);
    let rigid = star.relax(&model, Options::default())?;
    let law = law(&mut model, &star.model(1.0), &rigid.configuration)?;
    let (mut reached, mut last) = (Vec::new(), rigid.configuration.without_tension());
    for stiffness in DECADES.rev().map(|decade| 10f64.powi(decade)) {
        let mut model = star.model(stiffness);
        let start = if stiffness >= STIFFNESS_STARTED_AS_DRAWN { model.start().into() } else { model.enter(&last) };
        let found = relax_from(&model, start, Options::default(), &mut |_| true)?;
        reached.push(Reached {
            stiffness,
            distance: stiffness * distance(&found.state.fold_angle, &rigid.state.fold_angle) / law.distance,
            fall: stiffness * (rigid.state.total() - found.state.total()) / law.energy,
            bars: stiffness * found.state.energy_bars / law.energy,
        });
        last = found.configuration;
    }
    Ok(Size { cells: n, law, reached })
}

/// Computes the prediction. `unit` is the model with stiffness 1, for the compliances of the bars.
fn law(model: &mut Model, unit: &Model, rigid: &Configuration) -> Result<Law, ExperimentError> {
    let failed = |_| ExperimentError::Other("the rigid state has no inverse".into());
    let (x, tension) = (model.enter(rigid).x, rigid.tensions());
    let mut tangent = Tangent::at_state(model, &x, tension, HessianKind::Full).map_err(failed)?;
    tangent.factor(0.0).map_err(failed)?;
    let stretch: Vec<f64> = unit.compliance().iter().zip(tension).map(|(c, t)| c * t).collect();
    let step = tangent.solve(&vec![0.0; x.len()], &stretch, 1e-12);
    Ok(Law {
        distance: tangent.at.largest_measure_change(&step.dx),
        energy: stretch.iter().zip(tension).map(|(s, t)| 0.5 * s * t).sum(),
    })
}

/// Returns the least stiffness such that from there up to [`ENERGY_SEEN`] a number stays within [`LAW_TOLERANCE`] of
/// its prediction.
fn sets_in(reached: &[Reached], of: fn(&Reached) -> f64) -> f64 {
    let seen = reached.iter().skip_while(|r| r.stiffness > ENERGY_SEEN);
    let met = seen.take_while(|r| (of(r) - 1.0).abs() <= LAW_TOLERANCE);
    met.last().map_or(f64::NAN, |last| last.stiffness)
}

fn laws(sizes: &[Size]) -> ReportTable {
    let row = |size: &Size| {
        let Law { distance, energy } = size.law;
        let ways: [fn(&Reached) -> f64; 3] = [|r| r.distance, |r| r.fall, |r| r.bars];
        let from = ways.map(|of| sets_in(&size.reached, of));
        let numbers = [distance, from[0], energy, from[1], from[2]];
        [format!("{0} x {0}", size.cells)].into_iter().chain(numbers.map(figure)).collect()
    };
    let names = [
        "cells",
        "distance times k (rad)",
        "met to 1% from k =",
        "fall of energy times k",
        "met to 1% from k =",
        "bars' energy met from k =",
    ];
    ReportTable {
        title: "First order in 1/k, from one linear solve at the rigid state, and from where on it is met".into(),
        header: names.map(str::to_owned).to_vec(),
        rows: sizes.iter().map(row).collect(),
    }
}

fn distances(sizes: &[Size]) -> ReportTable {
    let number = |size: &Size, k: usize| {
        let Reached { distance, fall, bars, stiffness } = &size.reached[k];
        let fall = if *stiffness <= ENERGY_SEEN { format!("{fall:.4}") } else { "-".into() };
        format!("{distance:.4}, {fall}, {bars:.4}")
    };
    let row = |k: usize| {
        let stiffness = format!("{:e}", sizes[0].reached[k].stiffness);
        [stiffness].into_iter().chain(sizes.iter().map(|size| number(size, k))).collect()
    };
    let cells = sizes.iter().map(|size| format!("{0} x {0}", size.cells));
    ReportTable {
        title: "Distance, fall of energy and energy of the bars over what first order says".into(),
        header: ["k".to_owned()].into_iter().chain(cells).collect(),
        rows: (0..sizes.first().map_or(0, |size| size.reached.len())).map(row).collect(),
    }
}

fn chart(sizes: &[Size]) -> LineChart {
    let series = |size: &Size| {
        let point = |r: &Reached| DataPoint {
            x: r.stiffness,
            y: r.distance * size.law.distance / r.stiffness,
            label: String::new(),
        };
        Series { name: format!("{0} x {0} cells", size.cells), points: size.reached.iter().map(point).collect() }
    };
    LineChart {
        title: "Largest difference of a fold angle to the rigid sheet".into(),
        x: "stiffness of the bars".into(),
        y: "distance (rad)".into(),
        series: sizes.iter().map(series).collect(),
        ..LineChart::default()
    }
}
