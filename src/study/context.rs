//! What a study is asked about, and by whom it is watched.

use super::answer::SavedState;
use crate::analysis::intersections::SelfIntersection;
use crate::analysis::shown_cells::ShownCells;
use crate::model::Assembly;
use crate::output::OutputError;
use crate::output::figure::Caption;
use crate::output::figure::surface::PathPoint;
use crate::output::table::Table;
use crate::scene::spec::{Check, Draw, StudySpec};
use crate::scene::{SceneError, SceneFile};
use std::collections::HashMap;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, Ordering};

/// How far a study is.
#[derive(Clone, Debug, PartialEq)]
pub struct Progress {
    /// Name of the study.
    pub study: String,
    /// Steps taken.
    pub step: usize,
    /// Steps in all, where that is known.
    pub of: Option<usize>,
    /// The residual that has to become small; not a number where there is none.
    pub residual: f64,
}

/// Whoever watches a run: called after every step, it says whether to go on.
pub type Observer<'a> = &'a (dyn Fn(&Progress) -> ControlFlow<()> + Sync);

/// What the studies before this one found, by their names.
#[derive(Clone, Debug, Default)]
pub struct PreviousAnswers {
    /// States in which studies ended.
    pub states: HashMap<String, SavedState>,
    /// The trajectories that they followed, in the space of lattice strains.
    pub paths: HashMap<String, Vec<Vec<PathPoint>>>,
}

/// Where a long study keeps what it has so far, so that an interrupted run can go on from there.
pub trait Checkpoints: Sync {
    /// The rows of a table that an interrupted run kept, by the names of these columns; none where it kept none.
    ///
    /// # Errors
    /// [`OutputError`] where there is a table that cannot be read.
    fn rows(&self, file: &str, columns: &[&str]) -> Result<Vec<Vec<f64>>, OutputError>;

    /// Keeps a table.
    ///
    /// # Errors
    /// [`OutputError`] where it cannot be kept.
    fn keep(&self, file: &str, table: &Table) -> Result<(), OutputError>;
}

/// A study in its scene.
pub struct Context<'a> {
    /// The scene.
    pub file: &'a SceneFile,
    /// The sheet with its boundary conditions and terms.
    pub assembly: &'a Assembly,
    /// The cells that pictures show.
    pub view: &'a ShownCells,
    /// What is asked.
    pub study: &'a StudySpec,
    /// What the studies before it found.
    pub earlier: &'a PreviousAnswers,
    /// Where parts of the answer are kept.
    pub checkpoints: &'a dyn Checkpoints,
    /// Whoever watches.
    pub observer: Observer<'a>,
    /// Whether the observer has asked to stop.
    pub interrupted: &'a AtomicBool,
}

impl Context<'_> {
    /// The name of the study.
    pub fn name(&self) -> &str {
        &self.study.name.0
    }

    /// The title of a picture, and what it shows.
    pub fn caption(&self, state: impl Into<String>) -> Caption {
        Caption { title: self.file.title(), state: state.into() }
    }

    /// A message at the kind of this study.
    pub fn refuse(&self, message: impl AsRef<str>, help: impl AsRef<str>) -> SceneError {
        self.file.error_at(self.study.kind.span(), message.as_ref(), help.as_ref())
    }

    /// Tells the observer of a step without a residual; false: stop.
    pub fn step(&self, step: usize, of: Option<usize>) -> bool {
        self.step_with_residual(step, of, f64::NAN)
    }

    /// Tells the observer of a step with its residual; false: stop.
    pub fn step_with_residual(&self, step: usize, of: Option<usize>, residual: f64) -> bool {
        let progress = Progress { study: self.name().to_owned(), step, of, residual };
        let go_on = (self.observer)(&progress).is_continue();
        self.interrupted.fetch_or(!go_on, Ordering::Relaxed);
        go_on
    }

    /// Whether the observer asked to stop.
    pub fn interrupted(&self) -> bool {
        self.interrupted.load(Ordering::Relaxed)
    }

    /// Whether the study asks for this kind of picture.
    pub fn draws(&self, draw: Draw) -> bool {
        self.study.draw.contains(&draw)
    }

    /// What finds self-intersection in the states of the study; `None` where that is not asked.
    pub fn self_intersection(&self) -> Option<SelfIntersection> {
        self.study.check.contains(&Check::SelfIntersection).then(|| SelfIntersection::new(self.assembly))
    }
}
