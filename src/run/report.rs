//! What the command line can change about a run, and what a run did.

use crate::output::summary::Summary;
use std::path::PathBuf;

/// What the command line can change about a run.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct RunOptions {
    /// Folder for the files; `None`: the scene's name without its ending, in the current folder.
    pub out: Option<PathBuf>,
    /// Number of threads; `None`: as many as the machine has.
    pub threads: Option<usize>,
    /// Keep the studies that an interrupted run finished.
    pub resume: bool,
}

/// What a run did.
#[derive(Clone, Debug, PartialEq)]
pub struct RunReport {
    /// What is in `summary.json`.
    pub summary: Summary,
    /// Where the files are.
    pub out: PathBuf,
    /// Studies that an earlier run had finished and that were not computed again.
    pub kept: Vec<String>,
    /// Whether the observer stopped it.
    pub interrupted: bool,
    /// What is to be said about the scene.
    pub notes: Vec<String>,
}
