//! The options of a run and its report.

use crate::run::Summary;
use crate::scene::SceneFile;
use std::path::PathBuf;

/// The options of a run that the command line sets.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct RunOptions {
    /// Folder for the files; `None` for a folder in the current one, named like the scene without its ending.
    pub out: Option<PathBuf>,
    /// Number of threads; `None` for as many as the machine has.
    pub threads: Option<usize>,
    /// Whether to keep the studies that an interrupted run finished.
    pub resume: bool,
}

impl RunOptions {
    /// Returns the folder for the files of a scene.
    pub(super) fn folder(&self, file: &SceneFile) -> PathBuf {
        self.out.clone().unwrap_or_else(|| PathBuf::from(file.path().file_stem().unwrap_or_default()))
    }
}

/// The report of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct RunReport {
    /// The content of `summary.json`.
    pub summary: Summary,
    /// The folder of the files.
    pub out: PathBuf,
    /// Names of the studies that an earlier run had finished and that were not computed again.
    pub kept: Vec<String>,
    /// Whether the observer stopped the run.
    pub interrupted: bool,
}
