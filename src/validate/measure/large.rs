//! Large patches: time, memory and iterations from 5,000 to 300,000 unknowns.

use super::super::experiment::{Bench, ExperimentError, Findings, Grid};
use super::super::report::figure;
use super::super::star::{Star, size};
use super::memory;
use super::sizes::exponent;
use foldwell::numerics::larger;
use foldwell::output::figure::chart::{Chart, Point, Series};
use foldwell::solver::Options;
use serde_json::json;
use std::time::Instant;

const CELLS: [usize; 5] = [21, 36, 60, 100, 158];
const OFF: f64 = 0.02;
const TOLERANCE: f64 = 1e-10;

/// A size that was relaxed.
struct Size {
    cells: usize,
    unknowns: usize,
    iterations: usize,
    factorizations: usize,
    residual: f64,
    seconds: f64,
    /// Most memory so far, in MB; NaN where the system does not tell.
    memory: f64,
}

/// Relaxes patches of rigid cells to 1e-10, rest angles at random within 0.02 rad for each hinge, the smallest first, so that the most
/// memory so far is that of the last one.
pub fn measure(bench: &Bench) -> Result<Findings, ExperimentError> {
    let mut sizes = Vec::new();
    memory::forget();
    for (step, cells) in CELLS.into_iter().enumerate() {
        bench.step(step, CELLS.len())?;
        let star = Star::new([cells, cells], OFF)?;
        let mut model = star.model(f64::INFINITY);
        let clock = Instant::now();
        let found = star.relax(&mut model, Options { tolerance: TOLERANCE, ..Options::default() })?;
        sizes.push(Size {
            cells,
            unknowns: size(&model).0,
            iterations: found.iterations,
            factorizations: found.factorizations,
            residual: larger(found.residual_force, found.residual_length),
            seconds: clock.elapsed().as_secs_f64(),
            memory: memory::most().unwrap_or(f64::NAN),
        });
    }
    let growth =
        |of: fn(&Size) -> f64| exponent(&sizes.iter().map(|size| (size.unknowns as f64, of(size))).collect::<Vec<_>>());
    let values = json!({
        "residuals": sizes.iter().map(|size| size.residual).collect::<Vec<_>>(),
        "growth of time": growth(|size| size.seconds),
        "growth of memory": growth(|size| size.memory),
        "growth of iterations": growth(|size| size.iterations as f64),
        "seconds": sizes[sizes.len() - 1].seconds,
        "memory": sizes[sizes.len() - 1].memory,
    });
    Ok(Findings { values, charts: vec![chart(&sizes)], tables: vec![table(&sizes)], ..Findings::default() })
}

fn chart(sizes: &[Size]) -> Chart {
    let point = |s: &Size| Point { x: s.unknowns as f64, y: s.seconds, label: format!("{0} x {0}", s.cells) };
    Chart {
        title: "Large patches of rigid cells, relaxed to 1e-10".into(),
        x: "unknowns".into(),
        y: "seconds".into(),
        series: vec![Series { name: "tension form, rigid".into(), points: sizes.iter().map(point).collect() }],
        ..Chart::default()
    }
}

fn table(sizes: &[Size]) -> Grid {
    let row = |s: &Size| {
        let counts = [s.unknowns, s.iterations, s.factorizations].map(|count| count.to_string());
        let numbers = [s.residual, s.seconds, s.memory].map(figure);
        [format!("{0} x {0}", s.cells)].into_iter().chain(counts).chain(numbers).collect()
    };
    let names = ["cells", "unknowns", "iterations", "factorizations", "residual", "seconds", "most memory so far (MB)"];
    Grid {
        title: "Large patches of rigid cells, relaxed to 1e-10".into(),
        header: names.map(str::to_owned).to_vec(),
        rows: sizes.iter().map(row).collect(),
    }
}
