//! `kind = "wells"`: minima reached from random starts, the barriers between them, and the landscape of the rigid
//! sheet.

mod summary;

use super::states::{self, Shown};
use super::surface::{check_resolution, curvature_of_cell};
use super::{Answer, Context, NoAnswer, StudyError, StudyResult, start, supported};
use crate::analysis::intersections::SelfIntersection;
use crate::analysis::modes::ModesError;
use crate::analysis::state::State;
use crate::analysis::wells::barrier::{Barrier, BarrierError, barrier};
use crate::analysis::wells::families::is_in_family;
use crate::analysis::wells::limit::{Height, rigid_limit};
use crate::analysis::wells::merge::{Comparison, SAME_WELL_ANGLE_RAD, Well, wells};
use crate::analysis::wells::placement::free_rigid_motions;
use crate::analysis::wells::rigid::{RigidError, RigidLandscape, Sampling, landscape};
use crate::analysis::wells::starts::{Outcome, Starts, failures, relax_around};
use crate::model::{Assembly, Domain, Gauge};
use crate::numerics::{larger, worst};
use crate::output::figure::chart::{self, DataPoint, LineChart, Series};
use crate::output::figure::rounded;
use crate::output::table::{Table, Value};
use crate::scene::spec::{Draw, WellsSpec};
use crate::solver::Options;
use std::f64::consts::{PI, TAU};
use std::sync::atomic::{AtomicUsize, Ordering};
pub use summary::{BarrierSummary, FailedStartsSummary, HeightSummary, RigidSummary, WellSummary, WellsSummary};

/// Number of starts, and of states over a whole turn, unless the scene gives others.
const STARTS: u32 = 64;
const RESOLUTION: u32 = 64;

/// Checks that there is an energy of which wells are known, and that pins hold a sheet under loads.
pub(crate) fn check(context: &Context<'_>, spec: &WellsSpec) -> Result<(), StudyError> {
    let refuse = |message: &str, help: &str| Err(context.refuse(message, help).into());
    start::check(context, spec.start.as_ref())?;
    check_resolution(context.file, spec.resolution.as_ref())?;
    let terms = context.assembly.terms();
    let elastic = match (&terms.bars, &terms.creases) {
        (bars, Some(creases)) if bars.is_some() || terms.has_membranes() => !creases.stiffness.is_rigid(),
        (Some(bars), None) => !bars.stiffness.is_rigid() && *context.assembly.domain() == Domain::Patch,
        _ => false,
    };
    if !elastic {
        let help = "give bars (inf: rigid, or a membrane) and creases a stiffness, that of creases finite; bars of a patch may do without creases";
        return refuse("wells are those of the energy of bars and creases", help);
    }
    if terms.creases.is_none() && (spec.rigid || !spec.barriers.is_empty()) {
        let help = "give creases a stiffness, or leave out `barriers` and `rigid`";
        return refuse("barriers and rigid wells are sought in fold angles of creases", help);
    }
    supported::drawn_lengths(context, "wells")?;
    if spec.rigid || !spec.barriers.is_empty() {
        supported::linear_springs(context, "barriers and rigid wells")?;
    }
    if !terms.loads.is_empty() && free_rigid_motions(context.assembly) > 0 {
        let help = "pin three vertices that do not lie on a line, or leave out [[load]]";
        return refuse("wells under loads are those of a sheet that pins hold in place", help);
    }
    let free = [terms.pins.is_empty(), terms.guides.is_empty(), terms.parts.is_empty(), !terms.is_loaded()];
    if spec.rigid && !free.into_iter().all(|free| free) {
        let help = "leave out `rigid`, or [[pin]], [[part]] and [[load]]";
        return refuse("with `rigid` wells are sought in fold angles, which pins, parts and loads do not know", help);
    }
    if spec.rigid { supported::drawn_rigid_hinges(context, "wells of rigid states") } else { Ok(()) }
}

/// The reason for which a pass that was found has no energy.
const NO_LIMIT: &str = "the pass is singular in rigid bars, and its energies in stiff ones do not tell their limit";

/// Counts how the relaxations ended.
fn tally(outcomes: &[Outcome]) -> WellsSummary {
    let failed = |(reason, starts): (&str, usize)| FailedStartsSummary { reason: reason.into(), starts };
    let failures: Vec<FailedStartsSummary> = failures(outcomes).into_iter().map(failed).collect();
    WellsSummary {
        starts: outcomes.len(),
        failed: failures.iter().map(|failed| failed.starts).sum(),
        saddles: outcomes.iter().filter(|outcome| matches!(outcome, Outcome::Saddle)).count(),
        failures,
        ..WellsSummary::default()
    }
}

/// The results of a study of wells.
struct FoundWells {
    /// How the relaxations ended.
    tally: WellsSummary,
    /// Stiffness of the sheet's stiffest bars.
    stiffness: f64,
    wells: Vec<Well>,
    crossing: Vec<bool>,
    /// Number of the wells in which the sheet has motions that cost nothing.
    in_families: Result<usize, ModesError>,
    barriers: Vec<([usize; 2], Result<Barrier, BarrierError>)>,
    rigid: Option<Result<RigidLandscape, RigidError>>,
}

/// Finds the wells, and the barriers that the scene asks for.
pub(crate) fn compute(context: &Context<'_>, spec: &WellsSpec) -> Result<Answer, NoAnswer> {
    let assembly = context.assembly;
    let mut model = assembly.model(Gauge::Held);
    let start = start::initial_state(context, spec.start.as_ref(), &mut model)?;
    let centre = (!start::is_drawn(spec.start.as_ref())).then(|| model.configuration(&start.x, start.tension));
    let step = AtomicUsize::new(0);
    let watch = |of: Option<usize>| context.step(step.fetch_add(1, Ordering::Relaxed) + 1, of);
    let count = spec.starts.as_ref().map_or(STARTS, |count| count.0) as usize;
    let spread = spec.spread.as_ref().map_or(PI, |spread| spread.0);
    let starts = Starts { count, seed: spec.seed, spread, options: Options::default() };
    let outcomes = relax_around(assembly, centre.as_ref(), &starts, &|| watch(Some(count)));
    let tally = tally(&outcomes);
    let minima = outcomes.into_iter().filter_map(|outcome| match outcome {
        Outcome::Well(settled) => Some(*settled),
        _ => None,
    });
    let wells = wells(minima, &Comparison::new(assembly));
    let rigid = spec.rigid.then(|| landscape(assembly, &sampling(assembly, spec), &mut || watch(None)));
    let mut barriers = Vec::new();
    for &between in spec.barriers.iter().map(|pair| &pair.0) {
        if between.iter().all(|well| *well < wells.len()) && !context.interrupted() {
            barriers.push((between, barrier(assembly, &wells, between, &mut || watch(None))));
        }
    }
    let crossing = crossing(assembly, &wells);
    let in_families = wells.iter().map(|well| is_in_family(assembly, &well.settled).map(usize::from)).sum();
    let found =
        FoundWells { tally, stiffness: assembly.bar_stiffness(), wells, crossing, in_families, barriers, rigid };
    let mut answer = Answer::empty(context.study);
    add_files(&mut answer, context, &found);
    let interrupted = context.interrupted().then(|| "interrupted".to_owned());
    let result = found.summary();
    let (largest, reason) = (error(&result), interrupted.or_else(|| found.missing(spec, &result)));
    answer.conclude(StudyResult::Wells(result), largest, reason);
    Ok(answer)
}

fn sampling(assembly: &Assembly, spec: &WellsSpec) -> Sampling {
    let resolution = spec.resolution.as_ref().map_or(RESOLUTION, |count| count.0);
    let max_curvature = spec.max_curvature.as_ref().map_or_else(|| curvature_of_cell(assembly), |most| most.0);
    Sampling { step: TAU / f64::from(resolution), max_curvature }
}

/// Whether each well intersects itself.
fn crossing(assembly: &Assembly, wells: &[Well]) -> Vec<bool> {
    let mut finder = SelfIntersection::new(assembly);
    wells.iter().map(|well| finder.marks(assembly.drawn(), &well.settled.relaxed.state).any).collect()
}

/// Returns the largest residual; `None` if nothing was found.
fn error(result: &WellsSummary) -> Option<f64> {
    let wells = result.wells.iter().map(|well| larger(well.residual_force, well.residual_length));
    worst(wells.chain(result.barriers.iter().filter_map(|barrier| barrier.residual)))
}

impl FoundWells {
    /// Returns the reason for which the answer is incomplete; `None` if it is complete.
    fn missing(&self, spec: &WellsSpec, result: &WellsSummary) -> Option<String> {
        let WellsSummary { starts, failed, saddles, .. } = result;
        let failed_starts = || format!("{failed} of {starts} starts failed ({})", result.reasons());
        let count = self.wells.len();
        if count == 0 {
            return Some(format!("no well was found: {}, {saddles} ended in no minimum", failed_starts()));
        }
        if 2 * failed > *starts {
            return Some(format!("{}: there may be other wells", failed_starts()));
        }
        match &self.in_families {
            Ok(0) => {}
            Ok(some) => {
                let what = "have motions that cost nothing: each is one of many states at this energy";
                return Some(format!("{some} of {count} wells {what}"));
            }
            Err(error) => {
                return Some(format!("whether the wells have motions that cost nothing is not known: {error}"));
            }
        }
        if let Some(pair) = spec.barriers.iter().find(|pair| pair.0.iter().any(|well| *well >= count)) {
            return Some(format!("a barrier is wanted between wells {:?}, but there are {count}", pair.0));
        }
        if let Some(Err(error)) = &self.rigid {
            return Some(error.to_string());
        }
        if let Some(Ok(RigidLandscape { wells, contacts, states, .. })) = &self.rigid
            && wells.is_empty()
            && contacts.is_empty()
        {
            return Some(self.not_sampled().unwrap_or_else(|| {
                format!(
                    "no rigid well lies among the {states} states that were sampled: the energy is lowest where they end, at the \
                     largest curvature or where a crease is folded by half a turn"
                )
            }));
        }
        let failed = |found: &BarrierSummary| Some(format!("barrier {:?}: {}", found.between, found.reason.as_ref()?));
        result.barriers.iter().find_map(failed).or_else(|| self.not_sampled())
    }

    /// Returns a text about the missing parts of the rigid landscape; `None` if none is missing.
    fn not_sampled(&self) -> Option<String> {
        let RigidLandscape { lost, open, .. } = self.rigid.as_ref()?.as_ref().ok()?;
        let what = match (*lost, *open) {
            (0, 0) => return None,
            (lost, 0) => format!("{lost} wells or passes of the sampled rigid states could not be made exact"),
            (0, open) => format!("rigid states beyond {open} places were not followed"),
            (lost, open) => {
                format!(
                    "{lost} wells or passes of the rigid states could not be made exact, and those beyond {open} places were not followed"
                )
            }
        };
        Some(format!("{what}: the rigid sheet may have other wells and passes"))
    }

    /// Returns the number of a well among those of the rigid sheet; `None` if it is not one of them.
    fn among_rigid(&self, well: &Well) -> Option<usize> {
        let rigid = self.rigid.as_ref()?.as_ref().ok()?;
        let angles = &well.settled.relaxed.state.fold_angle;
        let apart = |other: &[f64]| worst(other.iter().zip(angles).map(|(a, b)| (a - b).abs()).filter(|d| !d.is_nan()));
        rigid.wells.iter().position(|other| apart(&other.angles).is_some_and(|apart| apart <= SAME_WELL_ANGLE_RAD))
    }

    fn summary(&self) -> WellsSummary {
        let well = |(well, crossing): (&Well, &bool)| WellSummary {
            energy: well.settled.energy,
            reached: well.reached,
            self_intersecting: *crossing,
            residual_force: well.settled.relaxed.residual_force,
            residual_length: well.settled.relaxed.residual_length,
            rigid: self.among_rigid(well),
        };
        WellsSummary {
            wells: self.wells.iter().zip(&self.crossing).map(well).collect(),
            barriers: self.barriers.iter().map(|(between, found)| self.barrier(*between, found.as_ref())).collect(),
            rigid: self.rigid.as_ref().and_then(|found| found.as_ref().ok()).map(rigid),
            ..self.tally.clone()
        }
    }

    fn barrier(&self, between: [usize; 2], found: Result<&Barrier, &BarrierError>) -> BarrierSummary {
        let found = match found {
            Ok(found) => found,
            Err(error) => {
                return BarrierSummary { between, reason: Some(error.to_string()), ..BarrierSummary::default() };
            }
        };
        let limit = rigid_limit(&found.heights);
        let extrapolated = || limit.map(|limit| limit.energy);
        let energy = if found.singular { found.flat.or_else(extrapolated) } else { Some(found.pass.energy) };
        let above = |energy: f64| found.joins.map(|well| energy - self.wells[well].settled.energy);
        let height = |height: &Height| HeightSummary {
            bars: height.stiffness.is_finite().then_some(height.stiffness),
            energy: height.energy,
        };
        BarrierSummary {
            between,
            confirmed: true,
            joins: Some(found.joins),
            energy,
            bars: if found.singular { None } else { Some(self.stiffness).filter(|bars| bars.is_finite()) },
            path_bars: Some(found.stiffness),
            height: energy.map(above),
            singular: found.singular,
            exponent: limit.map(|limit| limit.exponent),
            limit: limit.map(|limit| limit.energy),
            limit_error: limit.map(|limit| limit.error),
            flat: found.flat.is_some(),
            rigid: self.rigid_between(found.joins),
            residual: Some(larger(found.pass.residual_force, found.pass.residual_length)),
            heights: found.heights.iter().map(height).collect(),
            reason: energy.is_none().then(|| NO_LIMIT.to_owned()),
        }
    }

    /// Returns the energy of the lowest pass of the rigid sheet between two wells.
    fn rigid_between(&self, wells: [usize; 2]) -> Option<f64> {
        let [a, b] = wells.map(|well| self.among_rigid(&self.wells[well]));
        Some(self.rigid.as_ref()?.as_ref().ok()?.between(a?, b?)?.energy)
    }
}

fn rigid(found: &RigidLandscape) -> RigidSummary {
    RigidSummary {
        dimension: found.dimension,
        states: found.states,
        wells: found.wells.iter().map(|well| well.energy).collect(),
        contacts: found.contacts.clone(),
        passes: found.passes.clone(),
        lost: found.lost,
        open: found.open,
    }
}

/// Adds the wells and then the passes, as a table and as pictures; the energies of passes as a function of stiffness;
/// the energies along the paths.
fn add_files(answer: &mut Answer, context: &Context<'_>, found: &FoundWells) {
    let name = context.name();
    let passes: Vec<&Barrier> = found.barriers.iter().filter_map(|(_, found)| found.as_ref().ok()).collect();
    let mut finder = SelfIntersection::new(context.assembly);
    let shown = |(state, residuals): (&State, [f64; 2])| {
        let state = states::with_all_angles(context, state);
        let marks = finder.marks(context.assembly.drawn(), &state);
        Shown { state, residuals: Some(residuals), marks: Some(marks) }
    };
    let of_wells = found.wells.iter().map(|well| &well.settled.relaxed);
    let of_wells = of_wells.map(|found| (&found.state, [found.residual_force, found.residual_length]));
    let of_passes = passes.iter().map(|barrier| &barrier.pass);
    let of_passes = of_passes.map(|pass| (&pass.state, [pass.residual_force, pass.residual_length]));
    let all: Vec<Shown> = of_wells.chain(of_passes).map(shown).collect();
    answer.add(format!("{name}.csv"), states::table(context, all.iter().enumerate()));
    answer.add(format!("{name}-barriers.csv"), heights(&passes));
    states::add(answer, context, all.iter().enumerate().map(|(k, shown)| (k, k, shown)), None);
    if !context.draws(Draw::Svg) {
        return;
    }
    if !passes.is_empty() {
        let state = "energies along the paths down from passes to wells; a dashed line marks the pass";
        let charts: Vec<LineChart> = passes.iter().map(|barrier| path_chart(context, found, barrier)).collect();
        answer.add(format!("{name}.svg"), chart::panels(&charts, &context.caption(state)));
    } else if let Some(lowest) = all.first() {
        let state = format!("well 0, energy {}", rounded(found.wells[0].settled.energy, 5));
        states::add_figure(answer, context, &states::picture(context, lowest), &state);
    }
}

/// Returns a row for each pass and each stiffness at which it was followed; rigid bars have the stiffness `inf`.
fn heights(passes: &[&Barrier]) -> Table {
    let all = passes.iter().flat_map(|barrier| barrier.heights.iter().map(move |height| (barrier, height)));
    Table::new("from,to,joins_a,joins_b,bars,energy").with_rows(all.map(|(barrier, height)| {
        let wells = barrier.between.into_iter().chain(barrier.joins).map(Value::from);
        wells.chain([height.stiffness.into(), height.energy.into()])
    }))
}

/// Returns the chart of energies along the descents from a pass to the wells that it joins, in the sheet's own bars,
/// and of the energy of the pass.
fn path_chart(context: &Context<'_>, found: &FoundWells, barrier: &Barrier) -> LineChart {
    let ([from, to], last) = (barrier.joins, barrier.path.len() - 1);
    let label = |at: usize| match at {
        0 => format!("well {from}"),
        at if at == last => format!("well {to}"),
        _ => String::new(),
    };
    let point = |(at, &(x, y)): (usize, &(f64, f64))| DataPoint { x, y, label: label(at) };
    let points: Vec<DataPoint> = barrier.path.iter().enumerate().map(point).collect();
    let top = points.iter().max_by(|a, b| a.y.total_cmp(&b.y)).map_or(0.0, |top| top.x);
    let summary = found.barrier(barrier.between, Ok(barrier));
    let level = |energy: f64| {
        let above = energy - found.wells[from].settled.energy;
        DataPoint {
            x: top,
            y: energy,
            label: format!("pass at {}, {} above well {from}", rounded(energy, 5), rounded(above, 5)),
        }
    };
    let [a, b] = barrier.between;
    let sought = if barrier.joins == barrier.between || [to, from] == barrier.between {
        String::new()
    } else {
        format!(" (for {a} and {b})")
    };
    let bars = match barrier.heights.last() {
        Some(last) if barrier.singular => format!(" in bars of {}", rounded(last.stiffness, 3)),
        _ => String::new(),
    };
    LineChart {
        title: format!("well {from} to well {to}{sought}"),
        x: format!("length of the path over the pass{bars}"),
        y: context.units().energy(),
        series: vec![Series { name: String::new(), points }],
        levels: summary.energy.map(level).into_iter().collect(),
        ..LineChart::default()
    }
}
