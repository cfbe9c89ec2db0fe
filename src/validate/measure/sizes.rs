//! What the size of a patch costs, against an exact state that is known at every size.

use super::super::findings::{Bench, ExperimentError, Findings, ReportTable};
use super::super::forms::{self, Form};
use super::super::precision::shortest;
use super::super::report::figure;
use super::super::star::{Star, size};
use super::trial::distance;
use foldwell::analysis::relax::{RelaxError, Relaxed};
use foldwell::analysis::state::State;
use foldwell::output::figure::chart::{Chart, Point, Series};
use foldwell::solver::Options;
use serde_json::json;

const CELLS: [usize; 6] = [3, 6, 9, 12, 18, 24];
/// Larger ones where there is time.
const MORE: [usize; 2] = [36, 48];
/// The first of these that growth is fitted to.
const SMALL: usize = 2;
/// How often all sizes are timed, in turns.
const ROUNDS: usize = 5;
/// Up to this size the plain penalty is tried.
const MOST_FOR_PENALTY: usize = 12;
const STIFFNESS: f64 = 1e6;
/// Arc length along which the cell is folded.
const FOLDED: f64 = 0.1;

/// A size that was relaxed.
struct Size {
    cells: usize,
    unknowns: usize,
    iterations: usize,
    error: f64,
    seconds: f64,
    /// Error and seconds of the plain penalty.
    penalty: Option<[f64; 2]>,
}

/// Patches whose creases rest at the angles of an exact cylinder, the reference cell followed over 0.1 rad by the
/// kinematics: relaxed from the drawn state they have to end there. The error is the largest difference of a fold angle. Rigid bars by
/// the program's form, all sizes in turns; bars of 1e6 by a plain penalty, for which this state, free of tension, is as exact.
pub(crate) fn measure(bench: &Bench) -> Result<Findings, ExperimentError> {
    let exact = Star::cylinder(FOLDED)?;
    let cells: Vec<usize> = CELLS.into_iter().chain(MORE.into_iter().filter(|_| !bench.quick)).collect();
    let stars = cells.iter().map(|&n| Star::resting([n, n], &exact)).collect::<Result<Vec<_>, _>>()?;
    let mut times = vec![f64::INFINITY; cells.len()];
    for round in 0..ROUNDS {
        bench.step(round, ROUNDS)?;
        for (star, time) in stars.iter().zip(&mut times) {
            *time = time.min(shortest(1, &mut [Box::new(|| _ = rigid(star))])[0]);
        }
    }
    let measured = stars.iter().zip(&cells).zip(&times).map(|((star, &n), &seconds)| relaxed(star, n, seconds));
    let sizes = measured.collect::<Result<Vec<_>, _>>()?;
    let growth: Vec<(f64, f64)> =
        sizes[SMALL..].iter().map(|s| (s.unknowns as f64, s.seconds / s.iterations as f64)).collect();
    let values = json!({
        "errors": sizes.iter().map(|size| size.error).collect::<Vec<_>>(),
        "iterations": sizes.iter().map(|size| size.iterations).collect::<Vec<_>>(),
        "growth of an iteration": exponent(&growth),
    });
    Ok(Findings { values, charts: vec![chart(&sizes)], tables: vec![table(&sizes)], ..Findings::default() })
}

fn rigid(star: &Star) -> Result<Relaxed, Box<RelaxError>> {
    star.relax(&mut star.model(f64::INFINITY), Options::default())
}

fn relaxed(star: &Star, n: usize, seconds: f64) -> Result<Size, ExperimentError> {
    let found = rigid(star)?;
    let penalty = (n <= MOST_FOR_PENALTY).then(|| {
        let mut angles = Vec::new();
        let seconds = shortest(1, &mut [Box::new(|| angles = by_penalty(star))])[0];
        [distance(&angles, &star.rest), seconds]
    });
    Ok(Size {
        cells: n,
        unknowns: size(&star.model(f64::INFINITY)).0,
        iterations: found.iterations,
        error: distance(&found.state.fold_angle, &star.rest),
        seconds,
        penalty,
    })
}

fn chart(sizes: &[Size]) -> Chart {
    let label = |size: &Size| format!("{0} x {0}", size.cells);
    let point = |s: &Size| Point { x: s.unknowns as f64, y: s.seconds, label: label(s) };
    let penalty = |s: &Size| Some(Point { y: s.penalty?[1], ..point(s) });
    Chart {
        title: "Size of a patch that rolls up to an exact cylinder".into(),
        x: "unknowns".into(),
        y: "seconds".into(),
        series: vec![
            Series { name: "tension form, rigid".into(), points: sizes.iter().map(point).collect() },
            Series {
                name: format!("plain penalty, {STIFFNESS:e}"),
                points: sizes.iter().filter_map(penalty).collect(),
            },
        ],
        ..Chart::default()
    }
}

fn table(sizes: &[Size]) -> ReportTable {
    let row = |s: &Size| {
        let penalty = s.penalty.map_or([String::new(), String::new()], |both| both.map(figure));
        let ours = [s.unknowns.to_string(), s.iterations.to_string(), figure(s.error), figure(s.seconds)];
        [format!("{0} x {0}", s.cells)].into_iter().chain(ours).chain(penalty).collect()
    };
    let names =
        ["cells", "unknowns", "iterations", "error (rad)", "seconds", "error of the penalty (rad)", "its seconds"];
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

/// Exponent `p` of the power law `y ~ x^p` that fits best in logarithms.
pub(crate) fn exponent(points: &[(f64, f64)]) -> f64 {
    let logs: Vec<(f64, f64)> = points.iter().map(|(x, y)| (x.ln(), y.ln())).collect();
    let count = logs.len() as f64;
    let middle = |of: fn(&(f64, f64)) -> f64| logs.iter().map(of).sum::<f64>() / count;
    let (mx, my) = (middle(|p| p.0), middle(|p| p.1));
    let above: f64 = logs.iter().map(|p| (p.0 - mx) * (p.1 - my)).sum();
    above / logs.iter().map(|p| (p.0 - mx) * (p.0 - mx)).sum::<f64>()
}
