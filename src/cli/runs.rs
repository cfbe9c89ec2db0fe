//! `foldwell run`: the scenes of a call, one after the other.

use std::io::{self, Write};
use std::sync::Arc;

use foldwell::output::json::to_json;
use foldwell::run::{self, Ledger, RunOptions, RunReport, Shard, SweepReport};
use foldwell::scene::SceneFile;
use serde::{Serialize, Serializer};

use super::ending::{CommandFailure, FAILED, INTERRUPTED, say};
use crate::describe::{describe_run, describe_sweep};
use crate::progress::ProgressWatch;

/// Options for the messages of a run.
pub(super) struct Told {
    /// Nothing but errors.
    pub(super) quiet: bool,
    /// The summary on standard output.
    pub(super) json: bool,
}

/// What came of a scene.
enum SceneOutcome {
    Run(RunReport),
    Sweep(SweepReport),
}

/// As its summary.
impl Serialize for SceneOutcome {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Run(report) => report.summary.serialize(serializer),
            Self::Sweep(report) => report.summary.serialize(serializer),
        }
    }
}

/// Computes the studies of some scenes, or a shard of their points, one scene after the other; the status is that of
/// the first that has another than 0. Ctrl-C ends the scene at work and leaves out those after it.
pub(super) fn run_scenes(
    scenes: Vec<(SceneFile, RunOptions)>,
    shard: Option<Shard>,
    told: &Told,
) -> Result<u8, CommandFailure> {
    let watch = Arc::new(ProgressWatch::new(told.quiet));
    let (several, mut status) = (scenes.len() > 1, 0);
    let mut all = Vec::new();
    for (scene, options) in scenes {
        let found = if shard.is_some() || scene.scene.sweep.is_some() {
            sweep_scene(scene, options, shard, &watch)?.map(SceneOutcome::Sweep)
        } else {
            run_scene(scene, options, &watch)?.map(SceneOutcome::Run)
        };
        let Some(found) = found else { return Ok(INTERRUPTED) };
        found.tell(told)?;
        let own = found.status();
        all.push(found);
        status = if status == 0 || own == INTERRUPTED { own } else { status };
        if own == INTERRUPTED {
            break;
        }
    }
    match &all[..] {
        _ if !told.json => Ok(0),
        [one] if !several => say(&to_json(one)),
        _ => say(&to_json(&all)),
    }?;
    Ok(status)
}

impl SceneOutcome {
    /// Prints the results, and the remarks about the scene.
    fn tell(&self, told: &Told) -> Result<(), CommandFailure> {
        let notes = if let Self::Run(report) = self { &report.summary.notes[..] } else { &[] };
        for note in notes.iter().filter(|_| !told.quiet) {
            // an error is ignored: there is no other place for the message if standard error is closed
            let _ = writeln!(io::stderr(), "note: {note}");
        }
        if told.quiet || told.json {
            return Ok(());
        }
        say(&match self {
            Self::Run(report) => describe_run(report),
            Self::Sweep(report) => describe_sweep(report),
        })?;
        Ok(())
    }

    fn status(&self) -> u8 {
        match self {
            Self::Run(report) => status_of(report.interrupted, report.summary.converged()),
            Self::Sweep(report) => status_of(report.interrupted, report.converged),
        }
    }
}

/// Computes the studies of one scene; `None` if Ctrl-C ended the run before its summary was begun.
fn run_scene(
    scene: SceneFile,
    options: RunOptions,
    watch: &Arc<ProgressWatch>,
) -> Result<Option<RunReport>, CommandFailure> {
    let ledger = Ledger::default();
    let books = ledger.clone();
    let found = watch.over(move |watch| run::run(&scene, &options, &|step| watch.step(step), &books));
    watch.finish();
    match found.map_err(CommandFailure::Thread)? {
        Some(report) => Ok(Some(report?)),
        None => Ok(ledger.close(true)?),
    }
}

pub(super) fn status_of(interrupted: bool, converged: bool) -> u8 {
    match (interrupted, converged) {
        (true, _) => INTERRUPTED,
        (false, true) => 0,
        (false, false) => FAILED,
    }
}

/// Computes the points of a sweep; `None` if Ctrl-C ended it before it had a folder.
fn sweep_scene(
    scene: SceneFile,
    options: RunOptions,
    shard: Option<Shard>,
    watch: &Arc<ProgressWatch>,
) -> Result<Option<SweepReport>, CommandFailure> {
    let (file, of_sweep) = (scene.clone(), options.clone());
    let found = watch.over(move |watch| run::sweep(&file, &of_sweep, shard, &|step| watch.step(step)));
    watch.finish();
    if let Some(report) = found.map_err(CommandFailure::Thread)? {
        return Ok(Some(report?));
    }
    let out = options.out.clone().unwrap_or_default();
    let summary = run::assemble_at(&scene, &options)?;
    Ok(summary.map(|summary| SweepReport { summary, out, kept: 0, interrupted: true, converged: false }))
}
