//! Experiments: runs of scenes and measurements, each performed once even if several claims use it.

use super::claim::Experiment;
use super::findings::{ExperimentError, Findings};
use super::{library, measure};
use foldwell::output::json::to_json;
use foldwell::run::{RunOptions, run_scene};
use std::ops::ControlFlow;
use std::path::PathBuf;
use std::time::Instant;

/// The result of an experiment.
#[derive(Debug)]
pub struct Performed {
    /// The values found, or the reason why there are none.
    pub found: Result<Findings, ExperimentError>,
    /// Duration in seconds.
    pub seconds: f64,
    /// Whether the current claim is the first that uses it.
    pub first: bool,
}

/// Performs experiments, and keeps their results.
pub struct Experiments {
    folder: PathBuf,
    quick: bool,
    performed: Vec<(Experiment, Performed)>,
}

impl Experiments {
    /// Makes an empty collection; experiments write into folders inside `folder`.
    pub fn new(folder: PathBuf, quick: bool) -> Self {
        Self { folder, quick, performed: Vec::new() }
    }

    /// Performs an experiment, or returns its result if it was performed before.
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

    /// Runs a scene of `meshes/`, and returns its summary.
    fn run(&self, scene: &str) -> Result<Findings, ExperimentError> {
        let out = Some(self.folder.join("runs").join(scene.trim_end_matches(".toml")));
        let options = RunOptions { out, ..RunOptions::default() };
        let report = run_scene(&library::mesh(scene), &options, &|_| ControlFlow::Continue(()))?;
        if let Some(study) = report.summary.studies.iter().find(|study| !study.converged) {
            let reason = study.reason.clone().unwrap_or_default();
            return Err(ExperimentError::Study { study: study.name.clone(), reason });
        }
        let values = serde_json::from_str(&to_json(&report.summary));
        let values = values.map_err(|_| ExperimentError::Other("the summary is no JSON".into()))?;
        Ok(Findings { values, ..Findings::default() })
    }

    fn measure(&self, name: &str) -> Result<Findings, ExperimentError> {
        let measurement = measure::find(name).ok_or_else(|| ExperimentError::Unknown(name.into()))?;
        measurement(self.quick)
    }
}
