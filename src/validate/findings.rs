//! What a measurement may use, and what it gives.

use super::precision::Diagram;
use foldwell::analysis::relax::RelaxError;
use foldwell::analysis::trace::TraceError;
use foldwell::model::AssemblyError;
use foldwell::output::OutputError;
use foldwell::output::figure::chart::Chart;
use foldwell::run::{Observer, Progress, RunError};
use foldwell::sheet::SheetError;
use serde::Serialize;
use serde_json::Value;
use thiserror::Error;

/// Why an experiment gives no value.
#[derive(Debug, Error)]
pub(crate) enum ExperimentError {
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
pub(crate) struct ReportTable {
    /// What it shows.
    pub title: String,
    /// Names of its columns.
    pub header: Vec<String>,
    /// Its rows.
    pub rows: Vec<Vec<String>>,
}

/// What an experiment gives.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Findings {
    /// Its values, among which claims choose.
    pub values: Value,
    /// Its diagrams of error against run time.
    pub diagrams: Vec<Diagram>,
    /// Its other charts.
    pub charts: Vec<Chart>,
    /// Its tables.
    pub tables: Vec<ReportTable>,
}

/// What a measurement may use.
pub(crate) struct Bench<'a> {
    /// Whether little time is allowed.
    pub quick: bool,
    /// The measurement.
    pub name: &'a str,
    /// Sees how far it is.
    pub observer: Observer<'a>,
}

impl Bench<'_> {
    /// Tells how far it is.
    ///
    /// # Errors
    /// [`ExperimentError::Interrupted`] where the observer asks to stop.
    pub(crate) fn step(&self, step: usize, of: usize) -> Result<(), ExperimentError> {
        let progress = Progress { study: self.name.into(), step, of: Some(of), residual: f64::NAN };
        if (self.observer)(&progress).is_continue() { Ok(()) } else { Err(ExperimentError::Interrupted) }
    }
}
