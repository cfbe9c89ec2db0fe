//! The loop of a run: studies are checked, computed, timed and written, and their states are kept for later studies.

use super::belongings::Belongings;
use super::ledger::Ledger;
use super::log::Log;
use super::resume::{self, PreviousRun};
use super::studies::Studies;
use super::{RunError, RunOptions, RunReport, claim, inputs};
use crate::model::Assembly;
use crate::output::claim::Claim;
use crate::output::{OutputError, files};
use crate::run::{SheetSummary, Summary};
use crate::scene::notes::notes;
use crate::scene::spec::StudySpec;
use crate::scene::{SceneFile, digest};
use crate::sheet::Info;
use crate::study::{self, Answer, Checkpoints, Observer, PreviousAnswers};
use std::collections::{BTreeSet, HashMap};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

/// A run in progress.
pub(crate) struct Runner<'a> {
    studies: Studies<'a>,
    /// The folder of the files.
    out: PathBuf,
    /// Digest of the input, with which logs begin.
    digest: String,
    resumed: bool,
    kept: Vec<String>,
    /// Positions of the studies in the scene.
    order: HashMap<&'a str, usize>,
    belongings: Belongings,
    /// Files written by the current study.
    written: Mutex<BTreeSet<PathBuf>>,
    /// The log of the current study.
    log: Mutex<Option<Log>>,
    /// The claim on the folder, from [`Self::begin`] on.
    claim: Option<Claim>,
    ledger: Ledger,
    /// The answers of the studies that were computed, where they are wanted.
    pub(super) answers: Option<Vec<Answer>>,
}

impl<'a> Runner<'a> {
    /// Performs the remaining checks; nothing is written before or by it.
    pub(crate) fn new(
        file: &'a SceneFile,
        assembly: &'a Assembly,
        options: &RunOptions,
        observer: Observer<'a>,
        ledger: &Ledger,
    ) -> Result<Self, RunError> {
        let out = options.folder(file);
        let runner = Self {
            studies: Studies::new(file, assembly, PreviousAnswers::default(), observer),
            digest: String::new(),
            resumed: false,
            kept: Vec::new(),
            order: file.scene.studies.iter().enumerate().map(|(k, study)| (study.name.0.as_str(), k)).collect(),
            belongings: Belongings::new(file, &out),
            written: Mutex::default(),
            log: Mutex::default(),
            claim: None,
            out,
            ledger: ledger.clone(),
            answers: None,
        };
        for study in &file.scene.studies {
            study::check(&runner.studies.context(study, &runner))?;
        }
        inputs::check(file, &runner.out)?;
        Ok(runner)
    }

    /// Claims the folder, unless it is claimed already, and prepares it; with `resume`, keeps the studies that an
    /// earlier run of the same scene finished.
    ///
    /// The summary is written at once, with the studies that are kept, so that a later run cannot take files of this
    /// run for those of an earlier scene.
    pub(crate) fn begin(&mut self, resume: bool, claim: Option<Claim>) -> Result<(), RunError> {
        let digest = digest(self.studies.file)?;
        let claimed = || claim::of_run(&self.out, false, self.studies.observer);
        self.claim = Some(claim.map_or_else(claimed, Ok)?);
        let previous = if resume { PreviousRun::read(&self.out, &digest) } else { PreviousRun::default() };
        self.resumed = !previous.digest.is_empty();
        self.digest.clone_from(&digest);
        self.take_over(summary_of(self.studies.file, self.studies.assembly, digest), &previous)
    }

    /// Takes over the studies that an earlier run finished, and removes its unfinished files.
    fn take_over(&mut self, mut summary: Summary, previous: &PreviousRun) -> Result<(), RunError> {
        files::remove_drafts(&self.out);
        for study in &self.studies.file.scene.studies {
            files::remove_drafts(&self.out.join(&study.name.0));
            if let Some((found, state)) = previous.study(self.studies.file, (&self.out, &self.belongings), study) {
                self.studies.earlier.states.extend(state.map(|state| (found.name.clone(), state)));
                let paths = resume::paths(&self.out, study)?;
                self.studies.earlier.paths.extend(paths.map(|paths| (found.name.clone(), paths)));
                self.kept.push(found.name.clone());
                summary.studies.push(found);
            }
        }
        let places = summary.studies.iter().map(|study| self.order[study.name.as_str()]).collect();
        let (out, kept) = (self.out.clone(), self.kept.clone());
        self.ledger.open(RunReport { summary, out, kept, interrupted: false }, places)
    }

    /// Computes one study and writes its files; files that an earlier run wrote for it are removed. Does nothing if the
    /// study is kept.
    pub(crate) fn study(&mut self, study: &StudySpec) -> Result<(), RunError> {
        if self.kept.contains(&study.name.0) {
            return Ok(());
        }
        self.take_written();
        self.ledger.begin(study, self.order[study.name.0.as_str()]);
        let done = self.compute(study).and_then(|answer| self.finished(study, answer));
        // the studies before this one remain recorded as finished
        done.or_else(|error| self.ledger.write().and(Err(error)))
    }

    fn compute(&mut self, study: &StudySpec) -> Result<Answer, RunError> {
        let answer = self.studies.answer(study, self)?;
        self.studies.context(study, self).end_steps();
        for (name, artifact) in &answer.files {
            artifact.write(&self.path(name))?;
        }
        if let Some(state) = answer.state.as_ref().filter(|_| resume::is_start(self.studies.file, &study.name.0)) {
            resume::write_state(&self.path(resume::state_file(&study.name.0)), state)?;
        }
        self.studies.keep(&answer);
        Ok(answer)
    }

    /// Records the result of a study. A run that was stopped removes no files of earlier runs, since its own are
    /// incomplete.
    fn finished(&mut self, study: &StudySpec, mut answer: Answer) -> Result<(), RunError> {
        let found = &mut answer.summary;
        if !self.interrupted() {
            self.belongings.remove_others(&found.name, &self.take_written())?;
        }
        found.files = Some(self.belongings.record(&found.name)?);
        self.ledger.finished(found.clone(), self.order[study.name.0.as_str()])?;
        if let Some(answers) = &mut self.answers {
            answers.push(answer);
        }
        Ok(())
    }

    fn take_written(&self) -> BTreeSet<PathBuf> {
        std::mem::take(&mut *self.written.lock().unwrap_or_else(PoisonError::into_inner))
    }

    /// Whether the observer asked to stop.
    pub(crate) fn interrupted(&self) -> bool {
        self.studies.interrupted()
    }

    /// Returns the path of a file in the folder of the run, and records that the current study writes it.
    fn path(&self, name: impl AsRef<Path>) -> PathBuf {
        let path = self.out.join(name);
        self.written.lock().unwrap_or_else(PoisonError::into_inner).insert(path.clone());
        path
    }

    /// Ends the run and returns its report, and the answers that were kept.
    pub(crate) fn finish(self) -> Result<(RunReport, Vec<Answer>), RunError> {
        Ok((self.ledger.end(self.interrupted())?, self.answers.unwrap_or_default()))
    }
}

impl Checkpoints for Runner<'_> {
    fn log(&self, file: &str) -> Result<Vec<String>, OutputError> {
        let (log, kept) = Log::begin(self.out.join(file), &self.digest, self.resumed)?;
        *self.log.lock().unwrap_or_else(PoisonError::into_inner) = Some(log);
        Ok(kept)
    }

    fn log_line(&self, line: &str) -> Result<(), OutputError> {
        let mut log = self.log.lock().unwrap_or_else(PoisonError::into_inner);
        log.as_mut().map_or(Ok(()), |log| log.append(line))
    }
}

/// Returns the summary of a run without its studies.
pub(super) fn summary_of(file: &SceneFile, assembly: &Assembly, digest: String) -> Summary {
    let info = Info::new(assembly.sheet());
    let (terms, mut left_out) = built_terms(assembly);
    left_out.extend(file.scene.studies.iter().filter_map(|study| study::left_out(assembly, study)));
    let held = assembly.drawn().held.len() + assembly.terms().pinned();
    Summary {
        version: env!("CARGO_PKG_VERSION"),
        scene: file.path().display().to_string(),
        settings: file.settings().to_vec(),
        title: file.title(),
        units: file.scene.units.clone(),
        digest,
        sheet: SheetSummary {
            vertices: info.vertices,
            edges: assembly.sheet().edges.len(),
            faces: info.faces,
            polygons: info.polygons,
            developable: info.developable,
            cells: assembly.tiling().cells,
            degrees_of_freedom: assembly.drawn().coordinates.len() - held,
        },
        terms,
        left_out,
        notes: notes(file, assembly),
        studies: vec![],
    }
}

/// Returns the terms of the model, and those that it does not have, each with the reason.
fn built_terms(assembly: &Assembly) -> (Vec<String>, Vec<String>) {
    let terms = assembly.terms();
    let no_facets = if assembly.tiling().facets().next().is_some() { "" } else { "facets: every face is a triangle" };
    let table = [
        ("bars", terms.bars.is_some(), "bars: not in [energy]"),
        ("creases", terms.creases.is_some(), "creases: not in [energy]"),
        ("facets", terms.facets.is_some(), no_facets),
        ("locks", !terms.locks.is_empty(), "locks: none given"),
        ("pins", !terms.pins.is_empty(), "pins: none given"),
        ("loads", terms.is_loaded(), "loads: none given"),
    ];
    let (there, missing): (Vec<_>, Vec<_>) = table.into_iter().partition(|(_, there, _)| *there);
    let terms = there.into_iter().map(|(term, ..)| term.to_owned()).collect();
    (terms, missing.into_iter().map(|(_, _, why)| why.to_owned()).collect())
}
