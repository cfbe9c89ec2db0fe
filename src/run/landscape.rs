//! `kind = "landscape"`: samples every mode of a patch, fits, compares with the prediction, writes a table, summarises.

use super::runner::Runner;
use super::{RunError, studies};
use crate::analysis::landscape::samples::{Landscape, landscape};
use crate::analysis::landscape::{HeldSheet, LandscapeError, fit};
use crate::kinematics::folding_modes_with_locked;
use crate::model::assemble::{Surroundings, drawn_angles};
use crate::output::summary::{LandscapeSummary, ModeLandscape, SampleSummary, StudyResult, StudySummary};
use crate::output::table::{Table, Value};
use crate::scene::build::Built;
use crate::scene::forms::Mode;
use crate::scene::spec::{LandscapeSpec, StudySpec};
use crate::scene::{Located, SceneFile};
use crate::sheet::{EdgeKey, EdgeKind};
use crate::solver::Options;
use std::time::Instant;

/// Landscapes are those of patches of periodic sheets, with bars and creases and nothing that holds or pulls.
pub fn check(file: &SceneFile, built: &Built, study: &StudySpec, spec: &LandscapeSpec) -> Result<(), RunError> {
    let refuse = |message: &str, help: &str| Err(file.error_at(study.kind.span(), message, help).into());
    let recipe = &built.recipe;
    if built.surroundings != Surroundings::Patch || built.sheet.lattice.is_none() {
        return refuse("this version has landscapes of patches of periodic sheets", "use domain = \"patch\"");
    }
    if recipe.bars.is_none() || recipe.creases.is_none() {
        let help = "give bars (inf: rigid) and creases a stiffness";
        return refuse("a landscape is the energy of bars and creases", help);
    }
    if !(recipe.locks.is_empty() && recipe.pins.is_empty() && recipe.loads.is_empty()) {
        let help = "leave out [[lock]], [[pin]] and [[load]]";
        return refuse("a landscape holds nothing but the amplitude of a mode", help);
    }
    for mode in spec.modes.iter() {
        let Mode::Curvature(curvature) = **mode else {
            let help = "name the mode by its curvatures: [k11, k22, k12]";
            return Err(file.error_at(mode.span(), "this version has landscapes of named modes", help).into());
        };
        let modes = folding_modes_with_locked(&built.sheet, &rigid_facets(built));
        let named = modes.and_then(|modes| modes.named(curvature));
        named.map_err(|error| file.error_at(mode.span(), error.to_string(), "choose a sheet with three modes"))?;
    }
    Ok(())
}

fn rigid_facets(built: &Built) -> Vec<usize> {
    let rigid = built.recipe.facets.as_ref().is_some_and(|hinges| hinges.stiffness.is_infinite());
    let facet = |edge: &usize| rigid && built.sheet.edges[*edge].kind == EdgeKind::Facet;
    (0..built.sheet.edges.len()).filter(facet).collect()
}

/// Runs the study.
pub fn study(runner: &mut Runner<'_>, study: &StudySpec, spec: &LandscapeSpec) -> Result<StudySummary, RunError> {
    let clock = Instant::now();
    let found: Result<Vec<([f64; 3], Landscape)>, LandscapeError> =
        spec.modes.iter().filter_map(curvature).map(|mode| Ok((mode, along(runner, study, spec, mode)?))).collect();
    let mut summary = StudySummary {
        name: study.name.0.clone(),
        kind: study.kind.name().to_owned(),
        converged: false,
        seconds: clock.elapsed().as_secs_f64(),
        error: None,
        reason: None,
        result: None,
    };
    match found {
        Ok(found) => {
            table(runner.built, &found).write(&runner.path(format!("{}.csv", study.name.0)))?;
            let failed = |(mode, landscape): &([f64; 3], Landscape)| {
                landscape.failure.as_ref().map(|failure| format!("mode {mode:?}: {failure}"))
            };
            summary.reason = found.iter().find_map(failed);
            summary.converged = summary.reason.is_none();
            let residual = |landscape: &Landscape| -> f64 {
                let of = landscape
                    .samples
                    .iter()
                    .map(|sample| sample.relaxed.residual_force.max(sample.relaxed.residual_length));
                of.fold(0.0, f64::max)
            };
            summary.error = Some(found.iter().map(|(_, landscape)| residual(landscape)).fold(0.0, f64::max));
            let modes = found.iter().map(|(mode, landscape)| summarized(*mode, spec, landscape)).collect();
            summary.result = Some(StudyResult::Landscape(LandscapeSummary { modes }));
        }
        Err(error) => summary.reason = Some(error.to_string()),
    }
    Ok(summary)
}

fn curvature(mode: &Located<Mode>) -> Option<[f64; 3]> {
    if let Mode::Curvature(curvature) = **mode { Some(curvature) } else { None }
}

/// The landscape along one mode, by rising amplitude.
fn along(
    runner: &Runner<'_>,
    study: &StudySpec,
    spec: &LandscapeSpec,
    mode: [f64; 3],
) -> Result<Landscape, LandscapeError> {
    let built = runner.built;
    let mut patch =
        HeldSheet::patch(&built.sheet, &built.tiling, &built.recipe, &drawn_angles(&built.drawn, &built.tiling))?;
    let rates = patch.named(mode)?;
    let mut watch = studies::watcher(runner, study, Options::default().tolerance);
    landscape(&mut patch, rates, &amplitudes(spec), &mut watch)
}

fn amplitudes(spec: &LandscapeSpec) -> Vec<f64> {
    let mut amplitudes: Vec<f64> = spec.amplitudes.iter().map(|amplitude| amplitude.0).collect();
    amplitudes.sort_by(f64::total_cmp);
    amplitudes
}

/// A row for each sample: the mode, the amplitude, the energies, and the rest angles less those drawn.
fn table(built: &Built, found: &[([f64; 3], Landscape)]) -> Table {
    let names = [
        "k11",
        "k22",
        "k12",
        "amplitude",
        "energy_bars",
        "energy_creases",
        "energy_facets",
        "energy_total",
        "residual_force",
        "residual_length",
        "iterations",
        "rounds",
    ];
    let rest = |key: &EdgeKey| format!("rest_{}_{}_{}_{}", key.i, key.j, key.shift[0], key.shift[1]);
    let edges = built.sheet.edges.iter().map(|edge| rest(&edge.key));
    let mut table = Table::new(names.iter().map(|name| (*name).to_owned()).chain(edges).collect());
    for (mode, landscape) in found {
        for sample in &landscape.samples {
            let (relaxed, state) = (&sample.relaxed, &sample.relaxed.state);
            let facets = built.recipe.facets.as_ref().map(|_| state.energy_facets);
            let mut row: Vec<Value> = mode.iter().map(|k| Value::Number(*k)).collect();
            row.extend([sample.amplitude, state.energy_bars, state.energy_creases].map(Value::Number));
            row.push(Value::from(facets));
            row.extend([state.total(), relaxed.residual_force, relaxed.residual_length].map(Value::Number));
            row.extend([sample.iterations, sample.rounds].map(|count| Value::Whole(count as i64)));
            row.extend(sample.rest.iter().map(|angle| Value::Number(*angle)));
            table.push(row);
        }
    }
    table
}

fn summarized(mode: [f64; 3], spec: &LandscapeSpec, found: &Landscape) -> ModeLandscape {
    let energies: Vec<(f64, f64)> =
        found.samples.iter().map(|sample| (sample.amplitude, sample.relaxed.state.total())).collect();
    let sample = |(k, amplitude): (usize, f64)| SampleSummary {
        amplitude,
        energy: energies.get(k).map(|(_, energy)| *energy),
        converged: k < energies.len(),
    };
    let (exponent, coefficient) = (fit::exponent(&energies), fit::coefficient(&energies));
    let [k11, k22, k12] = mode;
    ModeLandscape {
        mode,
        samples: amplitudes(spec).into_iter().enumerate().map(sample).collect(),
        exponent: exponent.map(|estimate| estimate.value),
        exponent_error: exponent.map(|estimate| estimate.error),
        coefficient: coefficient.map(|estimate| estimate.value),
        coefficient_error: coefficient.map(|estimate| estimate.error),
        predicted_coefficient: found.predicted,
        defect: k11 * k22 - k12 * k12,
    }
}
