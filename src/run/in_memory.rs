//! Runs that write no file: the answers of the studies of a scene stay in memory.

use super::runner::summary_of;
use super::studies::Studies;
use super::{RunError, Summary};
use crate::model::Assembly;
use crate::numerics::parallel::Threads;
use crate::output::OutputError;
use crate::scene::SceneFile;
use crate::scene::spec::StudySpec;
use crate::study::{self, Answer, Checkpoints, Observer, PreviousAnswers};

/// The answers of the studies of a scene.
#[derive(Debug)]
pub struct Computed {
    /// What `summary.json` would contain, without a digest of the input.
    pub summary: Summary,
    /// The answers of the studies that were computed, in the order of the scene.
    pub answers: Vec<Answer>,
    /// Whether the observer stopped the run; studies after that are missing.
    pub interrupted: bool,
}

/// Computes the studies of a scene on an assembly of its sheet and writes nothing.
///
/// The assembly is that of the scene ([`scene::build::assembly`](crate::scene::build::assembly)), or one of the same
/// sheet, boundary conditions, locks, parts and drives with other stiffnesses and rest values. Studies whose final
/// state is in `earlier` are not computed: others start from these states.
///
/// ```
/// use foldwell::{run, scene};
/// use std::ops::ControlFlow;
///
/// let text = r#"
///     sheet = { generate = { pattern = "miura" }, cells = [2, 2] }
///     energy = { bars = { stiffness = inf }, creases = { stiffness = 1.0, rest = "flat" } }
///     study = [{ name = "relaxed", kind = "relax" }]
/// "#;
/// let file = scene::parse(text, "miura.toml")?;
/// let assembly = scene::build::assembly(&file)?;
/// let computed = run::compute(&file, &assembly, Default::default(), Some(1), &|_| ControlFlow::Continue(()))?;
/// assert!(computed.answers[0].summary.converged);
/// # Ok::<(), foldwell::run::RunError>(())
/// ```
///
/// # Errors
/// [`RunError`] if there is no study, or one does not fit the sheet; nothing was computed then.
pub fn compute(
    file: &SceneFile,
    assembly: &Assembly,
    earlier: PreviousAnswers,
    threads: Option<usize>,
    observer: Observer,
) -> Result<Computed, RunError> {
    super::single::has_studies(file)?;
    let work = || {
        let mut studies = Studies::new(file, assembly, earlier, observer);
        let wanted: Vec<&StudySpec> =
            file.scene.studies.iter().filter(|study| !studies.earlier.states.contains_key(&study.name.0)).collect();
        wanted.iter().try_for_each(|study| study::check(&studies.context(study, &NotKept)))?;
        let mut answers = Vec::new();
        for study in wanted {
            if !studies.interrupted() {
                let answer = studies.answer(study, &NotKept)?;
                studies.keep(&answer);
                answers.push(answer);
            }
        }
        let mut summary = summary_of(file, assembly, String::new());
        summary.studies = answers.iter().map(|answer| answer.summary.clone()).collect();
        Ok(Computed { summary, answers, interrupted: studies.interrupted() })
    };
    Threads::new(threads).install(work)
}

/// Checkpoints of a run that cannot be resumed.
struct NotKept;

impl Checkpoints for NotKept {
    fn log(&self, _file: &str) -> Result<Vec<String>, OutputError> {
        Ok(Vec::new())
    }

    fn log_line(&self, _line: &str) -> Result<(), OutputError> {
        Ok(())
    }
}
