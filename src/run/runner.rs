//! What the studies of one run share: the built scene, the folder, the summary, and the states already found.

use super::ledger::{INTERRUPTED, Ledger};
use super::resume::{Earlier, Kept, write_state};
use super::{
    Observer, Progress, RunError, RunOptions, RunReport, bloch, branches, landscape, studies, surface, trace, wells,
};
use crate::analysis::view::View;
use crate::numerics::parallel;
use crate::output::files;
use crate::output::summary::{SheetSummary, StudySummary, Summary};
use crate::scene::build::Built;
use crate::scene::spec::{StudyKind, StudySpec};
use crate::scene::{SceneFile, digest};
use crate::sheet::Info;
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};

/// One run.
pub struct Runner<'a> {
    /// The scene as written.
    pub file: &'a SceneFile,
    /// The scene as built.
    pub built: &'a Built,
    /// What pictures show.
    pub view: View,
    /// Where files go.
    pub out: PathBuf,
    resumed: bool,
    states: HashMap<String, Kept>,
    kept: Vec<String>,
    summary: Summary,
    observer: Observer<'a>,
    interrupted: AtomicBool,
    ledger: Ledger,
}

impl<'a> Runner<'a> {
    /// Checks what is left to check and makes the folder ready; nothing is written before this.
    ///
    /// The summary is written at once, with what is kept: a later run must not take files of this one for those of an
    /// earlier scene.
    pub fn new(
        file: &'a SceneFile,
        built: &'a Built,
        options: &RunOptions,
        observer: Observer<'a>,
        ledger: &Ledger,
    ) -> Result<Self, RunError> {
        parallel::set_threads(options.threads.unwrap_or(0));
        let stem = || PathBuf::from(file.path().file_stem().unwrap_or_default());
        let out = options.out.clone().unwrap_or_else(stem);
        let view = View::new(&built.sheet, &built.tiling, built.surroundings, built.shown);
        for study in &file.scene.studies {
            studies::check(file, built, &view, study)?;
        }
        let digest = digest(file)?;
        let earlier = if options.resume { Earlier::read(&out, &digest) } else { Earlier::default() };
        let resumed = earlier.is_of_this_scene();
        let summary = summary(file, built, digest);
        let (states, kept, interrupted) = (HashMap::new(), Vec::new(), AtomicBool::new(false));
        let ledger = ledger.clone();
        let mut runner = Self { file, built, view, out, resumed, states, kept, summary, observer, interrupted, ledger };
        runner.keep(&earlier)?;
        Ok(runner)
    }

    /// Takes over what an earlier run finished, and removes what it left half-written.
    fn keep(&mut self, earlier: &Earlier) -> Result<(), RunError> {
        files::remove_drafts(&self.out);
        for study in &self.file.scene.studies {
            files::remove_drafts(&self.out.join(&study.name.0));
            if let Some((summary, state)) = earlier.study(self.file, &self.out, study) {
                self.states.extend(state.map(|state| (summary.name.clone(), state)));
                self.kept.push(summary.name.clone());
                self.summary.studies.push(summary);
            }
        }
        self.write_summary()
    }

    /// Computes one study, writes its files, and the summary so far. A study that is kept is left as it is.
    pub fn study(&mut self, study: &StudySpec) -> Result<(), RunError> {
        if self.kept.contains(&study.name.0) {
            return Ok(());
        }
        self.ledger.begin(study, self.place(&study.name.0));
        let mut found = match &*study.kind {
            StudyKind::Relax(spec) => studies::relax(self, study, spec)?,
            StudyKind::Modes(spec) => studies::modes(self, study, spec)?,
            StudyKind::Branches(_) => branches::study(self, study)?,
            StudyKind::Trace(spec) => trace::study(self, study, spec)?,
            StudyKind::Surface(spec) => surface::study(self, study, spec)?,
            StudyKind::Landscape(spec) => landscape::study(self, study, spec)?,
            StudyKind::Bloch(spec) => bloch::study(self, study, spec)?,
            StudyKind::Wells(spec) => wells::study(self, study, spec)?,
        };
        if self.interrupted() && !found.converged {
            found.reason = Some(INTERRUPTED.to_owned()); // each method has its own words for being stopped
        }
        self.push(found)
    }

    /// How many of the finished studies stand before this one in the scene.
    fn place(&self, name: &str) -> usize {
        let before = self.file.scene.studies.iter().take_while(|study| study.name.0 != name);
        before.filter(|study| self.summary.studies.iter().any(|done| done.name == study.name.0)).count()
    }

    fn push(&mut self, study: StudySummary) -> Result<(), RunError> {
        self.summary.studies.push(study);
        let order = |name: &str| self.file.scene.studies.iter().position(|study| study.name.0 == name);
        self.summary.studies.sort_by_key(|study| order(&study.name));
        self.write_summary()
    }

    fn write_summary(&self) -> Result<(), RunError> {
        self.ledger.write(self.report())
    }

    /// What the run has done so far.
    fn report(&self) -> RunReport {
        RunReport {
            summary: self.summary.clone(),
            out: self.out.clone(),
            kept: self.kept.clone(),
            interrupted: self.interrupted(),
            notes: self.built.notes.clone(),
        }
    }

    /// Keeps the state in which a study ended for those that start from it.
    pub fn keep_state(&mut self, study: &StudySpec, state: Kept) -> Result<(), RunError> {
        write_state(self.file, &self.out, &study.name.0, &state)?;
        self.states.insert(study.name.0.clone(), state);
        Ok(())
    }

    /// Whether the run goes on where an earlier one of the same scene ended.
    pub fn resumed(&self) -> bool {
        self.resumed
    }

    /// The state in which a study ended.
    pub fn state(&self, name: &str) -> Option<&Kept> {
        self.states.get(name)
    }

    /// Tells the observer of a step; false: stop.
    pub fn watch(&self, progress: &Progress) -> bool {
        let go_on = (self.observer)(progress).is_continue();
        self.interrupted.fetch_or(!go_on, Ordering::Relaxed);
        go_on
    }

    /// Whether the observer asked to stop.
    pub fn interrupted(&self) -> bool {
        self.interrupted.load(Ordering::Relaxed)
    }

    /// File of a study in the folder.
    pub fn path(&self, name: impl AsRef<Path>) -> PathBuf {
        self.out.join(name)
    }

    /// Ends the run.
    pub fn finish(self) -> Result<RunReport, RunError> {
        Ok(self.report())
    }
}

fn summary(file: &SceneFile, built: &Built, digest: String) -> Summary {
    let info = Info::new(&built.sheet);
    let (terms, mut left_out) = built.terms();
    left_out.extend(file.scene.studies.iter().filter_map(|study| surface::left_out(built, study)));
    let held = built.drawn.held.len() + built.recipe.pins.iter().flat_map(|(_, axes)| axes).filter(|a| **a).count();
    Summary {
        version: env!("CARGO_PKG_VERSION"),
        scene: file.path().display().to_string(),
        digest,
        sheet: SheetSummary {
            vertices: info.vertices,
            edges: info.edges,
            faces: info.faces,
            polygons: info.polygons,
            developable: info.developable,
            cells: built.tiling.cells,
            degrees_of_freedom: built.drawn.coordinates.len() - held,
        },
        terms,
        left_out,
        studies: vec![],
    }
}
