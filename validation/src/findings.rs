//! The results of a measurement.

use super::precision::Diagram;
use foldwell::analysis::relax::RelaxError;
use foldwell::analysis::trace::TraceError;
use foldwell::model::AssemblyError;
use foldwell::output::OutputError;
use foldwell::output::figure::chart::LineChart;
use foldwell::run::RunError;
use foldwell::sheet::SheetError;
use serde::Serialize;
use serde_json::Value;
use thiserror::Error;

/// The reason why an experiment gives no value.
#[derive(Debug, Error)]
pub enum ExperimentError {
    /// A scene could not be run.
    #[error(transparent)]
    Run(#[from] RunError),
    /// A file could not be written or read.
    #[error(transparent)]
    Output(#[from] OutputError),
    /// A mesh is not valid.
    #[error(transparent)]
    Mesh(#[from] SheetError),
    /// A mechanical model cannot be assembled.
    #[error(transparent)]
    Assembly(#[from] AssemblyError),
    /// A relaxation failed.
    #[error(transparent)]
    Relax(#[from] Box<RelaxError>),
    /// A trajectory failed.
    #[error(transparent)]
    Trace(#[from] TraceError),
    /// Any other reason.
    #[error("{0}")]
    Other(String),
    /// A study of a scene did not converge.
    #[error("study {study}: {reason}")]
    Study {
        /// Name of the study.
        study: String,
        /// Reason given by the study.
        reason: String,
    },
    /// There is no experiment of this name.
    #[error("there is no experiment `{0}`")]
    Unknown(String),
}

/// A table of a report.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct ReportTable {
    /// Title.
    pub title: String,
    /// Names of the columns.
    pub header: Vec<String>,
    /// Rows, with a text for each column.
    pub rows: Vec<Vec<String>>,
}

/// The results of an experiment.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Findings {
    /// Values, as a JSON table with paths that claims refer to.
    pub values: Value,
    /// Diagrams of error against run time.
    pub diagrams: Vec<Diagram>,
    /// Other charts.
    pub charts: Vec<LineChart>,
    /// Tables.
    pub tables: Vec<ReportTable>,
}
