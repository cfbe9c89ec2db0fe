//! The input of a study: its scene and sheet, the answers of earlier studies, and the observer of the run.

use crate::analysis::intersections::SelfIntersection;
use crate::analysis::shown_cells::ShownCells;
use crate::model::{Assembly, Configuration};
use crate::output::OutputError;
use crate::output::figure::Caption;
use crate::output::figure::surface::TrajectoryPoint;
use crate::scene::spec::{Check, Draw, StudySpec, UnitsSpec};
use crate::scene::{SceneError, SceneFile};
use std::collections::HashMap;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, Ordering};

/// The progress of a study.
#[derive(Clone, Debug, PartialEq)]
pub struct Progress {
    /// Name of the study.
    pub study: String,
    /// Number of steps taken.
    pub step: usize,
    /// Total number of steps, if it is known; 0 where all are taken, and the results are drawn and written.
    pub of: Option<usize>,
    /// The residual to be reduced below its tolerance; NaN if there is none.
    pub residual: f64,
    /// The part of the way of a path that its drive has gone, 0 to 1; NaN if it is not known.
    pub part: f64,
}

impl Progress {
    /// Whether all steps of the study are taken: what is left is to draw and to write.
    pub fn all_taken(&self) -> bool {
        self.of == Some(0)
    }
}

/// The observer of a run: called after every step, it returns whether to go on.
pub type Observer<'a> = &'a (dyn Fn(&Progress) -> ControlFlow<()> + Sync);

/// The results of the studies before this one, by the names of the studies.
#[derive(Clone, Debug, Default)]
pub struct PreviousAnswers {
    /// The states in which the studies ended.
    pub states: HashMap<String, Configuration>,
    /// The trajectories that the studies followed, in the space of lattice strains.
    pub paths: HashMap<String, Vec<Vec<TrajectoryPoint>>>,
}

/// Storage for the partial results of a long study, from which an interrupted run can continue.
pub trait Checkpoints: Sync {
    /// Begins a log, and returns the lines of it that an interrupted run kept, up to the first that is incomplete or
    /// was changed; no lines if it kept none. New lines follow these.
    ///
    /// # Errors
    /// [`OutputError`] if the log cannot be begun.
    fn log(&self, file: &str) -> Result<Vec<String>, OutputError>;

    /// Appends a line to the log that was begun last, which is removed when the study is finished.
    ///
    /// # Errors
    /// [`OutputError`] if the log cannot be written.
    fn log_line(&self, line: &str) -> Result<(), OutputError>;
}

/// A study in its scene, the argument of [`super::check`] and [`super::compute`].
pub struct Context<'a> {
    /// The scene.
    pub file: &'a SceneFile,
    /// The sheet with its boundary conditions and terms.
    pub assembly: &'a Assembly,
    /// The cells that pictures show.
    pub view: &'a ShownCells,
    /// The study to be computed.
    pub study: &'a StudySpec,
    /// The results of the studies before it.
    pub earlier: &'a PreviousAnswers,
    /// Storage for partial results.
    pub checkpoints: &'a dyn Checkpoints,
    /// The observer of the run.
    pub observer: Observer<'a>,
    /// Whether the observer has asked to stop.
    pub interrupted: &'a AtomicBool,
}

impl Context<'_> {
    /// Returns the name of the study.
    pub fn name(&self) -> &str {
        &self.study.name.0
    }

    /// Returns the caption of a picture: the title of the scene, and the given description of the state.
    pub fn caption(&self, state: impl Into<String>) -> Caption {
        Caption { title: self.file.title(), state: state.into() }
    }

    /// Returns the names of units that the scene gives.
    pub fn units(&self) -> UnitsSpec {
        self.file.scene.units.clone().unwrap_or_default()
    }

    /// Returns an error that points at the kind of this study in the scene.
    pub fn refuse(&self, message: impl AsRef<str>, help: impl AsRef<str>) -> SceneError {
        self.file.error_at(self.study.kind.span(), message.as_ref(), help.as_ref())
    }

    /// Reports a step without a residual to the observer; returns whether to go on.
    pub fn step(&self, step: usize, of: Option<usize>) -> bool {
        self.step_with_residual(step, of, f64::NAN)
    }

    /// Reports a step and its residual to the observer; returns whether to go on.
    pub fn step_with_residual(&self, step: usize, of: Option<usize>, residual: f64) -> bool {
        self.step_on_way(Progress { study: self.name().to_owned(), step, of, residual, part: f64::NAN })
    }

    /// Reports a step to the observer; returns whether to go on.
    pub fn step_on_way(&self, progress: Progress) -> bool {
        let go_on = (self.observer)(&progress).is_continue();
        self.interrupted.fetch_or(!go_on, Ordering::Relaxed);
        go_on
    }

    /// Tells the observer that all steps are taken: what is left is to draw and to write, which is not stopped.
    pub fn end_steps(&self) {
        let (study, step, of) = (self.name().to_owned(), 0, Some(0));
        let _ = (self.observer)(&Progress { study, step, of, residual: f64::NAN, part: f64::NAN });
    }

    /// Whether the observer has asked to stop.
    pub fn interrupted(&self) -> bool {
        self.interrupted.load(Ordering::Relaxed)
    }

    /// Whether pictures of this kind are made: as files of their own, or for the page of the study.
    pub fn draws(&self, draw: Draw) -> bool {
        self.study.draw.contains(&draw) || self.study.draw.contains(&Draw::Html)
    }

    /// Returns a finder of self-intersections; `None` if the study does not ask for that check.
    pub fn self_intersection(&self) -> Option<SelfIntersection> {
        self.study.check.contains(&Check::SelfIntersection).then(|| SelfIntersection::new(self.assembly))
    }
}
