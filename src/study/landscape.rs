//! `kind = "landscape"`: the energy of a patch or a torus along folding modes, with fits and the predicted expansion.

mod map;
mod summary;

use super::{Answer, Context, NoAnswer, StudyError, StudyResult, energies, relax};
use crate::analysis::landscape::samples::{Landscape, Sample, landscape};
use crate::analysis::landscape::{HeldSheet, LandscapeError, fit};
use crate::model::{Assembly, Domain};
use crate::numerics::{larger, worst};
use crate::output::figure::chart::{self, DataPoint, LineChart, Series};
use crate::output::figure::rounded;
use crate::output::table::{EnergiesAndResiduals, Table, Value};
use crate::scene::forms::Mode;
use crate::scene::spec::{Draw, LandscapeSpec};
use crate::scene::{Located, build};
pub use summary::{LandscapeSummary, MapSummary, ModeLandscape, SampleSummary};

/// Checks that the sheet is a patch or torus of a periodic sheet with bars and creases, without locks, pins and loads.
pub(crate) fn check(context: &Context<'_>, spec: &LandscapeSpec) -> Result<(), StudyError> {
    let refuse = |message: &str, help: &str| Err(context.refuse(message, help).into());
    let (file, assembly, terms) = (context.file, context.assembly, context.assembly.terms());
    let torus = match assembly.domain() {
        Domain::Patch => false,
        Domain::FixedTorus(_) | Domain::FreeTorus => true,
        Domain::Screw | Domain::Tube { .. } | Domain::Own(_) => {
            return refuse("a landscape needs cells around its own", "use domain = \"patch\"");
        }
    };
    if assembly.sheet().lattice.is_none() {
        return refuse("a finite sheet has no uniform modes", "give the mesh a lattice");
    }
    if terms.bars.is_none() || terms.creases.is_none() {
        let help = "give bars (inf: rigid) and creases a stiffness";
        return refuse("a landscape is the energy of bars and creases", help);
    }
    if torus && terms.has_rigid_bars() {
        let help = "give bars a finite stiffness";
        return refuse("modes of a torus stretch bars beyond linear order, rigid bars forbid them", help);
    }
    if !(terms.locks.is_empty() && terms.pins.is_empty() && !terms.is_loaded()) {
        let help = "leave out [[lock]], [[pin]] and [[load]]";
        return refuse("a landscape holds nothing but the amplitude of a mode", help);
    }
    let held = HeldSheet::new(assembly).map_err(|error| context.refuse(error.to_string(), MODES))?;
    if let Some(map) = &spec.map {
        held.named([1.0, 0.0, 0.0]).map_err(|error| file.error_at(map.span(), error.to_string(), NO_MAP))?;
    }
    spec.modes.iter().try_for_each(|mode| rates(context, &held, mode).map(|_| ()))
}

/// Least number of samples above rounding for a fit, if others are below.
const FITTED: usize = 2;

/// Advice for a map that cannot be computed.
const NO_MAP: &str = "maps are of patches with three modes that curvatures name; leave out `map`";

/// Advice for a mode that does not exist.
const MODES: &str = "modes of patches are named by curvatures or, where these do not tell them apart, by { rates = \"file.csv\" }, \
                     which `response` lists for all modes; those of tori by wavenumbers on zero lines";

/// Returns the rates of the rest angles of a mode.
fn rates(context: &Context<'_>, held: &HeldSheet, mode: &Located<Mode>) -> Result<Vec<f64>, StudyError> {
    let (file, assembly) = (context.file, context.assembly);
    let found = match &**mode {
        Mode::Curvature(curvature) => held.named(*curvature),
        Mode::Wave(wave) if assembly.tiling().periodic => held.wave(assembly.tiling(), *wave.wave),
        Mode::Wave(_) => Err(LandscapeError::NoWaves),
        Mode::Rates(name) => held.with_rates(&uniform(context, mode, &build::rates(file, assembly, name)?)?),
    };
    Ok(found.map_err(|error| file.error_at(mode.span(), error.to_string(), MODES))?)
}

/// Converts rates of all edges to rates of the edges of the repeated piece. On a patch that piece is the cell, and the
/// rates must be the same in every cell.
fn uniform(context: &Context<'_>, mode: &Located<Mode>, all: &[f64]) -> Result<Vec<f64>, StudyError> {
    let assembly = context.assembly;
    if assembly.tiling().periodic {
        return Ok(all.to_vec());
    }
    let mut cell = vec![f64::NAN; assembly.sheet().edges.len()];
    for (tiled, rate) in assembly.tiling().edges.iter().zip(all) {
        if !cell[tiled.edge].is_nan() && !rate.is_nan() && cell[tiled.edge] != *rate {
            let help = "give one row for each crease of the cell, without cell1 and cell2";
            return Err(context.file.error_at(mode.span(), "the rates differ from cell to cell", help).into());
        }
        if !rate.is_nan() {
            cell[tiled.edge] = *rate;
        }
    }
    Ok(cell)
}

/// Computes the landscape of every mode, and the map if the scene asks for one.
pub(crate) fn compute(context: &Context<'_>, spec: &LandscapeSpec) -> Result<Answer, NoAnswer> {
    let found: Vec<Along> = spec.modes.iter().map(|mode| along(context, spec, mode)).collect::<Result<_, _>>()?;
    let mut answer = Answer::empty(context.study);
    answer.add(format!("{}.csv", context.name()), table(context.assembly, &found));
    if context.draws(Draw::Svg) {
        answer.add(format!("{}.svg", context.name()), chart::alone(&energies(context, &found)));
    }
    let map = spec.map.as_ref().map(|map| map::compute(context, map, &mut answer)).transpose()?;
    let of_map = map.as_ref().and_then(|map| map.reason.clone());
    let reason = found.iter().find_map(Along::failure).or(of_map);
    let error = worst(found.iter().filter_map(Along::residual));
    let modes = found.iter().map(|along| along.summarized(&amplitudes(spec))).collect();
    let result = LandscapeSummary { modes, map: map.map(|map| map.summary) };
    answer.conclude(StudyResult::Landscape(result), error, reason);
    Ok(answer)
}

/// The landscape along one mode.
struct Along {
    /// The mode as the scene names it.
    mode: Mode,
    curvature: Option<[f64; 3]>,
    landscape: Result<Landscape, LandscapeError>,
}

/// Computes the landscape along one mode, by increasing amplitude.
fn along(context: &Context<'_>, spec: &LandscapeSpec, mode: &Located<Mode>) -> Result<Along, StudyError> {
    let refuse = |error: LandscapeError| context.file.error_at(mode.span(), error.to_string(), MODES);
    let held = HeldSheet::new(context.assembly).map_err(refuse)?;
    let rates = rates(context, &held, mode)?;
    let curvature = match &**mode {
        Mode::Curvature(curvature) => Some(*curvature),
        _ => held.curvature(&rates),
    };
    let landscape = landscape(&held, rates, &amplitudes(spec), &mut relax::watcher(context));
    Ok(Along { mode: (**mode).clone(), curvature, landscape })
}

fn amplitudes(spec: &LandscapeSpec) -> Vec<f64> {
    let mut amplitudes: Vec<f64> = spec.amplitudes.iter().map(|amplitude| amplitude.0).collect();
    amplitudes.sort_by(f64::total_cmp);
    amplitudes
}

impl Along {
    fn samples(&self) -> &[Sample] {
        self.landscape.as_ref().map_or(&[], |landscape| &landscape.samples)
    }

    /// Returns the reason for which samples are missing or cannot be fitted; `None` if there is none.
    fn failure(&self) -> Option<String> {
        let why = match &self.landscape {
            Ok(landscape) => landscape.failure.as_ref().map(ToString::to_string).or_else(|| self.rounded())?,
            Err(error) => error.to_string(),
        };
        Some(format!("mode {}: {why}", self.name()))
    }

    fn name(&self) -> String {
        match &self.mode {
            Mode::Wave(wave) => format!("{{ wave = {:?} }}", *wave.wave),
            Mode::Rates(name) => format!("{{ rates = {:?} }}", *name.rates),
            Mode::Curvature(curvature) => format!("{curvature:?}"),
        }
    }

    /// Returns the name of the mode for the legend.
    fn legend(&self) -> String {
        match &self.mode {
            Mode::Wave(wave) => format!("wave ({}, {})", wave.wave[0], wave.wave[1]),
            Mode::Rates(name) => format!("rates of {:?}", *name.rates),
            Mode::Curvature([k11, k22, k12]) => {
                format!("k\u{2081}\u{2081}, k\u{2082}\u{2082}, k\u{2081}\u{2082} = {k11}, {k22}, {k12}")
                    .replace('-', "\u{2212}")
            }
        }
    }

    /// Returns a message if some samples are below rounding and fewer than `FITTED` are above it.
    fn rounded(&self) -> Option<String> {
        let (below, all) = (self.below_rounding(), self.samples().len());
        let least = self.samples().iter().map(|sample| sample.rounding).fold(0.0, f64::max);
        (below > 0 && all - below < FITTED).then(|| {
            format!(
                "the energies of {below} of {all} samples may be rounding (which makes {least:.1e} of energy), too few are \
                 left to fit: give larger amplitudes"
            )
        })
    }

    fn below_rounding(&self) -> usize {
        self.samples().iter().filter(|sample| sample.below_rounding()).count()
    }

    /// Returns amplitudes and energies of the samples to be fitted: those above rounding, or none if these are too few.
    fn fitted(&self) -> Vec<(f64, f64)> {
        if self.rounded().is_some() {
            return Vec::new();
        }
        let fitted = self.samples().iter().filter(|sample| sample.is_fitted());
        fitted.map(|sample| (sample.amplitude, sample.relaxed.state.total())).collect()
    }

    fn residual(&self) -> Option<f64> {
        let of = |sample: &Sample| larger(sample.relaxed.residual_force, sample.relaxed.residual_length);
        worst(self.samples().iter().map(of))
    }

    fn summarized(&self, amplitudes: &[f64]) -> ModeLandscape {
        let sample = |(k, amplitude): (usize, &f64)| SampleSummary {
            amplitude: *amplitude,
            energy: self.samples().get(k).map(|sample| sample.relaxed.state.total()),
            below_rounding: self.samples().get(k).is_some_and(Sample::below_rounding),
            other_minimum: self.samples().get(k).is_some_and(|sample| sample.other_minimum),
            converged: k < self.samples().len(),
        };
        let fitted = self.fitted();
        let (exponent, coefficient) = (fit::exponent(&fitted), fit::coefficient(&fitted));
        let predicted = self.landscape.as_ref().ok().map(|landscape| landscape.predicted);
        ModeLandscape {
            mode: self.curvature,
            wave: if let Mode::Wave(wave) = &self.mode { Some(*wave.wave) } else { None },
            samples: amplitudes.iter().enumerate().map(sample).collect(),
            exponent: exponent.map(|estimate| estimate.value),
            exponent_error: exponent.and_then(|estimate| estimate.error),
            coefficient: coefficient.map(|estimate| estimate.value),
            coefficient_error: coefficient.and_then(|estimate| estimate.error),
            predicted_coefficient: predicted.map(|expansion| expansion.fourth),
            predicted_fifth: predicted.map(|expansion| expansion.fifth),
            predicted_sixth: predicted.map(|expansion| expansion.sixth),
            below_rounding: self.below_rounding(),
            fit_agrees: coefficient.zip(predicted).map(|(fit, predicted)| fit::agrees(&fitted, fit, predicted)),
            defect: self.curvature.map(|[k11, k22, k12]| k11 * k22 - k12 * k12),
        }
    }
}

/// Returns the chart of energies against amplitudes, with a line for each mode and its fitted slope if there is one.
fn energies(context: &Context<'_>, found: &[Along]) -> LineChart {
    let point =
        |sample: &Sample| DataPoint { x: sample.amplitude, y: sample.relaxed.state.total(), label: String::new() };
    let series = |along: &Along| {
        let above = along.samples().iter().filter(|sample| !sample.below_rounding());
        let slope = fit::exponent(&along.fitted()).map(|slope| format!(", slope {}", rounded(slope.value, 4)));
        Series { name: along.legend() + &slope.unwrap_or_default(), points: above.map(point).collect() }
    };
    let below = found.iter().flat_map(Along::samples).filter(|sample| sample.below_rounding());
    LineChart {
        title: context.file.title(),
        x: "amplitude of the mode".to_owned(),
        y: context.units().energy(),
        series: found.iter().map(series).collect(),
        rounding: below.map(point).collect(),
        ..LineChart::default()
    }
}

/// Returns a row for each sample: the mode, the amplitude, the energies, and on patches the rest angles minus the drawn
/// ones.
fn table(assembly: &Assembly, found: &[Along]) -> Table {
    let uniform = if assembly.tiling().periodic { &[] } else { assembly.sheet().edges.as_slice() };
    let mut table = Table::new("mode,k11,k22,k12,amplitude")
        .with(EnergiesAndResiduals::columns([]))
        .with(["iterations", "rounds"])
        .with_edges("rest", uniform.iter().map(|edge| &edge.key));
    for (number, along) in found.iter().enumerate() {
        for sample in along.samples() {
            let relaxed = &sample.relaxed;
            let residuals = [relaxed.residual_force, relaxed.residual_length];
            let solution =
                EnergiesAndResiduals::new(energies::columns(assembly.terms(), &relaxed.state), Some(residuals));
            let mode = [0, 1, 2].map(|k| along.curvature.map(|curvature| curvature[k]).into());
            let first = [number.into()].into_iter().chain(mode).chain([sample.amplitude.into()]);
            let rounds = [sample.iterations, sample.rounds].map(Value::from);
            let rest = uniform.iter().zip(&sample.rest).map(|(_, angle)| Value::Number(*angle));
            table.push(first.chain(solution.values()).chain(rounds).chain(rest));
        }
    }
    table
}
