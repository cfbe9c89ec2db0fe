//! What the studies of one run share: the built scene, the folder, the summary, and the states already found.

use super::{Observer, Progress, RunError, RunOptions, RunReport, studies};
use crate::analysis::view::View;
use crate::numerics::parallel;
use crate::output::summary::{SheetSummary, StudySummary, Summary};
use crate::scene::SceneFile;
use crate::scene::build::Built;
use crate::scene::spec::{StudyKind, StudySpec};
use crate::sheet::Info;
use std::cell::Cell;
use std::collections::HashMap;
use std::path::{Path, PathBuf};

/// A state that later studies may start from.
#[derive(Clone, Debug)]
pub struct Kept {
    /// All coordinates.
    pub coordinates: Vec<f64>,
    /// Angles from which angles continue, see [`crate::model::Model::angles`].
    pub angles: Vec<f64>,
}

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
    /// States by the name of their study.
    pub kept: HashMap<String, Kept>,
    summary: Summary,
    observer: Observer<'a>,
    interrupted: Cell<bool>,
}

impl<'a> Runner<'a> {
    /// Makes the folder ready; nothing is written before this.
    pub fn new(
        file: &'a SceneFile,
        built: &'a Built,
        options: &RunOptions,
        observer: Observer<'a>,
    ) -> Result<Self, RunError> {
        parallel::set_threads(options.threads.unwrap_or(0));
        for study in &file.scene.studies {
            studies::check(file, built, study)?;
        }
        let stem = || PathBuf::from(file.path().file_stem().unwrap_or_default());
        let out = options.out.clone().unwrap_or_else(stem);
        let view = View::new(&built.sheet, &built.tiling, built.surroundings, built.shown);
        let summary = summary(file, built);
        Ok(Self { file, built, view, out, kept: HashMap::new(), summary, observer, interrupted: Cell::new(false) })
    }

    /// Computes one study, writes its files, and the summary so far.
    pub fn study(&mut self, study: &StudySpec) -> Result<(), RunError> {
        let found = match &*study.kind {
            StudyKind::Relax(spec) => studies::relax(self, study, spec)?,
            StudyKind::Modes(spec) => studies::modes(self, study, spec)?,
            other => return Err(RunError::NotAvailable(super::Feature::StudyKind(other.name()))),
        };
        self.push(found)
    }

    fn push(&mut self, study: StudySummary) -> Result<(), RunError> {
        self.summary.studies.push(study);
        Ok(self.summary.write(&self.out.join("summary.json"))?)
    }

    /// Tells the observer of a step; false: stop.
    pub fn watch(&self, study: &str, step: usize, of: Option<usize>, residual: f64) -> bool {
        let go_on = (self.observer)(&Progress { study: study.to_owned(), step, of, residual }).is_continue();
        self.interrupted.set(self.interrupted.get() || !go_on);
        go_on
    }

    /// Whether the observer asked to stop.
    pub fn interrupted(&self) -> bool {
        self.interrupted.get()
    }

    /// File of a study in the folder.
    pub fn path(&self, name: impl AsRef<Path>) -> PathBuf {
        self.out.join(name)
    }

    /// Ends the run.
    pub fn finish(self) -> Result<RunReport, RunError> {
        self.summary.write(&self.out.join("summary.json"))?;
        Ok(RunReport { summary: self.summary, out: self.out, interrupted: self.interrupted.get() })
    }
}

fn summary(file: &SceneFile, built: &Built) -> Summary {
    let info = Info::new(&built.sheet);
    let (terms, left_out) = built.terms();
    let held = built.drawn.held.len() + built.recipe.pins.iter().flat_map(|(_, axes)| axes).filter(|a| **a).count();
    Summary {
        version: env!("CARGO_PKG_VERSION"),
        scene: file.path().display().to_string(),
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
