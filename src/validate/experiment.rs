//! Experiments: a scene or a measurement, performed once however many claims ask for it.

use super::claim::Experiment;
use super::precision::Diagram;
use super::{library, measure};
use foldwell::analysis::relax::RelaxError;
use foldwell::analysis::trace::TraceError;
use foldwell::model::AssemblyError;
use foldwell::output::figure::chart::Chart;
use foldwell::output::{OutputError, files};
use foldwell::run::{Observer, Progress, RunError, RunOptions, run_scene};
use foldwell::sheet::SheetError;
use serde::Serialize;
use serde_json::Value;
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;
use thiserror::Error;

/// Why an experiment gives no value.
#[derive(Debug, Error)]
pub enum ExperimentError {
    /// A scene could not be run.
    #[error(transparent)]
    Run(#[from] RunError),
    /// A file could not be written or read.
    #[error(transparent)]
    Output(#[from] OutputError),
    /// A mesh is wrong.
    #[error(transparent)]
    Mesh(#[from] SheetError),
    /// A sheet cannot be put together.
    #[error(transparent)]
    Assembly(#[from] AssemblyError),
    /// A relaxation failed.
    #[error(transparent)]
    Relax(#[from] Box<RelaxError>),
    /// A trajectory failed.
    #[error(transparent)]
    Trace(#[from] TraceError),
    /// Something else.
    #[error("{0}")]
    Other(String),
    /// A study of a scene gave no answer.
    #[error("study {study}: {reason}")]
    Study {
        /// The study.
        study: String,
        /// Why.
        reason: String,
    },
    /// There is no such experiment.
    #[error("there is no experiment `{0}`")]
    Unknown(String),
    /// The observer asked to stop.
    #[error("stopped on request")]
    Interrupted,
}

/// A table of a report.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct ReportTable {
    /// What it shows.
    pub title: String,
    /// Names of its columns.
    pub header: Vec<String>,
    /// Its rows.
    pub rows: Vec<Vec<String>>,
}

/// What an experiment gives.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Findings {
    /// Its values, among which claims choose.
    pub values: Value,
    /// Its diagrams of error against run time.
    pub diagrams: Vec<Diagram>,
    /// Its other charts.
    pub charts: Vec<Chart>,
    /// Its tables.
    pub tables: Vec<ReportTable>,
}

/// An experiment that was performed.
#[derive(Debug)]
pub struct Performed {
    /// What was found.
    pub found: Result<Findings, ExperimentError>,
    /// Time it took.
    pub seconds: f64,
    /// Whether this is the first claim that asks for it.
    pub first: bool,
}

/// Where experiments are performed.
pub struct Experiments<'a> {
    folder: PathBuf,
    quick: bool,
    observer: Observer<'a>,
    performed: Vec<(Experiment, Performed)>,
}

/// What a measurement may use.
pub struct Bench<'a> {
    /// Whether little time is allowed.
    pub quick: bool,
    name: &'a str,
    observer: Observer<'a>,
}

impl Bench<'_> {
    /// Tells how far it is.
    ///
    /// # Errors
    /// [`ExperimentError::Interrupted`] where the observer asks to stop.
    pub fn step(&self, step: usize, of: usize) -> Result<(), ExperimentError> {
        let progress = Progress { study: self.name.into(), step, of: Some(of), residual: f64::NAN };
        if (self.observer)(&progress).is_continue() { Ok(()) } else { Err(ExperimentError::Interrupted) }
    }
}

impl<'a> Experiments<'a> {
    /// Experiments write into folders below this one.
    pub fn new(folder: PathBuf, quick: bool, observer: Observer<'a>) -> Self {
        Self { folder, quick, observer, performed: Vec::new() }
    }

    /// Performs an experiment, or remembers it.
    pub fn perform(&mut self, experiment: &Experiment) -> &Performed {
        let known = self.performed.iter().position(|(performed, _)| performed == experiment);
        let at = known.unwrap_or_else(|| {
            let clock = Instant::now();
            let found = match experiment {
                Experiment::Scene(scene) => self.run(scene),
                Experiment::Measurement(name) => self.measure(name),
            };
            let outcome = Performed { found, seconds: clock.elapsed().as_secs_f64(), first: true };
            self.performed.push((experiment.clone(), outcome));
            self.performed.len() - 1
        });
        let outcome = &mut self.performed[at].1;
        outcome.first = known.is_none();
        outcome
    }

    /// Runs a scene of `meshes/`, laid out beside the reports, and gives its summary.
    fn run(&self, scene: &str) -> Result<Findings, ExperimentError> {
        for (name, text) in library::meshes() {
            files::write(&self.folder.join("meshes").join(name), text)?;
        }
        let stopped = AtomicBool::new(false);
        let watch = |progress: &Progress| {
            let answer = (self.observer)(progress);
            stopped.fetch_or(answer.is_break(), Ordering::Relaxed);
            answer
        };
        let out = Some(self.folder.join("runs").join(scene.trim_end_matches(".toml")));
        let options = RunOptions { out, ..RunOptions::default() };
        let report = run_scene(&self.folder.join("meshes").join(scene), &options, &watch)?;
        if stopped.into_inner() {
            return Err(ExperimentError::Interrupted);
        }
        if let Some(study) = report.summary.studies.iter().find(|study| !study.converged) {
            let reason = study.reason.clone().unwrap_or_default();
            return Err(ExperimentError::Study { study: study.name.clone(), reason });
        }
        let values = serde_json::from_str(&report.summary.to_json());
        let values = values.map_err(|_| ExperimentError::Other("the summary is no JSON".into()))?;
        Ok(Findings { values, ..Findings::default() })
    }

    fn measure(&self, name: &str) -> Result<Findings, ExperimentError> {
        let measurement = measure::find(name).ok_or_else(|| ExperimentError::Unknown(name.into()))?;
        let bench = Bench { quick: self.quick, name, observer: self.observer };
        bench.step(0, 1)?;
        measurement(&bench)
    }
}
