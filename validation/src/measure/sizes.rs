//! Run time against the size of a patch, with an exact state that is known at every size.

use super::super::findings::{ExperimentError, Findings, ReportTable};
use super::super::forms::{self, Form};
use super::super::precision::medians;
use super::super::report::figure;
use super::super::star::{Star, size};
use super::trial::distance;
use foldwell::analysis::relax::{Method, RelaxError, RelaxOptions, Relaxed};
use foldwell::analysis::state::State;
use foldwell::output::figure::chart::{DataPoint, LineChart, Series};
use foldwell::solver::Problem;
use foldwell::solver::kkt::KktSystem;
use serde_json::json;

const CELLS: [usize; 6] = [3, 6, 9, 12, 18, 24];
/// Larger sizes, left out by `--quick`.
const MORE: [usize; 2] = [36, 48];
/// Index of the first size to which the growth is fitted.
const SMALL: usize = 2;
/// Number of times that all sizes are timed, by turns.
const ROUNDS: usize = 5;
/// Largest size for which the plain penalty is tried.
const MOST_FOR_PENALTY: usize = 12;
const STIFFNESS: f64 = 1e6;
/// Arc length along which the cell is folded, in radians.
const FOLDED: f64 = 0.1;

/// The methods that are compared: positions of the vertices, and fold angles as unknowns.
const METHODS: [Method; 2] = [Method::Vertices, Method::Intrinsic];

/// A patch that was relaxed by both methods.
struct Size {
    cells: usize,
    unknowns: usize,
    iterations: [usize; 2],
    errors: [f64; 2],
    seconds: [f64; 2],
    /// Count of numbers in the factor of the system in positions.
    stored: usize,
    /// Error and run time in seconds of the plain penalty.
    penalty: Option<[f64; 2]>,
}

/// Relaxes patches whose rest angles are the fold angles of an exact cylinder, the reference cell folded by 0.1 rad by
/// the kinematics. Relaxed from the drawn state they must end at this state; the error is the largest difference of a
/// fold angle. Rigid bars are relaxed by the program, in positions and in fold angles, all sizes by turns; bars of
/// stiffness 1e6 by a plain penalty, for which this state, free of tension, is exact as well.
pub fn measure(quick: bool) -> Result<Findings, ExperimentError> {
    let exact = Star::cylinder(FOLDED)?;
    let cells: Vec<usize> = CELLS.into_iter().chain(MORE.into_iter().filter(|_| !quick)).collect();
    let stars = cells.iter().map(|&n| Star::resting([n, n], &exact)).collect::<Result<Vec<_>, _>>()?;
    let mut work: Vec<Box<dyn FnMut() + '_>> = Vec::new();
    for star in &stars {
        METHODS.into_iter().for_each(|method| work.push(Box::new(move || _ = rigid(star, method))));
    }
    let times = medians(ROUNDS, &mut work);
    let times = times.chunks(METHODS.len()).map(|times| [times[0], times[1]]);
    let measured = stars.iter().zip(&cells).zip(times).map(|((star, &n), seconds)| relaxed(star, n, seconds));
    let sizes = measured.collect::<Result<Vec<_>, _>>()?;
    let growth: Vec<(f64, f64)> = sizes[SMALL..].iter().map(|s| (s.unknowns as f64, s.stored as f64)).collect();
    let values = json!({
        "errors": sizes.iter().flat_map(|size| size.errors).collect::<Vec<_>>(),
        "iterations": sizes.iter().map(|size| size.iterations[0]).collect::<Vec<_>>(),
        "iterations in fold angles": sizes.iter().map(|size| size.iterations[1]).collect::<Vec<_>>(),
        "growth of the factor": exponent(&growth),
    });
    Ok(Findings { values, charts: vec![chart(&sizes)], tables: vec![table(&sizes)], ..Findings::default() })
}

fn rigid(star: &Star, method: Method) -> Result<Relaxed, Box<RelaxError>> {
    star.relax(&star.model(f64::INFINITY), RelaxOptions { method, ..RelaxOptions::default() })
}

fn relaxed(star: &Star, n: usize, seconds: [f64; 2]) -> Result<Size, ExperimentError> {
    let [vertices, angles] = METHODS.map(|method| rigid(star, method));
    let found = [vertices?, angles?];
    let penalty = (n <= MOST_FOR_PENALTY).then(|| {
        let mut angles = Vec::new();
        let seconds = medians(1, &mut [Box::new(|| angles = by_penalty(star))])[0];
        [distance(&angles, &star.rest), seconds]
    });
    let model = star.model(f64::INFINITY);
    let too_large = |_| ExperimentError::Other("a pattern is too large".into());
    Ok(Size {
        cells: n,
        unknowns: size(&model).0,
        stored: KktSystem::new(model.layout()).map_err(too_large)?.stored(),
        iterations: found.each_ref().map(|found| found.iterations),
        errors: found.each_ref().map(|found| distance(&found.state.fold_angle, &star.rest)),
        seconds,
        penalty,
    })
}

fn chart(sizes: &[Size]) -> LineChart {
    let label = |size: &Size| format!("{0} x {0}", size.cells);
    let point = |s: &Size, y: f64| DataPoint { x: s.unknowns as f64, y, label: label(s) };
    let by = |method: usize| sizes.iter().map(|s| point(s, s.seconds[method])).collect();
    let penalty = |s: &Size| Some(point(s, s.penalty?[1]));
    LineChart {
        title: "Size of a patch that rolls up to an exact cylinder".into(),
        x: "unknowns".into(),
        y: "seconds".into(),
        series: vec![
            Series { name: "tension form, rigid, positions".into(), points: by(0) },
            Series { name: "tension form, rigid, fold angles".into(), points: by(1) },
            Series {
                name: format!("plain penalty, {STIFFNESS:e}"),
                points: sizes.iter().filter_map(penalty).collect(),
            },
        ],
        ..LineChart::default()
    }
}

fn table(sizes: &[Size]) -> ReportTable {
    let row = |s: &Size| {
        let penalty = s.penalty.map_or([String::new(), String::new()], |both| both.map(figure));
        let by =
            |method: usize| [s.iterations[method].to_string(), figure(s.errors[method]), figure(s.seconds[method])];
        let first = [format!("{0} x {0}", s.cells), s.unknowns.to_string()];
        first.into_iter().chain(by(0)).chain(by(1)).chain(penalty).collect()
    };
    let names = [
        "cells",
        "unknowns",
        "iterations",
        "error (rad)",
        "seconds",
        "iterations in fold angles",
        "their error (rad)",
        "their seconds",
        "error of the penalty (rad)",
        "its seconds",
    ];
    ReportTable {
        title: "Size of a patch that rolls up to an exact cylinder, rigid bars".into(),
        header: names.map(str::to_owned).to_vec(),
        rows: sizes.iter().map(row).collect(),
    }
}

fn by_penalty(star: &Star) -> Vec<f64> {
    let mut model = star.model(STIFFNESS);
    let found = forms::minimize(&mut model, Form::Penalty);
    found.map_or(vec![], |found| State::new(&model, &found.x, &found.tension).fold_angle)
}

/// Returns the exponent `p` of the power law `y ~ x^p` that fits best in logarithms.
pub fn exponent(points: &[(f64, f64)]) -> f64 {
    let logs: Vec<(f64, f64)> = points.iter().map(|(x, y)| (x.ln(), y.ln())).collect();
    let count = logs.len() as f64;
    let middle = |of: fn(&(f64, f64)) -> f64| logs.iter().map(of).sum::<f64>() / count;
    let (mx, my) = (middle(|p| p.0), middle(|p| p.1));
    let above: f64 = logs.iter().map(|p| (p.0 - mx) * (p.1 - my)).sum();
    above / logs.iter().map(|p| (p.0 - mx) * (p.0 - mx)).sum::<f64>()
}
