//! The run of one scene without a sweep: its studies are computed one after the other, and their files are written.

use super::runner::Runner;
use super::{Ledger, RunError, RunOptions, RunReport};
use crate::model::Assembly;
use crate::numerics::parallel::Threads;
use crate::output::claim::Claim;
use crate::scene::SceneFile;
use crate::study::{Answer, Observer, Progress};
use std::ops::ControlFlow;

/// Computes the studies of a scene and writes their files. The run is recorded in `ledger`, so that another thread can
/// end it without waiting for it.
///
/// # Errors
/// [`RunError`], as [`run_scene`](super::run_scene).
pub fn run(file: &SceneFile, options: &RunOptions, observer: Observer, ledger: &Ledger) -> Result<RunReport, RunError> {
    if let Some(sweep) = &file.scene.sweep {
        let help = "its points are computed by `foldwell run`, in the library by `run::sweep`; or leave out [sweep]";
        return Err(file.error_at(sweep.span(), "this scene is a sweep", help).into());
    }
    run_with(file, options, observer, ledger, None)
}

/// Does the same for a scene without a sweep, in a folder that may be claimed already.
pub(super) fn run_with(
    file: &SceneFile,
    options: &RunOptions,
    observer: Observer,
    ledger: &Ledger,
    claim: Option<Claim>,
) -> Result<RunReport, RunError> {
    Threads::new(options.threads).install(|| {
        let assembly = assembly(file)?;
        let runner = Runner::new(file, &assembly, options, observer, ledger)?;
        over_studies(runner, file, options, claim).map(|(report, _)| report)
    })
}

/// Does the same as [`run`] on the assembly of the scene
/// ([`scene::build::assembly`](crate::scene::build::assembly)), and returns the answers too, of those studies that an
/// earlier run has not finished.
///
/// # Errors
/// [`RunError`], as [`run_scene`](super::run_scene).
pub fn run_and_keep(
    file: &SceneFile,
    assembly: &Assembly,
    options: &RunOptions,
    observer: Observer,
    ledger: &Ledger,
) -> Result<(RunReport, Vec<Answer>), RunError> {
    has_something_to_compute(file)?;
    Threads::new(options.threads).install(|| {
        let mut runner = Runner::new(file, assembly, options, observer, ledger)?;
        runner.answers = Some(Vec::new());
        over_studies(runner, file, options, None)
    })
}

fn over_studies(
    mut runner: Runner<'_>,
    file: &SceneFile,
    options: &RunOptions,
    claim: Option<Claim>,
) -> Result<(RunReport, Vec<Answer>), RunError> {
    runner.begin(options.resume, claim)?;
    for study in &file.scene.studies {
        runner.study(study)?;
        if runner.interrupted() {
            break;
        }
    }
    runner.finish()
}

/// Does the checks that [`run`] does before it computes anything; writes nothing.
pub(super) fn check(file: &SceneFile, options: &RunOptions) -> Result<(), RunError> {
    let unobserved = |_: &Progress| ControlFlow::Continue(());
    Runner::new(file, &assembly(file)?, options, &unobserved, &Ledger::default()).map(|_| ())
}

/// Builds the model of a scene that has something to compute.
pub(super) fn assembly(file: &SceneFile) -> Result<Assembly, RunError> {
    has_something_to_compute(file)?;
    Ok(crate::scene::build::assembly(file)?)
}

/// Checks that a scene has a study, and one that reads its mass, if it has a mass.
fn has_something_to_compute(file: &SceneFile) -> Result<(), RunError> {
    has_studies(file)?;
    Ok(crate::scene::material::mass_is_read(file)?)
}

/// Checks that a scene has a study.
pub(super) fn has_studies(file: &SceneFile) -> Result<(), RunError> {
    let help = "add a [[study]], as in name = \"relaxed\", kind = \"relax\"";
    let none = file.scene.studies.is_empty();
    Ok(file.error_if(none, 0..0, "there is nothing to compute: the scene has no study", help)?)
}
