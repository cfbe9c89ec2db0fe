//! `kind = "path"`: equilibria while a quantity is driven, through limit points, with branches on request.

mod drive;
mod end;
mod plot;
mod summary;
mod table;

use self::drive::{drive, drive_name, folds, follows, has_effect, lists, may_snap, moves, snaps, then};
use self::end::{INSIDE_OUT, end_word, inside_out, reason};
use self::plot::{Words, event_word, figure};
use super::sides::RestSides;
use super::states::{self, Shown};
use super::supported::small_tolerance;
use super::{Answer, Context, NoAnswer, Progress, StudyError, StudyResult, ratios, start};
use crate::analysis::intersections::Marks;
use crate::analysis::path::{
    BranchPoint, HalfBranches, PathBranch, PathCallbacks, PathEnd, PathEntry, PathEvent, PathOptions, PathPoint,
    PathRecord, PathStop, Probe, resume_path,
};
use crate::model::{Assembly, Drive, Driven, Gauge};
use crate::numerics::{larger, worst};
use crate::output::figure::rounded;
use crate::scene::forms::StartSpec;
use crate::scene::places::Places;
use crate::scene::spec::{CreaseAngle, Draw, PathSpec, ProbeValue};
use crate::sheet::similar::there_are;
use std::collections::BTreeSet;
pub use summary::{FirstCrossing, HalfBranchesSummary, PathBranchSummary, PathEventSummary, PathSummary};

/// Number of pictures in the series, apart from more events and ends than that.
const PICTURES: usize = 60;
/// Number of states examined for self-intersection between two calls of the observer.
const OBSERVED: usize = 16;

/// Checks that the sheet has an energy, and that the drive, the start and the stops exist.
pub(crate) fn check(context: &Context<'_>, spec: &PathSpec) -> Result<(), StudyError> {
    if !context.assembly.terms().has_energy() {
        let help = "give bars, creases or facets a stiffness";
        return Err(context.refuse("there is no energy whose equilibria a path could follow", help).into());
    }
    small_tolerance(context, spec.tolerance.as_ref())?;
    ratios::check(context, spec.response.as_ref())?;
    moves(context, spec)?;
    has_effect(context, spec)?;
    lists(context, spec)?;
    stop(context, spec)?;
    probes(context, spec)?;
    follows(context, spec)?;
    may_snap(context, spec)?;
    match spec.start.as_ref().map(|start| (&**start, start.span())) {
        Some((StartSpec::Random(_), span)) => {
            let help =
                "start from \"drawn\", an earlier study or a file; a relaxation can start from random displacements";
            Err(context.file.error_at(span, "a path does not start there", help).into())
        }
        _ => start::check(context, spec.start.as_ref()),
    }
}

/// Follows the path, and its branches if the scene asks for them.
pub(crate) fn compute(context: &Context<'_>, spec: &PathSpec) -> Result<Answer, NoAnswer> {
    let (drive, stop) = (drive(context, spec)?, stop(context, spec)?);
    let mut model = context.assembly.model(Gauge::Held);
    let start = start::initial_state(context, spec.start.as_ref(), &mut model)?;
    let start = (!start::is_drawn(spec.start.as_ref())).then(|| model.configuration(&start.x, start.tension));
    let usual = PathOptions::default();
    let options = PathOptions {
        switch: spec.switch,
        snap: snaps(context, spec),
        stop,
        at: spec.at.iter().map(|value| value.0).collect(),
        then: then(context, spec),
        tolerance: spec.tolerance.as_ref().map_or(usual.tolerance, |tolerance| tolerance.0),
        max_step: spec.max_step.as_ref().map_or(usual.max_step, |step| step.0),
    };
    let mut step = 0;
    let mut observe = |_: usize, point: &PathPoint| {
        step += 1;
        let residual = larger(point.residual_force, point.residual_length);
        context.step_on_way(Progress { study: context.name().into(), step, of: None, residual, part: point.part })
    };
    let log = format!("{}.path.jsonl", context.name());
    let kept = context.checkpoints.log(&log)?;
    let record: PathRecord = kept.iter().map_while(|line| serde_json::from_str(line).ok()).collect();
    let mut fault = None;
    let mut keep = |entry: &PathEntry| {
        // numbers and words only, so that serialization cannot fail
        let line = serde_json::to_string(entry).unwrap_or_default();
        fault = context.checkpoints.log_line(&line).err();
        fault.is_none()
    };
    let callbacks = PathCallbacks { observe: &mut observe, keep: &mut keep };
    let found = resume_path(context.assembly, &drive, start, &options, record, callbacks);
    context.end_steps();
    match (found, fault) {
        (_, Some(fault)) => Err(fault.into()),
        (Ok(branches), None) => Ok(answer(context, (spec, probes(context, spec)?), &drive, &branches)),
        (Err(failure), None) => Err(NoAnswer::because(failure)),
    }
}

/// Returns the probes.
fn probes<'a>(context: &Context<'_>, spec: &'a PathSpec) -> Result<Vec<(&'a str, Probe)>, StudyError> {
    let mut found: Vec<(&str, Probe)> = vec![];
    for probe in &spec.probe {
        let refused = |message: &str, help| Err(context.file.error_at(probe.name.span(), message, help).into());
        if found.iter().any(|(name, _)| *name == probe.name.0) {
            return refused("two probes have this name", "give each probe a name of its own");
        }
        if context.assembly.domain().is_periodic() {
            return refused(
                "a periodic sheet has no vertex that can be told from its copies",
                "probes are for patches",
            );
        }
        let vertices = Places::new(context.file, context.assembly).set(&probe.vertices)?;
        found.push((probe.name.0.as_str(), Probe { vertices, axis: probe.axis as usize }));
    }
    Ok(found)
}

/// Returns the stops. The angle of a crease is that of its copy in the middle cell, as in the table.
fn stop(context: &Context<'_>, spec: &PathSpec) -> Result<PathStop, StudyError> {
    let inside_out = folds(context).then_some(INSIDE_OUT);
    let Some(said) = &spec.stop else { return Ok(PathStop { drive: inside_out, ..PathStop::default() }) };
    let crease_angle = |wanted: &CreaseAngle| {
        let edge = crease_in_middle(context.assembly, wanted.crease.0);
        edge.map(|edge| (edge, wanted.angle.radians)).ok_or_else(|| {
            let message = format!("the sheet has no crease {}", wanted.crease.0);
            let help = "name a crease between two faces as [i, j, n1, n2]";
            context.file.error_at(wanted.crease.span(), message, help)
        })
    };
    let displacement = |wanted: &ProbeValue| -> Result<_, StudyError> {
        let probes = probes(context, spec)?;
        let names: Vec<&str> = probes.iter().map(|(name, _)| *name).collect();
        let found = probes.into_iter().find(|(name, _)| *name == wanted.probe.as_str());
        let missing = || {
            let message = format!("no probe is called `{}`", *wanted.probe);
            context.file.error_at(wanted.probe.span(), message, there_are(&wanted.probe, names))
        };
        Ok((found.ok_or_else(missing)?.1, wanted.value.0))
    };
    let crease_angle = said.crease_angle.as_ref().map(crease_angle).transpose()?;
    Ok(PathStop {
        displacement: said.displacement.as_ref().map(displacement).transpose()?,
        drive: said.drive.as_ref().map(|value| value.0).or(inside_out),
        reaction: said.reaction.as_ref().map(|value| value.0),
        states: said.states.as_ref().map(|count| count.0 as usize),
        limit_points: said.limit_points.as_ref().map(|count| count.0 as usize),
        arc_length: said.arc_length.as_ref().map(|length| length.0),
        curvature: said.curvature.as_ref().map(|curvature| curvature.0),
        crease_angle,
        self_intersection: said.self_intersection == Some(true),
    })
}

/// Returns the number of the copy of an edge in the middle cell, or of its first copy if that one has one face only.
fn crease_in_middle(assembly: &Assembly, key: crate::sheet::EdgeKey) -> Option<usize> {
    let (tiling, sheet) = (assembly.tiling(), assembly.sheet());
    let middle = tiling.cells.map(|n| (n - 1) / 2);
    let copies = || {
        let all = tiling.edges.iter().enumerate();
        all.filter(|(_, edge)| sheet.edges[edge.edge].key == key && edge.hinge().is_some())
    };
    copies().find(|(_, edge)| edge.cell == middle).or_else(|| copies().next()).map(|(number, _)| number)
}

/// Returns the answer of a path that began.
fn answer(
    context: &Context<'_>,
    (spec, probes): (&PathSpec, Vec<(&str, Probe)>),
    drive: &Drive,
    branches: &[PathBranch],
) -> Answer {
    let mut answer = Answer::empty(context.study);
    let marks = marks(context, branches);
    answer.add(format!("{}.csv", context.name()), table::table(context, (spec, &probes), branches, marks.as_deref()));
    add_pictures(&mut answer, context, drive, branches, marks.as_deref());
    let result = summary(context, (spec, drive), branches, marks.as_deref());
    let error = worst(result.branches.iter().filter_map(|branch| branch.max_residual));
    let interrupted = context.interrupted().then(|| "interrupted".to_owned());
    let reason = branches.first().map_or(Some("the path has no states".to_owned()), reason);
    let asked = spec.stop.as_ref().is_some_and(|stop| stop.drive.is_some());
    let turned_back = branches.first().filter(|_| folds(context) && !asked).and_then(inside_out);
    answer.conclude(StudyResult::Path(result), error, reason.or(turned_back).or(interrupted));
    answer.state = branches.first().and_then(|branch| branch.points.last()).map(PathPoint::configuration);
    answer
}

/// Returns the self-intersections of all states, branch by branch; `None` if the study does not ask for that check. An
/// interruption leaves out the rest.
fn marks(context: &Context<'_>, branches: &[PathBranch]) -> Option<Vec<Vec<Marks>>> {
    let mut finder = context.self_intersection()?;
    let (mut all, mut count) = (Vec::new(), 0);
    for branch in branches {
        let mut found = Vec::new();
        for point in &branch.points {
            count += 1;
            if count % OBSERVED == 0 && !context.step(count, None) {
                break;
            }
            let state = states::with_all_angles(context, &point.state);
            found.push(finder.marks(context.assembly.drawn(), &state));
        }
        all.push(found);
    }
    Some(all)
}

/// Adds the series of some states, the last state of the first branch, and the plot of reactions.
fn add_pictures(
    answer: &mut Answer,
    context: &Context<'_>,
    drive: &Drive,
    branches: &[PathBranch],
    marks: Option<&[Vec<Marks>]>,
) {
    let points = branches
        .iter()
        .enumerate()
        .flat_map(|(number, branch)| branch.points.iter().enumerate().map(move |(step, point)| (number, step, point)));
    let picture = |number: usize, step: usize, point: &PathPoint| {
        let state = states::with_all_angles(context, &point.state);
        let marks = marks.and_then(|marks| marks[number].get(step).cloned());
        states::picture(context, &Shown { state, residuals: None, marks })
    };
    if context.draws(Draw::Vtk) {
        let chosen = pictured(branches);
        let rows = points.enumerate().filter(|(row, _)| chosen.contains(row));
        let pictures = rows.map(|(row, (number, step, point))| (row, row, picture(number, step, point)));
        states::add_series(answer, context, [""; 2], pictures);
    }
    let Some(branch) = branches.first() else { return };
    if let Some(last) = branch.points.last() {
        let Words { quantity, .. } = Words::new(context, drive);
        let unstable = match last.negative_eigenvalues {
            Some(0) => "",
            Some(_) => ", not stable",
            None => ", stability not known",
        };
        let driven = match drive.quantity {
            Driven::Rest => format!("folded to {}", summary::percent(last.drive)),
            _ => format!("{quantity} {}", rounded(last.drive, 5)),
        };
        let words = format!("{driven}, energy {}{unstable}", rounded(last.state.total(), 5));
        let loads = if drive.quantity == Driven::Loads { last.drive } else { 1.0 };
        let shown = (&picture(0, branch.points.len() - 1, last), &*words, loads);
        states::add_figure_as(context.name(), answer, context, shown);
    }
    if context.draws(Draw::Svg) {
        answer.add(format!("{}-reaction.svg", context.name()), figure(context, drive, branches));
    }
}

/// Returns the rows of the table of which there are pictures: events and the ends of branches, and others evenly.
fn pictured(branches: &[PathBranch]) -> BTreeSet<usize> {
    let count: usize = branches.iter().map(|branch| branch.points.len()).sum();
    let every = count.div_ceil(PICTURES).max(1);
    let mut rows: BTreeSet<usize> = (0..count).step_by(every).collect();
    let mut first = 0;
    for branch in branches {
        let last = branch.points.len().saturating_sub(1);
        for (step, point) in branch.points.iter().enumerate() {
            if point.event.is_some() || step == 0 || step == last {
                rows.insert(first + step);
            }
        }
        first += branch.points.len();
    }
    rows
}

fn summary(
    context: &Context<'_>,
    (spec, drive): (&PathSpec, &Drive),
    branches: &[PathBranch],
    marks: Option<&[Vec<Marks>]>,
) -> PathSummary {
    let branch = |(number, branch): (usize, &PathBranch)| PathBranchSummary {
        rest_sides: rest_sides(context, drive, branch),
        ..branch_summary(number, branch, marks.map(|marks| &marks[number][..]))
    };
    PathSummary {
        drive: drive_name(context, spec).to_owned(),
        driven: Words::new(context, drive).driven.to_owned(),
        to: finite(drive.to),
        branches: branches.iter().enumerate().map(branch).collect(),
        not_passed: not_passed(spec, branches),
    }
}

/// Returns the sides to which the hinges are folded where a branch has arrived at all rest angles.
fn rest_sides(context: &Context<'_>, drive: &Drive, branch: &PathBranch) -> Option<RestSides> {
    let folded = drive.quantity == Driven::Rest && drive.to == 1.0 && branch.end == PathEnd::Arrived;
    let last = branch.points.last().filter(|_| folded)?;
    Some(RestSides::of(context, &last.configuration())).filter(|sides| sides.hinges > 0)
}

/// Returns the values of which the study lists the states, but that no branch passes.
fn not_passed(spec: &PathSpec, branches: &[PathBranch]) -> Vec<f64> {
    let passes = |branch: &PathBranch, value: f64| {
        let off = || branch.points.iter().map(|point| point.drive - value);
        off().any(|off| off <= 0.0) && off().any(|off| off >= 0.0)
    };
    let listed = spec.at.iter().map(|value| value.0);
    listed.filter(|value| !branches.iter().any(|branch| passes(branch, *value))).collect()
}

fn branch_summary(number: usize, branch: &PathBranch, marks: Option<&[Marks]>) -> PathBranchSummary {
    let last = branch.points.last();
    let event = |point: &PathPoint| {
        Some(PathEventSummary {
            event: event_word(point.event?).to_owned(),
            drive: finite(point.drive),
            reaction: point.reaction,
            arc_length: point.arc_length,
            multiplicity: point.branch_point.map(|known| known.multiplicity),
            half_branches: point.branch_point.and_then(half_branches),
        })
    };
    let crossing =
        |marks: &[Marks]| branch.points.iter().zip(marks).find(|(_, marks)| marks.any).map(|(point, _)| point);
    let first = match marks {
        Some(marks) => crossing(marks),
        None => branch.points.iter().find(|point| point.event == Some(PathEvent::SelfIntersection)),
    };
    // at an event one eigenvalue is zero, and its sign is rounding
    let mut regular = branch.points.iter().filter(|point| point.event.is_none());
    PathBranchSummary {
        branch: number,
        end: end_word(&branch.end).to_owned(),
        steps: branch.points.len(),
        iterations: branch.points.iter().map(|point| point.iterations).sum(),
        arc_length: last.map(|point| point.arc_length),
        drive: last.and_then(|point| finite(point.drive)),
        reaction: last.map(|point| point.reaction),
        work: last.map(|point| point.work),
        energy: last.map(|point| point.state.total()),
        dissipated: last.filter(|point| !point.memory.is_empty()).map(|point| point.state.dissipated),
        stable: regular.all(|point| point.negative_eigenvalues == Some(0)),
        max_residual: worst(branch.points.iter().map(|point| larger(point.residual_force, point.residual_length))),
        self_intersecting: marks.map(|marks| marks.iter().any(|marks| marks.any)),
        first_self_intersection: first
            .map(|point| FirstCrossing { arc_length: point.arc_length, drive: finite(point.drive) }),
        events: branch.points.iter().filter_map(event).collect(),
        ..PathBranchSummary::default()
    }
}

/// What was found where branches were sought.
fn half_branches(BranchPoint { multiplicity, half_branches }: BranchPoint) -> Option<HalfBranchesSummary> {
    let HalfBranches { found, expected, known, left } = half_branches?;
    let along = format!("branches were sought along {multiplicity} directions only, on both sides of each");
    let reason = match (expected, multiplicity) {
        (Some(expected), _) if found == expected => None,
        (Some(expected), _) => {
            Some(format!("{expected} half branches leave, and of {} no state was found", expected - found))
        }
        (None, 2) => Some(format!("{along}: what tells others from each other is rounding error")),
        (None, _) => Some(format!("{along}: {multiplicity} eigenvalues vanish at once")),
    };
    Some(HalfBranchesSummary { found, expected, reason, known, left })
}

fn finite(value: f64) -> Option<f64> {
    Some(value).filter(|value| value.is_finite())
}
