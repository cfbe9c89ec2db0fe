//! What the studies of one run share: the assembly, the folder, the summary, and the states already found.

use super::belongings::Belongings;
use super::ledger::{INTERRUPTED, Ledger};
use super::resume::{Earlier, Kept, is_start, write_state};
use super::{
    Observer, Progress, RunError, RunOptions, RunReport, bloch, branches, inputs, landscape, studies, surface, trace,
    wells,
};
use crate::analysis::view::View;
use crate::model::Assembly;
use crate::output::files;
use crate::output::summary::{SheetSummary, StudySummary, Summary};
use crate::scene::build::notes;
use crate::scene::spec::{StudyKind, StudySpec};
use crate::scene::{SceneFile, digest};
use crate::sheet::Info;
use std::collections::{BTreeSet, HashMap};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};

/// One run.
pub struct Runner<'a> {
    /// The scene as written.
    pub file: &'a SceneFile,
    /// The sheet with its boundary conditions and terms.
    pub assembly: &'a Assembly,
    /// What pictures show.
    pub view: View,
    /// Where files go.
    pub out: PathBuf,
    resumed: bool,
    states: HashMap<String, Kept>,
    kept: Vec<String>,
    /// Places of studies in the scene.
    order: HashMap<&'a str, usize>,
    belongings: Belongings,
    /// Files of the study that is computed.
    written: Mutex<BTreeSet<PathBuf>>,
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
        assembly: &'a Assembly,
        options: &RunOptions,
        observer: Observer<'a>,
        ledger: &Ledger,
    ) -> Result<Self, RunError> {
        let stem = || PathBuf::from(file.path().file_stem().unwrap_or_default());
        let out = options.out.clone().unwrap_or_else(stem);
        let view = View::new(assembly);
        for study in &file.scene.studies {
            studies::check(file, assembly, &view, study)?;
        }
        inputs::check(file, &out)?;
        let digest = digest(file)?;
        let earlier = if options.resume { Earlier::read(&out, &digest) } else { Earlier::default() };
        let resumed = earlier.is_of_this_scene();
        let mut runner = Self {
            file,
            assembly,
            view,
            resumed,
            states: HashMap::new(),
            kept: Vec::new(),
            order: file.scene.studies.iter().enumerate().map(|(k, study)| (study.name.0.as_str(), k)).collect(),
            belongings: Belongings::new(file, &out),
            written: Mutex::default(),
            out,
            observer,
            interrupted: AtomicBool::new(false),
            ledger: ledger.clone(),
        };
        runner.keep(summary(file, assembly, digest), &earlier)?;
        Ok(runner)
    }

    /// Takes over what an earlier run finished, and removes what it left half-written.
    fn keep(&mut self, mut summary: Summary, earlier: &Earlier) -> Result<(), RunError> {
        files::remove_drafts(&self.out);
        for study in &self.file.scene.studies {
            files::remove_drafts(&self.out.join(&study.name.0));
            if let Some((found, state)) = earlier.study(self.file, (&self.out, &self.belongings), study) {
                self.states.extend(state.map(|state| (found.name.clone(), state)));
                self.kept.push(found.name.clone());
                summary.studies.push(found);
            }
        }
        let places = summary.studies.iter().map(|study| self.order[study.name.as_str()]).collect();
        let (out, kept, notes) = (self.out.clone(), self.kept.clone(), notes(self.file, self.assembly));
        self.ledger.open(RunReport { summary, out, kept, interrupted: false, notes }, places)
    }

    /// Computes one study and writes its files; what an earlier run left of it goes. A study that is kept is left as it is.
    pub fn study(&mut self, study: &StudySpec) -> Result<(), RunError> {
        if self.kept.contains(&study.name.0) {
            return Ok(());
        }
        self.take_written();
        self.ledger.begin(study, self.order[study.name.0.as_str()]);
        match self.compute(study).and_then(|found| self.finished(study, found)) {
            Ok(()) => Ok(()),
            // the studies before it stay done
            Err(error) => self.ledger.write().and(Err(error)),
        }
    }

    fn compute(&mut self, study: &StudySpec) -> Result<StudySummary, RunError> {
        match &*study.kind {
            StudyKind::Relax(spec) => studies::relax(self, study, spec),
            StudyKind::Modes(spec) => studies::modes(self, study, spec),
            StudyKind::Branches(_) => branches::study(self, study),
            StudyKind::Trace(spec) => trace::study(self, study, spec),
            StudyKind::Surface(spec) => surface::study(self, study, spec),
            StudyKind::Landscape(spec) => landscape::study(self, study, spec),
            StudyKind::Bloch(spec) => bloch::study(self, study, spec),
            StudyKind::Wells(spec) => wells::study(self, study, spec),
        }
    }

    /// Takes in what a study found. A run that was stopped removes nothing: what it would have written is not there.
    fn finished(&self, study: &StudySpec, mut found: StudySummary) -> Result<(), RunError> {
        if !self.interrupted() {
            self.belongings.remove_others(&found.name, &self.take_written())?;
        } else if !found.converged {
            found.reason = Some(INTERRUPTED.to_owned()); // each method has its own words for being stopped
        }
        found.files = Some(self.belongings.record(&found.name)?);
        self.ledger.finished(found, self.order[study.name.0.as_str()])
    }

    fn take_written(&self) -> BTreeSet<PathBuf> {
        std::mem::take(&mut *self.written.lock().unwrap_or_else(PoisonError::into_inner))
    }

    /// Keeps the state in which a study ended for those that start from it.
    pub fn keep_state(&mut self, study: &StudySpec, state: Kept) -> Result<(), RunError> {
        if is_start(self.file, &study.name.0) {
            self.path(format!("{}.state.json", study.name.0));
        }
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

    /// A file in the folder that the present study writes.
    pub fn path(&self, name: impl AsRef<Path>) -> PathBuf {
        let path = self.out.join(name);
        self.written.lock().unwrap_or_else(PoisonError::into_inner).insert(path.clone());
        path
    }

    /// Ends the run.
    pub fn finish(self) -> Result<RunReport, RunError> {
        self.ledger.end(self.interrupted())
    }
}

fn summary(file: &SceneFile, assembly: &Assembly, digest: String) -> Summary {
    let info = Info::new(assembly.sheet());
    let (terms, mut left_out) = built_terms(assembly);
    left_out.extend(file.scene.studies.iter().filter_map(|study| surface::left_out(assembly, study)));
    let held = assembly.drawn().held.len() + assembly.terms().pinned();
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
            cells: assembly.tiling().cells,
            degrees_of_freedom: assembly.drawn().coordinates.len() - held,
        },
        terms,
        left_out,
        studies: vec![],
    }
}

/// The terms that are built, and those that this scene made unnecessary, each with its reason.
fn built_terms(assembly: &Assembly) -> (Vec<String>, Vec<String>) {
    let terms = assembly.terms();
    let no_facets = if assembly.tiling().facets().next().is_some() { "" } else { "facets: every face is a triangle" };
    let table = [
        ("bars", terms.bars.is_some(), "bars: not in [energy]"),
        ("creases", terms.creases.is_some(), "creases: not in [energy]"),
        ("facets", terms.facets.is_some(), no_facets),
        ("locks", !terms.locks.is_empty(), "locks: none given"),
        ("pins", !terms.pins.is_empty(), "pins: none given"),
        ("loads", !terms.loads.is_empty(), "loads: none given"),
    ];
    let (there, missing): (Vec<_>, Vec<_>) = table.into_iter().partition(|(_, there, _)| *there);
    let terms = there.into_iter().map(|(term, ..)| term.to_owned()).collect();
    (terms, missing.into_iter().map(|(_, _, why)| why.to_owned()).collect())
}
