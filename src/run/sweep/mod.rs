//! Sweeps: the points of a scene with a table `[sweep]`, each computed as it would be alone, and the table of their results.
//!
//! A point is computed in its own folder, `points/0000`, ..., as by [`super::run`], so that points can be shared out to the
//! threads of this process ([`sweep`]), to processes on one machine ([`run_point`]), or to those of a cluster ([`Shard`]).
//! The table is made from these folders alone ([`assemble`]).

mod assemble;
pub(super) mod place;
mod pool;
mod record;
mod scalars;
mod shard;

use std::collections::BTreeSet;
use std::fs;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};

use super::belongings::Belongings;
use super::{Ledger, Observer, Progress, RunError, RunOptions, inputs, single};
use crate::output::files;
use crate::output::summary::{PointStatus, SweepSummary};
use crate::scene::{SceneFile, Sweep};
pub use assemble::{assemble, assemble_at};
pub use place::points;
use place::{POINTS, folder, point_folder};
use pool::Pool;
use record::Record;
pub use shard::{Shard, ShardError};

/// Exit status where the input is wrong.
const WRONG_INPUT: u8 = 2;

/// The report of a sweep.
#[derive(Clone, Debug, PartialEq)]
pub struct SweepReport {
    /// The content of `sweep.json`.
    pub summary: SweepSummary,
    /// The folder of the files.
    pub out: PathBuf,
    /// Number of points that an earlier run had finished and that were not computed again.
    pub kept: usize,
    /// Whether the observer stopped the sweep.
    pub interrupted: bool,
    /// Whether every study gave its answer at every point of this run: those of its shard, if it has one.
    pub converged: bool,
}

/// Computes the points of a scene with a table `[sweep]`, or those of a shard of them, and writes their files and the table.
///
/// The points are shared out to the threads, and every point has the bytes that it would have alone. With `resume` those that
/// an earlier run finished are kept. The observer is called with the number of finished points.
///
/// # Errors
/// [`RunError`] if the scene has no sweep or is wrong, or if its points cannot be written; a point that cannot be computed is
/// reported in the [`SweepReport`] instead.
pub fn sweep(
    file: &SceneFile,
    options: &RunOptions,
    shard: Option<Shard>,
    observer: Observer,
) -> Result<SweepReport, RunError> {
    let sweep = points(file)?;
    let own = shard.unwrap_or_default().points(sweep.len());
    let out = folder(file, options);
    check_base(&sweep, &out)?;
    own.iter().try_for_each(|&index| sweep.scene(index).map(|_| ()))?;
    if shard.is_none() {
        // on a disk that several machines share, the locks of other shards' drafts may not be seen
        files::remove_drafts(&out);
    }
    let kept = if options.resume { record::finished(&sweep, &out, &own) } else { Vec::new() };
    let rest: Vec<usize> = own.iter().copied().filter(|index| kept.binary_search(index).is_err()).collect();
    remove_leftovers(&sweep, &out)?;
    assemble(&sweep, &out)?;
    let (done, pool) = (AtomicUsize::new(kept.len()), Pool::new(options.threads, rest.len()));
    let of_run = RunOptions { out: Some(out.clone()), threads: Some(pool.threads_of_point()), ..*options };
    let report = || {
        let step = done.load(Ordering::Relaxed);
        observer(&Progress { study: POINTS.into(), step, of: Some(own.len()), residual: f64::NAN })
    };
    let computed = pool.over(&rest, |index| {
        let computed = run_point(&sweep, index, &of_run, &|_| report())?;
        done.fetch_add(usize::from(computed.is_some()), Ordering::Relaxed);
        Ok(if computed.is_some() { report() } else { ControlFlow::Break(()) })
    });
    let summary = assemble(&sweep, &out)?;
    let interrupted = computed?.is_break() && own.iter().any(|index| summary.missing.binary_search(index).is_ok());
    let unanswered = summary.unanswered.iter().any(|point| own.binary_search(&point.point).is_ok());
    Ok(SweepReport { converged: !unanswered, out, kept: kept.len(), interrupted, summary })
}

/// Computes a point of a sweep in its folder below that of the sweep, `options.out`, as [`super::run`] does with its scene.
/// With `options.resume` the point is left as it is if an earlier run finished it, and else its finished studies are kept.
/// Returns what became of the point; `None` if the observer stopped it.
///
/// A point whose scene cannot be computed has failed: its folder gets the reason.
///
/// # Errors
/// [`RunError`] if the scene of the point cannot be read or its folder cannot be written.
///
/// ```no_run
/// use foldwell::run::{RunOptions, assemble, points, read_scene, run_point};
/// use std::{ops::ControlFlow, path::Path};
///
/// let sweep = points(&read_scene(Path::new("sweep.toml"), &[])?)?;
/// let options = RunOptions { out: Some("sweep".into()), threads: Some(1), resume: true };
/// for index in 0..sweep.len() {
///     run_point(&sweep, index, &options, &|_| ControlFlow::Continue(()))?; // in any process and any order
/// }
/// let summary = assemble(&sweep, Path::new("sweep"))?;
/// assert!(summary.missing.is_empty());
/// # Ok::<(), foldwell::run::RunError>(())
/// ```
pub fn run_point(
    sweep: &Sweep,
    index: usize,
    options: &RunOptions,
    observer: Observer,
) -> Result<Option<PointStatus>, RunError> {
    let out = folder(sweep.file(), options);
    let (scene, folder) = (sweep.scene(index)?, point_folder(&out, index));
    if let Some(found) = options.resume.then(|| Record::finished(&scene, &folder)).flatten() {
        return Ok(Some(found.status()));
    }
    record::forget_failure(&folder)?;
    let options = RunOptions { out: Some(folder.clone()), ..*options };
    match single::run(&scene, &options, observer, &Ledger::default()) {
        Ok(report) if report.interrupted => Ok(None),
        Ok(report) if report.summary.converged() => Ok(Some(PointStatus::Converged)),
        Ok(_) => Ok(Some(PointStatus::NotConverged)),
        Err(error) if error.exit_status() == WRONG_INPUT => {
            clear(&scene, &folder)?;
            record::write_failure(&scene, &folder, &error)?;
            Ok(Some(PointStatus::Failed))
        }
        Err(error) => Err(error),
    }
}

/// Does the checks of [`sweep`] and those of [`super::check`] for every point; writes nothing.
pub(super) fn check(file: &SceneFile, options: &RunOptions) -> Result<(), RunError> {
    let (sweep, out) = (points(file)?, folder(file, options));
    check_base(&sweep, &out)?;
    (0..sweep.len()).try_for_each(|index| {
        let options = RunOptions { out: Some(point_folder(&out, index)), ..*options };
        single::check(&sweep.scene(index)?, &options)
    })
}

/// Checks the scene without its sweep, so that what is wrong at every point is said before anything is written.
fn check_base(sweep: &Sweep, out: &Path) -> Result<(), RunError> {
    inputs::check(sweep.file(), out)?;
    let options = RunOptions { out: Some(point_folder(out, 0)), ..RunOptions::default() };
    single::check(&sweep.base()?, &options)
}

/// Removes the files of points that an earlier, longer sweep wrote and this one does not have.
fn remove_leftovers(sweep: &Sweep, out: &Path) -> Result<(), RunError> {
    let base = sweep.base()?;
    for entry in fs::read_dir(out.join(POINTS)).into_iter().flatten().flatten() {
        let number = entry.file_name().to_str().and_then(|name| name.parse::<usize>().ok());
        if number.is_some_and(|number| number >= sweep.len() && point_folder(out, number) == entry.path()) {
            clear(&base, &entry.path())?;
            record::forget_failure(&entry.path())?;
            // fails, as intended, if the folder is not empty
            let _ = fs::remove_dir(entry.path());
        }
    }
    Ok(())
}

/// Removes the files that an earlier run wrote into the folder of a point.
fn clear(scene: &SceneFile, folder: &Path) -> Result<(), RunError> {
    let belongings = Belongings::new(scene, folder);
    for study in &scene.scene.studies {
        belongings.remove_others(&study.name.0, &BTreeSet::new())?;
    }
    Ok(record::remove(&folder.join(record::SUMMARY))?)
}
