//! The studies of a run: they are computed one after the other, and later ones are given what earlier ones found.

use super::RunError;
use super::ledger::INTERRUPTED;
use crate::analysis::shown_cells::ShownCells;
use crate::model::Assembly;
use crate::scene::SceneFile;
use crate::scene::spec::StudySpec;
use crate::study::{self, Answer, Checkpoints, Context, Observer, PreviousAnswers};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

/// The studies of a scene on its assembly, with what those that were computed found.
pub(super) struct Studies<'a> {
    pub file: &'a SceneFile,
    pub assembly: &'a Assembly,
    view: ShownCells,
    pub earlier: PreviousAnswers,
    pub observer: Observer<'a>,
    interrupted: AtomicBool,
}

impl<'a> Studies<'a> {
    pub fn new(file: &'a SceneFile, assembly: &'a Assembly, earlier: PreviousAnswers, observer: Observer<'a>) -> Self {
        Self { file, assembly, view: ShownCells::new(assembly), earlier, observer, interrupted: AtomicBool::new(false) }
    }

    /// Returns what a study is given.
    pub fn context<'b>(&'b self, study: &'b StudySpec, checkpoints: &'b dyn Checkpoints) -> Context<'b> {
        let Self { file, assembly, view, earlier, observer, interrupted } = self;
        Context { file, assembly, view, study, earlier, checkpoints, observer: *observer, interrupted }
    }

    /// Whether the observer has stopped the run.
    pub fn interrupted(&self) -> bool {
        self.interrupted.load(Ordering::Relaxed)
    }

    /// Computes and times a study.
    pub fn answer(&self, study: &StudySpec, checkpoints: &dyn Checkpoints) -> Result<Answer, RunError> {
        let clock = Instant::now();
        let mut answer = study::compute(&self.context(study, checkpoints))?;
        answer.summary.seconds = clock.elapsed().as_secs_f64();
        if self.interrupted() && !answer.summary.converged {
            answer.summary.reason = Some(INTERRUPTED.to_owned()); // each method describes an interruption differently
        }
        Ok(answer)
    }

    /// Keeps the paths and the state of an answer for later studies.
    pub fn keep(&mut self, answer: &Answer) {
        let name = &answer.summary.name;
        self.earlier.paths.insert(name.clone(), answer.paths.clone());
        self.earlier.states.extend(answer.state.clone().map(|state| (name.clone(), state)));
    }
}
