//! Large patches: time, memory and iterations from 5,000 to 300,000 unknowns, and the exponents of their growth.
//!
//! Patches of rigid cells, whose rest angles differ from the drawn angles by random numbers of at most 0.1 rad, are
//! relaxed to 1e-10. The smallest comes first, so that the peak memory is that of the last patch. With nested
//! dissection of a sheet the time of the factorization grows with the exponent 1.5, its number of entries with 1.1 over
//! this range, and everything else with 1.
//!
//! ```text
//! cargo bench --bench large
//! ```

#![allow(clippy::unwrap_used)] // benchmarks, also their helpers, may fail

mod common;

use common::{Star, measuring, size};
use foldwell::analysis::relax::relax_from;
use foldwell::model::RIGID;
use foldwell::solver::Options;
use std::time::Instant;

const CELLS: [usize; 5] = [21, 36, 60, 100, 158];
const TOLERANCE: f64 = 1e-10;

/// Returns the peak memory of this process in MB; `None` if the system does not report it (only Linux does).
fn most_memory() -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    Some(line.trim().trim_end_matches("kB").trim().parse::<f64>().ok()? / 1024.0)
}

/// Returns the exponent with which the second numbers grow with the first, from the first and the last pair.
fn growth(points: &[[f64; 2]]) -> f64 {
    let ([first, last], logs) = ([points[0], points[points.len() - 1]], |a: f64, b: f64| (b / a).ln());
    logs(first[1], last[1]) / logs(first[0], last[0])
}

fn main() {
    println!("{:>10} {:>9} {:>6} {:>9} {:>9} {:>9}", "cells", "unknowns", "steps", "residual", "seconds", "MB");
    let (mut times, mut memories) = (Vec::new(), Vec::new());
    for cells in CELLS.into_iter().take(if measuring() { CELLS.len() } else { 1 }) {
        let model = Star::new(cells).model(RIGID);
        let (unknowns, start) = (size(&model).0, model.start());
        let clock = Instant::now();
        let options = Options { tolerance: TOLERANCE, ..Options::default() };
        let found = relax_from(&model, start, options, &mut |_| true).expect("these patches relax");
        let (seconds, memory) = (clock.elapsed().as_secs_f64(), most_memory().unwrap_or(f64::NAN));
        let residual = found.residual_force.max(found.residual_length);
        assert!(residual <= TOLERANCE, "{cells} x {cells}: {residual:e}");
        println!(
            "{:>10} {unknowns:9} {:6} {residual:9.1e} {seconds:9.2} {memory:9.0}",
            format!("{cells} x {cells}"),
            found.iterations
        );
        times.push([unknowns as f64, seconds]);
        memories.push([unknowns as f64, memory]);
    }
    if times.len() > 1 {
        println!("time grows with the power {:.2}, memory with {:.2}", growth(&times), growth(&memories));
    }
}
