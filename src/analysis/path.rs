//! Paths: equilibria of an assembly along one driven quantity, through limit points, with branches on request.

mod options;
mod point;
mod seen;
mod snap;
mod stops;
#[cfg(test)]
mod tests;

use super::relax::relax_model;
use crate::model::{Assembly, Configuration, Drive, DriveError, DrivenModel, Gauge, Model};
use crate::solver::path::{self, Branch, BranchEnd, ParametrizedProblem, PathError, Watch};
pub use crate::solver::path::{HalfBranches, PathEntry, PathRecord};
use crate::solver::{Failure, Options, Start};
pub use options::PathOptions;
pub use point::{BranchPoint, PathBranch, PathEnd, PathEvent, PathPoint};
pub use seen::PathCallbacks;
use seen::Seen;
use std::mem;
use stops::Stops;
pub use stops::{PathStop, Probe};
use thiserror::Error;

/// The reason for which a path cannot begin.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[allow(missing_docs)] // each variant is documented by its message
pub enum PathFailure {
    #[error(transparent)]
    Drive(#[from] DriveError),
    #[error("no equilibrium was found with which the path could begin: {0}")]
    Start(#[from] Failure),
    #[error(transparent)]
    Path(#[from] PathError),
}

/// Follows the equilibria of an assembly while a quantity is driven, from the equilibrium next to `start` (the drawn
/// state if `None`). `observe` sees the number of the branch and every accepted state, and returns false to stop.
///
/// ```
/// use foldwell::analysis::path::{PathEvent, PathOptions, follow_path};
/// use foldwell::math::Vec3;
/// use foldwell::model::{Drive, Driven};
/// use foldwell::{Assembly, Pattern, generate};
///
/// // two bars between supports, pushed down at the vertex between them
/// let truss = generate(&Pattern::named("truss")?)?;
/// let assembly = Assembly::patch(truss, [1, 1])
///     .bars(1.0)
///     .pin(0, [0, 0], [true; 3])
///     .pin(2, [0, 0], [true; 3])
///     .pin(1, [0, 0], [false, true, false])
///     .build()?;
/// let quantity = Driven::Vertices { vertices: vec![1], direction: Vec3::new(0.0, 0.0, 1.0) };
/// let branches =
///     follow_path(&assembly, &Drive { quantity, to: -0.6 }, None, &PathOptions::default(), &mut |_, _| true)?;
/// let largest = branches[0].points.iter().find(|point| point.event == Some(PathEvent::LimitLoad));
/// // the largest force of two bars of length L0 is found where their length is the cube root of L0
/// assert!(largest.is_some_and(|point| (point.reaction + 9.530291997895e-3).abs() < 1e-12));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`PathFailure`] if the drive has no effect, or no equilibrium is found to begin with.
pub fn follow_path(
    assembly: &Assembly,
    drive: &Drive,
    start: Option<Configuration>,
    options: &PathOptions,
    observe: &mut dyn FnMut(usize, &PathPoint) -> bool,
) -> Result<Vec<PathBranch>, PathFailure> {
    resume_path(assembly, drive, start, options, PathRecord::default(), PathCallbacks { observe, keep: &mut |_| true })
}

/// Does the same as [`follow_path`], and goes on from what an interrupted run of the same path has recorded: of that
/// nothing is computed again.
pub(crate) fn resume_path(
    assembly: &Assembly,
    drive: &Drive,
    start: Option<Configuration>,
    options: &PathOptions,
    record: PathRecord,
    callbacks: PathCallbacks<'_>,
) -> Result<Vec<PathBranch>, PathFailure> {
    let (driven, first) = begin(assembly.model(Gauge::Held), drive, start, options)?;
    if driven.stays_straight(&first) {
        return Err(DriveError::StaysStraight.into());
    }
    follow_from(assembly, (driven, first), options, record, callbacks)
}

/// Follows the equilibria of a driven model from the first one, stretch by stretch where it snaps.
fn follow_from(
    assembly: &Assembly,
    (mut driven, mut first): (DrivenModel, Start),
    options: &PathOptions,
    mut record: PathRecord,
    callbacks: PathCallbacks<'_>,
) -> Result<Vec<PathBranch>, PathFailure> {
    let then = options.then.iter().map(|value| driven.parameter_at(*value));
    let ways = [driven.parameter(), driven.target()].into_iter().chain(then).collect();
    let mut seen = Seen::new(ways, callbacks);
    let kept = options.at.iter().copied().chain(options.stop.drive).map(|value| driven.parameter_at(value));
    let kept: Vec<f64> = kept.collect();
    let mut is_last = false;
    loop {
        let left = seen.left_of(&options.stop);
        let stop = PathStop { states: if is_last { Some(1) } else { left.states }, ..left };
        let mut watch = Stops::new(assembly, &stop, driven.has_conjugate_limits(), options.snap);
        let known = if options.snap { record.part(seen.stretch()) } else { mem::take(&mut record) };
        let settings = seen.settings(options, &stop, &driven);
        let found = match path::follow_path(&mut driven, first, &settings, &mut watch, &mut seen, known) {
            Err(_) if seen.stretch() > 0 => return Ok(seen.ended(PathEnd::NoMinimum)),
            found => found?,
        };
        let limit = found.first().and_then(snap::limit_point);
        let Some(limit) = limit.filter(|_| options.snap && !seen.has_enough(&options.stop)) else {
            return Ok(found.iter().zip(seen.points()).map(|(branch, points)| ended(branch, points, &stop)).collect());
        };
        let values = watch.values(&driven, &limit.state);
        seen.begin_stretch(limit);
        let Some(start) = snap::beyond(&mut driven, &limit.state.x, seen.target(), &kept, options.tolerance) else {
            return Ok(seen.ended(PathEnd::NoMinimum));
        };
        is_last = watch.passes(&driven, &values, &start);
        first = start;
    }
}

/// Checks that a drive has an effect on an assembly, in its drawn state or, `restarted`, in another one. Returns the
/// driven values at the beginning and at the end of its way.
pub(crate) fn check_drive(assembly: &Assembly, drive: &Drive, restarted: bool) -> Result<[f64; 2], DriveError> {
    let model = assembly.model(Gauge::Held);
    let drawn = model.values(&model.start());
    let driven = DrivenModel::new(model, drive, drawn, restarted)?;
    Ok([driven.drive_at(driven.parameter()), drive.to])
}

/// Makes the driven model and finds its equilibrium at the beginning.
fn begin(
    mut model: Model,
    drive: &Drive,
    start: Option<Configuration>,
    options: &PathOptions,
) -> Result<(DrivenModel, Start), PathFailure> {
    let drawn = model.values(&model.start());
    let restarted = start.is_some();
    let tension = start.and_then(|state| model.enter_well_held(&state).0.tension);
    let mut driven = DrivenModel::new(model, drive, drawn, restarted)?;
    let x = driven.model.start();
    let (x, tension) = if let Some(tension) = tension {
        // an equilibrium of any stability: the path's own iteration finds what the new support carries
        (x, driven.with_drive(tension))
    } else {
        let newton = Options { tolerance: options.tolerance, ..Options::default() };
        let (relaxed, model, x) =
            relax_model(driven.model.clone(), x, newton, &mut |_| true).map_err(|error| error.failure)?;
        driven.model = model;
        (x, relaxed.configuration.tension.unwrap_or_default())
    };
    let x = driven.about_best_axis(x, &tension);
    Ok((driven, Start { x, tension: Some(tension) }))
}

fn ended(branch: &Branch, mut points: Vec<PathPoint>, stop: &PathStop) -> PathBranch {
    let end = match branch.end {
        BranchEnd::Target => PathEnd::Arrived,
        BranchEnd::Returned => PathEnd::Returned,
        BranchEnd::Retraced => PathEnd::Retraced,
        BranchEnd::Length | BranchEnd::Marked => PathEnd::Stopped,
        BranchEnd::Steps if stop.states.is_some() => PathEnd::Stopped,
        BranchEnd::Steps => PathEnd::TooManySteps,
        BranchEnd::Failed => PathEnd::Failed,
        BranchEnd::Interrupted => PathEnd::Interrupted,
    };
    if matches!(branch.end, BranchEnd::Length | BranchEnd::Steps)
        && end == PathEnd::Stopped
        && let Some(last) = points.last_mut()
    {
        last.event = Some(PathEvent::Stop);
    }
    for (state, found) in &branch.half_branches {
        if let Some(point) = points.get_mut(*state).and_then(|point| point.branch_point.as_mut()) {
            point.half_branches = Some(*found);
        }
    }
    PathBranch { points, end }
}
