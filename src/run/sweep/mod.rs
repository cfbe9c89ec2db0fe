//! Sweeps: the points of a scene with a table `[sweep]`, each computed as it would be alone, and the table of their
//! results.
//!
//! A point is computed in its own folder, `points/0000`, ..., as by [`super::run`], so that points can be shared out to
//! the threads of this process ([`sweep`]), to processes on one machine ([`run_point`]), or to those of a cluster
//! ([`Shard`]). The table is made from these folders alone ([`assemble`]).

mod assemble;
pub(super) mod place;
mod pool;
mod record;
mod scalars;
mod shard;
mod summary;

use std::collections::BTreeSet;
use std::fs;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;
use std::sync::atomic::{AtomicUsize, Ordering};

use super::belongings::Belongings;
use super::{Ledger, Observer, Progress, RunError, RunOptions, claim, compute, inputs, single};
use crate::output::{OutputError, files};
use crate::scene::{SceneFile, Sweep};
use crate::study::PreviousAnswers;
use assemble::Board;
pub use assemble::{SweepRow, assemble, assemble_at, table_of};
pub use place::points;
use place::{CHECKS, POINTS, point_folder};
use pool::Pool;
use record::Record;
pub use shard::{Shard, ShardError};
pub use summary::{PointStatus, SweepSummary, UnansweredPoint};

/// Exit status where the input is wrong.
const WRONG_INPUT: u8 = 2;
/// Number of points that are checked between two calls of the observer.
const OBSERVED: usize = 256;

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

/// Computes the points of a scene with a table `[sweep]`, or those of a shard of them, and writes their files and the
/// table.
///
/// The points are shared out to the threads, and every point has the bytes that it would have alone. With `resume`
/// those that an earlier run finished are kept. The observer is called with the number of finished points.
///
/// # Errors
/// [`RunError`] if the scene has no sweep or is wrong, or if its points cannot be written; a point that cannot be
/// computed is reported in the [`SweepReport`] instead.
pub fn sweep(
    file: &SceneFile,
    options: &RunOptions,
    shard: Option<Shard>,
    observer: Observer,
) -> Result<SweepReport, RunError> {
    let (sweep, out) = (points(file)?, options.folder(file));
    let own = shard.unwrap_or_default().points(sweep.len());
    check_base(&sweep, &out)?;
    // a folder that does not exist is made when every scene is known to be right
    let claim = out.exists().then(|| claim::of_sweep(&out, &sweep)).transpose()?;
    let board = Board::new(&sweep, &out);
    let Some(kept) = survey(&board, &own, options.resume, observer)? else {
        let summary = board.summary()?;
        return Ok(SweepReport { summary, out: out.clone(), kept: 0, interrupted: true, converged: false });
    };
    let _claim = claim.map_or_else(|| claim::of_sweep(&out, &sweep), Ok)?;
    if shard.is_none() {
        // on a disk that several machines share, the locks of other shards' drafts may not be seen
        files::remove_drafts(&out);
    }
    let rest: Vec<usize> = own.iter().copied().filter(|index| kept.binary_search(index).is_err()).collect();
    remove_leftovers(&sweep, &out)?;
    board.write()?;
    let (done, pool) = (AtomicUsize::new(kept.len()), Pool::new(options.threads, rest.len()));
    let of_run = RunOptions { out: Some(out.clone()), threads: Some(pool.threads_of_point), ..*options };
    let report = || observer(&progress(POINTS, done.load(Ordering::Relaxed), own.len()));
    let computed = pool.over(&rest, |index| {
        let computed = run_point(&sweep, index, &of_run, &|_| report());
        board.look_up(index)?;
        let computed = computed?;
        done.fetch_add(usize::from(computed.is_some()), Ordering::Relaxed);
        Ok(if computed.is_some() { report() } else { ControlFlow::Break(()) })
    });
    let summary = board.write()?;
    let interrupted = computed?.is_break() && own.iter().any(|index| summary.missing.binary_search(index).is_ok());
    let unanswered = summary.unanswered.iter().any(|point| own.binary_search(&point.point).is_ok());
    Ok(SweepReport { converged: !unanswered, out: out.clone(), kept: kept.len(), interrupted, summary })
}

/// Checks the scenes of the points `own` of a run, and looks up what became of all points in earlier runs. Returns the
/// points of `own` that need not be computed again, none unless `resume`; `None` if the observer ends it.
fn survey(board: &Board<'_>, own: &[usize], resume: bool, observer: Observer) -> Result<Option<Vec<usize>>, RunError> {
    let (sweep, mut kept) = (board.sweep, Vec::new());
    for index in 0..sweep.len() {
        let seen = index + 1;
        if seen.is_multiple_of(OBSERVED) && observer(&progress(CHECKS, seen, sweep.len())).is_break() {
            return Ok(None);
        }
        let (is_own, folder) = (own.binary_search(&index).is_ok(), point_folder(board.out, index));
        if !is_own {
            board.look_up(index)?;
            continue;
        }
        let scene = sweep.scene(index)?;
        if resume {
            files::remove_drafts(&folder);
        }
        let found = Record::read(&scene, &folder);
        if resume && found.as_ref().is_some_and(|found| found.is_whole(&scene, &folder)) {
            kept.push(index);
        }
        board.set(index, found.as_ref());
    }
    Ok(Some(kept))
}

/// Returns the progress of work over points.
fn progress(work: &str, step: usize, of: usize) -> Progress {
    Progress { study: work.to_owned(), step, of: Some(of), residual: f64::NAN, part: f64::NAN }
}

/// Checks the scenes of all points as [`sweep`] does before it computes anything; of a sweep that writes nothing.
///
/// # Errors
/// [`RunError`] if the scene, or that of a point, is wrong.
pub fn check_scenes(sweep: &Sweep) -> Result<(), RunError> {
    check_base(sweep, Path::new(""))?;
    Ok((0..sweep.len()).try_for_each(|index| sweep.scene(index).map(|_| ()))?)
}

/// Computes points of a sweep on the threads of this process and writes nothing. Returns the row of each, none for
/// those that the observer stopped.
///
/// # Errors
/// [`RunError`] if the scene of a point cannot be read.
pub fn rows(
    sweep: &Sweep,
    own: &[usize],
    threads: Option<usize>,
    observer: Observer,
) -> Result<Vec<Option<SweepRow>>, RunError> {
    let (done, pool) = (AtomicUsize::new(0), Pool::new(threads, own.len()));
    let found: Vec<OnceLock<SweepRow>> = own.iter().map(|_| OnceLock::new()).collect();
    let report = || observer(&progress(POINTS, done.load(Ordering::Relaxed), own.len()));
    let all: Vec<usize> = (0..own.len()).collect();
    let _ended = pool.over(&all, |k| {
        let Some(record) = in_memory(&sweep.scene(own[k])?, pool.threads_of_point, &|_| report())? else {
            return Ok(ControlFlow::Break(()));
        };
        found[k].get_or_init(|| SweepRow::new(Some(&record)));
        done.fetch_add(1, Ordering::Relaxed);
        Ok(report())
    })?;
    Ok(found.into_iter().map(OnceLock::into_inner).collect())
}

/// Computes the scene of a point in memory; `None` if the observer stopped it.
fn in_memory(scene: &SceneFile, threads: usize, observer: Observer) -> Result<Option<Record>, RunError> {
    let assembly = single::assembly(scene);
    match assembly.and_then(|assembly| compute(scene, &assembly, PreviousAnswers::default(), Some(threads), observer)) {
        Ok(computed) if computed.interrupted => Ok(None),
        Ok(computed) => Ok(Some(Record::of(&computed.summary))),
        Err(error) if error.exit_status() == WRONG_INPUT => Ok(Some(Record::Failed(error.to_string()))),
        Err(error) => Err(error),
    }
}

/// Computes a point of a sweep in its folder below that of the sweep, `options.out`, as [`super::run`] does with its
/// scene. With `options.resume` the point is left as it is if an earlier run finished it, and else its finished studies
/// are kept. Returns what became of the point; `None` if the observer stopped it.
///
/// While another run computes this point, it waits for the end of that. A point whose scene cannot be computed has
/// failed: its folder gets the reason.
///
/// # Errors
/// [`RunError`] if the scene of the point cannot be read, its folder cannot be written, or a run of another scene is
/// writing into the folder of the sweep.
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
    let out = options.folder(sweep.file());
    let (scene, folder) = (sweep.scene(index)?, point_folder(&out, index));
    let _of_sweep = claim::of_sweep(&out, sweep)?;
    let claim = match claim::of_run(&folder, true, observer) {
        Err(OutputError::Claimed { .. }) => return Ok(None),
        found => found?,
    };
    if let Some(found) = options.resume.then(|| Record::finished(&scene, &folder)).flatten() {
        return Ok(Some(found.status()));
    }
    record::forget_failure(&folder)?;
    let options = RunOptions { out: Some(folder.clone()), ..*options };
    match single::run_with(&scene, &options, observer, &Ledger::default(), Some(claim)) {
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
    let (sweep, out) = (points(file)?, options.folder(file));
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
    Ok(files::remove(&folder.join(record::SUMMARY))?)
}
